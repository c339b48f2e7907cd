//! `freebound figures`: the paper's figures 1, 3, 4, 5, 6, 8 and 9, computed again on the built-in meshes.
//!
//! Each is written as a drawing and as a picture with all its panels; their numbers stand in one table, on standard
//! output and in `figures.csv`. The same bytes come out every time.

mod flat;
mod free;
pub mod pairs;
mod repaired;
mod textured;

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::sync::Arc;

use super::flatten::go_on;
use super::progress::{Progress, interrupted};
use super::{Failure, Status};
use crate::examples::Example;
use crate::io::figure::Sheet;
use crate::io::{WriteError, write_atomically};
use crate::mesh::DiskMesh;
use crate::solver::{Control, SolveError, Step};

/// Pixels per point of the pictures.
const PIXELS: f64 = 2.0;

/// Name of the table.
const TABLE: &str = "figures.csv";

/// Heads of the table's columns.
const COLUMNS: [&str; 7] = ["figure", "panel", "shows", "flips", "crossings", "turning_number", "steps"];

/// A figure, laid out and measured.
struct Figure {
    number: u32,
    sheet: Sheet,
    rows: Vec<Row>,
}

/// A line of the table.
struct Row {
    panel: char,
    shows: String,
    /// What was measured, where the panel shows an embedding.
    numbers: Option<Numbers>,
}

/// What is measured of an embedding.
#[derive(Clone, Copy)]
struct Numbers {
    flips: usize,
    crossings: usize,
    turning_number: Option<i64>,
    /// Linear solves that led to it.
    steps: usize,
}

impl Numbers {
    fn of(step: &Step) -> Self {
        let verdict = &step.verdict;
        Self {
            flips: verdict.flipped_faces.len(),
            crossings: verdict.crossing_count(),
            turning_number: verdict.turning_number,
            steps: step.index + 1,
        }
    }
}

impl Row {
    fn cells(&self, figure: u32) -> [String; 7] {
        let number = |value: fn(&Numbers) -> Option<i64>| {
            self.numbers.as_ref().and_then(value).map(|n| n.to_string()).unwrap_or_default()
        };
        [
            figure.to_string(),
            self.panel.to_string(),
            self.shows.clone(),
            number(|n| i64::try_from(n.flips).ok()),
            number(|n| i64::try_from(n.crossings).ok()),
            number(|n| n.turning_number),
            number(|n| i64::try_from(n.steps).ok()),
        ]
    }
}

/// Computes the figures and writes them into a folder.
pub(super) fn run(folder: &Path) -> Result<Status, Failure> {
    let progress = Progress::default();
    progress.follow(|| {
        let figures = compute(&progress)?;
        let table = table_of(&figures);
        let mut files = Vec::new();
        for figure in &figures {
            progress.enter("drawing");
            go_on()?;
            files.extend(drawn(figure)?);
        }
        files.push((TABLE.to_owned(), csv_of(&table).into_bytes()));
        fs::create_dir_all(folder).map_err(|source| WriteError { path: folder.to_owned(), source })?;
        for (name, bytes) in &files {
            go_on()?;
            write_atomically(&folder.join(name), |out| out.write_all(bytes))?;
        }
        print_table(&table);
        println!("wrote {} files into {}", files.len(), folder.display());
        Ok(Status::Fine)
    })
}

fn compute(progress: &Progress) -> Result<Vec<Figure>, SolveError> {
    let quiet = |_| {};
    let control = Control::new(interrupted(), &quiet);
    let disk = |example: Example| Arc::new(DiskMesh::try_from(example.mesh()).expect("built-in meshes are disks"));
    let (ell, cube) = (disk(Example::Ell), disk(Example::Cube));
    progress.enter("figure 1");
    let mut figures = vec![flat::figure_1(&ell, control)?];
    progress.enter("figure 3");
    figures.push(free::figure_3(&cube));
    progress.enter("figure 4");
    figures.push(free::figure_4(&cube, control)?);
    progress.enter("figure 5");
    figures.push(repaired::figure_5(&cube, control)?);
    progress.enter("figure 6");
    figures.push(repaired::figure_6(&cube, control)?);
    progress.enter("figure 8");
    let face = textured::Subject::face();
    figures.push(textured::figure_8(&face, control)?);
    progress.enter("figure 9");
    figures.push(textured::figure_9(&face, control)?);
    Ok(figures)
}

/// Drawing and picture of a figure, by their names.
fn drawn(figure: &Figure) -> Result<[(String, Vec<u8>); 2], WriteError> {
    let page = figure.sheet.page();
    let [svg, png] = ["svg", "png"].map(|kind| format!("figure-{}.{kind}", figure.number));
    let failed = |source| WriteError { path: svg.clone().into(), source };
    let (mut drawing, mut picture) = (Vec::new(), Vec::new());
    page.write_svg(&mut drawing).map_err(failed)?;
    page.picture(PIXELS).write_png(&mut picture).map_err(|error| failed(std::io::Error::other(error)))?;
    Ok([(svg, drawing), (png, picture)])
}

fn table_of(figures: &[Figure]) -> Vec<[String; 7]> {
    let rows = figures.iter().flat_map(|figure| figure.rows.iter().map(|row| row.cells(figure.number)));
    std::iter::once(COLUMNS.map(str::to_owned)).chain(rows).collect()
}

fn csv_of(table: &[[String; 7]]) -> String {
    table.iter().map(|row| row.join(",") + "\n").collect()
}

/// Prints the table in columns.
fn print_table(table: &[[String; 7]]) {
    let width = |column: usize| table.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..COLUMNS.len()).map(width).collect();
    for row in table {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
            // Words on the left, numbers on the right.
            if column < 3 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        println!("{}", cells.collect::<Vec<_>>().join("  ").trim_end());
    }
}
