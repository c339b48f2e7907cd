//! Where an embedding violates the hull conditions: vertices outside the convex hull of their neighbours.
//!
//! # Theorem
//!
//! A drawing of a 3-connected triangulated disk with straight edges, whose boundary has the turning number 1, is planar if
//! every interior vertex lies in the convex hull of its neighbours, and so does every *reflex* vertex of the boundary, where
//! the boundary turns right. (S. Gortler, C. Gotsman, D. Thurston, "Discrete one-forms on meshes and applications to 3D mesh
//! parameterization", 2006; so stated in the proof of the paper's Theorem 1.) Planar is meant locally: all faces are
//! positive. With a simple boundary it is so globally. For a surface with holes the turning number of each inner loop is to be
//! −1, with the surface to its left ([`holes_turn_once`]): that of the outer loop alone says too little.
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
//! An inner loop with the turning number −1 and c convex extremes has c + 2 reflex ones, and the index 1 − (2c + 2)/2 = −c:
//! again the convex extremes cannot make up for more. Where several loops meet in a vertex it is a corner of each; all its
//! edges lie to one side only where it is an extreme of each of them. So one convex corner is enough for it to be free.
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

use crate::geom::{Orientation, is_down, is_inside_hull, orientation, turning_number};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, Embedding, SolveError};

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
    /// The boundary turns toward the surface, or exactly back: nothing is asked of it. So it is where several loops meet and
    /// one of them does.
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

/// Whether the loop around each hole turns once, as the theorem asks besides the outer loop: +1 in the direction in which its
/// filling runs around, and that is −1 with the surface to the left. The other way round where `upright` is clockwise. Exact.
pub fn holes_turn_once(mesh: &DiskMesh, embedding: &Embedding, upright: Orientation) -> bool {
    let once = if upright == Orientation::Clockwise { -1 } else { 1 };
    mesh.mesh().holes().iter().all(|hole| {
        let places: Vec<DVec2> = hole.rim.iter().map(|&v| embedding[v]).collect();
        turning_number(&places) == Some(once)
    })
}

/// The vertices that violate the hull condition, ascending: inside the surface, and where its boundary turns away from it or
/// goes straight on. `upright` is the orientation that faces should have: clockwise for an
/// embedding that is judged in the mirror. Exact; vertices with a neighbour that is not finite count as outside.
pub fn vertices_outside_hull(mesh: &DiskMesh, embedding: &Embedding, upright: Orientation) -> Vec<VertexId> {
    // Nobody stops it.
    vertices_outside_hull_unless(mesh, embedding, upright, Control::unattended()).unwrap_or_default()
}

/// The same, unless the caller asks to stop.
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

/// The neighbours of a vertex along edges of the surface, counter-clockwise: edges within what fills a hole lead to none. Empty
/// for a vertex of no real face.
pub(crate) fn neighbours_on_surface(mesh: &DiskMesh, vertex: VertexId) -> Vec<VertexId> {
    let mut ring = Ring::default();
    ring.surround(mesh, vertex).map_or_else(Vec::new, |()| ring.neighbours)
}

/// The neighbours of a vertex along edges of the surface: what only fills holes is none of it.
#[derive(Debug, Default)]
struct Ring {
    /// Counter-clockwise; of a vertex on the rim they begin with one that is next along it.
    neighbours: Vec<VertexId>,
    places: Vec<DVec2>,
    /// Of each loop that the vertex is a corner of, the vertices before and after it, the surface being to the left.
    corners: Vec<[VertexId; 2]>,
    /// The heads of all halfedges that leave the vertex, and whether a face of the surface lies to the left.
    spokes: Vec<(VertexId, bool)>,
}

impl Ring {
    /// Takes in the neighbours of a vertex; none where it has no real face.
    fn surround(&mut self, mesh: &DiskMesh, vertex: VertexId) -> Option<()> {
        // A halfedge has a face of the surface to its left, or none.
        let is_real = |h| mesh.face_of(h).is_some_and(|face| !mesh.is_virtual(face));
        self.spokes.clear();
        self.spokes.extend(mesh.outgoing(vertex).map(|h| (mesh.head(h), is_real(h))));
        let (spokes, count) = (&self.spokes, self.spokes.len());
        // Whether faces of the surface lie before and behind a spoke.
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
        // Of several loops the one that asks least counts.
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

/// What is asked of a vertex between those before and after it along a loop.
fn kind_of([before, next]: [DVec2; 2], place: DVec2, upright: Orientation) -> CornerKind {
    match orientation(before, place, next) {
        Some(Orientation::Collinear) => {
            let is_continued = is_down(before, place).zip(is_down(place, next)).is_some_and(|(a, b)| a == b);
            if is_continued { CornerKind::Straight } else { CornerKind::Convex }
        }
        turn if turn == Some(upright) => CornerKind::Convex,
        // Also where it cannot be told, for a coordinate is not finite.
        _ => CornerKind::Reflex,
    }
}
