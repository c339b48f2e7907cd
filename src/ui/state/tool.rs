//! Tools of the left mouse button, and the halves of a pair that the constrain tool joins.

use glam::DVec2;

use freebound_core::mesh::VertexId;

/// Tools of the left mouse button.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Selects vertices.
    #[default]
    Select,
    /// Pins vertices where they lie.
    Fix,
    /// Joins vertices with their places on the picture.
    Constrain,
    /// Cuts the mesh along paths from vertex to vertex.
    Seam,
}

impl Tool {
    /// All tools, from top to bottom.
    pub const ALL: [Self; 4] = [Self::Select, Self::Fix, Self::Constrain, Self::Seam];

    /// Its name in files, its entry in menus, and what it does.
    pub(in crate::ui) const fn words(self) -> [&'static str; 3] {
        match self {
            Self::Select => ["select", "Select vertices", "Select vertices"],
            Self::Fix => ["fix", "Fix vertices", "Fix: pin a vertex where it lies"],
            Self::Constrain => ["constrain", "Constrain vertices", "Constrain: join a vertex with its place"],
            Self::Seam => ["seam", "Draw seams", "Seam: cut the mesh along paths from vertex to vertex"],
        }
    }
}

/// The half of a pair that was placed first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Half {
    /// The vertex; its place is to come.
    Vertex(VertexId),
    /// The place, in texture coordinates; the vertex is to come.
    Target(DVec2),
}

/// Effect of a click of the constrain tool.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Intent {
    /// Nothing.
    #[default]
    Nothing,
    /// Take a vertex as the first half of a pair.
    TakeVertex(VertexId),
    /// Take a place, in texture coordinates, as the first half.
    TakeTarget(DVec2),
    /// Complete the pair.
    Join(VertexId, DVec2),
    /// Select a pin that is there.
    Select(VertexId),
}
