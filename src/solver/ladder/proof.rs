//! From candidates to steps: placed, taken to the plane, and proved in the numbers that are written.

use std::sync::Arc;
use std::time::Instant;

use super::plan::Aim;
use super::rung::Latest;
use super::{Candidate, Ladder, Step, largest_move};
use crate::mesh::DiskMesh;
use crate::solver::rest::Rest;
use crate::solver::units::Units;
use crate::solver::{Control, Method, Phase, Pins, SolveError, Verdict, verdict};

impl Ladder {
    /// Those of the part under way: a planar start lies in the plane where it lies.
    pub(super) fn units_in_force(&self) -> Units {
        if self.plan.part().aim == Aim::Constraints { self.units } else { Units::default() }
    }

    /// A candidate with its verdict, handed over even where the caller has asked to stop: the rung has moved on.
    pub(super) fn proved(
        &mut self,
        mut candidate: Candidate,
        mesh: &DiskMesh,
        control: Control<'_>,
    ) -> Result<Step, SolveError> {
        control.enter(Phase::Verify).ok();
        let start = Instant::now();
        let units = self.units_in_force();
        let task = Arc::clone(&self.plan.part().task);
        let refinement = candidate.refinement.clone();
        let disk = refinement.as_ref().map_or(mesh, |refinement| refinement.disk());
        candidate.solution.embedding.gather_unused(disk);
        let placing = task.place(disk, &mut candidate);
        let mut verdict = self.verdict_of(mesh, &candidate);
        let is_start = self.plan.part().aim == Aim::PlanarStart;
        let is_proved = verdict.is_one_to_one() && (verdict.planar || is_start);
        if !is_proved || !task.are_met(&candidate.solution.embedding) {
            let is_kept = self.keep_what_is_proved(&mut candidate);
            verdict = if is_kept { self.verdict_of(mesh, &candidate) } else { verdict };
        }
        if candidate.progress.is_none() && verdict.planar && self.plan.part().rounds_until_it_serves() > 0 {
            let of = candidate.mesh(mesh);
            candidate.progress = Some(Rest::new(of).progress(of, &candidate.solution.embedding, 0.0));
        }
        let verify_seconds = start.elapsed().as_secs_f64();
        // New vertices have no position before, or another one's.
        let old = mesh.vertex_count();
        let moved = |latest: &Latest| largest_move(&latest.embedding[..old], &candidate.solution.embedding[..old]);
        let max_move = self.latest.as_ref().map(moved).map(|length| units.length_in_plane(length));
        candidate.take_to_plane(&units, &self.asked.held());
        candidate.solution.embedding.check_finite()?;
        if self.plan.part().is_from_layout {
            // Only a start from the surface alone serves others.
            candidate.planar_start = None;
        }
        self.notes.say(candidate.note.take());
        self.notes.say(placing);
        candidate.note = self.notes.take();
        let set_aside = match self.plan.part().aim {
            Aim::Constraints => Pins::new(),
            Aim::PlanarStart => {
                candidate.prepared = None;
                self.asked.held()
            }
        };
        let lies_as_given = task.start.is_some();
        Ok(Step { candidate, index: self.step_count, verdict, max_move, verify_seconds, set_aside, lies_as_given })
    }

    /// The verdict on a candidate as it is written.
    fn verdict_of(&self, mesh: &DiskMesh, candidate: &Candidate) -> Verdict {
        let (units, disk) = (self.units_in_force(), candidate.mesh(mesh));
        if units.is_plane() {
            return verdict(disk, &self.plan.part().task.sheet.written(&candidate.solution.embedding));
        }
        let mut embedding = candidate.solution.embedding.clone();
        units.embedding_to_plane(&mut embedding, &self.asked.held());
        verdict(disk, &self.asked.sheet.written(&embedding))
    }

    /// Gives back the embedding before a round of relaxing, where that was all that is asked for and this is not.
    /// Returns whether it did.
    fn keep_what_is_proved(&self, candidate: &mut Candidate) -> bool {
        let is_relaxed = candidate.rung == Method::Relax;
        let Some(latest) = self.latest.as_ref().filter(|latest| is_relaxed && latest.is_solved) else { return false };
        candidate.solution.embedding.clone_from(&latest.embedding);
        candidate.solution.pins.clone_from(&latest.pins);
        (candidate.outside, candidate.progress) = (None, None);
        candidate.note = Some("the relaxed embedding would fold in its place: that before is kept".to_owned());
        true
    }
}
