//! Project files: what a person has made of a mesh, as JSON that a person can read.
//!
//! | file     | what it holds                                    |
//! |----------|--------------------------------------------------|
//! | `mod`    | a project, read and written; paths in it         |
//! | `error`  | why a file did not become a project              |
//! | `fields` | how sources, seams and pins stand in the file    |
//!
//! A project names mesh and picture and holds everything else. Fields that this version does not know are ignored, so
//! that a later version can add some; one that changes what fields mean takes the next [`PROJECT_VERSION`].

mod error;
mod fields;

use std::collections::BTreeMap;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

pub use self::error::ProjectError;
use self::fields::{SourceFields, pin_list, seam_list};
use super::finite::check_finite;
use super::paths::{named_in_files, relative, whole_folder_of};
use super::{FileStamp, WriteError, write_durably};
use freebound_core::geom::{PackingOptions, VAxis};
use freebound_core::mesh::{HoleTreatment, Preparation, Repairs, Seams, WeldDistance};
use freebound_core::pipeline::Targets;
use freebound_core::problem::{BoundaryShape, Family, GaugeSize, Growth, Method, Settings, Spacing, Start, Treatment};

/// The version of the format that this program writes, and the newest that it reads.
pub const PROJECT_VERSION: u64 = 1;

/// Extension of a project file's name.
pub const PROJECT_EXTENSION: &str = "freebound";

/// A project as a file holds it, field by field in the file's order. Paths are whole; the file has them relative to
/// itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProjectFile {
    /// Version of the format.
    freebound_project: u64,
    /// The mesh.
    pub mesh: ProjectSource,
    /// Whether the mesh's faces are turned around.
    #[serde(default)]
    pub faces_turned: bool,
    /// What may be repaired of it.
    #[serde(default)]
    pub repair: Repairs,
    /// The distance within which vertices of it are joined.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weld_distance: Option<WeldDistance>,
    /// What becomes of its holes; of older projects they are cut where the mesh is.
    #[serde(default)]
    pub holes: Option<HoleTreatment>,
    /// Whether it is cut open where it is no disk.
    #[serde(default)]
    pub cut: bool,
    /// Where it is cut before that.
    #[serde(default, skip_serializing_if = "Seams::is_empty", with = "seam_list")]
    pub seams: Seams,
    /// Parts of it that are left out, by the numbers of their first faces.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out_parts: Vec<u32>,
    /// The picture.
    #[serde(default)]
    pub picture: Option<ProjectSource>,
    /// Where v = 0 is on the picture.
    #[serde(default)]
    pub v_axis: VAxis,
    /// Of one with a shape the default; its shape stands in the next field.
    #[serde(default)]
    method: Method,
    #[serde(default)]
    boundary: BoundaryShape,
    #[serde(default)]
    spacing: Spacing,
    #[serde(default = "default_layers")]
    layers: usize,
    /// Where nobody chose, missing, as is the limit of steps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    family: Option<Family>,
    #[serde(default)]
    treatment: Option<Treatment>,
    #[serde(default)]
    growth: Growth,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    max_steps: Option<usize>,
    #[serde(default)]
    relax_rounds: Option<usize>,
    /// Rounds of relaxing that a person has asked for beside those of the settings.
    #[serde(default)]
    pub relaxed: usize,
    #[serde(default = "default_new_vertices")]
    new_vertices: bool,
    /// What the first step is.
    #[serde(default)]
    start: Start,
    /// The chart on the screen, where the mesh has several; the largest without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chart: Option<usize>,
    /// As `relaxed`, of charts that are not on the screen.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub relaxed_elsewhere: BTreeMap<usize, usize>,
    /// How charts are packed.
    #[serde(default)]
    pub packing: PackingOptions,
    /// How many times as large as the others charts are packed, by their first faces in the file.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub sizes: BTreeMap<u32, f64>,
    /// The targets of the user's pins.
    #[serde(default, rename = "pins", with = "pin_list")]
    pub targets: Targets,
    /// How the person looked at it.
    #[serde(default)]
    pub view: ProjectView,
    /// What only a copy for recovery has.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recovery: Option<RecoveryNote>,
}

fn default_layers() -> usize {
    Settings::LAYERS
}

fn default_new_vertices() -> bool {
    Settings::default().new_vertices
}

/// Where a mesh or a picture is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "SourceFields", into = "SourceFields")]
pub enum ProjectSource {
    /// In a file.
    File {
        /// Its path.
        path: PathBuf,
        /// The state that it had, where that is known.
        stamp: Option<FileStamp>,
    },
    /// In the program: the name of an example.
    Example(String),
}

/// How a person looked at a project. Only the screen knows what the words and numbers mean; each may be missing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ProjectView {
    /// Name of the shading of the mesh.
    pub mesh_shading: Option<String>,
    /// Name of the shading of the embedding.
    pub plane_shading: Option<String>,
    /// The camera before the mesh.
    pub mesh_camera: Option<Vec<f64>>,
    /// The camera over the plane.
    pub plane_camera: Option<Vec<f64>>,
    /// Numbers of the selected vertices.
    pub selection: Vec<u32>,
    /// Name of the tool.
    pub tool: Option<String>,
}

/// What a copy for recovery says about the work that it is a copy of.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct RecoveryNote {
    /// What the work was called.
    pub name: String,
    /// The project that it was last saved to.
    pub project: Option<PathBuf>,
}

/// How a project names files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathStyle {
    /// From the project's folder, so that a folder can be moved as a whole.
    Relative,
    /// From the root, for a project that lies anywhere.
    Absolute,
}

/// All that is read of a file before its version is known.
#[derive(Deserialize)]
struct Head {
    freebound_project: u64,
}

impl ProjectFile {
    /// What is made of the mesh's faces.
    pub fn form(&self) -> Preparation {
        let holes = self.holes.unwrap_or(if self.cut { HoleTreatment::Cut } else { HoleTreatment::Fill });
        Preparation {
            faces_turned: self.faces_turned,
            repair: self.repair.welding(self.weld_distance),
            holes,
            cut: self.cut,
            seams: self.seams.clone(),
            left_out: Arc::new(self.left_out_parts.iter().copied().collect()),
        }
    }

    /// A project of a mesh, with nothing but settings made of it yet.
    pub fn new(mesh: ProjectSource, settings: &Settings) -> Self {
        let boundary = settings.method.boundary_shape().cloned().unwrap_or_default();
        let method = settings.method.clone().on_shape(BoundaryShape::default());
        Self {
            freebound_project: PROJECT_VERSION,
            mesh,
            faces_turned: false,
            repair: Repairs::default(),
            weld_distance: None,
            holes: Some(HoleTreatment::default()),
            cut: false,
            seams: Seams::default(),
            left_out_parts: Vec::new(),
            picture: None,
            v_axis: VAxis::default(),
            method,
            boundary,
            spacing: settings.spacing,
            layers: settings.layers,
            family: settings.family,
            treatment: settings.treatment,
            growth: settings.growth,
            max_steps: settings.max_steps,
            relax_rounds: settings.relax_rounds,
            relaxed: 0,
            chart: None,
            relaxed_elsewhere: BTreeMap::new(),
            packing: PackingOptions::default(),
            sizes: BTreeMap::new(),
            new_vertices: settings.new_vertices,
            start: settings.start,
            targets: Targets::new(),
            view: ProjectView::default(),
            recovery: None,
        }
    }

    /// Method and weights. Their size follows from the picture, so that it is not in the file.
    pub fn settings(&self) -> Settings {
        Settings {
            method: self.method.clone().on_shape(self.boundary.clone()),
            spacing: self.spacing,
            layers: self.layers.clamp(1, usize::from(Settings::MOST_LAYERS)),
            family: self.family,
            treatment: self.treatment,
            max_steps: self.max_steps,
            growth: self.growth,
            size: GaugeSize::default(),
            relax_rounds: self.relax_rounds,
            new_vertices: self.new_vertices,
            start: self.start,
        }
    }

    /// Reads a project file.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, that is none, or that has a fault; nothing of it is guessed.
    pub fn read(path: &Path) -> Result<Self, ProjectError> {
        let bytes = std::fs::read(path).map_err(|source| ProjectError::File { path: path.to_owned(), source })?;
        let not_a_project = || ProjectError::NotAProject { path: path.to_owned() };
        let text = std::str::from_utf8(&bytes).map_err(|_| not_a_project())?;
        match parse(path, text) {
            Ok(Head { freebound_project: 0 }) => return Err(not_a_project()),
            Ok(Head { freebound_project: version }) if version > PROJECT_VERSION => {
                return Err(ProjectError::Newer { path: path.to_owned(), version });
            }
            Ok(_) => {}
            Err(error) if text.contains("\"freebound_project\"") => return Err(error),
            Err(_) => return Err(not_a_project()),
        }
        let mut project: Self = parse(path, text)?;
        let folder = whole_folder_of(path);
        for source in [Some(&mut project.mesh), project.picture.as_mut()].into_iter().flatten() {
            if let ProjectSource::File { path, .. } = source {
                *path = folder.join(&*path);
            }
        }
        Ok(project)
    }

    /// Writes the project whole or not at all; what is written survives a loss of power.
    ///
    /// # Errors
    ///
    /// [`WriteError`] names the path and says what went wrong.
    pub fn write(&self, path: &Path, style: PathStyle) -> Result<(), WriteError> {
        let failed = |source| WriteError::writing(path, source);
        check_finite(self.targets.values().map(|target| &target.uv)).map_err(failed)?;
        let mut project = self.clone();
        let folder = whole_folder_of(path);
        for source in [Some(&mut project.mesh), project.picture.as_mut()].into_iter().flatten() {
            if let ProjectSource::File { path, .. } = source {
                *path = named(path, &folder, style).map_err(failed)?;
            }
        }
        write_durably(path, |out| {
            serde_json::to_writer_pretty(&mut *out, &project)?;
            writeln!(out)
        })
    }
}

/// Reads the text of a file; a fault is told with its line and its field.
fn parse<'de, T: Deserialize<'de>>(path: &Path, text: &'de str) -> Result<T, ProjectError> {
    let mut source = serde_json::Deserializer::from_str(text);
    let malformed = |field: String, error: &serde_json::Error| {
        let message = error.to_string();
        let reason = message.rfind(" at line ").map_or(message.as_str(), |end| &message[..end]).to_owned();
        let field = if field == "." { "the project".to_owned() } else { field };
        ProjectError::Malformed { path: path.to_owned(), line: error.line(), field, reason }
    };
    let found = serde_path_to_error::deserialize(&mut source)
        .map_err(|error| malformed(error.path().to_string(), error.inner()))?;
    source.end().map_err(|error| malformed(".".to_owned(), &error))?;
    Ok(found)
}

/// A file's name in a project that is in `folder`. Folders are divided by slashes on every system.
fn named(path: &Path, folder: &Path, style: PathStyle) -> io::Result<PathBuf> {
    let own = path.file_name().ok_or_else(|| io::Error::other(format!("{} names no file", path.display())))?;
    let whole = whole_folder_of(path).join(own);
    let found = match style {
        PathStyle::Absolute => whole,
        PathStyle::Relative => relative(&whole, folder).unwrap_or(whole),
    };
    named_in_files(&found).map(PathBuf::from).ok_or_else(|| {
        let text = format!("the name {} is not Unicode, which a project cannot hold", found.display());
        io::Error::new(io::ErrorKind::InvalidData, text)
    })
}
