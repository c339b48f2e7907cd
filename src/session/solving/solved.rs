//! Solution of a stopped run, kept for undo and restored unchanged.

use std::sync::Arc;

use super::Solving;
use super::rounds::Rounds;
use super::running::{Resting, Task};
use crate::session::timeline::TIMELINE_BUDGET;
use crate::session::{Messages, Timeline};
use freebound_core::flatten::Ending;
use freebound_core::pipeline::{Outcome, Problem};
use freebound_core::problem::{SolveError, Stage};

/// Approximate memory per face of a mesh with new vertices, bytes: corners, halfedges with twins and vertices, edges,
/// lengths.
const BYTES_A_FACE: usize = 200;

/// Steps of a stopped run, with its ending.
#[derive(Clone, Debug)]
pub(in crate::session) struct Solved {
    timeline: Timeline,
    ending: Option<Ending>,
    rounds: Rounds,
}

impl Solved {
    /// Memory of the solution, bytes.
    pub(in crate::session) fn bytes(&self) -> usize {
        let of_new_mesh = |outcome: &Outcome| {
            outcome
                .step
                .candidate
                .refinement
                .as_ref()
                .map_or(0, |refinement| refinement.disk().face_count() * BYTES_A_FACE)
        };
        self.timeline.kept().map(|(_, outcome)| outcome.bytes() + of_new_mesh(outcome)).sum()
    }

    fn newest(&self) -> Option<&Arc<Outcome>> {
        self.timeline.outcome(self.timeline.newest()?)
    }

    /// True if the steps belong to this problem.
    pub(in crate::session) fn is_of(&self, problem: &Problem) -> bool {
        self.newest().is_some_and(|newest| newest.problem.has_steps_of(problem))
    }
}

impl Solving {
    /// Solution of a problem, if its run has stopped. The steps are condensed to `bytes` bytes.
    pub(in crate::session) fn solved(&self, problem: &Problem, bytes: usize) -> Option<Solved> {
        let newest = self.newest().filter(|newest| newest.problem.has_steps_of(problem))?;
        // Steps towards a planar start are not worth restoring.
        let is_at_rest = self.running.is_none() && !newest.step.is_of_planar_start();
        let solved = || Solved { timeline: self.timeline.condensed(bytes), ending: self.ending, rounds: self.rounds };
        is_at_rest.then(solved)
    }

    /// Shows a map that was saved, as the first step of a run. `relaxed` rounds of relaxing count as taken. Further steps
    /// continue from it.
    pub(in crate::session) fn show_map(
        &mut self,
        outcome: Arc<Outcome>,
        task: Task,
        relaxed: usize,
        messages: &mut Messages,
    ) {
        let mut timeline = Timeline::with_budget(TIMELINE_BUDGET);
        timeline.push(outcome);
        self.show_again(Solved { timeline, ending: None, rounds: Rounds::taken(relaxed) }, task, messages);
        self.ending = self.resting.as_ref().and_then(|resting| resting.run.ending());
    }

    /// Restores a solution. Further steps continue from it.
    pub(in crate::session) fn show_again(&mut self, solved: Solved, task: Task, messages: &mut Messages) {
        self.give_up_all();
        self.forget_message(messages);
        messages.forget_written();
        self.failed = None;
        let Some(newest) = solved.newest() else { return };
        let stages: Vec<Stage> = solved.timeline.records().iter().map(|record| record.stage.clone()).collect();
        let run = self.run_of(&task).resume_after(&newest.step, &stages);
        self.resting = Some(Resting { problem: task.problem, run });
        (self.timeline, self.ending, self.rounds) = (solved.timeline, solved.ending, solved.rounds);
        self.timeline.set_budget(TIMELINE_BUDGET);
        self.outcome_revision += 1;
        if self.ending == Some(Ending::Unmet) {
            let has_new_vertices = self.resting.as_ref().is_some_and(|resting| resting.problem.settings.new_vertices);
            self.tell(&SolveError::Unmet, &task.model, has_new_vertices, messages);
        }
    }
}
