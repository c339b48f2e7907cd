//! A mesh as it was opened.

use std::io::Read;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::examples::Example;
use crate::io::{FileStamp, MeshFile, PictureFile, ReadError, read_mesh_with, read_stream_with};
use crate::mesh::{
    Diagnosis, DiskMesh, Fault, Form, PolygonMesh, RepairExtent, Repaired, TriMesh, diagnose, relative_volume,
};

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
    /// What is made of its faces.
    pub form: Form,
    /// The file's contents, its faces turned around where the form says so, to be written back with the result.
    pub source: Arc<MeshFile>,
    /// The repairs of it, where there are any.
    pub repaired: Option<Arc<Repaired>>,
    /// The repairs that would make a disk of what is none.
    pub remedy: Option<Arc<Repaired>>,
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
    pub fn read(path: &Path, form: Form) -> Result<Self, ReadError> {
        Ok(Self { stamp: FileStamp::read(path).ok(), ..Self::read_until(path, form, &|| false)? })
    }

    /// As [`read`](Self::read), without the file's stamp, looking now and then whether to stop.
    ///
    /// # Errors
    ///
    /// As [`read`](Self::read), and [`ReadError::Cancelled`] where it was to stop.
    pub fn read_until(path: &Path, form: Form, is_enough: &dyn Fn() -> bool) -> Result<Self, ReadError> {
        let source = read_mesh_with(path, &mut |_| flow(is_enough))?;
        let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
        Ok(Self::as_in_file(name, Some(path.to_owned()), source).in_form(form))
    }

    /// Reads and diagnoses a stream, looking now and then whether to stop. `name` is what to call it.
    ///
    /// # Errors
    ///
    /// As [`read_until`](Self::read_until).
    pub fn read_stream(
        name: &str,
        stream: impl Read,
        form: Form,
        is_enough: &dyn Fn() -> bool,
    ) -> Result<Self, ReadError> {
        let source = read_stream_with(stream, &mut |_| flow(is_enough))?;
        Ok(Self::as_in_file(name.to_owned(), None, source).in_form(form))
    }

    /// A built-in mesh.
    pub fn example(example: Example) -> Self {
        let source = MeshFile::from(&example.mesh());
        let model = Self::as_in_file(example.title().to_owned(), None, source);
        Self { example: Some(example), ..model.in_form(Form::default()) }
    }

    /// A mesh of which nothing is known yet.
    fn as_in_file(name: String, path: Option<PathBuf>, source: MeshFile) -> Self {
        Self {
            name,
            path,
            stamp: None,
            example: None,
            form: Form::default(),
            source: Arc::new(source),
            repaired: None,
            remedy: None,
            surface: Surface::default(),
            faces_point_inward: false,
        }
    }

    /// The same mesh in another form: the order of its faces stays, and so does every vertex of the file, with its number.
    #[must_use = "the mesh itself stays as it is"]
    pub fn in_form(&self, form: Form) -> Self {
        let is_turned = form.faces_turned != self.form.faces_turned;
        let source = if is_turned { Arc::new(self.source.turned()) } else { Arc::clone(&self.source) };
        let (surface, repaired) = surface_of(&source.polygons, form);
        let remedy = match &surface {
            Surface::Disk(_) => None,
            Surface::Faulty(..) => {
                Some(form.mended().repaired(&source.polygons)).filter(Repaired::is_disk).map(Arc::new)
            }
        };
        let faces_point_inward = matches!(&surface, Surface::Disk(disk) if relative_volume(disk) < -LEAST_VOLUME);
        Self { form, source, repaired, remedy, surface, faces_point_inward, ..self.clone() }
    }

    /// Where it came from, in words.
    pub fn path_words(&self) -> String {
        match (&self.path, self.example) {
            (Some(path), _) => path.display().to_string(),
            (None, Some(_)) => format!("built-in: {}", self.name),
            (None, None) => self.name.clone(),
        }
    }

    /// The triangles, with those that fill its holes.
    pub fn mesh(&self) -> &TriMesh {
        match &self.surface {
            Surface::Disk(disk) => disk.mesh(),
            Surface::Faulty(mesh, _) => mesh,
        }
    }

    /// How many vertices it has, those of no face included. What fills its holes has none of its own here.
    pub fn vertex_count(&self) -> usize {
        let polygons = self.repaired.as_ref().map_or(&self.source.polygons, |repaired| repaired.polygons());
        polygons.positions.len()
    }

    /// The disk, where it is one.
    pub fn disk(&self) -> Option<&Arc<DiskMesh>> {
        match &self.surface {
            Surface::Disk(disk) => Some(disk),
            Surface::Faulty(..) => None,
        }
    }
}

impl Default for Surface {
    fn default() -> Self {
        Self::Faulty(Arc::default(), Arc::default())
    }
}

/// The triangles of a file's faces in a form, and the repairs that this took.
fn surface_of(polygons: &PolygonMesh, form: Form) -> (Surface, Option<Arc<Repaired>>) {
    let as_given = DiskMesh::try_from(polygons.triangulate()).and_then(|disk| {
        let diagnosis = match form.repair {
            RepairExtent::Nothing => diagnose(&polygons.triangulate()),
            RepairExtent::Safe | RepairExtent::All => Diagnosis::default(),
        };
        if diagnosis.faults.is_empty() { Ok(disk) } else { Err(Box::new(diagnosis)) }
    });
    match as_given {
        Ok(disk) => (Surface::Disk(Arc::new(disk)), None),
        Err(diagnosis) if form.repair == RepairExtent::Nothing && !diagnosis.faults.iter().all(Fault::is_cut_open) => {
            (Surface::Faulty(Arc::new(polygons.triangulate()), Arc::new(*diagnosis)), None)
        }
        Err(diagnosis) => {
            let repaired = form.repaired(polygons);
            let disk = if repaired.done().is_empty() { None } else { DiskMesh::try_from(repaired.triangulate()).ok() };
            match disk {
                Some(disk) => (Surface::Disk(Arc::new(disk)), Some(Arc::new(repaired))),
                None => (Surface::Faulty(Arc::new(polygons.triangulate()), Arc::new(*diagnosis)), None),
            }
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
