//! From candidates to steps: placed, converted to the plane, and proved in the written numbers.

use std::borrow::Cow;
use std::sync::Arc;
use std::time::Instant;

use super::stage::{PhaseGoal, StepState};
use super::{Candidate, Flattener, Step, largest_move};
use crate::mesh::{DiskMesh, VertexId};
use crate::nonlinear::rest_shape::RestShape;
use crate::problem::units::Units;
use crate::problem::{Control, Embedding, Phase, Pins, SolveError, Stage};
use crate::verify::Verdict;
use crate::verify::hull_condition::vertices_outside_hull_unless;
use crate::verify::verdict::verdict_unless;

impl Flattener {
    /// Units of the current phase. A planar start is solved in the plane itself.
    pub(super) fn units_in_force(&self) -> Units {
        if self.strategy.phase().aim == PhaseGoal::Constraints { self.units } else { Units::default() }
    }

    /// Proves a candidate. If cancelled, keeps the candidate, because its stage has already advanced; the next step
    /// then starts with its proof.
    pub(super) fn proved(
        &mut self,
        mut candidate: Candidate,
        mesh: &DiskMesh,
        control: Control<'_>,
    ) -> Result<Step, SolveError> {
        if self.strategy.phase().aim == PhaseGoal::PlanarStart || !self.keeps_factors {
            // Factors take most of the memory; the next factors must not add to them.
            candidate.prepared = None;
        }
        self.unproved = Some(candidate.clone());
        let step = self.placed_and_proved(candidate, mesh, control);
        if !matches!(step, Err(SolveError::Cancelled)) {
            self.unproved = None;
        }
        step
    }

    /// Places and proves a candidate. If cancelled, the flattener is unchanged.
    fn placed_and_proved(
        &mut self,
        mut candidate: Candidate,
        mesh: &DiskMesh,
        control: Control<'_>,
    ) -> Result<Step, SolveError> {
        control.enter(Phase::Verify)?;
        let (start, units) = (Instant::now(), self.units_in_force());
        let task = Arc::clone(&self.strategy.phase().task);
        let refinement = candidate.refinement.clone();
        let disk = refinement.as_ref().map_or(mesh, |refinement| refinement.disk());
        candidate.solution.embedding.gather_unused(disk);
        let placing = task.place(disk, &mut candidate, control)?;
        let mut verdict = self.verdict_of(mesh, &candidate, control)?;
        let is_start = self.strategy.phase().aim == PhaseGoal::PlanarStart;
        let is_proved = verdict.is_one_to_one() && (verdict.planar || is_start);
        if !is_proved || !task.are_met(&candidate.solution.embedding) {
            let is_kept = self.keep_what_is_proved(&mut candidate);
            verdict = if is_kept { self.verdict_of(mesh, &candidate, control)? } else { verdict };
        }
        control.go_on()?;
        let is_measured = verdict.planar || (is_start && verdict.is_one_to_one());
        if candidate.progress.is_none() && is_measured && self.strategy.phase().rounds_until_it_serves() > 0 {
            let of = candidate.mesh(mesh);
            candidate.progress = Some(RestShape::progress_at_end(of, &candidate.solution.embedding));
        }
        let verify_seconds = start.elapsed().as_secs_f64();
        control.go_on()?;
        let (outside_hull, hull_seconds) = self.outside_hull_of(mesh, &candidate, &verdict, control)?;
        // New vertices have no previous position, or that of another vertex.
        let old = mesh.vertex_count();
        let moved = |latest: &StepState| largest_move(&latest.embedding[..old], &candidate.solution.embedding[..old]);
        let max_move = self.latest.as_ref().map(moved).map(|length| units.length_in_plane(length));
        candidate.take_to_plane(&units, &self.asked.held());
        candidate.solution.embedding.check_finite()?;
        if self.strategy.phase().is_from_layout {
            // Only a start from the surface alone is valid for other flatteners.
            candidate.planar_start = None;
        }
        self.notes.say(candidate.note.take());
        self.notes.say(placing);
        candidate.note = self.notes.take();
        let set_aside = if is_start { self.asked.held() } else { Pins::new() };
        let lies_as_given = task.lies_as_given();
        let (index, is_continued) = (self.step_count, self.strategy.phase().is_continued());
        let step = Step {
            candidate,
            index,
            verdict,
            outside_hull,
            max_move,
            verify_seconds,
            hull_seconds,
            set_aside,
            lies_as_given,
            is_continued,
        };
        Ok(step)
    }

    /// Verdict on a candidate as written.
    fn verdict_of(&self, mesh: &DiskMesh, candidate: &Candidate, control: Control<'_>) -> Result<Verdict, SolveError> {
        control.go_on()?;
        verdict_unless(candidate.mesh(mesh), &self.written(candidate), control)
    }

    /// Causes of the folds of a candidate: vertices outside the hull of their neighbours, and the seconds taken to
    /// find them. Empty if the candidate is one-to-one, by the theorem.
    fn outside_hull_of(
        &self,
        mesh: &DiskMesh,
        candidate: &Candidate,
        verdict: &Verdict,
        control: Control<'_>,
    ) -> Result<(Vec<VertexId>, f64), SolveError> {
        if verdict.is_one_to_one() {
            return Ok((Vec::new(), 0.0));
        }
        let start = Instant::now();
        let found =
            vertices_outside_hull_unless(candidate.mesh(mesh), &self.written(candidate), verdict.upright(), control)?;
        Ok((found, start.elapsed().as_secs_f64()))
    }

    /// Written numbers of a candidate.
    fn written<'a>(&self, candidate: &'a Candidate) -> Cow<'a, Embedding> {
        let (units, embedding) = (self.units_in_force(), &candidate.solution.embedding);
        if units.is_plane() {
            return self.strategy.phase().task.frame.written(embedding);
        }
        let mut in_plane = embedding.clone();
        units.embedding_to_plane(&mut in_plane, &self.asked.held());
        Cow::Owned(self.asked.frame.written(&in_plane).into_owned())
    }

    /// Restores the embedding before a round of relaxing if that met the whole request and the candidate does not.
    /// Returns true if restored.
    fn keep_what_is_proved(&self, candidate: &mut Candidate) -> bool {
        let is_relaxed = candidate.stage == Stage::Relax;
        let Some(latest) = self.latest.as_ref().filter(|latest| is_relaxed && latest.is_solved()) else { return false };
        candidate.solution.embedding.clone_from(&latest.embedding);
        candidate.solution.pins.clone_from(&latest.pins);
        (candidate.outside, candidate.progress) = (None, None);
        candidate.note =
            Some("the relaxed embedding would fold at its final position: the previous one is kept".to_owned());
        true
    }
}
