//! How a project stands in its file: names, defaults, and where a fault is.

use std::path::PathBuf;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::project::{PROJECT_VERSION, ProjectFile, ProjectSource, ProjectView, RecoveryNote};
use super::project_fields::{RawChoice, RawFamily, RawWeight};
use super::{FileStamp, Target, Targets};
use crate::geom::VAxis;
use crate::mesh::VertexId;
use crate::solver::{BoundaryShape, GaugeSize, Growth, Hold, Method, Pin, Settings, Treatment};

/// The fields of a project file, in their order.
#[derive(Serialize, Deserialize)]
pub(super) struct RawProject {
    freebound_project: u64,
    mesh: RawSource,
    #[serde(default)]
    faces_turned: bool,
    #[serde(default)]
    picture: Option<RawSource>,
    #[serde(default)]
    v_axis: RawVAxis,
    #[serde(default)]
    method: RawChoice<Method>,
    #[serde(default)]
    boundary: RawChoice<BoundaryShape>,
    #[serde(default)]
    family: RawFamily,
    #[serde(default)]
    treatment: Option<RawChoice<Treatment>>,
    #[serde(default)]
    growth: RawChoice<Growth>,
    #[serde(default = "usual_max_steps")]
    max_steps: usize,
    #[serde(default)]
    relax_rounds: Option<usize>,
    #[serde(default = "usually_allowed")]
    new_vertices: bool,
    #[serde(default)]
    pins: RawPins,
    #[serde(default)]
    view: ProjectView,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    recovery: Option<RecoveryNote>,
}

fn usual_max_steps() -> usize {
    Settings::MAX_STEPS
}

fn usually_allowed() -> bool {
    true
}

#[derive(Serialize, Deserialize)]
#[serde(try_from = "RawSourceFields", into = "RawSourceFields")]
#[derive(Clone)]
struct RawSource(ProjectSource);

#[derive(Serialize, Deserialize)]
struct RawSourceFields {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    example: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    file: Option<PathBuf>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    bytes: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sha256: Option<String>,
}

impl TryFrom<RawSourceFields> for RawSource {
    type Error = &'static str;

    fn try_from(raw: RawSourceFields) -> Result<Self, Self::Error> {
        let stamp = match (raw.bytes, raw.sha256) {
            (Some(bytes), Some(sha256)) => Some(FileStamp { bytes, sha256 }),
            _ => None,
        };
        match (raw.example, raw.file) {
            (Some(name), None) => Ok(Self(ProjectSource::Example(name))),
            (None, Some(path)) => Ok(Self(ProjectSource::File { path, stamp })),
            _ => Err("name either a \"file\" or an \"example\""),
        }
    }
}

impl From<RawSource> for RawSourceFields {
    fn from(RawSource(source): RawSource) -> Self {
        let nothing = Self { example: None, file: None, bytes: None, sha256: None };
        match source {
            ProjectSource::Example(name) => Self { example: Some(name), ..nothing },
            ProjectSource::File { path, stamp } => {
                let (bytes, sha256) = stamp.map(|stamp| (stamp.bytes, stamp.sha256)).unzip();
                Self { file: Some(path), bytes, sha256, ..nothing }
            }
        }
    }
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum RawVAxis {
    #[default]
    Up,
    Down,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum RawHold {
    Fixed,
    Hard,
    Weighted,
}

#[derive(Serialize, Deserialize)]
struct RawPinFields {
    vertex: u32,
    u: f64,
    v: f64,
    hold: RawHold,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weight: Option<RawWeight>,
}

#[derive(Clone, Serialize, Deserialize)]
#[serde(from = "RawPinFields", into = "RawPinFields")]
struct RawPin(VertexId, Target);

impl From<RawPinFields> for RawPin {
    fn from(raw: RawPinFields) -> Self {
        let hold = match raw.hold {
            RawHold::Fixed => Hold::Fixed,
            RawHold::Hard => Hold::Hard,
            RawHold::Weighted => Hold::Weighted(raw.weight.map_or(Pin::DEFAULT_WEIGHT, |weight| weight.0)),
        };
        Self(VertexId::new(raw.vertex), Target { uv: DVec2::new(raw.u, raw.v), hold })
    }
}

impl From<RawPin> for RawPinFields {
    fn from(RawPin(vertex, Target { uv, hold }): RawPin) -> Self {
        let (hold, weight) = match hold {
            Hold::Fixed => (RawHold::Fixed, None),
            Hold::Hard => (RawHold::Hard, None),
            Hold::Weighted(weight) => (RawHold::Weighted, Some(RawWeight(weight))),
        };
        Self { vertex: vertex.number(), u: uv.x, v: uv.y, hold, weight }
    }
}

#[derive(Clone, Default, Serialize, Deserialize)]
#[serde(try_from = "Vec<RawPin>", into = "Vec<RawPin>")]
struct RawPins(Targets);

impl TryFrom<Vec<RawPin>> for RawPins {
    type Error = String;

    fn try_from(list: Vec<RawPin>) -> Result<Self, Self::Error> {
        let mut targets = Targets::new();
        for RawPin(vertex, target) in list {
            if targets.insert(vertex, target).is_some() {
                return Err(format!("vertex {vertex} is pinned twice"));
            }
        }
        Ok(Self(targets))
    }
}

impl From<RawPins> for Vec<RawPin> {
    fn from(RawPins(targets): RawPins) -> Self {
        targets.into_iter().map(|(vertex, target)| RawPin(vertex, target)).collect()
    }
}

impl From<RawProject> for ProjectFile {
    fn from(raw: RawProject) -> Self {
        let settings = Settings {
            method: match raw.method.0 {
                Method::Convex(_) => Method::Convex(raw.boundary.0),
                other => other,
            },
            family: raw.family.0,
            treatment: raw.treatment.map(|treatment| treatment.0),
            max_steps: raw.max_steps,
            growth: raw.growth.0,
            size: GaugeSize::default(),
            relax_rounds: raw.relax_rounds,
            new_vertices: raw.new_vertices,
        };
        Self {
            mesh: raw.mesh.0,
            faces_turned: raw.faces_turned,
            picture: raw.picture.map(|picture| picture.0),
            v_axis: match raw.v_axis {
                RawVAxis::Up => VAxis::Up,
                RawVAxis::Down => VAxis::Down,
            },
            settings,
            targets: raw.pins.0,
            view: raw.view,
            recovery: raw.recovery,
        }
    }
}

impl From<ProjectFile> for RawProject {
    fn from(project: ProjectFile) -> Self {
        let settings = project.settings;
        let boundary = match settings.method {
            Method::Convex(shape) => shape,
            _ => BoundaryShape::default(),
        };
        Self {
            freebound_project: PROJECT_VERSION,
            mesh: RawSource(project.mesh),
            faces_turned: project.faces_turned,
            picture: project.picture.map(RawSource),
            v_axis: match project.v_axis {
                VAxis::Up => RawVAxis::Up,
                VAxis::Down => RawVAxis::Down,
            },
            method: RawChoice(settings.method),
            boundary: RawChoice(boundary),
            family: RawFamily(settings.family),
            treatment: settings.treatment.map(RawChoice),
            growth: RawChoice(settings.growth),
            max_steps: settings.max_steps,
            relax_rounds: settings.relax_rounds,
            new_vertices: settings.new_vertices,
            pins: RawPins(project.targets),
            view: project.view,
            recovery: project.recovery,
        }
    }
}
