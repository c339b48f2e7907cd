//! What a rung gives, before it is proved.

use std::sync::Arc;
use std::time::Instant;

use super::{PlanarStart, Progress};
use crate::mesh::{DiskMesh, Refinement};
use crate::solver::{Embedding, Family, Method, Outside, Pins, Prepared, Solution, VirtualBoundary};

/// An embedding, and what made it.
#[derive(Clone, Debug, Default)]
pub struct Candidate {
    /// The rung, as the method that it is by itself; for a linear solve the method that was asked for.
    pub rung: Method,
    /// The family of its weights, where its method has a choice.
    pub family: Family,
    /// The embedding and the numbers of its solve.
    pub solution: Solution,
    /// The mesh with new vertices that the embedding is of; none where it is of the mesh as given.
    pub refinement: Option<Arc<Refinement>>,
    /// How far a continuation or relaxing has come.
    pub progress: Option<Progress>,
    /// The outside that it was made with, where there was one.
    pub outside: Option<Arc<Outside>>,
    /// Boundary vertices bent to a convex polygon (paper §5, k); none where it is free, or convex by the method.
    pub bent_vertices: usize,
    /// The stages of §5, where it has any.
    pub virtual_boundary: Option<Arc<VirtualBoundary>>,
    /// What else there is to say: why the rung before gave nothing, or what had to be repaired.
    pub note: Option<String>,
    /// Equations and factors of a linear solve, for other targets of the same pins.
    pub prepared: Option<Arc<Prepared>>,
    /// The planar start that it was fitted from, for other targets on the same mesh.
    pub planar_start: Option<Arc<PlanarStart>>,
}

impl Candidate {
    pub(super) fn new(rung: Method, family: Family, solution: Solution) -> Self {
        Self { rung, family, solution, ..Self::default() }
    }

    /// An embedding that minimises an energy: no linear system has it as its solution.
    pub(in crate::solver) fn one_to_one(rung: Method, embedding: Embedding, pins: &Pins) -> Self {
        let gauge_completed = pins.len() < 2;
        let solution = Solution { embedding, pins: pins.clone(), gauge_completed, ..Solution::default() };
        Self::new(rung, Family::default(), solution)
    }

    /// The same, computed since `start`.
    pub(super) fn since(mut self, start: Instant) -> Self {
        self.solution.seconds.solve = start.elapsed().as_secs_f64();
        self
    }

    /// The mesh that the embedding is of: `mesh` as given, or its refinement.
    pub fn mesh<'a>(&'a self, mesh: &'a DiskMesh) -> &'a DiskMesh {
        self.refinement.as_ref().map_or(mesh, |refinement| refinement.disk())
    }
}
