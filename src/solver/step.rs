//! One step of a run: an embedding with its verdict and its numbers.

use std::sync::Arc;

use glam::DVec2;

use super::{Embedding, Family, Method, Outside, Prepared, Solution, Verdict, VirtualBoundary};
use crate::mesh::{DiskMesh, Refinement, VertexId};

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

/// An embedding, what made it, and how good it is.
#[derive(Clone, Debug)]
pub struct Step {
    /// The rung of the ladder, as the method that it is by itself: natural, iterate, virtual boundary, or the linear
    /// method that was asked for.
    pub rung: Method,
    /// The family of its weights, where its method has a choice.
    pub family: Family,
    /// Place in the run, from 0.
    pub index: usize,
    /// The embedding and the numbers of its solve.
    pub solution: Solution,
    /// The exact verdict on it.
    pub verdict: Verdict,
    /// Largest move of a vertex since the step before, in the plane; none for the first.
    pub max_move: Option<f64>,
    /// Seconds that the verdict took.
    pub verify_seconds: f64,
    /// Boundary vertices that were bent to a convex polygon to make the boundary simple (paper §5, k); none where it is
    /// free, or was convex by the method.
    pub bent_vertices: usize,
    /// The stages of §5, where the step has any.
    pub virtual_boundary: Option<Arc<VirtualBoundary>>,
    /// What else there is to say: why the rung before gave nothing, or what had to be repaired.
    pub note: Option<String>,
    /// Equations and factors of a linear solve, for other targets of the same pins.
    pub prepared: Option<Arc<Prepared>>,
    /// The mesh with new vertices that the embedding is of; none where it is of the mesh as given.
    pub refinement: Option<Arc<Refinement>>,
    /// How far a continuation or relaxing has come.
    pub progress: Option<Progress>,
    /// The outside that the step was made with, where there was one.
    pub outside: Option<Arc<Outside>>,
}

impl Step {
    /// The mesh that the embedding is of: `mesh` as given, or its refinement.
    pub fn mesh<'a>(&'a self, mesh: &'a DiskMesh) -> &'a DiskMesh {
        self.refinement.as_ref().map_or(mesh, |refinement| refinement.disk())
    }

    /// Vertices that are to be met exactly and are not, by number.
    pub fn unmet(&self) -> Vec<VertexId> {
        let Solution { embedding, pins, .. } = &self.solution;
        let is_unmet =
            |(vertex, pin): &(&VertexId, &super::Pin)| pin.hold.is_exact() && embedding[*vertex] != pin.target;
        pins.iter().filter(is_unmet).map(|(&vertex, _)| vertex).collect()
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

/// The diagonal of the box around an embedding.
pub fn diameter(embedding: &Embedding) -> f64 {
    let low = embedding.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = embedding.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    low.distance(high)
}
