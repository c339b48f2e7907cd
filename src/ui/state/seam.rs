//! Requests to the seam tool: clicks, and rules that choose edges.

use freebound_core::mesh::VertexId;

/// Edge by its two end vertices, vertices of the file.
pub(in crate::ui) type Edge = [VertexId; 2];

/// Click on a vertex of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SeamClick {
    /// Clicked vertex.
    pub vertex: VertexId,
    /// True if the click closes seams.
    pub erases: bool,
}

/// Rule that chooses edges for seams.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeamRule {
    /// Edges with at least this angle between the normals of their faces, degrees.
    Sharp(f64),
    /// Edges between faces of two materials.
    Materials,
    /// Edges between faces of two groups or objects.
    Groups,
}
