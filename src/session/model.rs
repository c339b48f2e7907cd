//! A mesh as it was opened.

use std::io::Read;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::examples::Example;
use crate::io::{FileStamp, MeshFile, PictureFile, ReadError, read_mesh_with, read_stream_with};
use crate::mesh::{Diagnosis, DiskMesh, TriMesh, relative_volume};

/// Relative volume below which nobody can say which side of a surface is the outside: that of a cap 28 times as wide as
/// it is high.
const LEAST_VOLUME: f64 = 0.01;

/// A mesh that was opened, whether or not it can be flattened.
#[derive(Clone, Debug)]
pub struct Model {
    /// What to call it: file name or title of the example.
    pub name: String,
    /// The file it came from.
    pub path: Option<PathBuf>,
    /// The state of that file when it was read, where a project is to know it again.
    pub stamp: Option<FileStamp>,
    /// The built-in mesh that it is.
    pub example: Option<Example>,
    /// Whether its faces are turned around, against its file.
    pub faces_turned: bool,
    /// The file's contents, to be written back with the result.
    pub source: Arc<MeshFile>,
    /// Its triangles and what is known of them.
    pub surface: Surface,
    /// Whether the outside of its faces seems to be where a person would look for the inside. Silent where the surface
    /// is too flat to tell. Found once, for it takes a look at all faces.
    pub faces_point_inward: bool,
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
        Ok(Self { stamp: FileStamp::read(path).ok(), ..Self::read_until(path, &|| false)? })
    }

    /// As [`read`](Self::read), without the file's stamp, looking now and then whether to stop.
    ///
    /// # Errors
    ///
    /// As [`read`](Self::read), and [`ReadError::Cancelled`] where it was to stop.
    pub fn read_until(path: &Path, is_enough: &dyn Fn() -> bool) -> Result<Self, ReadError> {
        let source = read_mesh_with(path, &mut |_| flow(is_enough))?;
        let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
        Ok(Self::new(name, Some(path.to_owned()), source))
    }

    /// Reads and diagnoses a stream, looking now and then whether to stop. `name` is what to call it.
    ///
    /// # Errors
    ///
    /// As [`read_until`](Self::read_until).
    pub fn read_stream(name: &str, stream: impl Read, is_enough: &dyn Fn() -> bool) -> Result<Self, ReadError> {
        let source = read_stream_with(stream, &mut |_| flow(is_enough))?;
        Ok(Self::new(name.to_owned(), None, source))
    }

    /// A built-in mesh.
    pub fn example(example: Example) -> Self {
        let source = MeshFile::from(&example.mesh());
        Self { example: Some(example), ..Self::new(example.title().to_owned(), None, source) }
    }

    fn new(name: String, path: Option<PathBuf>, source: MeshFile) -> Self {
        let surface = match DiskMesh::try_from(source.polygons.triangulate()) {
            Ok(disk) => Surface::Disk(Arc::new(disk)),
            Err(diagnosis) => Surface::Faulty(Arc::new(source.polygons.triangulate()), Arc::new(*diagnosis)),
        };
        let faces_point_inward = matches!(&surface, Surface::Disk(disk) if relative_volume(disk) < -LEAST_VOLUME);
        let source = Arc::new(source);
        Self { name, path, stamp: None, example: None, faces_turned: false, source, surface, faces_point_inward }
    }

    /// The same mesh with its faces turned around: positions and vertices stay, and so does the order of the polygons.
    #[must_use = "the mesh itself stays as it is"]
    pub fn turned(&self) -> Self {
        Self {
            stamp: self.stamp.clone(),
            example: self.example,
            faces_turned: !self.faces_turned,
            ..Self::new(self.name.clone(), self.path.clone(), self.source.turned())
        }
    }

    /// Where it came from, in words.
    pub fn path_words(&self) -> String {
        match (&self.path, self.example) {
            (Some(path), _) => path.display().to_string(),
            (None, Some(_)) => format!("built-in: {}", self.name),
            (None, None) => self.name.clone(),
        }
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

fn flow(is_enough: &dyn Fn() -> bool) -> ControlFlow<()> {
    if is_enough() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// The picture that belongs to a built-in mesh.
pub(super) fn example_picture(example: Example) -> Option<Arc<PictureFile>> {
    let pixels = Arc::new(example.picture()?);
    Some(Arc::new(PictureFile { name: "portrait".to_owned(), path: None, stamp: None, pixels }))
}
