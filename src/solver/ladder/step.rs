//! One step of a ladder: an embedding with its verdict and its numbers.

use std::ops::Deref;

use glam::DVec2;

use super::Candidate;
use crate::mesh::VertexId;
use crate::solver::{Method, Pin, Pins, Verdict};

/// Where a one-to-one embedding stands on its way: the numbers of continuation and relaxing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Mean over the surface of the symmetric Dirichlet energy |J|² + |J⁻¹|²: 4 where nothing is distorted.
    pub energy: f64,
    /// Smallest determinant of a face's map, at equal total areas.
    pub least_determinant: f64,
    /// Largest distance of an exact pin from its target, in the plane.
    pub distance_left: f64,
}

/// A candidate, proved: how good it is. What the candidate says, its step says too.
#[derive(Clone, Debug)]
pub struct Step {
    /// The embedding, and what made it.
    pub candidate: Candidate,
    /// Place in the ladder, from 0.
    pub index: usize,
    /// The exact verdict on it.
    pub verdict: Verdict,
    /// Largest move of a vertex since the step before, in the plane; none for the first.
    pub max_move: Option<f64>,
    /// Seconds that the verdict took.
    pub verify_seconds: f64,
    /// Pins that have no part in it: all constraints, where it is on the way to a planar start without them.
    pub set_aside: Pins,
}

impl Deref for Step {
    type Target = Candidate;

    fn deref(&self) -> &Candidate {
        &self.candidate
    }
}

impl Step {
    /// Vertices that are to be met exactly and are not, by number.
    pub fn unmet(&self) -> Vec<VertexId> {
        let pins = if self.is_of_planar_start() { &self.set_aside } else { &self.solution.pins };
        let is_unmet =
            |(vertex, pin): &(&VertexId, &Pin)| pin.hold.is_exact() && self.solution.embedding[*vertex] != pin.target;
        pins.iter().filter(is_unmet).map(|(&vertex, _)| vertex).collect()
    }

    /// Whether it is on the way to a planar start, in which the constraints have no part.
    pub fn is_of_planar_start(&self) -> bool {
        !self.set_aside.is_empty()
    }

    /// Whether the boundary is simple and runs counter-clockwise.
    pub fn has_simple_boundary(&self) -> bool {
        self.verdict.boundary_crossings.is_empty() && self.verdict.turning_number == Some(1)
    }

    /// Whether the boundary was bent to a convex polygon: it is no longer free.
    pub fn has_convex_boundary(&self) -> bool {
        matches!(self.rung, Method::Convex(_)) || self.bent_vertices > 0
    }

    /// Seconds of the solve and the verdict.
    pub fn seconds(&self) -> f64 {
        self.solution.seconds.total() + self.verify_seconds
    }
}

/// The largest distance between the same vertices of two embeddings.
pub fn largest_move(before: &[DVec2], after: &[DVec2]) -> f64 {
    before.iter().zip(after).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}
