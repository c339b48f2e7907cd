//! Edges that seams usually follow: creases, and borders between faces of two kinds.
//!
//! The search uses the repaired mesh before it is cut, so that faces become neighbours if a repair joins their
//! vertices. Edges are named by vertices of the file.

use glam::DVec3;

use super::sides::Sides;
use super::{Repaired, Repairs};
use crate::mesh::{PolygonMesh, VertexId};

/// Tolerance on the smallest crease angle, in radians, so that a box has creases of 90 degrees.
const SLACK: f64 = 1e-9;

/// Returns the edges whose faces meet at `degrees` or more, as the angle between their normals: 0 in a plane.
///
/// A face without area has no angle to its neighbours.
pub fn creases(source: &PolygonMesh, repairs: Repairs, degrees: f64) -> Vec<[VertexId; 2]> {
    let repaired = Repaired::new(source, repairs);
    let least = degrees.to_radians() - SLACK;
    let normals: Vec<DVec3> = if repaired.has_faces() {
        (0..repaired.face_of.len()).map(|face| repaired.polygons.face_normal(face)).collect()
    } else {
        Vec::new()
    };
    edges_between(source, &repaired, |sides, [a, b]| {
        let [n, m] = [a, b].map(|side| normals[sides.face[side as usize] as usize]);
        // Inconsistently oriented neighbours: one of them shows its other side.
        let m = if sides.ends(a)[0] == sides.ends(b)[0] { -m } else { m };
        n != DVec3::ZERO && m != DVec3::ZERO && n.cross(m).length().atan2(n.dot(m)) >= least
    })
}

/// Returns the edges at which faces with different labels meet. `labels` has one label per face of the file.
pub fn borders(source: &PolygonMesh, repairs: Repairs, labels: &[u32]) -> Vec<[VertexId; 2]> {
    let repaired = Repaired::new(source, repairs);
    edges_between(source, &repaired, |sides, pair| {
        let [a, b] = pair.map(|side| labels[repaired.face_of[sides.face[side as usize] as usize] as usize]);
        a != b
    })
}

/// Returns the edges at which repairs have joined different vertices: the seams of a mesh that a program has split there.
pub fn splits(source: &PolygonMesh, repairs: Repairs) -> Vec<[VertexId; 2]> {
    let repaired = Repaired::new(source, repairs);
    edges_between(source, &repaired, |sides, pair| {
        let [a, b] = pair.map(|side| sides.edge_in_file(&repaired, source, side));
        a != b
    })
}

/// Edges with two or more sides that satisfy `is_sought`, by the file's vertices, the smaller first; ascending.
fn edges_between(
    source: &PolygonMesh,
    repaired: &Repaired,
    is_sought: impl Fn(&Sides<'_>, [u32; 2]) -> bool,
) -> Vec<[VertexId; 2]> {
    if !repaired.has_faces() {
        return Vec::new();
    }
    let sides = Sides::new(&repaired.polygons);
    let sought = sides.table.edges().filter(|on| on.windows(2).any(|pair| is_sought(&sides, [pair[0], pair[1]])));
    let mut edges: Vec<[VertexId; 2]> = sought.map(|on| sides.edge_in_file(repaired, source, on[0])).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}
