//! What the session has to tell a person: what happened, where, and what to do.

use crate::mesh::VertexId;

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
    /// Vertices of the element concerned, to be shown; empty where it is about the whole.
    pub vertices: Vec<VertexId>,
}
