//! What is in the way of a dragged pin.

use glam::DVec2;

use super::Live;
use crate::mesh::VertexId;

/// What is in the way of a dragged pin: what is crushed on its way lies next to that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Obstacle {
    /// Another pin.
    Pin(VertexId),
    /// The sheet's own boundary, from outside, at this vertex.
    Boundary(VertexId),
    /// The part of the sheet that does not move along while the pin is held.
    Surroundings,
}

impl Live {
    /// What lies next to a triangle that is crushed.
    pub(super) fn obstacle(&self, end: usize) -> Option<Obstacle> {
        let patch = self.patch.as_ref()?;
        let corners = patch.corners_of(end)?;
        let middle = corners.iter().map(|(_, z)| *z).sum::<DVec2>() / 3.0;
        if patch.is_outside(end) {
            let of_mesh = corners.iter().filter(|(v, _)| v.index() < self.begin.len() && !self.dragged.contains(v));
            return of_mesh.map(|(v, _)| *v).min().map(Obstacle::Boundary);
        }
        let exact = self.pins.keys().copied().filter(|&v| self.is_exact(v) && !self.dragged.contains(&v));
        let at_distance = |v: VertexId| (middle.distance_squared(self.embedding[v]), v);
        let pin = exact.map(at_distance).min_by(|a, b| a.0.total_cmp(&b.0));
        let is_rim = |v: VertexId| v.index() < self.begin.len() && !self.is_exact(v);
        let rim = patch.held().filter(|(v, _)| is_rim(*v)).map(|(_, z)| middle.distance_squared(z));
        let to_rim = rim.fold(f64::INFINITY, f64::min);
        match pin {
            Some((distance, vertex)) if distance <= to_rim => Some(Obstacle::Pin(vertex)),
            _ if to_rim.is_finite() => Some(Obstacle::Surroundings),
            _ => None,
        }
    }
}
