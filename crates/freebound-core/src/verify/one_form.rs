//! Indices of discrete one-forms, which count sign changes of values on edges around vertices and faces.
//!
//! # Definition
//!
//! A *one-form* assigns a number to every halfedge, and the opposite number to its twin. Here none of the numbers is
//! zero. Then
//!
//! ```text
//! index = 1 − sc/2
//! ```
//!
//! with `sc` the number of sign changes on the halfedges that leave a vertex, in turn, or on the halfedges around a
//! face or around the outside. A vertex has the index 1 if all its numbers have one sign (a source or a sink, an
//! extreme). The index is 0 if the numbers change sign twice (regular), and less at saddles.
//!
//! # Theorem
//!
//! The indices of all vertices, faces and the outside sum to 2, the Euler characteristic of the sphere that a disk
//! and its outside make (Poincaré–Hopf). Proof: two consecutive halfedges of a face share a corner. At this corner
//! either the signs of the face change or the signs of the vertex, never both. So the number of all changes is the
//! number of corners, 2e, and v + f − e = 2.
//!
//! An embedding defines a one-form for every direction d: the numbers `d·(z_head − z_tail)`. Around a triangle they
//! sum to 0, so that its index is 0. Around a vertex strictly inside the hull of its neighbours they have both signs:
//! its index is at most 0.
//!
//! Source: S. Gortler, C. Gotsman, D. Thurston, "Discrete one-forms on meshes and applications to 3D mesh
//! parameterization", 2006.

use std::cmp::Ordering;

use glam::DVec2;

use super::hull_condition::neighbours_on_surface;
use crate::geom::{Orientation, is_down, order_along, orientation};
use crate::mesh::{DiskMesh, HalfedgeId, VertexId};
use crate::problem::Embedding;

/// Indices of a one-form on a disk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OneFormIndices {
    /// Index of every vertex; 0 for unreferenced vertices.
    pub vertices: Vec<i64>,
    /// Index of every face.
    pub faces: Vec<i64>,
    /// Index of the outside.
    pub outside: i64,
}

impl OneFormIndices {
    /// Indices of a one-form without zeros. `is_positive` is its sign on each halfedge.
    pub fn new(mesh: &DiskMesh, is_positive: impl Fn(HalfedgeId) -> bool) -> Self {
        let signs_at = |vertex| mesh.outgoing(vertex).map(&is_positive).collect::<Vec<bool>>();
        let vertices = mesh.vertices().map(|vertex| if mesh.is_used(vertex) { index_of(&signs_at(vertex)) } else { 0 });
        let side = |face: usize, k: usize| is_positive(HalfedgeId::from_index(3 * face + k));
        let faces = (0..mesh.face_count()).map(|face| index_of(&[side(face, 0), side(face, 1), side(face, 2)]));
        let outer = mesh.halfedges().skip(3 * mesh.face_count()).map(&is_positive);
        Self { vertices: vertices.collect(), faces: faces.collect(), outside: index_of(&outer.collect::<Vec<bool>>()) }
    }

    /// Indices of the one-form of an embedding along a direction, which may have any length. Exact. `None` if an edge
    /// is perpendicular to the direction, has length zero, or is not finite.
    pub fn along(mesh: &DiskMesh, embedding: &Embedding, direction: DVec2) -> Option<Self> {
        let sign = |h| match order_along(direction, embedding[mesh.tail(h)], embedding[mesh.head(h)])? {
            Ordering::Less => Some(false),
            Ordering::Equal => None,
            Ordering::Greater => Some(true),
        };
        let signs: Vec<bool> = mesh.halfedges().map(sign).collect::<Option<_>>()?;
        Some(Self::new(mesh, |h| signs[h.index()]))
    }

    /// Sum of all indices: 2 for every one-form.
    pub fn sum(&self) -> i64 {
        self.vertices.iter().sum::<i64>() + self.faces.iter().sum::<i64>() + self.outside
    }
}

/// Index of signs in cyclic order: 1 less half of the sign changes.
fn index_of(signs: &[bool]) -> i64 {
    let changes = signs.iter().zip(signs.iter().cycle().skip(1)).filter(|(a, b)| a != b).count();
    1 - i64::try_from(changes / 2).expect("a vertex has fewer than 2⁶³ edges")
}

/// Least and greatest index of a vertex over all directions that are perpendicular to none of its edges. Edges within
/// the filling of a hole do not count, because the filling may fold. Exact. `None` for a vertex of no real face, or
/// if a neighbour coincides with it or is not finite.
///
/// When a turning direction becomes perpendicular to an edge, the sign of the edge changes. So the edges are sorted
/// by their lines, and half a turn is swept line by line: O(d log d) for d neighbours.
pub fn index_range(mesh: &DiskMesh, embedding: &Embedding, vertex: VertexId) -> Option<[i64; 2]> {
    let place = embedding.get(vertex.index()).copied()?;
    let mut spokes: Vec<Spoke> = Vec::new();
    for neighbour in neighbours_on_surface(mesh, vertex) {
        let end = embedding[neighbour];
        spokes.push(Spoke { end, is_down: is_down(place, end)? });
    }
    // Just before the angle 0, an edge that points up lies to the left.
    let mut signs: Vec<bool> = spokes.iter().map(|spoke| !spoke.is_down).collect();
    let mut by_line: Vec<usize> = (0..spokes.len()).collect();
    by_line.sort_by(|&a, &b| spokes[a].line_order(&spokes[b], place));
    let mut index = (!spokes.is_empty()).then(|| index_of(&signs))?;
    let mut range = [index; 2];
    for line in by_line.chunk_by(|&a, &b| spokes[a].line_order(&spokes[b], place) == Ordering::Equal) {
        let mut doubled_change = 0;
        for &k in line {
            let beside = [(k + 1) % signs.len(), (k + signs.len() - 1) % signs.len()];
            // Different signs become equal, and equal signs different.
            doubled_change += beside.iter().map(|&other| if signs[other] == signs[k] { -1 } else { 1 }).sum::<i64>();
            signs[k] = !signs[k];
        }
        index += doubled_change / 2;
        range = [range[0].min(index), range[1].max(index)];
    }
    Some(range)
}

/// Neighbour as seen from a vertex.
struct Spoke {
    end: DVec2,
    /// True if its direction lies in the lower half-turn.
    is_down: bool,
}

impl Spoke {
    /// Order of the lines along two spokes of a vertex, counter-clockwise from the angle 0.
    fn line_order(&self, other: &Self, vertex: DVec2) -> Ordering {
        let order = match orientation(vertex, self.end, other.end) {
            Some(Orientation::CounterClockwise) => Ordering::Less,
            Some(Orientation::Clockwise) => Ordering::Greater,
            Some(Orientation::Collinear) | None => Ordering::Equal,
        };
        if self.is_down == other.is_down { order } else { order.reverse() }
    }
}
