//! The report of a run that came to nothing: one JSON object that names what is wrong.

use serde::Serialize;

use super::report::REPORT_SCHEMA;
use super::{ConstraintsError, EdgesError, ParseFault, ReadError, TextureError};
use freebound_core::mesh::{Diagnosis, Elements, Fault, VertexId};

/// Everything that is reported of a run without a result. Field names are part of the interface.
#[derive(Debug, Serialize)]
pub struct ErrorReport {
    /// Version of the report's form.
    pub schema: u32,
    /// Version of the program.
    pub freebound: &'static str,
    /// The input.
    pub mesh: MeshName,
    /// Why there is no result.
    pub error: ErrorWords,
}

/// The input, by its name.
#[derive(Debug, Serialize)]
pub struct MeshName {
    /// Where it came from.
    pub path: String,
}

/// Why there is no result.
#[derive(Debug, Serialize)]
pub struct ErrorWords {
    /// The exit status.
    pub exit_status: u8,
    /// What could not be used or done.
    pub kind: &'static str,
    /// The message on standard error.
    pub message: String,
    /// What to do about it, where it is not each fault's own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remedy: Option<&'static str>,
    /// The faults by themselves, where there are several kinds of them or they have elements.
    pub faults: Vec<FaultReport>,
}

/// One fault.
#[derive(Debug, Serialize)]
pub struct FaultReport {
    /// Its name.
    pub kind: &'static str,
    /// What is wrong.
    pub message: String,
    /// What to do about it, where the whole error has no remedy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remedy: Option<&'static str>,
    /// Where it is: a list by the name of its elements.
    #[serde(flatten)]
    pub elements: Option<FaultElements>,
}

/// Where a fault is.
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
    /// A report on the mesh at `path`.
    pub fn new(path: String, error: ErrorWords) -> Self {
        Self { schema: REPORT_SCHEMA, freebound: env!("CARGO_PKG_VERSION"), mesh: MeshName { path }, error }
    }
}

impl FaultReport {
    /// The faults of a mesh.
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

    /// The faults of a file that was not understood.
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

    /// The fault of a constraint file.
    pub fn of_constraints(error: &ConstraintsError) -> Vec<Self> {
        match error {
            ConstraintsError::Line { line, kind, .. } => vec![Self::of_line(*line, kind.to_string())],
            ConstraintsError::File { .. } => Vec::new(),
        }
    }

    /// The fault of a file of edges.
    pub fn of_edges(error: &EdgesError) -> Vec<Self> {
        match error {
            EdgesError::Line { line, kind, .. } => vec![Self::of_line(*line, kind.to_string())],
            EdgesError::File { .. } | EdgesError::TooLong { .. } => Vec::new(),
        }
    }

    /// The faces whose texture coordinates are not all there.
    pub fn of_texture(error: &TextureError) -> Vec<Self> {
        let TextureError::Missing(faces) = error else { return Vec::new() };
        let elements = Some(FaultElements::Faces(faces.clone()));
        vec![Self { kind: "missing-texture-coordinates", message: error.to_string(), remedy: None, elements }]
    }

    fn of_line(line: u64, message: String) -> Self {
        Self { kind: "line", message, remedy: None, elements: Some(FaultElements::Line(line)) }
    }
}
