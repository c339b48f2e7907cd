//! One step of a flattener: what a stage gives, and that with its verdict and its numbers.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;

use super::PlanarStart;
use crate::bijective::{Advance, VirtualBoundary};
use crate::flatten::Prepared;
use crate::mesh::{DiskMesh, Refinement, VertexId};
use crate::nonlinear::Scaffold;
use crate::problem::units::Units;
use crate::problem::{Embedding, Family, Pin, Pins, Progress, Solution, Stage};
use crate::verify::Verdict;

/// An embedding, and what made it.
#[derive(Clone, Debug, Default)]
pub struct Candidate {
    /// The stage that made it.
    pub stage: Stage,
    /// The family of its weights, where its method has a choice.
    pub family: Family,
    /// The embedding and the numbers of its solve.
    pub solution: Solution,
    /// The mesh with new vertices that the embedding is of; none where it is of the mesh as given.
    pub refinement: Option<Arc<Refinement>>,
    /// How far a continuation or relaxing has come.
    pub progress: Option<Progress>,
    /// The outside that it was made with, where there was one.
    pub outside: Option<Arc<Scaffold>>,
    /// Boundary vertices bent to a convex polygon (paper §5, k); none where it is free, or convex by the method.
    pub bent_vertices: usize,
    /// The stages of §5, where it has any.
    pub virtual_boundary: Option<Arc<VirtualBoundary>>,
    /// What else there is to say: why the stage before gave nothing, or what had to be repaired.
    pub note: Option<String>,
    /// Equations and factors of a linear solve, for other targets of the same pins.
    pub prepared: Option<Arc<Prepared>>,
    /// The planar start that it was fitted from, for other targets on the same mesh.
    pub planar_start: Option<Arc<PlanarStart>>,
}

impl Candidate {
    pub(super) fn new(stage: Stage, family: Family, solution: Solution) -> Self {
        Self { stage, family, solution, ..Self::default() }
    }

    /// An embedding that minimises an energy: no linear system has it as its solution.
    pub(crate) fn one_to_one(stage: Stage, embedding: Embedding, pins: &Pins) -> Self {
        let gauge_completed = pins.len() < 2;
        let solution = Solution { embedding, pins: pins.clone(), gauge_completed, ..Solution::default() };
        Self::new(stage, Family::default(), solution)
    }

    /// An advance of continuation or relaxing under these pins.
    pub(super) fn of_advance(stage: Stage, advance: Advance, pins: &Pins) -> Self {
        let Advance { embedding, progress, scaffold, note } = advance;
        let candidate = Self::one_to_one(stage, embedding, pins);
        Self { progress: Some(progress), outside: Some(scaffold), note, ..candidate }
    }

    /// Takes it from units of the solve to the plane, vertices on the targets asked for to the last bit.
    pub(super) fn take_to_plane(&mut self, units: &Units, asked: &Pins) {
        if units.is_plane() {
            return;
        }
        units.embedding_to_plane(&mut self.solution.embedding, asked);
        units.pins_to_plane(&mut self.solution.pins, asked);
        if let Some(progress) = &mut self.progress {
            progress.distance_left = units.length_in_plane(progress.distance_left);
        }
        if let Some(outside) = &mut self.outside {
            units.places_to_plane(&mut Arc::make_mut(outside).frame);
        }
    }

    /// The same, computed since `start`.
    pub(super) fn since(mut self, start: Instant) -> Self {
        self.solution.seconds.solve = start.elapsed().as_secs_f64();
        self
    }

    /// Whether the boundary was bent to a convex polygon: it is no longer free.
    pub fn has_convex_boundary(&self) -> bool {
        matches!(self.stage, Stage::Convex(_) | Stage::Stretch(_)) || self.bent_vertices > 0
    }

    /// The mesh that the embedding is of: `mesh` as given, or its refinement.
    pub fn mesh<'a>(&'a self, mesh: &'a DiskMesh) -> &'a DiskMesh {
        self.refinement.as_ref().map_or(mesh, |refinement| refinement.disk())
    }
}

/// A candidate, proved: how good it is.
#[derive(Clone, Debug)]
pub struct Step {
    /// The embedding, and what made it.
    pub candidate: Candidate,
    /// Place in the flattener, from 0.
    pub index: usize,
    /// The exact verdict on it.
    pub verdict: Verdict,
    /// Vertices outside the hull of their neighbours, ascending, or without a neighbour on the surface's side where the boundary
    /// goes straight on: why it folds. None where it is one-to-one.
    pub outside_hull: Vec<VertexId>,
    /// Largest move of a vertex since the step before, in the plane; none for the first.
    pub max_move: Option<f64>,
    /// Seconds that the verdict took.
    pub verify_seconds: f64,
    /// Seconds that it took to find those vertices: part of neither solve nor verdict. 0 where it is one-to-one.
    pub hull_seconds: f64,
    /// Pins that have no part in it: all constraints, where it is on the way to a planar start without them.
    pub set_aside: Pins,
    /// Whether it lies as the layout does that it started from, as far as pins leave that open.
    pub lies_as_given: bool,
    /// Whether it goes on from an embedding that was there before its flattener began.
    pub is_continued: bool,
}

impl Step {
    /// Vertices that are to be met exactly and are not, by number.
    pub fn unmet(&self) -> Vec<VertexId> {
        let pins = if self.is_of_planar_start() { &self.set_aside } else { &self.candidate.solution.pins };
        let is_unmet = |(vertex, pin): &(&VertexId, &Pin)| {
            pin.kind.is_hard() && self.candidate.solution.embedding[*vertex] != pin.target
        };
        pins.iter().filter(is_unmet).map(|(&vertex, _)| vertex).collect()
    }

    /// Whether it is on the way to a planar start, in which the constraints have no phase.
    pub fn is_of_planar_start(&self) -> bool {
        !self.set_aside.is_empty()
    }

    /// Whether the boundary is simple and runs counter-clockwise.
    pub fn has_simple_boundary(&self) -> bool {
        self.verdict.boundary_crossings.is_empty() && self.verdict.turning_number == Some(1)
    }

    /// Seconds of the solve and the verdict.
    pub fn seconds(&self) -> f64 {
        self.candidate.solution.seconds.total() + self.verify_seconds
    }
}

/// The largest distance between the same vertices of two embeddings.
pub fn largest_move(before: &[DVec2], after: &[DVec2]) -> f64 {
    before.iter().zip(after).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}
