//! A mesh as it was opened.

use std::io::Read;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::surface::{Found, cut_surface, is_refused_uncut, surface_of};
use crate::examples::Example;
use crate::io::{FileStamp, LayoutError, MeshFile, PictureFile, ReadError, Texture, read_mesh_with, read_stream_with};
use crate::mesh::{Chart, Charts, Diagnosis, DiskMesh, Form, PartFaces, Repaired, TriMesh, VertexId, relative_volume};
use crate::solver::{Embedding, Settings, Start};

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
    /// Which chart of the mesh this is, where it has several.
    pub chart: Option<ChartOf>,
    /// Its triangles and what is known of them: those of the chart, where it is one of several.
    pub surface: Surface,
    /// Texture coordinates of another file, for a run that starts from them in the place of its own.
    pub layout_file: Option<Arc<LayoutFile>>,
    /// Whether the outside of its faces seems to be where a person would look for the inside. Silent where the surface
    /// is too flat to tell. Found once, for it takes a look at all faces.
    pub faces_point_inward: bool,
}

/// A file whose texture coordinates a run starts from.
#[derive(Clone, Debug)]
pub struct LayoutFile {
    /// What to call it.
    pub path: String,
    /// Its texture coordinates, for the corners of the mesh.
    texture: Texture,
}

/// One chart of several.
#[derive(Clone, Debug)]
pub struct ChartOf {
    /// All of them.
    pub charts: Arc<Charts>,
    /// Which of them it is.
    pub number: usize,
    /// The chart.
    pub chart: Arc<Chart>,
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
        Ok(Self::read_formless(path, is_enough)?.in_form(form))
    }

    /// As [`read_until`](Self::read_until), for a form that depends on what is read: until it has one, the mesh has no faces.
    ///
    /// # Errors
    ///
    /// As [`read_until`](Self::read_until).
    pub fn read_formless(path: &Path, is_enough: &dyn Fn() -> bool) -> Result<Self, ReadError> {
        let source = read_mesh_with(path, &mut |_| flow(is_enough))?;
        let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
        Ok(Self::as_in_file(name, Some(path.to_owned()), source))
    }

    /// As [`read_formless`](Self::read_formless), of a stream. `name` is what to call it.
    ///
    /// # Errors
    ///
    /// As [`read_until`](Self::read_until).
    pub fn read_stream(name: &str, stream: impl Read, is_enough: &dyn Fn() -> bool) -> Result<Self, ReadError> {
        let source = read_stream_with(stream, &mut |_| flow(is_enough))?;
        Ok(Self::as_in_file(name.to_owned(), None, source))
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
            chart: None,
            surface: Surface::default(),
            layout_file: None,
            faces_point_inward: false,
        }
    }

    /// The same mesh in another form: the order of its faces stays, and so does every vertex of the file, with its number.
    /// Along texture coordinates it is cut where all corners have some.
    #[must_use = "the mesh itself stays as it is"]
    pub fn in_form(&self, form: Form) -> Self {
        let is_turned = form.faces_turned != self.form.faces_turned;
        let source = if is_turned { Arc::new(self.source.turned()) } else { Arc::clone(&self.source) };
        let labels = if form.seams.of_texture { source.texture_labels().ok() } else { None };
        let repaired = |form: &Form| form.repaired_along(&source.polygons, labels.as_deref());
        let is_cut_along = !form.seams.edges().is_empty() && !is_refused_uncut(&source.polygons, form.repair);
        let has_seams = labels.is_some() || is_cut_along;
        let found = if has_seams { cut_surface(repaired(&form)) } else { surface_of(&source.polygons, &form) };
        let remedy = match &found.surface {
            Surface::Disk(_) => None,
            Surface::Faulty(..) => Some(repaired(&form.mended())).filter(Repaired::flattens).map(Arc::new),
        };
        Self { form, source, remedy, layout_file: None, ..self.clone() }.with(found)
    }

    /// Its parts, those that are left out among them.
    pub fn parts(&self) -> Vec<PartFaces> {
        let labels = if self.form.seams.of_texture { self.source.texture_labels().ok() } else { None };
        self.form.parts(&self.source.polygons, labels.as_deref())
    }

    /// The chart that is wanted, where the mesh has several.
    pub(super) fn with_chart(self, wanted: Option<usize>) -> Self {
        match self.chart.as_ref().map(|of| of.charts.pick(wanted)) {
            Some(number) => self.of_chart(number),
            None => self,
        }
    }

    /// Another chart of the same mesh, where it has several.
    #[must_use = "the mesh itself stays as it is"]
    pub fn of_chart(&self, number: usize) -> Self {
        match &self.chart {
            Some(now) if now.number != number => self.clone().with(Found::chart(&now.charts, number)),
            _ => self.clone(),
        }
    }

    fn with(self, Found { surface, repaired, chart }: Found) -> Self {
        let faces_point_inward = matches!(&surface, Surface::Disk(disk) if relative_volume(disk) < -LEAST_VOLUME);
        Self { repaired, chart, surface, faces_point_inward, ..self }
    }

    /// Whether it is the chart that is wanted, where the mesh has several.
    pub(super) fn is_chart(&self, wanted: Option<usize>) -> bool {
        self.chart.as_ref().is_none_or(|of| of.number == of.charts.pick(wanted))
    }

    /// The sides of its edges that are listed as seams, with its own vertices.
    pub fn seam_sides(&self) -> Vec<[VertexId; 2]> {
        match &self.repaired {
            Some(repaired) => repaired.seam_sides(&self.form.seams, &self.source.polygons),
            None => self.form.seams.edges().iter().copied().collect(),
        }
    }

    /// How many charts the mesh has.
    pub fn chart_count(&self) -> usize {
        self.chart.as_ref().map_or(1, |of| of.charts.count())
    }

    /// The repairs of the whole mesh, where there are any.
    pub fn whole_repaired(&self) -> Option<&Repaired> {
        self.chart.as_ref().map(|of| of.charts.whole()).or(self.repaired.as_deref())
    }

    /// The vertex of the repaired mesh that one of this mesh or chart is: with the file's number, where the file has it.
    pub fn vertex_in_file(&self, vertex: VertexId) -> VertexId {
        self.chart.as_ref().and_then(|of| of.chart.vertex_of.get(vertex.index()).copied()).unwrap_or(vertex)
    }

    /// The vertex of this mesh or chart that one of the repaired mesh is.
    pub fn vertex_of_file(&self, vertex: VertexId) -> Option<VertexId> {
        match &self.chart {
            Some(of) => of.chart.vertex_at(vertex),
            None => (vertex.index() < self.vertex_count()).then_some(vertex),
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

    /// The same with the texture coordinates of another file to start from, which is called `path`. In another form it has its
    /// own again.
    ///
    /// # Errors
    ///
    /// [`LayoutError`] where that has none for this mesh.
    pub fn with_layout_of(self, path: String, file: &MeshFile) -> Result<Self, LayoutError> {
        let texture = self.source.texture_of(file)?;
        Ok(Self { layout_file: Some(Arc::new(LayoutFile { path, texture })), ..self })
    }

    /// The texture coordinates of the file as an embedding of this mesh or chart.
    ///
    /// # Errors
    ///
    /// [`LayoutError`] where they are not all there, or a vertex has several.
    pub fn layout(&self) -> Result<Embedding, LayoutError> {
        match &self.layout_file {
            Some(file) => self.source.layout_by(&file.texture, self.repaired.as_deref(), self.mesh()),
            None => self.source.layout(self.repaired.as_deref(), self.mesh()),
        }
    }

    /// Where the layout comes from that a run with these settings starts from; none where it starts afresh.
    pub(super) fn start_words(&self, settings: &Settings) -> Option<String> {
        let from_file = || self.layout_file.as_ref().map_or_else(|| "uv".to_owned(), |file| file.path.clone());
        (settings.start == Start::File && settings.method.goes_on_from_layout()).then(from_file)
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

fn flow(is_enough: &dyn Fn() -> bool) -> ControlFlow<()> {
    if is_enough() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// The picture that belongs to a built-in mesh.
pub(super) fn example_picture(example: Example) -> Option<Arc<PictureFile>> {
    let pixels = Arc::new(example.picture()?);
    Some(Arc::new(PictureFile { name: "portrait".to_owned(), path: None, stamp: None, pixels }))
}
