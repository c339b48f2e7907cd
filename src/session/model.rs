//! A mesh as it was opened.

use std::io::Read;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::examples::Example;
use freebound_core::flatten::Options;
use freebound_core::geom::PackingOptions;
use freebound_core::mesh::{DiskMesh, PartFaces, Preparation, Repaired, TriMesh, VertexId};
use freebound_core::pipeline::{Arrangement, Fit, Outcome, PreparedMesh, Problem, SolvedChart, atlas};
use freebound_core::problem::{Embedding, Settings, Start};
use freebound_io::{
    FileStamp, LayoutError, MeshFile, Output, PictureFile, ReadError, ResultSource, StepReport, Texture,
    read_mesh_with, read_stream_with,
};

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
    /// The file's contents, its faces turned around where the form says so, to be written back with the result.
    pub source: Arc<MeshFile>,
    /// The mesh or its chart, prepared for flattening.
    pub prepared: PreparedMesh,
    /// Texture coordinates of another file, for a run that starts from them in the place of its own.
    pub layout_file: Option<Arc<LayoutFile>>,
}

/// A file whose texture coordinates a run starts from.
#[derive(Clone, Debug)]
pub struct LayoutFile {
    /// What to call it.
    pub path: String,
    /// Its texture coordinates, for the corners of the mesh.
    texture: Texture,
}

impl Model {
    /// Reads and diagnoses a file.
    ///
    /// # Errors
    ///
    /// Where the file cannot be read as a mesh at all. A mesh with faults is no error here.
    pub fn read(path: &Path, form: Preparation) -> Result<Self, ReadError> {
        Ok(Self { stamp: FileStamp::read(path).ok(), ..Self::read_until(path, form, &|| false)? })
    }

    /// As [`read`](Self::read), without the file's stamp, looking now and then whether to stop.
    ///
    /// # Errors
    ///
    /// As [`read`](Self::read), and [`ReadError::Cancelled`] where it was to stop.
    pub fn read_until(path: &Path, form: Preparation, is_enough: &dyn Fn() -> bool) -> Result<Self, ReadError> {
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
        Self { example: Some(example), ..model.in_form(Preparation::default()) }
    }

    /// A mesh of which nothing is known yet.
    fn as_in_file(name: String, path: Option<PathBuf>, source: MeshFile) -> Self {
        Self {
            name,
            path,
            stamp: None,
            example: None,
            source: Arc::new(source),
            prepared: PreparedMesh::default(),
            layout_file: None,
        }
    }

    /// The same mesh in another form: the order of its faces stays, and so does every vertex of the file, with its number.
    /// Along texture coordinates it is cut where all corners have some.
    #[must_use = "the mesh itself stays as it is"]
    pub fn in_form(&self, form: Preparation) -> Self {
        let is_turned = form.faces_turned != self.prepared.form.faces_turned;
        let source = if is_turned { Arc::new(self.source.turned()) } else { Arc::clone(&self.source) };
        let labels = if form.seams.of_texture { source.texture_labels().ok() } else { None };
        let prepared = PreparedMesh::new(&source.polygons, labels.as_deref(), form);
        Self { source, prepared, layout_file: None, ..self.clone() }
    }

    /// Copy that asks for another preparation. Its faces stay as they are.
    #[must_use = "the mesh itself stays as it is"]
    pub fn asking_for(&self, form: Preparation) -> Self {
        Self { prepared: PreparedMesh { form, ..self.prepared.clone() }, ..self.clone() }
    }

    /// Its parts, those that are left out among them.
    pub fn parts(&self) -> Vec<PartFaces> {
        let is_cut_there = self.prepared.form.seams.of_texture;
        let labels = if is_cut_there { self.source.texture_labels().ok() } else { None };
        self.prepared.parts(&self.source.polygons, labels.as_deref())
    }

    /// The chart that is wanted, where the mesh has several.
    pub(super) fn with_chart(self, wanted: Option<usize>) -> Self {
        match self.prepared.chart.as_ref().map(|of| of.charts.pick(wanted)) {
            Some(number) => self.of_chart(number),
            None => self,
        }
    }

    /// Another chart of the same mesh, where it has several.
    #[must_use = "the mesh itself stays as it is"]
    pub fn of_chart(&self, number: usize) -> Self {
        Self { prepared: self.prepared.of_chart(number), ..self.clone() }
    }

    /// Whether it is the chart that is wanted, where the mesh has several.
    pub(super) fn is_chart(&self, wanted: Option<usize>) -> bool {
        self.prepared.chart.as_ref().is_none_or(|of| of.number == of.charts.pick(wanted))
    }

    /// The sides of its edges that are listed as seams, with its own vertices.
    pub fn seam_sides(&self) -> Vec<[VertexId; 2]> {
        self.prepared.seam_sides(&self.source.polygons)
    }

    /// How many charts the mesh has.
    pub fn chart_count(&self) -> usize {
        self.prepared.chart_count()
    }

    /// The repairs of the whole mesh, where there are any.
    pub fn whole_repaired(&self) -> Option<&Repaired> {
        self.prepared.whole_repaired()
    }

    /// The vertex of the repaired mesh that one of this mesh or chart is: with the file's number, where the file has it.
    pub fn vertex_in_file(&self, vertex: VertexId) -> VertexId {
        self.prepared.vertex_in_file(vertex)
    }

    /// The vertex of this mesh or chart that one of the repaired mesh is.
    pub fn vertex_of_file(&self, vertex: VertexId) -> Option<VertexId> {
        match &self.prepared.chart {
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
        self.prepared.mesh()
    }

    /// How many vertices it has, those of no face included. What fills its holes has none of its own here.
    pub fn vertex_count(&self) -> usize {
        let polygons = self.prepared.repaired.as_ref().map_or(&self.source.polygons, |repaired| repaired.polygons());
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
            Some(file) => self.source.layout_by(&file.texture, self.prepared.repaired.as_deref(), self.mesh()),
            None => self.source.layout(self.prepared.repaired.as_deref(), self.mesh()),
        }
    }

    /// Where the layout comes from that a run with these settings starts from; none where it starts from scratch.
    pub(super) fn start_words(&self, settings: &Settings) -> Option<String> {
        let from_file = || self.layout_file.as_ref().map_or_else(|| "uv".to_owned(), |file| file.path.clone());
        (settings.start == Start::File && settings.method.continues_from_layout()).then(from_file)
    }

    /// The disk, where it is one.
    pub fn disk(&self) -> Option<&Arc<DiskMesh>> {
        self.prepared.disk()
    }

    /// Options of a flattener of a problem, with the layout of the file if the problem starts from it.
    ///
    /// # Errors
    ///
    /// [`LayoutError`] if the layout is asked for and is not there.
    pub fn flattener_options(&self, problem: &Problem) -> Result<Options, LayoutError> {
        Ok(match problem.settings.start {
            Start::File => problem.options_from(&self.layout()?),
            Start::FromScratch => problem.options(),
        })
    }

    /// The origin of results on this mesh with these settings.
    fn result_source(&self, settings: &Settings) -> ResultSource<'_> {
        let (name, start) = (self.path_words(), self.start_words(settings));
        ResultSource { file: &self.source, path: self.path.as_deref(), name, start }
    }

    /// An outcome at its final size, proved and measured there.
    ///
    /// # Panics
    ///
    /// If the outcome is of another mesh, and the model no disk.
    pub fn finished<'a>(&'a self, outcome: &'a Outcome, steps: Vec<StepReport>, fit: Fit) -> Output<'a> {
        self.result_source(&outcome.problem.settings).finished(&self.prepared, outcome, steps, fit)
    }
}

/// A chart that is solved, with its steps.
#[derive(Clone, Copy, Debug)]
pub struct SolvedModel<'a> {
    /// The chart.
    pub model: &'a Model,
    /// Step that is written.
    pub outcome: &'a Outcome,
    /// Steps up to it.
    pub steps: &'a [StepReport],
    /// Size relative to the other packed charts.
    pub size: f64,
}

/// All charts of a mesh, laid out and proved, ready to be written.
///
/// # Panics
///
/// If there is no chart, or one is no chart of several, or no disk.
pub fn finished_atlas<'a>(charts: &[SolvedModel<'a>], options: PackingOptions, arrangement: Arrangement) -> Output<'a> {
    let solved = |of: &SolvedModel<'a>| SolvedChart { chart: &of.model.prepared, outcome: of.outcome, size: of.size };
    let solved: Vec<SolvedChart<'a>> = charts.iter().map(solved).collect();
    let laid = atlas(&solved, options, arrangement);
    let steps = charts.iter().map(|of| of.steps.to_vec()).collect();
    charts[0].model.result_source(&charts[0].outcome.problem.settings).finished_atlas(&solved, laid, steps)
}

fn flow(is_enough: &dyn Fn() -> bool) -> ControlFlow<()> {
    if is_enough() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// The picture that belongs to a built-in mesh.
pub fn example_picture(example: Example) -> Option<Arc<PictureFile>> {
    let pixels = Arc::new(example.picture()?);
    Some(Arc::new(PictureFile { name: "portrait".to_owned(), path: None, stamp: None, pixels }))
}
