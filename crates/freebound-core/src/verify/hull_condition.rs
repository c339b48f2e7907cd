//! Hull condition of an embedding: vertices must not lie outside the convex hull of their neighbours.
//!
//! # Theorem
//!
//! A drawing of a 3-connected triangulated disk with straight edges, whose boundary has the turning number 1, is
//! planar under two conditions. Every interior vertex lies in the convex hull of its neighbours. So does every
//! *reflex* vertex of the boundary, at which the boundary turns right. (S. Gortler, C. Gotsman, D. Thurston,
//! "Discrete one-forms on meshes and applications to 3D mesh parameterization", 2006; stated in this form in the
//! proof of the paper's Theorem 1.) Planar is meant locally: all faces are positive. With a simple boundary the
//! drawing is also planar globally.
//!
//! For a surface with holes, each inner loop must have the turning number −1, with the surface to its left
//! ([`holes_turn_once`]). The outer loop alone is not enough.
//!
//! # Proof
//!
//! Take a direction that is perpendicular to no edge. The indices of the one-form dz along it sum to 2 over vertices,
//! faces and the outside ([`one_form`](super::one_form)). Faces have the index 0. A vertex strictly inside the hull
//! has neighbours on both sides: its index is at most 0. A convex vertex of the boundary has at most the index 1, and
//! only if it is an extreme of the boundary. A boundary with the turning number 1 and r reflex extremes has 2 + r
//! convex extremes; the outside then has the index 1 − (2 + 2r)/2 = −r. So the sum of 2 is reached only if every
//! convex extreme has the index 1 and every other vertex 0, for each such direction. Then neighbours go once around
//! each vertex, and nothing folds.
//!
//! An inner loop with the turning number −1 and c convex extremes has c + 2 reflex extremes, and the index 1 − (2c +
//! 2)/2 = −c: again the convex extremes cannot make up for more. A vertex in which several loops meet is a corner of
//! each loop. All its edges lie to one side only if the vertex is an extreme of each loop. So one convex corner is
//! enough to exempt the vertex from the condition.
//!
//! Here *inside* is strict, and a vertex on a straight part of the boundary must have a neighbour on the surface's
//! side. So no face has area zero, and the mesh need not be 3-connected.
//!
//! # Converse
//!
//! Around a vertex of a planar embedding, positive faces leave no gap of half a turn, neither at an interior nor at a
//! reflex vertex. So a planar embedding has no vertex outside the hull of its neighbours. The listed vertices show
//! the places at which an embedding folds although its boundary turns once. They also prove that an iteration has not
//! reached its fixed point: a solution of the mean-value equations has no such vertex either (the paper's Theorem 1).

use glam::DVec2;

use crate::geom::{Orientation, is_down, is_inside_hull, orientation, turning_number};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, Embedding, SolveError};

/// Condition that applies to a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CornerKind {
    /// Vertex inside the surface: the hull condition applies.
    Interior,
    /// The boundary, or the loop around a hole, turns away from the surface: the hull condition applies.
    Reflex,
    /// The boundary, or the loop around a hole, goes straight on. The vertex is on the rim of the hull, and a
    /// neighbour must lie on the surface's side.
    Straight,
    /// The boundary turns toward the surface, or exactly back: no condition applies. Several loops may meet in the
    /// vertex; one such corner is enough.
    Convex,
}

/// Position of a vertex relative to the convex hull of its neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HullStanding {
    /// Condition that applies to the vertex.
    pub corner: CornerKind,
    /// True if the vertex lies strictly inside the hull. On a straight part of the boundary: true if a neighbour lies
    /// on the surface's side.
    pub is_inside: bool,
}

impl HullStanding {
    /// True if the vertex violates its condition.
    pub fn is_at_fault(self) -> bool {
        self.corner != CornerKind::Convex && !self.is_inside
    }
}

/// True if the loop around each hole turns once, which the theorem requires besides the outer loop. The turning
/// number must be +1 in the direction in which the hole's filling runs around, which is −1 with the surface to the
/// left. If `upright` is clockwise, the signs are opposite. Exact.
pub fn holes_turn_once(mesh: &DiskMesh, embedding: &Embedding, upright: Orientation) -> bool {
    let once = if upright == Orientation::Clockwise { -1 } else { 1 };
    mesh.mesh().holes().iter().all(|hole| {
        let places: Vec<DVec2> = hole.rim.iter().map(|&v| embedding[v]).collect();
        turning_number(&places) == Some(once)
    })
}

/// Vertices that violate the hull condition, ascending: inside the surface, and on boundaries that turn away from the
/// surface or go straight on. `upright` is the orientation that faces should have: clockwise for an embedding that is
/// judged as a mirror image. Exact; vertices with a neighbour that is not finite count as outside.
pub fn vertices_outside_hull(mesh: &DiskMesh, embedding: &Embedding, upright: Orientation) -> Vec<VertexId> {
    // Never cancelled.
    vertices_outside_hull_unless(mesh, embedding, upright, Control::unattended()).unwrap_or_default()
}

/// [`vertices_outside_hull`] with cancellation.
pub(crate) fn vertices_outside_hull_unless(
    mesh: &DiskMesh,
    embedding: &Embedding,
    upright: Orientation,
    control: Control<'_>,
) -> Result<Vec<VertexId>, SolveError> {
    let is_at_fault = |ring: &mut Ring, vertex: usize| {
        let vertex = VertexId::from_index(vertex);
        ring.surround(mesh, vertex).is_some_and(|()| ring.standing(embedding, vertex, upright).is_at_fault())
    };
    let at_fault: Vec<bool> = control.each_with(mesh.vertex_count(), Ring::default, is_at_fault)?;
    Ok(mesh.vertices().filter(|vertex| at_fault[vertex.index()]).collect())
}

/// Position of one vertex relative to the hull of its neighbours. `None` for a vertex of no real face.
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

/// Neighbours of a vertex along edges of the surface, counter-clockwise. Edges within the filling of a hole do not
/// count. Empty for a vertex of no real face.
pub(crate) fn neighbours_on_surface(mesh: &DiskMesh, vertex: VertexId) -> Vec<VertexId> {
    let mut ring = Ring::default();
    ring.surround(mesh, vertex).map_or_else(Vec::new, |()| ring.neighbours)
}

/// Neighbours of a vertex along edges of the surface, without the filling of holes.
#[derive(Debug, Default)]
struct Ring {
    /// Counter-clockwise. For a vertex on a rim, the first neighbour is the next vertex along the rim.
    neighbours: Vec<VertexId>,
    places: Vec<DVec2>,
    /// Vertices before and after the vertex along each loop through it, with the surface to the left.
    corners: Vec<[VertexId; 2]>,
    /// Heads of all halfedges that leave the vertex, each with true if a face of the surface lies to the left.
    spokes: Vec<(VertexId, bool)>,
}

impl Ring {
    /// Collects the neighbours of a vertex. `None` if it has no real face.
    fn surround(&mut self, mesh: &DiskMesh, vertex: VertexId) -> Option<()> {
        // True if a face of the surface lies to the left of a halfedge.
        let is_real = |h| mesh.face_of(h).is_some_and(|face| !mesh.is_virtual(face));
        self.spokes.clear();
        self.spokes.extend(mesh.outgoing(vertex).map(|h| (mesh.head(h), is_real(h))));
        let (spokes, count) = (&self.spokes, self.spokes.len());
        // True for each side, before and behind a spoke, with a face of the surface.
        let sides = |k: usize| [spokes[(k + count - 1) % count].1, spokes[k].1];
        let first = (0..count).find(|&k| sides(k) == [false, true]);
        if first.is_none() && !spokes.iter().any(|&(_, is_real)| is_real) {
            return None;
        }
        self.neighbours.clear();
        self.corners.clear();
        let mut before = None;
        let begin = first.unwrap_or(0);
        for k in (begin..begin + count).map(|k| k % count) {
            let neighbour = spokes[k].0;
            match sides(k) {
                [false, false] => continue,
                [false, true] => self.corners.extend(before.take().map(|before| [before, neighbour])),
                [true, false] => before = Some(neighbour),
                [true, true] => {}
            }
            self.neighbours.push(neighbour);
        }
        self.corners.extend(before.zip(first).map(|(before, first)| [before, spokes[first].0]));
        Some(())
    }

    fn standing(&mut self, embedding: &Embedding, vertex: VertexId, upright: Orientation) -> HullStanding {
        self.places.clear();
        self.places.extend(self.neighbours.iter().map(|v| embedding[v]));
        let place = embedding[vertex];
        let is_of_kind = |kind: &CornerKind| {
            self.corners.iter().any(|corner| kind_of(corner.map(|v| embedding[v]), place, upright) == *kind)
        };
        // If several loops meet, the weakest condition applies.
        let kinds = [CornerKind::Convex, CornerKind::Straight, CornerKind::Reflex];
        let corner = kinds.into_iter().find(is_of_kind).unwrap_or(CornerKind::Interior);
        let is_on_side = |[before, _]: &[VertexId; 2]| {
            self.places.iter().any(|&other| orientation(embedding[*before], place, other) == Some(upright))
        };
        let is_inside = match corner {
            CornerKind::Straight => self.corners.iter().all(is_on_side),
            _ => is_inside_hull(place, &self.places),
        };
        HullStanding { corner, is_inside }
    }
}

/// Condition of a vertex between the vertices before and after it along a loop.
fn kind_of([before, next]: [DVec2; 2], place: DVec2, upright: Orientation) -> CornerKind {
    match orientation(before, place, next) {
        Some(Orientation::Collinear) => {
            let is_continued = is_down(before, place).zip(is_down(place, next)).is_some_and(|(a, b)| a == b);
            if is_continued { CornerKind::Straight } else { CornerKind::Convex }
        }
        turn if turn == Some(upright) => CornerKind::Convex,
        // Also if the turn is undecided, because a coordinate is not finite.
        _ => CornerKind::Reflex,
    }
}
