//! Result of opening a file: mesh, picture, pins and view, with remarks.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec2;

use super::chart_layout::{ChartLayout, ChartPlace};
use super::large::LocatedFile;
use super::locating::located;
use super::messages::named;
use super::restored_charts::{RestoredChart, restored};
use super::{Document, Message, MessagePlace, Model};
use crate::examples::Example;
use freebound_core::mesh::{FaceId, Preparation, VertexId};
use freebound_core::pipeline::Target;
use freebound_core::problem::Control;
use freebound_io::{
    FileStamp, MemoryShortage, PROJECT_EXTENSION, PictureFile, ProjectError, ProjectFile, ProjectPins, ProjectSource,
    ProjectView, ReadError, RecoveryNote, SavedMap, check_memory, material_picture,
};

/// Result of opening a file.
#[derive(Debug)]
pub(super) struct Opened {
    pub(super) model: Model,
    pub(super) document: Document,
    pub(super) view: ProjectView,
    pub(super) origin: Origin,
    /// Charts whose maps the project has.
    pub(super) restored: Vec<RestoredChart>,
    /// Remarks on missing or changed files and elements.
    pub(super) remarks: Vec<Message>,
    /// Picture of the project, if it could not be read.
    pub(super) missing_picture: Option<ProjectSource>,
    /// True if pins or seams of the project are left out.
    pub(super) is_partial: bool,
}

/// Origin of the opened document.
#[derive(Debug)]
pub(super) enum Origin {
    /// A mesh file or an example.
    Mesh,
    /// A project.
    Project(PathBuf),
    /// A copy for recovery.
    Recovery(RecoveryNote),
}

impl Origin {
    /// Project of the document.
    fn project(&self) -> Option<&Path> {
        match self {
            Self::Mesh => None,
            Self::Project(path) => Some(path),
            Self::Recovery(note) => note.project.as_deref(),
        }
    }
}

/// Reason for not opening a file.
#[derive(Debug, thiserror::Error)]
pub(super) enum OpenError {
    #[error("{}: {source}", path.display())]
    Mesh { path: PathBuf, source: ReadError },
    #[error("{}: {source}", path.display())]
    Memory { path: PathBuf, source: MemoryShortage },
    #[error(transparent)]
    Project(#[from] ProjectError),
    #[error("{}: the mesh of the project does not exist", mesh.display())]
    NoMesh { mesh: PathBuf },
    #[error("the built-in mesh of the project is unknown: \"{name}\"")]
    NoExample { name: String },
}

impl OpenError {
    /// Action that the message suggests.
    pub(super) fn remedy(&self) -> &'static str {
        match self {
            Self::Mesh { source, .. } => source.remedy(),
            Self::Memory { .. } => "open it on a machine with more memory, or simplify the mesh",
            Self::Project(error) => error.remedy(),
            Self::NoMesh { .. } => "press Locate… to choose its new place, or restore the file",
            Self::NoExample { .. } => "open it with a newer version of Freebound",
        }
    }
}

impl Opened {
    /// Opens a project or a mesh file, by the extension of its name. `memory` is the machine's memory in bytes; at most
    /// half of it may be used. `None` means no limit.
    pub(super) fn read(path: &Path, memory: Option<u64>) -> Result<Self, OpenError> {
        if is_project(path) {
            return Self::project(ProjectFile::read(path)?, Origin::Project(path.to_owned()), memory);
        }
        let model = read_model(path, Preparation::default(), memory)?;
        let mut remarks = Vec::new();
        let picture = material_picture(&model.source, path).and_then(|picture| {
            let found = PictureFile::read_for(&model.source, path, &picture);
            found
                .map_err(|error| remarks.push(picture_remark(&picture, error.to_string(), "open another picture")))
                .ok()
        });
        let document = Document { picture: picture.map(Arc::new), ..Document::default() };
        Ok(Self { remarks, ..Self::mesh(model, document) })
    }

    /// Opens a project with a file in place of a missing one.
    pub(super) fn project_with(path: &Path, file: &LocatedFile, memory: Option<u64>) -> Result<Self, OpenError> {
        let project = with_file(ProjectFile::read(path)?, Some(file));
        Self::project(project, Origin::Project(path.to_owned()), memory)
    }

    /// Opens a recovery copy, possibly with a file in place of a missing one. At most half of `memory`, bytes, may be
    /// used.
    pub(super) fn recovered(path: &Path, file: Option<&LocatedFile>, memory: Option<u64>) -> Result<Self, OpenError> {
        let mut project = with_file(ProjectFile::read(path)?, file);
        let note = project.recovery.take().unwrap_or_default();
        Self::project(project, Origin::Recovery(note), memory)
    }

    /// Opens a built-in mesh with its picture and constraints.
    pub(super) fn example(example: Example) -> Self {
        Self::mesh(example.model(), Document::of_example(example))
    }

    fn mesh(model: Model, document: Document) -> Self {
        Self {
            model,
            document,
            view: ProjectView::default(),
            origin: Origin::Mesh,
            restored: Vec::new(),
            remarks: Vec::new(),
            missing_picture: None,
            is_partial: false,
        }
    }

    fn project(mut project: ProjectFile, origin: Origin, memory: Option<u64>) -> Result<Self, OpenError> {
        let mut remarks = Vec::new();
        let near = origin.project();
        project.mesh = located(project.mesh, near, MessagePlace::Mesh, &mut remarks);
        project.picture = project.picture.map(|it| located(it, near, MessagePlace::Embedding, &mut remarks));
        let asked = project.form();
        let (mesh, change) = project_mesh(&project.mesh, asked.clone(), memory)?;
        remarks.extend(change);
        let model = mesh.with_chart(project.chart);
        let form = with_seams_there_are(&asked, &model, &mut remarks);
        let model = model.asking_for(form.clone());
        let picture = project.picture.as_ref().and_then(|source| project_picture(source, &model, &mut remarks));
        let (settings, pin_count) = (project.settings(), project.pins.targets.len());
        let pins = pins_there_are(project.pins, &model, &mut remarks);
        let is_partial = pins.targets.len() < pin_count || form != asked;
        let layout = ChartLayout {
            packing: project.packing,
            sizes: project.sizes.into_iter().map(|(face, size)| (FaceId::new(face), size)).collect(),
            locked: places(project.locked),
            placed: places(project.placed),
            stacked: project.stacked.into_iter().map(|(face, on)| (FaceId::new(face), FaceId::new(on))).collect(),
        };
        let mut document = Document {
            settings,
            picture,
            v_axis: project.v_axis,
            form,
            chart: project.chart,
            layout,
            relaxed: project.relaxed,
            ..Document::default()
        };
        document.take_charts(&model, pins, &project.relaxed_elsewhere);
        let restored = restored(&model, &document, &project.maps);
        if project.maps.values().any(|SavedMap(map)| map.is_empty()) {
            let text = "a map of the project is damaged: it is solved again";
            remarks.push(Message::caution(MessagePlace::Embedding, text));
        }
        // Saving must keep a picture that was only unavailable this time.
        let missing_picture = project.picture.filter(|_| document.picture.is_none());
        let mut view = project.view;
        view.selection.retain(|&vertex| (vertex as usize) < model.vertex_count());
        Ok(Self { model, document, view, origin, restored, remarks, missing_picture, is_partial })
    }
}

/// True for the path of a project, by its extension.
pub(super) fn is_project(path: &Path) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(PROJECT_EXTENSION))
}

/// Project with a file in place of a missing one. The stamp stays that of the missing file.
fn with_file(mut project: ProjectFile, file: Option<&LocatedFile>) -> ProjectFile {
    let moved = |source: Option<&ProjectSource>, path: &PathBuf| {
        let stamp = match source {
            Some(ProjectSource::File { stamp, .. }) => stamp.clone(),
            _ => None,
        };
        ProjectSource::File { path: path.clone(), stamp }
    };
    match file {
        None => {}
        Some(LocatedFile::Mesh(path)) => project.mesh = moved(Some(&project.mesh), path),
        Some(LocatedFile::Picture(path)) => project.picture = Some(moved(project.picture.as_ref(), path)),
    }
    project
}

/// Places of charts of a project.
fn places(places: BTreeMap<u32, Vec<[f64; 2]>>) -> BTreeMap<FaceId, ChartPlace> {
    let place = |place: Vec<[f64; 2]>| ChartPlace(Arc::new(place.into_iter().map(DVec2::from).collect()));
    places.into_iter().map(|(face, coordinates)| (FaceId::new(face), place(coordinates))).collect()
}

/// Reads a mesh that takes at most half of `memory`, bytes.
fn read_model(path: &Path, form: Preparation, memory: Option<u64>) -> Result<Model, OpenError> {
    check_memory(path, memory).map_err(|source| OpenError::Memory { path: path.to_owned(), source })?;
    Model::read(path, form).map_err(|source| OpenError::Mesh { path: path.to_owned(), source })
}

/// Mesh of a project, with a remark if it has changed since the project was saved.
pub(super) fn project_mesh(
    source: &ProjectSource,
    form: Preparation,
    memory: Option<u64>,
) -> Result<(Model, Option<Message>), OpenError> {
    match source {
        ProjectSource::Example(name) => {
            let example = example_called(name).ok_or_else(|| OpenError::NoExample { name: name.clone() })?;
            Ok((example.model().in_form(form).mapped(Control::unattended()), None))
        }
        ProjectSource::File { path, .. } if !path.exists() => Err(OpenError::NoMesh { mesh: path.clone() }),
        ProjectSource::File { path, stamp } => {
            let mesh = read_model(path, form, memory)?.mapped(Control::unattended());
            let change = change_remark(path, stamp.as_ref(), &mesh);
            Ok((mesh, change))
        }
    }
}

/// Remark on a mesh that has changed since its project was saved.
fn change_remark(path: &Path, stamp: Option<&FileStamp>, mesh: &Model) -> Option<Message> {
    has_changed(stamp, mesh.stamp.as_ref()).then(|| {
        let text = format!("{}: the mesh has changed since the project was saved", path.display());
        let remedy = "check that the pins are on the right vertices, then save the project";
        Message::error(MessagePlace::Mesh, text).with_remedy(remedy).of_file(Some(path))
    })
}

fn project_picture(source: &ProjectSource, model: &Model, remarks: &mut Vec<Message>) -> Option<Arc<PictureFile>> {
    match source {
        ProjectSource::Example(name) => example_called(name).and_then(Example::picture_file),
        ProjectSource::File { path, stamp } => {
            let remedy = "open another picture, or repair this one and open the project again";
            let picture = if path.exists() {
                let read = match &model.path {
                    Some(mesh) => PictureFile::read_for(&model.source, mesh, path),
                    None => PictureFile::read(path),
                };
                read.map_err(|error| error.to_string())
            } else {
                Err(format!("{}: the picture of the project does not exist", path.display()))
            };
            let picture = picture.map_err(|text| remarks.push(picture_remark(path, text, remedy))).ok()?;
            if has_changed(stamp.as_ref(), picture.stamp.as_ref()) {
                let text = format!("{}: the picture has changed since the project was saved", path.display());
                remarks.push(picture_remark(
                    path,
                    text,
                    "check that the targets are in the right places, then save the project",
                ));
            }
            Some(Arc::new(picture))
        }
    }
}

fn picture_remark(path: &Path, text: String, remedy: &str) -> Message {
    Message::error(MessagePlace::Embedding, text).with_remedy(remedy).of_file(Some(path))
}

/// True if the state of a file has changed. False if one of the states is unknown.
fn has_changed(before: Option<&FileStamp>, now: Option<&FileStamp>) -> bool {
    before.zip(now).is_some_and(|(before, now)| before != now)
}

fn example_called(name: &str) -> Option<Example> {
    Example::ALL.into_iter().find(|example| example.name() == name)
}

/// Preparation without seam edges that do not exist in the mesh, with a remark about them. These edges are never cut.
fn with_seams_there_are(form: &Preparation, model: &Model, remarks: &mut Vec<Message>) -> Preparation {
    let lost = form.seams.missing_in(&model.source.polygons);
    if lost.is_empty() {
        return form.clone();
    }
    let ([a, b], count, before) = (lost[0], lost.len(), form.seams.edges().len());
    let others = if count > 1 { format!(" and {} more", count - 1) } else { String::new() };
    let text = format!(
        "{count} of the project's {before} seam edges are left out ({a}–{b}{others}): the mesh has no such edges"
    );
    let remedy = "draw them again, or restore the mesh and open the project again";
    remarks.push(Message::error(MessagePlace::Mesh, text).with_remedy(remedy));
    Preparation { seams: form.seams.without(lost), ..form.clone() }
}

/// Pins of existing vertices, with a remark about the others.
fn pins_there_are(mut pins: ProjectPins, model: &Model, remarks: &mut Vec<Message>) -> ProjectPins {
    let targets = &mut pins.targets;
    let count = model.vertex_count_in_file();
    let before = targets.len();
    let has_face =
        |vertex: VertexId| model.prepared.chart.as_ref().is_none_or(|of| of.charts.chart_of_vertex(vertex).is_some());
    let is_there =
        |vertex: &VertexId, target: &Target| vertex.index() < count && target.uv.is_finite() && has_face(*vertex);
    let lost: Vec<VertexId> = targets.iter().filter(|(v, target)| !is_there(v, target)).map(|(&v, _)| v).collect();
    targets.retain(|vertex, target| is_there(vertex, target));
    pins.notes.retain(|vertex, _| pins.targets.contains_key(vertex));
    if !lost.is_empty() {
        let text = format!(
            "{} of the project's {before} pins are left out ({}): the mesh has only {count} vertices",
            lost.len(),
            named(&lost)
        );
        let remedy = "place them again, or restore the mesh and open the project again";
        remarks.push(Message::error(MessagePlace::Embedding, text).with_remedy(remedy));
    }
    pins
}
