//! Project files: the user's edits of a mesh, as readable JSON.
//!
//! | file     | contents                                         |
//! |----------|--------------------------------------------------|
//! | `mod`    | a project, read and written; paths in it         |
//! | `error`  | errors of reading a project file                 |
//! | `fields` | form of sources, seams and pins in the file      |
//! | `saved_map` | maps of charts, bit for bit, with a checksum  |
//!
//! A project refers to its mesh and picture and contains everything else. Fields that this version does not know are
//! ignored, so that a later version can add fields. A version that changes the meaning of a field increments
//! [`PROJECT_VERSION`].

mod error;
mod fields;
mod saved_map;

use std::collections::BTreeMap;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

pub use self::error::ProjectError;
use self::fields::{SourceFields, seam_list};
pub use self::saved_map::SavedMap;
use super::finite::check_finite;
use super::paths::{named_in_files, relative, whole_folder_of};
use super::{FileStamp, PinNotes, WriteError, write_durably};
use freebound_core::geom::{PackingOptions, VAxis};
use freebound_core::mesh::{HoleTreatment, Preparation, Repairs, Seams, WeldDistance};
use freebound_core::pipeline::Targets;
use freebound_core::problem::{BoundaryShape, Family, GaugeSize, Growth, Method, Settings, Spacing, Start, Treatment};

/// Version of the format that this program writes, and the newest that it reads.
pub const PROJECT_VERSION: u64 = 1;

/// Extension of the name of a project file.
pub const PROJECT_EXTENSION: &str = "freebound";

/// Contents of a project file, in the order of the file's fields. Paths are absolute here, and relative to the
/// project in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProjectFile {
    /// Version of the format.
    freebound_project: u64,
    /// The mesh.
    pub mesh: ProjectSource,
    /// True if the mesh's faces are reversed.
    #[serde(default)]
    pub faces_turned: bool,
    /// Repairs that may be applied to the mesh.
    #[serde(default)]
    pub repair: Repairs,
    /// Distance within which vertices are welded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weld_distance: Option<WeldDistance>,
    /// Treatment of holes. Default (older projects): cut if `cut` is set, filled otherwise.
    #[serde(default)]
    pub holes: Option<HoleTreatment>,
    /// True if the mesh is cut open unless it is a disk.
    #[serde(default)]
    pub cut: bool,
    /// Seams along which the mesh is cut first.
    #[serde(default, skip_serializing_if = "Seams::is_default", with = "seam_list")]
    pub seams: Seams,
    /// Parts that are left out, by the number of their first face.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out_parts: Vec<u32>,
    /// The picture.
    #[serde(default)]
    pub picture: Option<ProjectSource>,
    /// Position of v = 0 on the picture.
    #[serde(default)]
    pub v_axis: VAxis,
    /// Method. A method with a boundary shape is stored with the default shape; `boundary` holds the shape.
    #[serde(default)]
    method: Method,
    #[serde(default)]
    boundary: BoundaryShape,
    #[serde(default)]
    spacing: Spacing,
    #[serde(default = "default_layers")]
    layers: usize,
    /// Weight family. Missing if the user chose none, like `max_steps`.
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
    /// Rounds of relaxation that the user requested in addition to those of the settings.
    #[serde(default)]
    pub relaxed: usize,
    #[serde(default = "default_new_vertices")]
    new_vertices: bool,
    /// Origin of the first step.
    #[serde(default)]
    start: Start,
    /// Number of the chart on the screen, if the mesh has several. Default: the largest chart.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chart: Option<usize>,
    /// Rounds of relaxation, like `relaxed`, of the charts that are not on the screen.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub relaxed_elsewhere: BTreeMap<usize, usize>,
    /// Packing of the charts.
    #[serde(default)]
    pub packing: PackingOptions,
    /// Relative size of charts in the packing, by the number of their first face in the file. Default: 1.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub sizes: BTreeMap<u32, f64>,
    /// Texture coordinates of the vertices of locked charts, v up, by the number of their first face in the file.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub locked: BTreeMap<u32, Vec<[f64; 2]>>,
    /// Texture coordinates, like `locked`, of charts that the user placed. They stay until they are packed.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub placed: BTreeMap<u32, Vec<[f64; 2]>>,
    /// Stacked charts, each with the chart whose place it shares, by the numbers of their first faces in the file.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub stacked: BTreeMap<u32, u32>,
    /// Maps of the charts, by the number of their first face in the file. The only chart of a mesh has 0.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub maps: BTreeMap<u32, SavedMap>,
    /// The user's pins.
    #[serde(default)]
    pub pins: ProjectPins,
    /// View of the project on the screen.
    #[serde(default)]
    pub view: ProjectView,
    /// Origin of a recovery copy; only recovery copies have it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recovery: Option<RecoveryNote>,
}

fn default_layers() -> usize {
    Settings::LAYERS
}

fn default_new_vertices() -> bool {
    Settings::default().new_vertices
}

/// Pins of a project.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProjectPins {
    /// Targets of the pins.
    pub targets: Targets,
    /// Names of the pins.
    pub notes: PinNotes,
}

/// Origin of a mesh or a picture.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "SourceFields", into = "SourceFields")]
pub enum ProjectSource {
    /// File.
    File {
        /// Path of the file.
        path: PathBuf,
        /// State of the file when it was used, if known.
        stamp: Option<FileStamp>,
    },
    /// Built-in example, by its name.
    Example(String),
}

/// View of a project on the screen. Only the screen knows the meaning of the words and numbers; each may be missing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ProjectView {
    /// Name of the shading of the mesh.
    pub mesh_shading: Option<String>,
    /// Name of the shading of the embedding.
    pub plane_shading: Option<String>,
    /// Camera of the mesh view.
    pub mesh_camera: Option<Vec<f64>>,
    /// Camera of the plane view.
    pub plane_camera: Option<Vec<f64>>,
    /// Selected vertices, by number.
    pub selection: Vec<u32>,
    /// Name of the current tool.
    pub tool: Option<String>,
}

/// Origin of a recovery copy.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct RecoveryNote {
    /// Name of the original work.
    pub name: String,
    /// Project file that the work was last saved to.
    pub project: Option<PathBuf>,
}

/// Style of the paths in a project file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathStyle {
    /// Relative to the project's folder, so that a folder can be moved as a whole.
    Relative,
    /// Absolute, for a project file in an arbitrary folder.
    Absolute,
}

/// Fields that are read before the version is known.
#[derive(Deserialize)]
struct Head {
    freebound_project: u64,
}

impl ProjectFile {
    /// Preparation of the mesh: reversed faces, repairs, holes, cuts, seams, and left-out parts.
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

    /// Project of a mesh with these settings and without edits.
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
            locked: BTreeMap::new(),
            placed: BTreeMap::new(),
            stacked: BTreeMap::new(),
            maps: BTreeMap::new(),
            new_vertices: settings.new_vertices,
            start: settings.start,
            pins: ProjectPins::default(),
            view: ProjectView::default(),
            recovery: None,
        }
    }

    /// Method and weights. Their size follows from the picture, so it is not stored in the file.
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

    /// Reads a project file. Faulty values are never guessed.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, is no project, has a newer format, or has an invalid field.
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

    /// Writes the project whole or not at all; the written file survives a loss of power.
    ///
    /// # Errors
    ///
    /// [`WriteError`] with the path and the cause.
    pub fn write(&self, path: &Path, style: PathStyle) -> Result<(), WriteError> {
        let failed = |source| WriteError::writing(path, source);
        check_finite(self.pins.targets.values().map(|target| &target.uv)).map_err(failed)?;
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

/// Parses the text of a project file; an error names its line and field.
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

/// Name of a file in a project in `folder`. Folders are separated by slashes on every system.
fn named(path: &Path, folder: &Path, style: PathStyle) -> io::Result<PathBuf> {
    let own =
        path.file_name().ok_or_else(|| io::Error::other(format!("{} is not the name of a file", path.display())))?;
    let whole = whole_folder_of(path).join(own);
    let found = match style {
        PathStyle::Absolute => whole,
        PathStyle::Relative => relative(&whole, folder).unwrap_or(whole),
    };
    named_in_files(&found).map(PathBuf::from).ok_or_else(|| {
        let text = format!("the name {} is not Unicode: rename the file to use it in a project", found.display());
        io::Error::new(io::ErrorKind::InvalidData, text)
    })
}
