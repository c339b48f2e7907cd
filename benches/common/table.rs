//! Plain text tables.

/// Rows under a head, with columns as wide as needed.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    title: String,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// Empty table with a title and column heads.
    pub(crate) fn new(title: impl Into<String>, heads: &[&str]) -> Self {
        Self { title: title.into(), rows: vec![heads.iter().map(|&head| head.to_owned()).collect()] }
    }

    /// Adds a row.
    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Prints the table, the first column aligned left, the others aligned right.
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

/// Formats seconds for a table.
pub(crate) fn seconds(value: f64) -> String {
    format!("{value:.3}")
}

/// Formats a number of bytes for a table, in millions.
pub(crate) fn megabytes(bytes: usize) -> String {
    format!("{:.1}", bytes as f64 / 1e6)
}

/// Formats a ratio for a table.
pub(crate) fn ratio(value: f64) -> String {
    format!("{value:.2}")
}

/// Formats an upper limit, and if a value meets it.
pub(crate) fn target(value: f64, at_most: f64) -> String {
    let word = if value <= at_most { "met" } else { "MISSED" };
    format!("≤ {at_most:?} {word}")
}
