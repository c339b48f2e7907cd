//! Continuation from a one-to-one embedding, or from a step of another flattener. An edit of the request keeps
//! existing results, and an edit that is undone needs no new solve.

use std::sync::Arc;

use super::continuation::Continue;
use super::sequence::{CONTINUING, StageKind};
use super::stage::{Attained, PhaseGoal, StepState};
use super::strategy::{PhaseState, Strategy};
use super::task::Task;
use super::{Flattener, Pins, PlanarStart, Step};
use crate::mesh::DiskMesh;
use crate::problem::{Embedding, Method, Settings, Stage};
use crate::verify::is_one_to_one;

impl Flattener {
    /// Continues from a one-to-one embedding, such as one under a dragged pin, and meets the constraints from there.
    /// If that gets stuck, the usual stages follow. The embedding has one position per vertex, in the plane.
    ///
    /// The embedding is ignored if the method does not continue or the pins are not constraints.
    #[must_use]
    pub fn continue_from(mut self, embedding: &Embedding) -> Self {
        if !self.task.continues() {
            return self;
        }
        self.strategy = Strategy::continuing(&self.task, &self.cache);
        self.latest = Some(StepState {
            embedding: self.units.embedding(embedding),
            onward: None,
            pins: Pins::new(),
            has_simple_boundary: true,
            is_one_to_one: true,
            attained: Attained::Nothing,
            concave_polygons: Vec::new(),
            refinement: None,
        });
        self.notes.say("continued from the existing embedding".to_owned());
        self
    }

    /// Continues like [`continue_from`](Self::continue_from), but returns an embedding that meets all constraints
    /// unchanged, bit for bit.
    #[must_use]
    pub fn warm_start(self, embedding: &Embedding) -> Self {
        let mut run = self.continue_from(embedding);
        if run.strategy.phase().is_continued() {
            run.strategy.phase_mut().stay();
        }
        run
    }

    /// Resumes after the newest step of another flattener on the same mesh, with equal settings and pins. Further
    /// steps continue from that step and from its index. `stages` are the stages of all its steps, in order.
    #[must_use]
    pub fn resume_after(mut self, step: &Step, stages: &[Stage]) -> Self {
        let is_climber = |stage: &Stage| matches!(stage, Stage::Continuation | Stage::Matchmaker);
        if step.is_continued {
            self.strategy = Strategy::continuing(&self.task, &self.cache);
        } else if self.task.is_constrained() && stages.iter().any(is_climber) {
            self.strategy = Strategy::on_the_way(&self.task, &self.cache);
        }
        self.adopt(step);
        self.step_count = step.index + 1;
        self
    }

    /// Restarts from scratch if the embedding to continue from is not one-to-one in units of the solve.
    pub(super) fn check_beginning(&mut self, mesh: &DiskMesh) {
        let is_bad = |latest: &StepState| {
            latest.embedding.len() != mesh.vertex_count() || !is_one_to_one(mesh, &latest.embedding)
        };
        if self.step_count == 0 && self.latest.as_ref().is_some_and(is_bad) {
            self.strategy = Strategy::new(&self.task, &self.cache, self.asked.start.as_ref());
            self.latest = None;
            self.notes.take();
            self.notes.say("restarted from scratch: the existing embedding is not one-to-one".to_owned());
        }
    }
}

impl PhaseState {
    /// True if the phase continues from an embedding that existed before the flattener.
    pub(super) fn is_continued(&self) -> bool {
        self.sequences == CONTINUING
    }

    /// Returns that embedding unchanged if it meets all constraints.
    fn stay(&mut self) {
        self.stages.insert(StageKind::Continuation, Box::new(Continue::staying()));
    }
}

impl Flattener {
    /// Keeps a step as the planar start of flatteners with constraints, if their planar start would be this step. A
    /// flattener without constraints takes equal steps until it relaxes on for itself. A step is kept once. No step
    /// is kept if the mesh has polygons, because a planar start may leave them concave.
    pub(super) fn keep_start(&mut self, step: &mut Step, mesh: &DiskMesh) {
        let phase = self.strategy.phase();
        let Task { settings, pins, start, .. } = &*self.task;
        let usual = Settings { size: settings.size, new_vertices: settings.new_vertices, ..Settings::default() };
        let has_polygons = mesh.mesh().polygon_of.is_some();
        let is_alone =
            phase.aim == PhaseGoal::Constraints && pins.is_empty() && start.is_none() && self.units.is_plane();
        let is_alike = settings.method == Method::Auto && settings.resolves_to(&usual);
        let is_end = step.verdict.planar && !step.verdict.mirrored && !phase.relax.goes_on_for_start();
        if is_alone && is_alike && is_end && !has_polygons && self.cache.planar_start.is_none() {
            let start = Arc::new(PlanarStart::new(&self.task, step.candidate.solution.embedding.clone()));
            self.cache.planar_start = Some(Arc::clone(&start));
            step.candidate.planar_start = Some(start);
        }
    }
}
