//! Plain tables.

/// Rows under a head; columns as wide as they need to be.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    title: String,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table with a title and the heads of its columns.
    pub(crate) fn new(title: impl Into<String>, heads: &[&str]) -> Self {
        Self { title: title.into(), rows: vec![heads.iter().map(|&head| head.to_owned()).collect()] }
    }

    /// Adds a row.
    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Prints it, the first column to the left, all others to the right.
    pub(crate) fn print(&self) {
        println!("{}", self.title);
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |column: usize| {
            self.rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        for row in &self.rows {
            let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
                if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            println!("  {}", cells.collect::<Vec<_>>().join("  ").trim_end());
        }
        println!();
    }
}

/// A time for a table.
pub(crate) fn seconds(value: f64) -> String {
    format!("{value:.3}")
}

/// A number of bytes for a table, in millions.
pub(crate) fn megabytes(bytes: usize) -> String {
    format!("{:.1}", bytes as f64 / 1e6)
}

/// A quotient for a table.
pub(crate) fn ratio(value: f64) -> String {
    format!("{value:.2}")
}

/// Whether a target is met, in words.
pub(crate) fn target(value: f64, at_most: f64) -> String {
    let word = if value <= at_most { "met" } else { "MISSED" };
    format!("≤ {at_most:?} {word}")
}
