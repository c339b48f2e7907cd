//! Clearance inside a pinned boundary: splits interior edges if a face between three boundary vertices would turn
//! over.
//!
//! A face with three pinned corners cannot be unfolded by any later step. For example, an ear whose tip lies in a
//! concave part of the target polygon, by however little, cannot be embedded. With a new vertex on each interior edge
//! between two boundary vertices, no face has three boundary corners. Then every simple target polygon can be met.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::geom::{Orientation, orientation};
use crate::mesh::{DiskMesh, EdgeId, FaceId, HalfedgeId, NewVertex, Refinement, VertexId};

/// Returns the mesh with a new vertex in the middle of each interior edge between two boundary vertices.
///
/// Edges are split only if the targets turn over a face between three boundary vertices, or leave it without area.
/// Otherwise `None`. `targets` holds one position per vertex of the boundary loop.
pub(crate) fn with_boundary_clearance(mesh: &DiskMesh, targets: &[DVec2]) -> Option<Refinement> {
    let target = |vertex: VertexId| mesh.boundary_place(vertex).map(|place| targets[place]);
    let is_turned = |face: FaceId| {
        let [a, b, c] = mesh.face(face).map(target);
        let (Some(a), Some(b), Some(c)) = (a, b, c) else { return false };
        orientation(a, b, c) != Some(Orientation::CounterClockwise)
    };
    if !mesh.faces().any(is_turned) {
        return None;
    }
    let joins_boundary = |edge: &EdgeId| {
        !mesh.is_boundary_edge(*edge) && mesh.ends(*edge).iter().all(|&v| mesh.boundary_place(v).is_some())
    };
    let mut number_of = BTreeMap::new();
    let mut new_vertices = Vec::new();
    for edge in mesh.edges().filter(joins_boundary) {
        let [a, b] = mesh.ends(edge);
        number_of.insert(edge, VertexId::from_index(mesh.vertex_count() + new_vertices.len()));
        new_vertices.push(NewVertex { edge: [a.min(b), a.max(b)], at: 0.5 });
    }
    let mut parts = BTreeMap::new();
    for face in mesh.faces() {
        let first = HalfedgeId::from_index(3 * face.index());
        let sides = [first, mesh.next(first), mesh.previous(first)];
        let on = sides.map(|side| number_of.get(&mesh.edge_of(side)).copied());
        if on.iter().any(Option::is_some) {
            parts.insert(face, cut(sides.map(|side| mesh.tail(side)), on));
        }
    }
    Refinement::new(mesh, new_vertices, &parts).ok()
}

/// Triangles of a face after splitting: `on` holds the new vertex of each side, `on[k]` on the side that starts at
/// corner k.
#[expect(clippy::many_single_char_names, reason = "corners, and what lies between them")]
fn cut([a, b, c]: [VertexId; 3], on: [Option<VertexId>; 3]) -> Vec<[VertexId; 3]> {
    match on {
        [None, None, None] => vec![[a, b, c]],
        [Some(p), None, None] => vec![[a, p, c], [p, b, c]],
        [Some(p), Some(q), None] => vec![[a, p, c], [p, b, q], [p, q, c]],
        [Some(p), Some(q), Some(r)] => vec![[a, p, r], [p, b, q], [r, q, c], [p, q, r]],
        // Rotates the corners until one of the cases above applies.
        [x, y, z] => cut([b, c, a], [y, z, x]),
    }
}
