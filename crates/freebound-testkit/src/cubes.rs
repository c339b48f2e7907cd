//! A cube of six squares and its cuts.

use freebound_core::mesh::{PolygonMesh, VertexId};
use glam::DVec3;

/// Edges to cut so that the cube unfolds to a cross: four upright ones, and three of its lid.
pub fn cross() -> [[VertexId; 2]; 7] {
    [edge(0, 4), edge(1, 5), edge(6, 2), edge(3, 7), edge(5, 7), edge(7, 6), edge(6, 4)]
}

/// A cube of six squares; the bits of a vertex's number are its coordinates.
pub fn cube() -> PolygonMesh {
    let at = |v: u32| DVec3::new(f64::from(v & 1), f64::from(v >> 1 & 1), f64::from(v >> 2 & 1));
    let faces: [&[u32]; 6] = [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
    polygons((0..8).map(at).collect(), &faces)
}

/// An edge between two numbered vertices.
pub fn edge(a: u32, b: u32) -> [VertexId; 2] {
    [a, b].map(VertexId::new)
}

/// Polygons at these positions.
pub fn polygons(positions: Vec<DVec3>, faces: &[&[u32]]) -> PolygonMesh {
    let corners = faces.iter().flat_map(|face| face.iter().map(|&v| VertexId::new(v))).collect();
    let ends = faces.iter().scan(0, |end, face| {
        *end += u32::try_from(face.len()).expect("few");
        Some(*end)
    });
    PolygonMesh { positions, corners, starts: Some(std::iter::once(0).chain(ends).collect()) }
}
