//! Elements of the mesh by name.

use freebound_core::mesh::{EdgeId, FaceId, VertexId};

/// Element of the mesh, named by a defect or by the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) enum Element {
    Vertex(VertexId),
    Edge(EdgeId),
    Face(FaceId),
}

impl Element {
    /// Parses user input: `12` or `v12` is a vertex, `e3` an edge, `f7` a face. Vertices and faces have the numbers of
    /// files, edges those of the mesh on the screen.
    pub(in crate::ui) fn parse(text: &str) -> Option<Self> {
        let text = text.trim().to_ascii_lowercase();
        let number = text.strip_prefix(['v', 'e', 'f']).unwrap_or(&text).trim().parse().ok()?;
        Some(match text.as_bytes()[0] {
            b'e' => Self::Edge(EdgeId::new(number)),
            b'f' => Self::Face(FaceId::new(number)),
            _ => Self::Vertex(VertexId::new(number)),
        })
    }
}
