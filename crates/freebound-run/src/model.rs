//! Opened mesh.

use std::io::Read;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use freebound_core::cutting::SeamOptions;
use freebound_core::flatten::Options;
use freebound_core::geom::PackingOptions;
use freebound_core::mesh::{DiskMesh, FaceId, PartFaces, Preparation, Repaired, TriMesh, VertexId};
use freebound_core::pipeline::{
    Arrangement, AutomaticSeams, Fit, MeshToCut, Outcome, PreparedMesh, Problem, SeamReport, SolvedChart, Surface,
    atlas,
};
use freebound_core::problem::{Control, Embedding, Settings, SolveError, Start};
use freebound_io::{
    FileStamp, LayoutError, MeshFile, Output, ReadError, ReadOptions, ResultSource, StepReport, Texture,
    read_mesh_with, read_stream_with,
};

/// Most automatic seams that a model keeps, with their maps.
const MOST_SEAMS: usize = 8;

/// Opened mesh, which may have faults that prevent flattening.
#[derive(Clone, Debug)]
pub struct Model {
    /// Name: the file name, or the title of the example.
    pub name: String,
    /// Path of the file.
    pub path: Option<PathBuf>,
    /// State of the file when it was read, by which a project recognises it.
    pub stamp: Option<FileStamp>,
    /// Name of the built-in mesh, if the model is one.
    pub built_in: Option<&'static str>,
    /// Content of the file, to be written back with the result. Its faces are reversed if the preparation reverses
    /// them.
    pub source: Arc<MeshFile>,
    /// The mesh or its chart, prepared for flattening.
    pub prepared: PreparedMesh,
    /// Automatic seams that were found for preparations of the mesh, the newest last, with their maps.
    seams_found: Vec<Arc<AutomaticSeams>>,
    /// Texture coordinates of another file, which replace the file's own as the start of a run.
    pub layout_file: Option<Arc<LayoutFile>>,
}

/// File whose texture coordinates a run starts from.
#[derive(Clone, Debug)]
pub struct LayoutFile {
    /// Name of the file in reports.
    pub path: String,
    /// Texture coordinates of the file, for the corners of the mesh.
    texture: Texture,
}

impl Model {
    /// Reads and diagnoses a file.
    ///
    /// # Errors
    ///
    /// [`ReadError`] if the file cannot be read as a mesh. Faults of the mesh are no error here.
    pub fn read(path: &Path, form: Preparation) -> Result<Self, ReadError> {
        Ok(Self { stamp: FileStamp::read(path).ok(), ..Self::read_until(path, form, &|| false)? })
    }

    /// Reads and diagnoses a file without its stamp. `is_enough` is polled and cancels if it returns true.
    ///
    /// # Errors
    ///
    /// Errors of [`read`](Self::read), and [`ReadError::Cancelled`] if `is_enough` cancels.
    pub fn read_until(path: &Path, form: Preparation, is_enough: &dyn Fn() -> bool) -> Result<Self, ReadError> {
        Ok(Self::read_formless(path, ReadOptions::default(), is_enough)?.in_form(form))
    }

    /// Reads a file whose preparation depends on its content. The mesh has no faces until [`in_form`](Self::in_form).
    ///
    /// # Errors
    ///
    /// Errors of [`read_until`](Self::read_until).
    pub fn read_formless(path: &Path, options: ReadOptions, is_enough: &dyn Fn() -> bool) -> Result<Self, ReadError> {
        let source = read_mesh_with(path, options, &mut |_| flow(is_enough))?;
        Ok(Self::of_file(path, Arc::new(source)))
    }

    /// Reads a stream like [`read_formless`](Self::read_formless) reads a file. `name` becomes the name of the model.
    ///
    /// # Errors
    ///
    /// Errors of [`read_until`](Self::read_until).
    pub fn read_stream(
        name: &str,
        stream: impl Read,
        options: ReadOptions,
        is_enough: &dyn Fn() -> bool,
    ) -> Result<Self, ReadError> {
        let source = read_stream_with(stream, options, &mut |_| flow(is_enough))?;
        Ok(Self::in_memory(name, Arc::new(source)))
    }

    /// Model of a built-in mesh. `name` identifies it, `title` is for people.
    pub fn built_in(name: &'static str, title: &str, mesh: &TriMesh) -> Self {
        let model = Self::as_in_file(title.to_owned(), None, Arc::new(MeshFile::from(mesh)));
        Self { built_in: Some(name), ..model.in_form(Preparation::default()) }
    }

    /// Model of a mesh in memory, which is not prepared yet. `name` stands for a path in messages and reports.
    pub fn in_memory(name: &str, mesh: Arc<MeshFile>) -> Self {
        Self::as_in_file(name.to_owned(), None, mesh)
    }

    /// Model of a file that was read before, which is not prepared yet.
    pub fn of_file(path: &Path, mesh: Arc<MeshFile>) -> Self {
        Self::as_in_file(name_of(path), Some(path.to_owned()), mesh)
    }

    /// Model of a file that is not prepared or diagnosed yet.
    fn as_in_file(name: String, path: Option<PathBuf>, source: Arc<MeshFile>) -> Self {
        Self {
            name,
            path,
            stamp: None,
            built_in: None,
            source,
            prepared: PreparedMesh::default(),
            seams_found: Vec::new(),
            layout_file: None,
        }
    }

    /// Model in another preparation. Faces keep their order, and vertices of the file keep their numbers. Seams of
    /// texture coordinates are cut only if all corners have texture coordinates.
    #[must_use = "the mesh itself stays as it is"]
    pub fn in_form(&self, form: Preparation) -> Self {
        let source = self.source_in(&form);
        let labels = labels_for(&source, &form);
        let prepared = PreparedMesh::new(&source.polygons, labels.as_deref(), form);
        Self { source, prepared, layout_file: None, ..self.clone() }
    }

    /// File with its faces reversed as a preparation asks for.
    fn source_in(&self, form: &Preparation) -> Arc<MeshFile> {
        let is_turned = form.faces_turned != self.prepared.form.faces_turned;
        if is_turned { Arc::new(self.source.turned()) } else { Arc::clone(&self.source) }
    }

    /// Model that is cut along automatic seams.
    #[must_use = "the mesh itself stays as it is"]
    pub fn cut_along(&self, seams: AutomaticSeams) -> Self {
        let form = seams.form.clone();
        // A plain disk that needs no seam is prepared already.
        let is_prepared = self.prepared.is_plain_disk() && self.prepared.form.prepares_like(&form);
        let model = self.knowing(Arc::new(seams));
        if is_prepared { model.asking_for(form) } else { model.in_form(form) }
    }

    /// Model that knows automatic seams. It is not cut along them.
    #[must_use = "the mesh itself stays as it is"]
    pub fn knowing(&self, seams: Arc<AutomaticSeams>) -> Self {
        let mut seams_found = self.seams_found.clone();
        seams_found.retain(|known| known.form != seams.form);
        seams_found.push(seams);
        if seams_found.len() > MOST_SEAMS {
            // The mesh may be cut along the oldest.
            let oldest = seams_found.iter().position(|known| known.form != self.prepared.form);
            seams_found.remove(oldest.unwrap_or(0));
        }
        Self { seams_found, ..self.clone() }
    }

    /// Model that knows the map of its automatic seams. The map is computed if it is not known. A model without such
    /// seams, and a computation that is cancelled or fails, change nothing.
    #[must_use = "the mesh itself stays as it is"]
    pub fn mapped(self, control: Control<'_>) -> Self {
        let form = &self.prepared.form;
        let Some(bound) = form.seams.bound().filter(|_| self.automatic_seams().is_none()) else { return self };
        let labels = labels_for(&self.source, form);
        let to_cut = MeshToCut { mesh: &self.source.polygons, labels: labels.as_deref(), form };
        match AutomaticSeams::along(to_cut, SeamOptions::new(bound), control) {
            Ok(seams) => self.knowing(Arc::new(seams)),
            Err(_) => self,
        }
    }

    /// Automatic seams that the mesh is cut along, with their map. A run of `auto` without pins and without another
    /// start begins with this map.
    pub fn automatic_seams(&self) -> Option<&AutomaticSeams> {
        self.seams_of(&self.prepared.form).map(AsRef::as_ref)
    }

    /// Automatic seams that were found for a preparation that cuts along them.
    fn seams_of(&self, form: &Preparation) -> Option<&Arc<AutomaticSeams>> {
        self.seams_found.iter().find(|known| known.form == *form)
    }

    /// Automatic seams that were found for a preparation without them and a bound.
    pub fn known_seams(&self, form: &Preparation, bound: f64) -> Option<&Arc<AutomaticSeams>> {
        let is_for = |known: &&Arc<AutomaticSeams>| {
            let seams = known.form.seams.without_automatic();
            known.bound.to_bits() == bound.to_bits() && Preparation { seams, ..known.form.clone() } == *form
        };
        self.seams_found.iter().find(is_for)
    }

    /// Finds automatic seams for the mesh in a preparation. `report` receives each improvement of a part.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub fn find_seams(
        &self,
        form: &Preparation,
        options: SeamOptions,
        control: Control<'_>,
        report: SeamReport<'_>,
    ) -> Result<AutomaticSeams, SolveError> {
        let source = self.source_in(form);
        let labels = labels_for(&source, form);
        let to_cut = MeshToCut { mesh: &source.polygons, labels: labels.as_deref(), form };
        if *form != self.prepared.form || !self.prepared.is_plain_disk() {
            return AutomaticSeams::find(to_cut, options, control, report);
        }
        match AutomaticSeams::of_uncut(&self.prepared, &source.polygons, options, control, report)? {
            Some(seams) => Ok(seams),
            None => AutomaticSeams::find_cut(to_cut, options, control, report),
        }
    }

    /// Copy that asks for another preparation. Its faces are unchanged.
    #[must_use = "the mesh itself stays as it is"]
    pub fn asking_for(&self, form: Preparation) -> Self {
        Self { prepared: PreparedMesh { form, ..self.prepared.clone() }, ..self.clone() }
    }

    /// Parts of the mesh, including those that are left out.
    pub fn parts(&self) -> Vec<PartFaces> {
        let is_cut_there = self.prepared.form.seams.of_texture;
        let labels = if is_cut_there { self.source.texture_labels().ok() } else { None };
        self.prepared.parts(&self.source.polygons, labels.as_deref())
    }

    /// Model of the wanted chart, if the mesh has several charts.
    #[must_use = "the mesh itself stays as it is"]
    pub fn with_chart(self, wanted: Option<usize>) -> Self {
        match self.prepared.chart.as_ref().map(|of| of.charts.pick(wanted)) {
            Some(number) => self.of_chart(number),
            None => self,
        }
    }

    /// Model of another chart, if the mesh has several charts.
    #[must_use = "the mesh itself stays as it is"]
    pub fn of_chart(&self, number: usize) -> Self {
        Self { prepared: self.prepared.of_chart(number), ..self.clone() }
    }

    /// True if this is the wanted chart, or the mesh has only one.
    pub fn is_chart(&self, wanted: Option<usize>) -> bool {
        self.prepared.chart.as_ref().is_none_or(|of| of.number == of.charts.pick(wanted))
    }

    /// Sides of the edges that are listed as seams, by the model's own vertices.
    pub fn seam_sides(&self) -> Vec<[VertexId; 2]> {
        self.prepared.seam_sides(&self.source.polygons)
    }

    /// Number of charts of the mesh.
    pub fn chart_count(&self) -> usize {
        self.prepared.chart_count()
    }

    /// Repairs of the whole mesh, if there are any.
    pub fn whole_repaired(&self) -> Option<&Repaired> {
        self.prepared.whole_repaired()
    }

    /// Vertex of the repaired mesh for a vertex of this mesh or chart. Vertices of the file have the file's numbers.
    pub fn vertex_in_file(&self, vertex: VertexId) -> VertexId {
        self.prepared.vertex_in_file(vertex)
    }

    /// Vertex of this mesh or chart for a vertex of the repaired mesh.
    pub fn vertex_of_file(&self, vertex: VertexId) -> Option<VertexId> {
        match &self.prepared.chart {
            Some(of) => of.chart.vertex_at(vertex),
            None => (vertex.index() < self.vertex_count()).then_some(vertex),
        }
    }

    /// Origin of the mesh, for messages and reports.
    pub fn path_words(&self) -> String {
        match (&self.path, self.built_in) {
            (Some(path), _) => path.display().to_string(),
            (None, Some(_)) => format!("built-in: {}", self.name),
            (None, None) => self.name.clone(),
        }
    }

    /// Triangles of the mesh, including those that fill holes.
    pub fn mesh(&self) -> &TriMesh {
        self.prepared.mesh()
    }

    /// Number of vertices, including vertices without faces. Vertices that only fill holes are not counted.
    pub fn vertex_count(&self) -> usize {
        let polygons = self.prepared.repaired.as_ref().map_or(&self.source.polygons, |repaired| repaired.polygons());
        polygons.positions.len()
    }

    /// Model that starts from the texture coordinates of another file, named `path` in reports.
    /// [`in_form`](Self::in_form) drops them.
    ///
    /// # Errors
    ///
    /// [`LayoutError`] if the file has no texture coordinates for this mesh.
    pub fn with_layout_of(self, path: String, file: &MeshFile) -> Result<Self, LayoutError> {
        let texture = self.source.texture_of(file)?;
        Ok(self.with_layout(path, texture))
    }

    /// Texture coordinates of the file as an embedding of this mesh or chart.
    ///
    /// # Errors
    ///
    /// [`LayoutError`] if texture coordinates are missing, or a vertex has several.
    pub fn layout(&self) -> Result<Embedding, LayoutError> {
        match &self.layout_file {
            Some(file) => self.source.layout_by(&file.texture, self.prepared.repaired.as_deref(), self.mesh()),
            None => self.source.layout(self.prepared.repaired.as_deref(), self.mesh()),
        }
    }

    /// Model that starts from texture coordinates for its corners, named `path` in reports.
    #[must_use = "the model itself stays as it is"]
    pub fn with_layout(self, path: String, texture: Texture) -> Self {
        Self { layout_file: Some(Arc::new(LayoutFile { path, texture })), ..self }
    }

    /// Name of the layout that a run with these settings starts from. `None` if the run starts from scratch.
    pub fn start_words(&self, settings: &Settings) -> Option<String> {
        let from_file = || self.layout_file.as_ref().map_or_else(|| "uv".to_owned(), |file| file.path.clone());
        (settings.start == Start::File && settings.method.continues_from_layout()).then(from_file)
    }

    /// True if faults prevent flattening.
    pub fn is_faulty(&self) -> bool {
        matches!(self.prepared.surface, Surface::Faulty(..))
    }

    /// Disk of the mesh, if it is one.
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
            Start::FromScratch => problem.options_with_map(self.map_of_seams()),
        })
    }

    /// Map of the mesh or chart that was found with automatic seams.
    fn map_of_seams(&self) -> Option<Embedding> {
        let seams = self.automatic_seams()?;
        self.prepared.map_of_corners(&self.source.polygons, &seams.corners)
    }

    /// The origin of results on this mesh with these settings.
    fn result_source(&self, settings: &Settings) -> ResultSource<'_> {
        let (name, start) = (self.path_words(), self.start_words(settings));
        ResultSource { file: &self.source, path: self.path.as_deref(), name, start }
    }

    /// Outcome at its final size, proved and measured at this size.
    ///
    /// # Panics
    ///
    /// If the outcome belongs to another mesh and the model is not a disk.
    pub fn finished<'a>(&'a self, outcome: &'a Outcome, steps: Vec<StepReport>, fit: Fit) -> Output<'a> {
        self.result_source(&outcome.problem.settings).finished(&self.prepared, outcome, steps, fit)
    }
}

/// Solved chart with its steps.
#[derive(Clone, Copy, Debug)]
pub struct SolvedModel<'a> {
    /// Model of the chart.
    pub model: &'a Model,
    /// Step to be written.
    pub outcome: &'a Outcome,
    /// Steps up to the step that is written.
    pub steps: &'a [StepReport],
    /// Size relative to the other packed charts.
    pub size: f64,
    /// Tile in which the chart must be packed. Default: any.
    pub tile: Option<u32>,
    /// Texture coordinates where the chart stays, v up. Default: the chart is packed.
    pub locked: Option<&'a Embedding>,
    /// Number of the chart whose place this chart shares. Default: a place of its own.
    pub stacked_on: Option<usize>,
    /// True if all files that are written keep the materials of the source. Charts of different materials may then
    /// overlap, because each material has a picture of its own.
    pub keeps_materials: bool,
}

/// Lays out and proves all charts of a mesh, ready to be written.
///
/// # Panics
///
/// If there is no chart, a model is not a chart of several, or a chart is not a disk.
pub fn finished_atlas<'a>(charts: &[SolvedModel<'a>], options: PackingOptions, arrangement: Arrangement) -> Output<'a> {
    // Charts that are packed do not overlap, whatever their materials.
    let may_overlap = arrangement == Arrangement::AsGiven && charts.iter().all(|chart| chart.keeps_materials);
    let materials = may_overlap.then(|| charts[0].model.source.material_labels().ok()).flatten();
    let solved = |&SolvedModel { model, outcome, size, tile, locked, stacked_on, .. }: &SolvedModel<'a>| SolvedChart {
        chart: &model.prepared,
        outcome,
        size,
        tile,
        locked,
        stacked_on,
        group: materials.as_deref().and_then(|materials| common_label(model.mesh(), materials)),
    };
    let solved: Vec<SolvedChart<'a>> = charts.iter().map(solved).collect();
    let laid = atlas(&solved, options, arrangement);
    let steps = charts.iter().map(|of| of.steps.to_vec()).collect();
    charts[0].model.result_source(&charts[0].outcome.problem.settings).finished_atlas(&solved, laid, steps)
}

/// Label of all faces of a mesh; `None` if they differ. `labels` has one label per face of the file.
fn common_label(mesh: &TriMesh, labels: &[u32]) -> Option<u32> {
    let mut faces = (0..mesh.real_face_count()).map(|face| labels.get(mesh.polygon(FaceId::from_index(face)) as usize));
    let first = faces.next()??;
    faces.all(|label| label == Some(first)).then_some(*first)
}

/// Labels of the corners by texture coordinates, if a preparation cuts along their seams.
fn labels_for(source: &MeshFile, form: &Preparation) -> Option<Vec<u32>> {
    if form.seams.of_texture { source.texture_labels().ok() } else { None }
}

/// Name of a file without its folder.
fn name_of(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

fn flow(is_enough: &dyn Fn() -> bool) -> ControlFlow<()> {
    if is_enough() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
