//! `freebound figures`: the paper's figures 1, 3, 4, 5, 6, 8 and 9, reproduced on the built-in meshes.
//!
//! Each figure is written as a drawing and as a picture with all its panels. Their numbers are in one table, on
//! standard output and in `figures.csv`. The output is deterministic, byte for byte.
//!
//! | file       | content                                                                    |
//! |------------|----------------------------------------------------------------------------|
//! | `mod`      | a figure and its rows of the table; all figures computed and written       |
//! | `free`     | figures 1, 3 and 4: a flat mesh; the cube and its free-boundary embeddings |
//! | `repaired` | figures 5 and 6: the iteration and the virtual boundary                    |
//! | `textured` | figures 8 and 9: the face and its portrait                                 |
//! | `pairs`    | the pinned pairs of vertices                                               |

mod free;
pub mod pairs;
mod repaired;
mod textured;

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::sync::Arc;

use serde::Serialize;

use super::progress::go_on;
use super::progress::{INTERRUPTED, ProgressLine};
use super::say::say;
use super::{CommandError, CommandOutcome};
use crate::examples::Example;
use freebound_core::flatten::Step;
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::{Control, SolveError};
use freebound_core::verify::Verdict;
use freebound_io::figure::{Drawing, Panel, PrintedSheet};
use freebound_io::{WriteError, write_atomically};

/// Pixels per point of the pictures.
const PIXELS: f64 = 2.0;

/// Name of the table.
const TABLE: &str = "figures.csv";

/// Figure with its panels and measurements.
struct Figure {
    number: u32,
    sheet: PrintedSheet,
    rows: Vec<Row>,
}

impl Figure {
    /// Creates a figure without panels. `columns` panels will be in a row.
    fn new(number: u32, columns: usize, caption: impl Into<String>) -> Self {
        Self { number, sheet: PrintedSheet { columns, panels: Vec::new(), caption: caption.into() }, rows: Vec::new() }
    }

    /// Adds a panel with the next letter, and its row of the table with the same text.
    fn panel(&mut self, words: &str, drawing: Drawing) -> &mut Row {
        let letter = ('a'..='z').nth(self.rows.len()).expect("a figure has few panels");
        self.sheet.panels.push(Panel { words: format!("({letter}) {words}"), drawing });
        let shows = words.replace(',', ";");
        self.rows.push(Row { figure: self.number, panel: letter, shows, ..Row::default() });
        self.rows.last_mut().expect("one was added")
    }
}

/// Row of the table. Measurements are present if the panel shows an embedding.
#[derive(Default, Serialize)]
struct Row {
    figure: u32,
    panel: char,
    shows: String,
    flips: Option<usize>,
    crossings: Option<usize>,
    turning_number: Option<i64>,
    /// Number of linear solves up to the embedding.
    steps: Option<usize>,
}

impl Row {
    /// Replaces the text of the panel.
    fn showing(&mut self, words: &str) -> &mut Self {
        words.clone_into(&mut self.shows);
        self
    }

    fn measure(&mut self, step: &Step) {
        self.measure_verdict(&step.verdict, step.index + 1);
    }

    fn measure_verdict(&mut self, verdict: &Verdict, steps: usize) {
        self.flips = Some(verdict.flipped_faces.len());
        self.crossings = Some(verdict.boundary_crossings.len());
        self.turning_number = verdict.turning_number;
        self.steps = Some(steps);
    }
}

/// Text for the number of flipped faces.
fn flips_in_words(step: &Step) -> String {
    match step.verdict.flipped_faces.len() {
        0 => "no flipped face".to_owned(),
        1 => "1 flipped face".to_owned(),
        count => format!("{count} flipped faces"),
    }
}

fn iterations_in_words(count: usize) -> String {
    if count == 1 { "1 iteration".to_owned() } else { format!("{count} iterations") }
}

/// Computes the figures and writes them into a folder.
pub(super) fn run(folder: &Path) -> Result<CommandOutcome, CommandError> {
    let progress = ProgressLine::default();
    progress.follow(|| {
        let figures = compute(&progress)?;
        let table = table_of(&figures).expect("memory takes all");
        let mut files = Vec::new();
        for figure in &figures {
            progress.enter("drawing");
            go_on()?;
            files.extend(drawn(figure)?);
        }
        files.push((TABLE.to_owned(), table.clone()));
        fs::create_dir_all(folder).map_err(|source| WriteError::writing(folder, source))?;
        for (name, bytes) in &files {
            go_on()?;
            write_atomically(&folder.join(name), |out| out.write_all(bytes))?;
        }
        let columns = in_columns(&table).expect("the table was just written");
        say(format_args!("{columns}wrote {} files into {}", files.len(), folder.display()))?;
        Ok(CommandOutcome::Fine)
    })
}

fn compute(progress: &ProgressLine) -> Result<Vec<Figure>, SolveError> {
    type Make<'a> = &'a dyn Fn() -> Result<Figure, SolveError>;
    let quiet = |_| {};
    let control = Control::new(&INTERRUPTED, &quiet);
    let disk = |example: Example| Arc::new(DiskMesh::try_from(example.mesh()).expect("built-in meshes are disks"));
    let (ell, cube) = (disk(Example::Ell), disk(Example::Cube));
    let face = textured::FigureSubject::face();
    let figures: [(&'static str, Make); 7] = [
        ("figure 1", &|| free::figure_1(&ell, control)),
        ("figure 3", &|| Ok(free::figure_3(&cube))),
        ("figure 4", &|| free::figure_4(&cube, control)),
        ("figure 5", &|| repaired::figure_5(&cube, control)),
        ("figure 6", &|| repaired::figure_6(&cube, control)),
        ("figure 8", &|| textured::figure_8(&face, control)),
        ("figure 9", &|| textured::figure_9(&face, control)),
    ];
    let made = figures.into_iter().map(|(name, make)| {
        progress.enter(name);
        make()
    });
    made.collect()
}

/// Drawing and picture of a figure, with their file names.
fn drawn(figure: &Figure) -> Result<[(String, Vec<u8>); 2], WriteError> {
    let page = figure.sheet.page();
    let [svg, png] = ["svg", "png"].map(|kind| format!("figure-{}.{kind}", figure.number));
    let failed = |source| WriteError::writing(&svg, source);
    let (mut drawing, mut picture) = (Vec::new(), Vec::new());
    page.write_svg(&mut drawing).map_err(failed)?;
    freebound_io::raster::write_png(&page.picture(PIXELS), &mut picture).map_err(failed)?;
    Ok([(svg, drawing), (png, picture)])
}

/// Table of all figures (CSV).
fn table_of(figures: &[Figure]) -> csv::Result<Vec<u8>> {
    let mut table = csv::Writer::from_writer(Vec::new());
    for row in figures.iter().flat_map(|figure| &figure.rows) {
        table.serialize(row)?;
    }
    Ok(table.into_inner().map_err(csv::IntoInnerError::into_error)?)
}

/// Table in aligned columns, for the terminal.
fn in_columns(table: &[u8]) -> csv::Result<String> {
    let records = csv::ReaderBuilder::new().has_headers(false).from_reader(table).into_records();
    let records = records.collect::<csv::Result<Vec<_>>>()?;
    let width = |column: usize| records.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let mut lines = String::new();
    for row in &records {
        let cells = row.iter().enumerate().map(|(column, cell)| {
            let width = width(column);
            // Text is aligned left, numbers right.
            if column < 3 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        lines.push_str(cells.collect::<Vec<_>>().join("  ").trim_end());
        lines.push('\n');
    }
    Ok(lines)
}
