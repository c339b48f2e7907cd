//! Requests to the seam tool: clicks, and rules that choose edges.

use freebound_core::mesh::VertexId;

/// An edge by its ends, vertices of the file.
pub(in crate::ui) type Edge = [VertexId; 2];

/// A click on a vertex of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SeamClick {
    /// The vertex.
    pub vertex: VertexId,
    /// True if seams go.
    pub erases: bool,
}

/// Which edges become seams.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeamRule {
    /// Edges whose faces meet at this angle or more between their normals, degrees.
    Sharp(f64),
    /// Edges between faces of two materials.
    Materials,
    /// Edges between faces of two groups or objects.
    Groups,
}
