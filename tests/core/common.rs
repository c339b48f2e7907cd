//! The corpus by its manifest; the steps of a method.

use std::fs;
use std::path::PathBuf;

use freebound::io::{MeshFile, read_mesh};
use freebound::mesh::{DiskMesh, TriMesh};
use freebound::solver::{Control, Family, Ladder, Method, Pins, Settings, SolveError, Step};

use crate::makers::corpus;

/// One line of the corpus's manifest.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    /// Path under the corpus.
    pub(crate) file: String,
    /// Where it lies.
    pub(crate) path: PathBuf,
    columns: Vec<(String, String)>,
}

impl Entry {
    /// A column as text.
    pub(crate) fn text(&self, column: &str) -> &str {
        &self.columns.iter().find(|(name, _)| name == column).expect("the manifest has the column").1
    }

    /// A column as a number, if it has one.
    pub(crate) fn number(&self, column: &str) -> Option<i64> {
        self.text(column).parse().ok()
    }

    /// The file as read.
    pub(crate) fn read(&self) -> MeshFile {
        read_mesh(&self.path).unwrap_or_else(|error| panic!("{}: {error}", self.file))
    }

    /// The file as triangles.
    pub(crate) fn mesh(&self) -> TriMesh {
        self.read().polygons.triangulate()
    }

    /// The file as a disk.
    pub(crate) fn disk(&self) -> DiskMesh {
        DiskMesh::try_from(self.mesh()).unwrap_or_else(|faults| panic!("{}: {faults}", self.file))
    }
}

/// All files of the corpus, in the manifest's order. Empty where there is no corpus.
pub(crate) fn manifest() -> Vec<Entry> {
    let Some(folder) = corpus() else { return Vec::new() };
    let text = fs::read_to_string(folder.join("manifest.csv")).expect("the manifest is readable");
    let mut rows = csv_rows(&text).into_iter();
    let head = rows.next().expect("the manifest has a head");
    rows.map(|row| {
        assert_eq!(row.len(), head.len(), "{row:?}");
        let file = row[0].clone();
        Entry { path: folder.join(&file), file, columns: head.iter().cloned().zip(row).collect() }
    })
    .collect()
}

/// The disks of the corpus.
pub(crate) fn corpus_disks() -> Vec<Entry> {
    manifest().into_iter().filter(|entry| !entry.file.starts_with("bad/")).collect()
}

/// Rows of comma-separated values, the head among them.
pub(crate) fn csv_rows(text: &str) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(text.as_bytes());
    reader.records().map(|row| row.expect("a row of text").iter().map(str::to_owned).collect()).collect()
}

/// The steps that a method takes.
pub(crate) fn steps(mesh: &DiskMesh, method: Method, pins: Pins) -> Result<Vec<Step>, SolveError> {
    let mut steps = Vec::new();
    let mut ladder = Ladder::new(Settings::new(method, Family::default()), pins);
    ladder.finish(mesh, Control::unattended(), |step| steps.push(step))?;
    Ok(steps)
}
