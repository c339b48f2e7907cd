//! Entries of the corpus's manifest, and the steps of a method.

use std::fs;
use std::path::{Path, PathBuf};

use freebound_core::flatten::{Flattener, Step};
use freebound_core::mesh::{DiskMesh, TriMesh};
use freebound_core::problem::{Control, Family, Method, Pins, Settings, SolveError};
use freebound_io::{MeshFile, read_mesh};

use super::corpus;

/// Line of the corpus's manifest.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Path within the corpus.
    pub file: String,
    /// Path of the file.
    pub path: PathBuf,
    columns: Vec<(String, String)>,
}

impl Entry {
    /// Entry of a file in a folder that has no manifest.
    pub(crate) fn in_folder(folder: &Path, file: &str) -> Self {
        Self { file: file.to_owned(), path: folder.join(file), columns: Vec::new() }
    }

    /// Text of a column.
    pub fn text(&self, column: &str) -> &str {
        &self.columns.iter().find(|(name, _)| name == column).expect("the manifest has the column").1
    }

    /// Number in a column, if the column holds one.
    pub fn number(&self, column: &str) -> Option<i64> {
        self.text(column).parse().ok()
    }

    /// The file as read.
    pub fn read(&self) -> MeshFile {
        read_mesh(&self.path).unwrap_or_else(|error| panic!("{}: {error}", self.file))
    }

    /// The file as triangles.
    pub fn mesh(&self) -> TriMesh {
        self.read().polygons.triangulate()
    }

    /// Path and disk of the file.
    pub fn named_disk(&self) -> (String, DiskMesh) {
        (self.file.clone(), self.disk())
    }

    /// The file as a disk.
    pub fn disk(&self) -> DiskMesh {
        DiskMesh::try_from(self.mesh()).unwrap_or_else(|faults| panic!("{}: {faults}", self.file))
    }
}

/// All files of the corpus, in the manifest's order.
pub fn manifest() -> Vec<Entry> {
    let folder = corpus();
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

/// File of the corpus by its path in it, for example `bad/moebius.obj`.
pub fn corpus_entry(file: &str) -> Entry {
    manifest().into_iter().find(|entry| entry.file == file).unwrap_or_else(|| panic!("the corpus has no {file}"))
}

/// Disks of the corpus.
pub fn corpus_disks() -> Vec<Entry> {
    manifest().into_iter().filter(|entry| !entry.file.starts_with("bad/")).collect()
}

/// Rows of comma-separated values, with the head.
pub fn csv_rows(text: &str) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(text.as_bytes());
    reader.records().map(|row| row.expect("a row of text").iter().map(str::to_owned).collect()).collect()
}

/// Steps that a method takes.
pub fn steps(mesh: &DiskMesh, method: Method, pins: Pins) -> Result<Vec<Step>, SolveError> {
    let mut steps = Vec::new();
    let mut ladder = Flattener::new(Settings::new(method, Family::default()), pins);
    ladder.finish(mesh, Control::unattended(), |step| steps.push(step))?;
    Ok(steps)
}
