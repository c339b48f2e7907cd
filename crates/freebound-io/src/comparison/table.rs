//! Table of a comparison, and the steps of its methods.

use std::io::{self, Write};

use super::column::exact_number;
use super::{Cell, Column, ComparisonReport, Direction, MethodReport, TimedStep};
use freebound_core::problem::NamedOption as _;

/// Blanks between two columns.
const GAP: &str = "  ";

impl ComparisonReport {
    /// Methods sorted by a column; equal methods keep their order. Without a column: in the order of the comparison.
    pub fn sorted(&self, by: Option<Column>) -> Vec<&MethodReport> {
        let mut methods: Vec<&MethodReport> = self.methods.iter().collect();
        if let Some(column) = by {
            methods.sort_by(|first, second| column.compare(Direction::Up, [first, second]));
        }
        methods
    }

    /// Table as text: words aligned at the left, numbers at the right. The column after the method's name holds its
    /// weights.
    pub fn table(&self, by: Option<Column>) -> String {
        let row = |of: &MethodReport| {
            let mut cells: Vec<String> = Column::ALL.iter().map(|column| column.cell(of).words()).collect();
            cells.insert(1, of.family.map_or_else(|| Cell::Nothing.words(), |family| family.to_string()));
            cells
        };
        let mut heads: Vec<String> = Column::ALL.iter().map(|column| column.labels().title.to_owned()).collect();
        heads.insert(1, "Weights".to_owned());
        let mut are_words: Vec<bool> = Column::ALL.iter().map(|column| column.is_of_words()).collect();
        are_words.insert(1, true);
        let rows: Vec<Vec<String>> = std::iter::once(heads).chain(self.sorted(by).into_iter().map(row)).collect();
        let width = |at: usize| rows.iter().map(|row| row[at].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..are_words.len()).map(width).collect();
        let line = |row: &Vec<String>| {
            let cells = row.iter().zip(&widths).zip(&are_words).map(|((cell, &width), is_of_words)| {
                if *is_of_words { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            cells.collect::<Vec<_>>().join(GAP).trim_end().to_owned()
        };
        rows.iter().map(line).collect::<Vec<_>>().join("\n")
    }

    /// Writes the table as a file (CSV): one line per method, with all digits.
    ///
    /// # Errors
    ///
    /// If `out` cannot be written.
    pub fn write_csv(&self, by: Option<Column>, out: impl Write) -> io::Result<()> {
        let mut table = csv::Writer::from_writer(out);
        table.write_record(Column::ALL.iter().map(|column| column.head()).chain(["planar", "error", "family"]))?;
        for of in self.sorted(by) {
            let planar = of.result.as_ref().map(|result| result.verdict.planar.to_string()).unwrap_or_default();
            let error = of.error.as_ref().map(|error| error.message.clone()).unwrap_or_default();
            let family = of.family.map(|family| family.to_string()).unwrap_or_default();
            let cells = Column::ALL.iter().map(|column| column.cell(of).exact());
            table.write_record(cells.chain([planar, error, family]))?;
        }
        table.flush()
    }

    /// Writes every step of every method (CSV) with the quality of its embedding: curves over time.
    ///
    /// # Errors
    ///
    /// If `out` cannot be written.
    pub fn write_steps(&self, out: impl Write) -> io::Result<()> {
        let mut table = csv::Writer::from_writer(out);
        let heads = TimedStep::default().row();
        table.write_record(std::iter::once("method").chain(heads.iter().map(|(head, _)| *head)))?;
        for of in &self.methods {
            for step in &of.steps {
                let row = step.row();
                table
                    .write_record(std::iter::once(of.name.as_str()).chain(row.iter().map(|(_, cell)| cell.as_str())))?;
            }
        }
        table.flush()
    }
}

impl TimedStep {
    /// Fields of the step as a row of a table, after those of its curve.
    fn row(&self) -> Vec<(&'static str, String)> {
        let of_curve = [
            ("elapsed", self.elapsed),
            ("energy", self.energy),
            ("stretch_l2", self.stretch_l2),
            ("stretch_linf", self.stretch_linf),
        ];
        let of_curve = of_curve.map(|(head, number)| (head, exact_number(number)));
        // The energy of the step exists only if its stage measures it. The energy of the curve always exists.
        let of_step = self.step.row().into_iter().filter(|(head, _)| *head != "energy");
        of_curve.into_iter().chain(of_step).collect()
    }
}
