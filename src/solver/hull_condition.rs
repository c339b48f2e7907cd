//! Where an embedding violates the hull conditions: vertices outside the convex hull of their neighbours.
//!
//! # Theorem
//!
//! A drawing of a 3-connected triangulated disk with straight edges, whose boundary has the turning number 1, is planar if
//! every interior vertex lies in the convex hull of its neighbours, and so does every *reflex* vertex of the boundary, where
//! the boundary turns right. (S. Gortler, C. Gotsman, D. Thurston, "Discrete one-forms on meshes and applications to 3D mesh
//! parameterization", 2006; so stated in the proof of the paper's Theorem 1.) Planar is meant locally: all faces are
//! positive. With a simple boundary it is so globally. For a surface with holes the turning number of each inner loop is to be −1.
//!
//! # Why
//!
//! Along a direction that no edge is at right angles to, the indices of the one-form dz add up to 2 over vertices, faces and
//! the outside ([`one_form`](super::one_form)). Faces have the index 0. A vertex strictly inside the hull has neighbours on
//! both sides: its index is at most 0. A convex vertex of the boundary has the index 1 at most, and only where it is an
//! extreme of the boundary. A boundary with the turning number 1 and r reflex extremes has 2 + r convex ones; the outside
//! then has the index 1 − (2 + 2r)/2 = −r. So the sum of 2 is reached only where every convex extreme has the index 1 and
//! every other vertex 0, for each of these directions: neighbours go once around each vertex, and nothing folds.
//!
//! Here *inside* is strict, and a vertex where the boundary goes straight on must have a neighbour on the surface's side: so no
//! face is without area, and the mesh need not be 3-connected.
//!
//! # The converse
//!
//! Around a vertex of a planar embedding positive faces leave no gap of half a turn, neither inside nor around a reflex
//! vertex. So a planar embedding has no vertex outside, and those that are listed say where an embedding folds though its
//! boundary turns once, or why an iteration cannot have reached its fixed point: a solution of the mean-value equations has
//! none either (the paper's Theorem 1).

use glam::DVec2;
use rayon::prelude::*;

use super::Embedding;
use crate::geom::{Orientation, is_down, is_inside_hull, orientation};
use crate::mesh::{DiskMesh, VertexId};

/// What is asked of a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CornerKind {
    /// It lies inside the surface: the condition holds for it.
    Interior,
    /// The boundary, or the loop around a hole, turns away from the surface: the condition holds for it.
    Reflex,
    /// The boundary, or the loop around a hole, goes straight on: it lies on the rim of the hull then, and a neighbour has to lie on the
    /// surface's side.
    Straight,
    /// The boundary turns toward the surface, or exactly back: nothing is asked of it.
    Convex,
}

/// How a vertex stands to the convex hull of its neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HullStanding {
    /// What is asked of it.
    pub corner: CornerKind,
    /// Whether it lies strictly inside; where the boundary goes straight on, whether a neighbour lies on the surface's side.
    pub is_inside: bool,
}

impl HullStanding {
    /// Whether it violates the condition.
    pub fn is_at_fault(self) -> bool {
        self.corner != CornerKind::Convex && !self.is_inside
    }
}

/// Vertices whose neighbours' positions share the work of one task.
const VERTICES_PER_TASK: usize = 1024;

/// The vertices that violate the hull condition, ascending. `upright` is the orientation that faces should have: clockwise for an
/// embedding that is judged in the mirror. Exact; vertices with a neighbour that is not finite count as outside.
pub fn vertices_outside_hull(mesh: &DiskMesh, embedding: &Embedding, upright: Orientation) -> Vec<VertexId> {
    let is_at_fault = |ring: &mut Ring, vertex: VertexId| {
        ring.surround(mesh, vertex).is_some_and(|()| ring.standing(embedding, vertex, upright).is_at_fault())
    };
    let at_fault: Vec<bool> = (0..mesh.vertex_count())
        .into_par_iter()
        .with_min_len(VERTICES_PER_TASK)
        .map_init(Ring::default, |ring, vertex| is_at_fault(ring, VertexId::from_index(vertex)))
        .collect();
    mesh.vertices().filter(|vertex| at_fault[vertex.index()]).collect()
}

/// How one vertex stands to the hull of its neighbours; none for a vertex of no real face.
pub fn hull_standing(
    mesh: &DiskMesh,
    embedding: &Embedding,
    vertex: VertexId,
    upright: Orientation,
) -> Option<HullStanding> {
    let mut ring = Ring::default();
    ring.surround(mesh, vertex)?;
    Some(ring.standing(embedding, vertex, upright))
}

/// The neighbours of a vertex along edges of the surface: what only fills holes is none of it.
#[derive(Debug, Default)]
struct Ring {
    /// Counter-clockwise; of a vertex on the rim from the next one along the rim to the one before.
    neighbours: Vec<VertexId>,
    places: Vec<DVec2>,
    rim: Rim,
    /// The heads of all halfedges that leave the vertex, and whether a face of the surface lies to the left.
    spokes: Vec<(VertexId, bool)>,
}

/// Whether the surface ends at a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Rim {
    #[default]
    None,
    /// It is a corner of one loop.
    Once,
    /// It is a corner of several holes, between which faces stand alone.
    Several,
}

impl Ring {
    /// Takes in the neighbours of a vertex; none where it has no real face.
    fn surround(&mut self, mesh: &DiskMesh, vertex: VertexId) -> Option<()> {
        // A halfedge has a face of the surface to its left, or none.
        let is_real = |h| mesh.face_of(h).is_some_and(|face| !mesh.is_virtual(face));
        self.spokes.clear();
        self.spokes.extend(mesh.outgoing(vertex).map(|h| (mesh.head(h), is_real(h))));
        let (spokes, count) = (&self.spokes, self.spokes.len());
        let begins = |&k: &usize| spokes[k].1 && !spokes[(k + count - 1) % count].1;
        let mut beginnings = (0..count).filter(begins);
        let first = beginnings.next();
        self.rim = match (first, beginnings.next()) {
            (None, _) => Rim::None,
            (Some(_), None) => Rim::Once,
            (Some(_), Some(_)) => Rim::Several,
        };
        if first.is_none() && !spokes.iter().any(|&(_, is_real)| is_real) {
            return None;
        }
        let first = first.unwrap_or(0);
        self.neighbours.clear();
        for k in first..first + count {
            let touches = spokes[k % count].1 || spokes[(k + count - 1) % count].1;
            self.neighbours.extend(touches.then_some(spokes[k % count].0));
        }
        Some(())
    }

    fn standing(&mut self, embedding: &Embedding, vertex: VertexId, upright: Orientation) -> HullStanding {
        self.places.clear();
        self.places.extend(self.neighbours.iter().map(|v| embedding[v]));
        let place = embedding[vertex];
        let corner = self.corner(place, upright);
        let is_on_side =
            |other: &DVec2| orientation(self.places[self.places.len() - 1], place, *other) == Some(upright);
        let is_inside = match corner {
            CornerKind::Straight => self.places.iter().any(is_on_side),
            _ => is_inside_hull(place, &self.places),
        };
        HullStanding { corner, is_inside }
    }

    fn corner(&self, place: DVec2, upright: Orientation) -> CornerKind {
        let (Some(&next), Some(&before)) = (self.places.first(), self.places.last()) else { return CornerKind::Convex };
        match self.rim {
            Rim::None => CornerKind::Interior,
            Rim::Several => CornerKind::Convex,
            Rim::Once => match orientation(before, place, next) {
                Some(Orientation::Collinear) => {
                    let goes_on = is_down(before, place).zip(is_down(place, next)).is_some_and(|(a, b)| a == b);
                    if goes_on { CornerKind::Straight } else { CornerKind::Convex }
                }
                turn if turn == Some(upright) => CornerKind::Convex,
                // Also where it cannot be told, for a coordinate is not finite.
                _ => CornerKind::Reflex,
            },
        }
    }
}
