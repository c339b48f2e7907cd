//! Table of numbers that colours the faces, one column at a time.

use std::path::PathBuf;

use super::async_scene::AsyncScene;
use super::in_file::{face_in_source, vertex_in_source};
use crate::session::{JobFailure, Model, Wake};
use freebound_core::mesh::{FaceId, TriMesh, VertexId};
use freebound_io::{ElementCounts, TableElement, TableError, ValueColumn, ValueTable};

/// Key of a job that reads a table: the file, and the session's count of openings.
pub(super) type TableKey = (PathBuf, u64);

/// Table that the user opened, and the job that reads one.
#[derive(Debug, Default)]
pub struct ColourTable {
    open: Option<OpenTable>,
    job: Option<AsyncScene<TableKey, Result<ValueTable, TableError>>>,
    /// Number of changes of the shown column.
    revision: u64,
}

#[derive(Debug)]
struct OpenTable {
    table: ValueTable,
    chosen: usize,
}

/// Shown column of a table.
#[derive(Clone, Copy, Debug)]
pub(in crate::ui) struct ShownColumn<'a> {
    pub(in crate::ui) column: &'a ValueColumn,
    pub(in crate::ui) element: TableElement,
    /// Number of changes of the shown column.
    pub(in crate::ui) revision: u64,
}

impl ColourTable {
    /// Names of the columns.
    pub fn titles(&self) -> impl Iterator<Item = &str> {
        self.open.iter().flat_map(|open| &open.table.columns).map(|column| column.title.as_str())
    }

    /// Place of the shown column.
    pub fn chosen(&self) -> Option<usize> {
        self.open.as_ref().map(|open| open.chosen)
    }

    /// Shown column.
    pub(in crate::ui) fn shown(&self) -> Option<ShownColumn<'_>> {
        let open = self.open.as_ref()?;
        let column = open.table.columns.get(open.chosen)?;
        Some(ShownColumn { column, element: open.table.element, revision: self.revision })
    }

    /// True while a table is being read.
    pub fn is_reading(&self) -> bool {
        self.job.as_ref().is_some_and(AsyncScene::is_busy)
    }

    /// Reads a table in the background, for a mesh with these counts. `opening` is the session's count of openings.
    pub(super) fn read(&mut self, path: PathBuf, opening: u64, counts: ElementCounts, wake: &Wake) {
        let mut job = AsyncScene::new("table", wake);
        job.make((path.clone(), opening), move |_| ValueTable::read(&path, counts));
        self.job = Some(job);
    }

    /// Table that was read, or its fault, returned once.
    pub(super) fn poll(&mut self) -> Option<(TableKey, Result<ValueTable, TableError>)> {
        self.job.as_mut()?.poll()
    }

    /// Failure of the job, returned once.
    pub(super) fn take_failure(&mut self) -> Option<JobFailure> {
        self.job.as_mut()?.take_failure()
    }

    /// Opens a table.
    pub(super) fn open(&mut self, table: ValueTable) {
        self.open = Some(OpenTable { table, chosen: 0 });
    }

    /// Forgets the table.
    pub(super) fn forget(&mut self) {
        *self = Self { revision: self.revision + 1, ..Self::default() };
    }

    /// Shows another column. Returns false if there is none at this place.
    pub(super) fn choose(&mut self, place: usize) -> bool {
        let Some(open) = self.open.as_mut().filter(|open| place < open.table.columns.len()) else { return false };
        open.chosen = place;
        self.revision += 1;
        true
    }
}

impl ShownColumn<'_> {
    /// Value of each face of a mesh of a model. A face takes the mean of its corners that have a value. `in_file` is
    /// the result of [`vertices_in_file`](super::in_file::vertices_in_file).
    pub(super) fn values_on(&self, mesh: &TriMesh, model: &Model, in_file: Option<&[VertexId]>) -> Vec<f64> {
        let values = &self.column.values;
        let at = |place: usize| values.get(place).copied().unwrap_or(f64::NAN);
        let of_vertex =
            |vertex: VertexId| vertex_in_source(model, in_file, vertex).map_or(f64::NAN, |of_file| at(of_file.index()));
        let of_face = |polygon: u32| face_in_source(model, polygon).map_or(f64::NAN, |face| at(face.index()));
        match self.element {
            TableElement::Vertex => {
                let corners = mesh.real_triangles().iter();
                corners.map(|corners| mean(corners.map(of_vertex).into_iter())).collect()
            }
            TableElement::Face => {
                let faces = (0..mesh.real_face_count()).map(FaceId::from_index);
                faces.map(|face| of_face(mesh.polygon(face))).collect()
            }
        }
    }
}

/// Mean of the values that are numbers; not a number without one.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.filter(|value| value.is_finite()).fold((0.0, 0.0), |(s, n), value| (s + value, n + 1.0));
    sum / count
}
