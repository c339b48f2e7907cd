//! Opening a mesh: reading, triangulating, diagnosing.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::examples::Example;
use crate::io::{ObjMesh, ReadError, read_mesh_with};
use crate::mesh::{Diagnosis, DiskMesh, PolygonMesh, TriMesh};

/// A mesh that was opened, whether or not it can be flattened.
#[derive(Clone, Debug)]
pub struct Model {
    /// What to call it: file name or title of the example.
    pub name: String,
    /// The file it came from.
    pub path: Option<PathBuf>,
    /// The file's contents, to be written back with the result.
    pub source: Arc<ObjMesh>,
    /// Its triangles and what is known of them.
    pub surface: Surface,
}

/// Triangles, with the diagnosis' word on them.
#[derive(Clone, Debug)]
pub enum Surface {
    /// It is a disk.
    Disk(Arc<DiskMesh>),
    /// It has faults.
    Faulty(Arc<TriMesh>, Arc<Diagnosis>),
}

impl Model {
    /// Reads and diagnoses a file.
    ///
    /// # Errors
    ///
    /// Where the file cannot be read as a mesh at all. A mesh with faults is no error here.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        Self::read_until(path, &|| false)
    }

    /// As [`read`](Self::read), looking now and then whether to stop.
    ///
    /// # Errors
    ///
    /// As [`read`](Self::read), and [`ReadError::Cancelled`] where it was to stop.
    pub fn read_until(path: &Path, is_enough: &dyn Fn() -> bool) -> Result<Self, ReadError> {
        let source = read_mesh_with(path, &mut |_| {
            if is_enough() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
        Ok(Self::new(name, Some(path.to_owned()), source))
    }

    /// A built-in mesh.
    pub fn example(example: Example) -> Self {
        let source = ObjMesh::from(PolygonMesh::from(&example.mesh()));
        Self::new(example.title().to_owned(), None, source)
    }

    fn new(name: String, path: Option<PathBuf>, source: ObjMesh) -> Self {
        let surface = match DiskMesh::try_from(source.polygons.triangulate()) {
            Ok(disk) => Surface::Disk(Arc::new(disk)),
            Err(diagnosis) => Surface::Faulty(Arc::new(source.polygons.triangulate()), Arc::new(*diagnosis)),
        };
        Self { name, path, source: Arc::new(source), surface }
    }

    /// Where it came from, in words.
    pub fn path_words(&self) -> String {
        self.path.as_ref().map_or_else(|| format!("built-in: {}", self.name), |path| path.display().to_string())
    }

    /// Whether it is a built-in mesh.
    pub fn is_example(&self) -> bool {
        self.path.is_none()
    }

    /// The triangles.
    pub fn mesh(&self) -> &TriMesh {
        match &self.surface {
            Surface::Disk(disk) => disk.mesh(),
            Surface::Faulty(mesh, _) => mesh,
        }
    }

    /// The disk, where it is one.
    pub fn disk(&self) -> Option<&Arc<DiskMesh>> {
        match &self.surface {
            Surface::Disk(disk) => Some(disk),
            Surface::Faulty(..) => None,
        }
    }
}
