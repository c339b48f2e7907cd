//! What the session has to tell a person: what happened, where, and what to do.

use crate::mesh::{EdgeId, FaceId, VertexId};

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Good news, such as a file that was written.
    Note,
    /// Something did not work.
    Error,
}

/// The pane that a message belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The mesh in space.
    Mesh,
    /// Its embedding.
    Embedding,
}

/// A part of the mesh that a message or a defect is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// A vertex.
    Vertex(VertexId),
    /// An edge.
    Edge(EdgeId),
    /// A face.
    Face(FaceId),
}

/// One thing said.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// Tells this message from all others of the session.
    pub id: u64,
    /// How bad it is.
    pub severity: Severity,
    /// Where it belongs.
    pub place: Place,
    /// What happened.
    pub text: String,
    /// What to do about it.
    pub remedy: Option<String>,
    /// The element concerned.
    pub element: Option<Element>,
}
