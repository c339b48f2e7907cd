//! Tools of the left mouse button, and the halves of a pair that the constrain tool joins.

use glam::DVec2;

use freebound_core::mesh::VertexId;

/// Tools of the left mouse button.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Select vertices.
    #[default]
    Select,
    /// Pin vertices at their current positions.
    Fix,
    /// Join vertices with targets on the picture.
    Constrain,
    /// Cut the mesh along paths from vertex to vertex.
    Seam,
    /// Shape a planar map with brushes.
    Brush,
}

impl Tool {
    /// All tools, from top to bottom.
    pub const ALL: [Self; 5] = [Self::Select, Self::Fix, Self::Constrain, Self::Seam, Self::Brush];

    /// Name in files, name of its button, menu entry, and description.
    pub(in crate::ui) const fn words(self) -> [&'static str; 4] {
        match self {
            Self::Select => ["select", "Select", "Select vertices", "Select vertices"],
            Self::Fix => ["fix", "Fix", "Fix vertices", "Fix: pin a vertex at its current position"],
            Self::Constrain => {
                ["constrain", "Constrain", "Constrain vertices", "Constrain: choose the position of a vertex"]
            }
            Self::Seam => ["seam", "Seam", "Draw seams", "Seam: cut the mesh along paths from vertex to vertex"],
            Self::Brush => ["brush", "Brush", "Brush the map", "Brush: relax, grab, pinch, smooth, or more texels"],
        }
    }
}

/// First placed half of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Half {
    /// Vertex, which waits for its target.
    Vertex(VertexId),
    /// Target, in texture coordinates, which waits for its vertex.
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
    /// Take a target, in texture coordinates, as the first half of a pair.
    TakeTarget(DVec2),
    /// Complete the pair.
    Join(VertexId, DVec2),
    /// Select an existing pin.
    Select(VertexId),
}
