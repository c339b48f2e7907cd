//! Blocker of a dragged pin.

use glam::DVec2;

use super::DragSolver;
use crate::mesh::{DiskMesh, VertexId};

/// Object in the way of a dragged pin: the one next to the triangle that would be crushed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blocker {
    /// Another pin.
    Pin(VertexId),
    /// The boundary of the embedding, from outside, at this vertex.
    Boundary(VertexId),
    /// The part of the embedding that does not move while the pin is held.
    Surroundings,
}

impl DragSolver {
    /// Object next to a triangle that would be crushed.
    pub(super) fn obstacle(&self, mesh: &DiskMesh, end: usize) -> Option<Blocker> {
        let patch = self.patch.as_ref()?;
        let corners = patch.corners_of(end)?;
        let middle = corners.iter().map(|(_, z)| *z).sum::<DVec2>() / 3.0;
        if patch.is_outside(end) {
            let of_mesh: Vec<VertexId> =
                corners.iter().map(|(v, _)| *v).filter(|v| v.index() < self.begin.len()).collect();
            let other = of_mesh.iter().copied().filter(|v| !self.dragged.contains(v)).min();
            let pin = self.pin_along_boundary(mesh, &of_mesh);
            return pin.map(Blocker::Pin).or(other.map(Blocker::Boundary));
        }
        let exact = self.pins.keys().copied().filter(|&v| self.is_hard(v) && !self.dragged.contains(&v));
        let at_distance = |v: VertexId| (middle.distance_squared(self.embedding[v]), v);
        let pin = exact.map(at_distance).min_by(|a, b| a.0.total_cmp(&b.0));
        let is_rim = |v: VertexId| v.index() < self.begin.len() && !self.is_hard(v);
        let rim = patch.held().filter(|(v, _)| is_rim(*v)).map(|(_, z)| middle.distance_squared(z));
        let to_rim = rim.fold(f64::INFINITY, f64::min);
        match pin {
            Some((distance, vertex)) if distance <= to_rim => Some(Blocker::Pin(vertex)),
            _ if to_rim.is_finite() => Some(Blocker::Surroundings),
            _ => None,
        }
    }

    /// Pin against which boundary vertices are squeezed: all of them lie between a dragged pin and that pin along the
    /// boundary. Then no other part of the boundary is in the way.
    fn pin_along_boundary(&self, mesh: &DiskMesh, corners: &[VertexId]) -> Option<VertexId> {
        let place = |v: VertexId| mesh.boundary_place(v);
        let mut pins: Vec<(usize, VertexId)> =
            self.pins.keys().filter(|v| self.is_hard(**v)).filter_map(|&v| Some((place(v)?, v))).collect();
        pins.sort_unstable();
        let places: Vec<usize> = corners.iter().filter_map(|&v| place(v)).collect();
        let (count, next) = (mesh.boundary_loop().len(), pins.iter().cycle().skip(1));
        let mut arcs = pins.iter().zip(next);
        let is_within = |from: usize, to: usize| {
            let along = |place: usize| (place + count - from) % count;
            places.iter().all(|&place| along(place) <= along(to))
        };
        let (first, second) = arcs.find(|((from, _), (to, _))| from != to && is_within(*from, *to))?;
        let is_dragged = |v: &VertexId| self.dragged.contains(v);
        match [first.1, second.1] {
            [a, b] if is_dragged(&a) && !is_dragged(&b) => Some(b),
            [a, b] if is_dragged(&b) && !is_dragged(&a) => Some(a),
            _ => None,
        }
    }
}
