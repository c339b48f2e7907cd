//! Report of a run without a result: one JSON object that names the error.

use serde::Serialize;

use super::report::REPORT_SCHEMA;
use super::{ConstraintsError, EdgesError, ParseFault, ReadError, TextureError};
use freebound_core::mesh::{Diagnosis, Elements, Fault, VertexId};

/// Report of a run without a result. Field names are part of the interface.
#[derive(Debug, Serialize)]
pub struct ErrorReport {
    /// Version of the report format.
    pub schema: u32,
    /// Version of the program.
    pub freebound: &'static str,
    /// The input.
    pub mesh: MeshName,
    /// Error that prevented a result.
    pub error: ErrorWords,
}

/// Input mesh, by name.
#[derive(Debug, Serialize)]
pub struct MeshName {
    /// Path of the mesh.
    pub path: String,
}

/// Error that prevented a result.
#[derive(Debug, Serialize)]
pub struct ErrorWords {
    /// The exit status.
    pub exit_status: u8,
    /// Name of the kind of error.
    pub kind: &'static str,
    /// The message on standard error.
    pub message: String,
    /// Remedy for the whole error, unless each fault has its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remedy: Option<&'static str>,
    /// Single faults, if there are several kinds or they have elements.
    pub faults: Vec<FaultReport>,
}

/// Fault of the input.
#[derive(Debug, Serialize)]
pub struct FaultReport {
    /// Name of the fault.
    pub kind: &'static str,
    /// Message of the fault.
    pub message: String,
    /// Remedy for this fault, unless the whole error has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remedy: Option<&'static str>,
    /// Position of the fault: a list under the name of its elements.
    #[serde(flatten)]
    pub elements: Option<FaultElements>,
}

/// Position of a fault.
#[derive(Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaultElements {
    /// Vertices, numbered from 0.
    Vertices(Vec<VertexId>),
    /// Edges by their two vertices.
    Edges(Vec<[VertexId; 2]>),
    /// Faces of the file, numbered from 0.
    Faces(Vec<u32>),
    /// Boundary loops by their vertices.
    Loops(Vec<Vec<VertexId>>),
    /// A line of the file, counted from 1.
    Line(u64),
    /// A byte of the file, counted from 0.
    Byte(u64),
}

impl ErrorReport {
    /// Report on the mesh at `path`.
    pub fn new(path: String, error: ErrorWords) -> Self {
        Self { schema: REPORT_SCHEMA, freebound: env!("CARGO_PKG_VERSION"), mesh: MeshName { path }, error }
    }
}

impl FaultReport {
    /// Faults of a mesh.
    pub fn of_diagnosis(diagnosis: &Diagnosis) -> Vec<Self> {
        diagnosis.faults.iter().map(Self::of_mesh).collect()
    }

    fn of_mesh(fault: &Fault) -> Self {
        let elements = match fault.elements() {
            Elements::Nothing => None,
            Elements::Vertices(vertices) => Some(FaultElements::Vertices(vertices.to_vec())),
            Elements::Edges(edges) => Some(FaultElements::Edges(edges.to_vec())),
            Elements::Faces(faces) => Some(FaultElements::Faces(faces.polygons.clone())),
            Elements::Loops(loops) => Some(FaultElements::Loops(loops.to_vec())),
        };
        Self { kind: fault.name(), message: fault.message(), remedy: Some(fault.remedy()), elements }
    }

    /// Faults of a file that could not be parsed.
    pub fn of_file(error: &ReadError) -> Vec<Self> {
        match error {
            ReadError::Parse { faults, .. } => {
                faults.iter().map(|ParseFault { line, kind }| Self::of_line(*line, kind.to_string())).collect()
            }
            ReadError::Bytes { byte, kind } => {
                let elements = Some(FaultElements::Byte(*byte));
                vec![Self { kind: "byte", message: kind.to_string(), remedy: None, elements }]
            }
            _ => Vec::new(),
        }
    }

    /// Fault of a constraint file.
    pub fn of_constraints(error: &ConstraintsError) -> Vec<Self> {
        match error {
            ConstraintsError::Line { line, kind, .. } => vec![Self::of_line(*line, kind.to_string())],
            ConstraintsError::File { .. } => Vec::new(),
        }
    }

    /// Fault of an edges file.
    pub fn of_edges(error: &EdgesError) -> Vec<Self> {
        match error {
            EdgesError::Line { line, kind, .. } => vec![Self::of_line(*line, kind.to_string())],
            EdgesError::File { .. } | EdgesError::TooLong { .. } => Vec::new(),
        }
    }

    /// Faces without complete texture coordinates.
    pub fn of_texture(error: &TextureError) -> Vec<Self> {
        let TextureError::Missing(faces) = error else { return Vec::new() };
        let elements = Some(FaultElements::Faces(faces.clone()));
        vec![Self { kind: "missing-texture-coordinates", message: error.to_string(), remedy: None, elements }]
    }

    fn of_line(line: u64, message: String) -> Self {
        Self { kind: "line", message, remedy: None, elements: Some(FaultElements::Line(line)) }
    }
}
