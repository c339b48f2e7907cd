//! A whole boundary held where faces between three of its vertices would turn over: edges between its vertices are split.
//!
//! Where all corners of a face are held, nothing that follows can unfold it: an ear whose tip lies in a concave part of the
//! targets' polygon, by however little, cannot be embedded. With a new vertex on each of its edges that lead from one
//! boundary vertex to another through the surface, no face has three corners there, and a polygon that is simple can be met.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::geom::{Orientation, orientation};
use crate::mesh::{DiskMesh, EdgeId, FaceId, HalfedgeId, NewVertex, Refinement, VertexId};

/// The mesh with a new vertex in the middle of each edge that joins two boundary vertices through the surface, where their
/// targets turn over a face between three of them, or leave it without area; `None` where they turn over none.
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

/// A triangle in parts, with new vertices on some of its sides, which begin at its corners in turn.
#[expect(clippy::many_single_char_names, reason = "corners, and what lies between them")]
fn cut([a, b, c]: [VertexId; 3], on: [Option<VertexId>; 3]) -> Vec<[VertexId; 3]> {
    match on {
        [None, None, None] => vec![[a, b, c]],
        [Some(p), None, None] => vec![[a, p, c], [p, b, c]],
        [Some(p), Some(q), None] => vec![[a, p, c], [p, b, q], [p, q, c]],
        [Some(p), Some(q), Some(r)] => vec![[a, p, r], [p, b, q], [r, q, c], [p, q, r]],
        // The same, turned.
        [x, y, z] => cut([b, c, a], [y, z, x]),
    }
}
