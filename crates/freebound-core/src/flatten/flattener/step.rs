//! Step of a flattener: the result of a stage, with its verdict and its numbers.

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
use crate::verify::{UvFrame, Verdict, verdict};

/// Embedding with its origin.
#[derive(Clone, Debug, Default)]
pub struct Candidate {
    /// Stage that computed it.
    pub stage: Stage,
    /// Family of its weights, if its method has a choice.
    pub family: Family,
    /// Embedding, and the numbers of its solve.
    pub solution: Solution,
    /// Mesh with new vertices of the embedding. `None` if the embedding belongs to the input mesh.
    pub refinement: Option<Arc<Refinement>>,
    /// Progress of a continuation or relaxation.
    pub progress: Option<Progress>,
    /// Outside with which it was computed, if any.
    pub outside: Option<Arc<Scaffold>>,
    /// Number of boundary vertices bent to a convex polygon (paper §5, k). 0 if the boundary is free, or convex by the
    /// method.
    pub bent_vertices: usize,
    /// Intermediate results of paper §5, if any.
    pub virtual_boundary: Option<Arc<VirtualBoundary>>,
    /// Remark: why an earlier stage failed, or which part was repaired.
    pub note: Option<String>,
    /// Equations and factors of a linear solve, for other targets of these pins.
    pub prepared: Option<Arc<Prepared>>,
    /// Planar start from which it was fitted, for other targets on the same mesh.
    pub planar_start: Option<Arc<PlanarStart>>,
}

impl Candidate {
    pub(super) fn new(stage: Stage, family: Family, solution: Solution) -> Self {
        Self { stage, family, solution, ..Self::default() }
    }

    /// Candidate whose embedding is not the solution of a linear system, such as the minimum of an energy.
    pub(crate) fn one_to_one(stage: Stage, embedding: Embedding, pins: &Pins) -> Self {
        let gauge_completed = pins.len() < 2;
        let solution = Solution { embedding, pins: pins.clone(), gauge_completed, ..Solution::default() };
        Self::new(stage, Family::default(), solution)
    }

    /// Candidate of an advance of continuation or relaxing, with these pins.
    pub(super) fn of_advance(stage: Stage, advance: Advance, pins: &Pins) -> Self {
        let Advance { embedding, progress, scaffold, note } = advance;
        let candidate = Self::one_to_one(stage, embedding, pins);
        Self { progress: Some(progress), outside: Some(scaffold), note, ..candidate }
    }

    /// Converts from units of the solve to the plane. Vertices on the targets in `asked` get their exact bits.
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

    /// Sets the seconds of the solve to the time since `start`.
    pub(super) fn since(mut self, start: Instant) -> Self {
        self.solution.seconds.solve = start.elapsed().as_secs_f64();
        self
    }

    /// True if the boundary is a convex polygon, by the method or by bending, and no longer free.
    pub fn has_convex_boundary(&self) -> bool {
        matches!(self.stage, Stage::Convex(_) | Stage::Stretch(_)) || self.bent_vertices > 0
    }

    /// Mesh of the embedding: `mesh`, the input, or its refinement.
    pub fn mesh<'a>(&'a self, mesh: &'a DiskMesh) -> &'a DiskMesh {
        self.refinement.as_ref().map_or(mesh, |refinement| refinement.disk())
    }
}

/// Candidate with its proof.
#[derive(Clone, Debug)]
pub struct Step {
    /// Embedding with its origin.
    pub candidate: Candidate,
    /// Index in the flattener, from 0.
    pub index: usize,
    /// Exact verdict on the embedding as written.
    pub verdict: Verdict,
    /// Vertices outside the convex hull of their neighbours, ascending: the causes of folds. Includes boundary
    /// vertices at which the boundary goes straight on and no neighbour lies on the surface's side. Empty if the
    /// embedding is one-to-one.
    pub outside_hull: Vec<VertexId>,
    /// Largest move of a vertex since the previous step, in the plane. `None` for the first step.
    pub max_move: Option<f64>,
    /// Seconds for the verdict.
    pub verify_seconds: f64,
    /// Seconds for `outside_hull`, not included in solve or verdict. 0 if the embedding is one-to-one.
    pub hull_seconds: f64,
    /// Pins without influence: all constraints, if this is a step of a planar start without them.
    pub set_aside: Pins,
    /// True if its placement is that of the initial layout, as far as pins leave it open.
    pub lies_as_given: bool,
    /// True if it continues from an embedding that existed before its flattener.
    pub is_continued: bool,
}

impl Step {
    /// First step of a flattener that made this map before: the map, unchanged, with its verdict. The embedding has one
    /// position per vertex, in the plane. `pins` are the pins of its solve.
    pub(crate) fn of_saved_map(mesh: &DiskMesh, embedding: Embedding, pins: &Pins, written: &UvFrame) -> Self {
        let start = Instant::now();
        let verdict = verdict(mesh, &written.written(&embedding));
        Self {
            candidate: Candidate::one_to_one(Stage::Saved, embedding, pins),
            index: 0,
            verdict,
            outside_hull: Vec::new(),
            max_move: None,
            verify_seconds: start.elapsed().as_secs_f64(),
            hull_seconds: 0.0,
            set_aside: Pins::new(),
            lies_as_given: false,
            is_continued: false,
        }
    }

    /// True if the step is the spectral map: no vertex is pinned, and the equations of the boundary are those of an
    /// eigenvector.
    pub fn is_spectral(&self) -> bool {
        let is_natural = self.candidate.stage == Stage::Natural && self.candidate.solution.convergence.is_some();
        is_natural || self.candidate.stage == Stage::Spectral
    }

    /// Vertices with hard pins that are not on their targets, ascending.
    pub fn unmet(&self) -> Vec<VertexId> {
        let pins = if self.is_of_planar_start() { &self.set_aside } else { &self.candidate.solution.pins };
        let is_unmet = |(vertex, pin): &(&VertexId, &Pin)| {
            pin.kind.is_hard() && self.candidate.solution.embedding[*vertex] != pin.target
        };
        pins.iter().filter(is_unmet).map(|(&vertex, _)| vertex).collect()
    }

    /// True if this is a step of a planar start, which ignores the constraints.
    pub fn is_of_planar_start(&self) -> bool {
        !self.set_aside.is_empty()
    }

    /// True if the boundary is simple and runs counter-clockwise.
    pub fn has_simple_boundary(&self) -> bool {
        self.verdict.boundary_crossings.is_empty() && self.verdict.turning_number == Some(1)
    }

    /// Seconds for the solve and the verdict.
    pub fn seconds(&self) -> f64 {
        self.candidate.solution.seconds.total() + self.verify_seconds
    }
}

/// Largest distance between corresponding vertices of two embeddings.
pub fn largest_move(before: &[DVec2], after: &[DVec2]) -> f64 {
    before.iter().zip(after).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}
