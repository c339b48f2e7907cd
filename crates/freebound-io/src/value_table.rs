//! Tables with numbers of the vertices or faces of a mesh, in.
//!
//! The first line names the columns. Without a column `vertex` or `face` the rows follow the numbers of the mesh, and
//! their count says which of the two they belong to. With such a column, its numbers, from 0, say where a row belongs.
//! Empty cells have no value. Columns that begin with words are left out. Cells are separated by commas, tabs or
//! semicolons.

use std::fs;
use std::io;
use std::path::Path;

/// Kind of elements that a table has rows for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableElement {
    /// Vertices.
    Vertex,
    /// Faces.
    Face,
}

impl TableElement {
    /// Name of the column with numbers of such elements.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Face => "face",
        }
    }
}

/// Numbers of vertices and faces of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ElementCounts {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of faces.
    pub faces: usize,
}

impl ElementCounts {
    const fn of(self, element: TableElement) -> usize {
        match element {
            TableElement::Vertex => self.vertices,
            TableElement::Face => self.faces,
        }
    }
}

/// Table of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct ValueTable {
    /// Kind of its rows.
    pub element: TableElement,
    /// Columns of numbers, at least one.
    pub columns: Vec<ValueColumn>,
}

/// Column of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct ValueColumn {
    /// Name of the column.
    pub title: String,
    /// Value of each vertex or face of the mesh; not a number without a value.
    pub values: Vec<f64>,
}

/// Fault of a table.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Read(#[from] io::Error),
    /// A line has another number of cells.
    #[error("{0}")]
    Lines(#[from] csv::Error),
    /// The number of rows fits neither vertices nor faces.
    #[error("{rows} rows, but the mesh has {} vertices and {} faces", counts.vertices, counts.faces)]
    Count {
        /// Number of rows.
        rows: usize,
        /// Numbers of the mesh.
        counts: ElementCounts,
    },
    /// The number of rows fits both.
    #[error("{0} rows fit the vertices and the faces")]
    Either(usize),
    /// A cell is no number.
    #[error("line {line}, column {title}: \"{cell}\" is not a number")]
    Cell {
        /// Line of the file, from 1.
        line: u64,
        /// Name of the column.
        title: String,
        /// Text of the cell.
        cell: String,
    },
    /// An element has no place in the mesh, or two rows.
    #[error("line {line}: {} {cell} {}", element.name(), if *is_double { "has a row already" } else { "does not exist" })]
    Element {
        /// Line of the file, from 1.
        line: u64,
        /// Kind of the element.
        element: TableElement,
        /// Text of the cell.
        cell: String,
        /// True if the element has a row before.
        is_double: bool,
    },
    /// There are no numbers.
    #[error("no column has numbers")]
    NoNumbers,
}

impl TableError {
    /// Remedy.
    pub const fn remedy(&self) -> &'static str {
        match self {
            Self::Read(_) => "choose a CSV or TSV file in UTF-8",
            Self::Lines(_) => "give every line as many cells as the first",
            Self::Count { .. } => "write a row for each element, or add a column vertex or face with numbers from 0",
            Self::Either(_) => "add a column vertex or face with numbers from 0",
            Self::Cell { .. } => "write a number, or leave the cell empty",
            Self::Element { .. } => "number from 0, as in the file of the mesh, and each element once",
            Self::NoNumbers => "add a column of numbers with a name in the first line",
        }
    }
}

impl ValueTable {
    /// Reads a file for a mesh with these counts.
    ///
    /// # Errors
    ///
    /// [`TableError`].
    pub fn read(path: &Path, counts: ElementCounts) -> Result<Self, TableError> {
        Self::parse(&fs::read_to_string(path)?, counts)
    }

    /// Parses a table for a mesh with these counts.
    ///
    /// # Errors
    ///
    /// [`TableError`].
    pub fn parse(text: &str, counts: ElementCounts) -> Result<Self, TableError> {
        let text = text.trim_start_matches('\u{feff}');
        let head = text.lines().next().unwrap_or_default();
        let delimiter = [b'\t', b';'].into_iter().find(|&mark| head.contains(char::from(mark))).unwrap_or(b',');
        let mut reader =
            csv::ReaderBuilder::new().delimiter(delimiter).trim(csv::Trim::All).from_reader(text.as_bytes());
        let heads: Vec<String> = reader.headers()?.iter().map(str::to_owned).collect();
        let rows = reader.records().collect::<Result<Vec<csv::StringRecord>, csv::Error>>()?;
        let index_of = |element: TableElement| heads.iter().position(|head| head.eq_ignore_ascii_case(element.name()));
        let index = [TableElement::Vertex, TableElement::Face]
            .into_iter()
            .find_map(|element| Some((element, index_of(element)?)));
        let (element, places) = match index {
            Some((element, column)) => (element, places(&rows, column, element, counts)?),
            None => (element_of_count(rows.len(), counts)?, (0..rows.len()).collect()),
        };
        let mut columns = Vec::new();
        for (column, title) in heads.iter().enumerate().filter(|(column, _)| Some(*column) != index.map(|(_, c)| c)) {
            let numbers = numbers(&rows, column, title)?;
            if let Some(numbers) = numbers {
                let mut values = vec![f64::NAN; counts.of(element)];
                for (&place, number) in places.iter().zip(numbers) {
                    values[place] = number;
                }
                columns.push(ValueColumn { title: title.clone(), values });
            }
        }
        if columns.is_empty() { Err(TableError::NoNumbers) } else { Ok(Self { element, columns }) }
    }
}

fn line_of(row: &csv::StringRecord) -> u64 {
    row.position().map_or(0, csv::Position::line)
}

/// Kind of elements of which there are as many as rows.
fn element_of_count(rows: usize, counts: ElementCounts) -> Result<TableElement, TableError> {
    match (rows == counts.vertices, rows == counts.faces) {
        (true, true) => Err(TableError::Either(rows)),
        (true, false) => Ok(TableElement::Vertex),
        (false, true) => Ok(TableElement::Face),
        (false, false) => Err(TableError::Count { rows, counts }),
    }
}

/// Elements of the rows, from a column with their numbers.
fn places(
    rows: &[csv::StringRecord],
    column: usize,
    element: TableElement,
    counts: ElementCounts,
) -> Result<Vec<usize>, TableError> {
    let mut has_row = vec![false; counts.of(element)];
    let place = |row: &csv::StringRecord| {
        let cell = row.get(column).unwrap_or_default();
        let fault = |is_double| TableError::Element { line: line_of(row), element, cell: cell.to_owned(), is_double };
        let place = cell.parse::<usize>().ok().filter(|&place| place < has_row.len()).ok_or_else(|| fault(false))?;
        if std::mem::replace(&mut has_row[place], true) { Err(fault(true)) } else { Ok(place) }
    };
    rows.iter().map(place).collect()
}

/// Numbers of a column, not a number for empty cells. `None` if the column begins with words, or is empty.
fn numbers(rows: &[csv::StringRecord], column: usize, title: &str) -> Result<Option<Vec<f64>>, TableError> {
    let cells = || rows.iter().map(|row| (row, row.get(column).unwrap_or_default()));
    let first = cells().map(|(_, cell)| cell).find(|cell| !cell.is_empty());
    if first.is_none_or(|first| first.parse::<f64>().is_err()) {
        return Ok(None);
    }
    let number = |(row, cell): (&csv::StringRecord, &str)| match cell.parse::<f64>() {
        _ if cell.is_empty() => Ok(f64::NAN),
        Ok(number) => Ok(number),
        Err(_) => Err(TableError::Cell { line: line_of(row), title: title.to_owned(), cell: cell.to_owned() }),
    };
    cells().map(number).collect::<Result<Vec<f64>, TableError>>().map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNTS: ElementCounts = ElementCounts { vertices: 3, faces: 2 };

    fn parse(text: &str) -> Result<ValueTable, TableError> {
        ValueTable::parse(text, COUNTS)
    }

    #[test]
    fn the_count_of_rows_or_a_column_of_numbers_says_what_they_belong_to() {
        let table = parse("name,curvature,area\na,1.5,2\nb,-2,\nc,0,4\n").unwrap();
        assert_eq!(table.element, TableElement::Vertex);
        assert_eq!(table.columns.iter().map(|of| &*of.title).collect::<Vec<_>>(), ["curvature", "area"]);
        assert_eq!(table.columns[0].values, [1.5, -2.0, 0.0]);
        assert!(table.columns[1].values[1].is_nan());
        assert_eq!(parse("x\n1\n2\n").unwrap().element, TableElement::Face);
        let table = parse("\u{feff}Vertex\tx\n2\t7\n0\t5\n").unwrap();
        assert_eq!(table.element, TableElement::Vertex);
        assert_eq!(table.columns[0].values[..1], [5.0]);
        assert!(table.columns[0].values[1].is_nan());
        assert_eq!(parse("face;x\n1;7\n").unwrap().element, TableElement::Face);
    }

    #[test]
    fn faults_name_the_line() {
        let words = |text: &str| parse(text).unwrap_err().to_string();
        assert!(words("x\n1\n").contains("1 rows, but the mesh has 3 vertices and 2 faces"));
        assert!(words("x\n1\nfoo\n3\n").starts_with("line 3, column x: \"foo\""), "{}", words("x\n1\nfoo\n3\n"));
        assert!(words("vertex,x\n9,1\n").starts_with("line 2: vertex 9 does not exist"));
        assert!(words("face,x\n1,1\n1,2\n").starts_with("line 3: face 1 has a row already"));
        assert!(words("name\na\nb\n").contains("no column"));
        assert!(matches!(parse("x,y\n1\n2,3\n"), Err(TableError::Lines(_))));
        let same = ElementCounts { vertices: 2, faces: 2 };
        assert!(matches!(ValueTable::parse("x\n1\n2\n", same), Err(TableError::Either(2))));
        for text in ["", "\n\n", "a,b", "\"", "x\nNaN\ninf\n-inf\n"] {
            let _ = parse(text);
        }
    }
}
