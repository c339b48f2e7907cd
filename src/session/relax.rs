//! Relaxing on a person's wish: the distortion of a planar embedding lowered, one-to-one throughout, constraints exact.

use super::stop::Goal;
use super::{Place, Session};

/// The most rounds of relaxing that are asked for at once.
const ROUNDS: usize = 20;

impl Session {
    /// Whether the newest step is planar, its constraints met, and its run waits to be taken on.
    pub fn can_relax(&self) -> bool {
        let newest = self.timeline.newest().and_then(|newest| self.timeline.outcome(newest));
        let is_planar = newest.is_some_and(|newest| newest.step.verdict.planar && newest.step.unmet().is_empty());
        let is_of_document = |run: &crate::solver::Ladder| self.document.is_solved_by(run.settings(), run.pins());
        is_planar && self.is_current() && self.resting.as_ref().is_some_and(is_of_document)
    }

    /// Lowers the distortion of the newest step, until all rounds are used up or nothing is gained.
    pub(super) fn relax(&mut self) {
        if !self.can_relax() {
            return;
        }
        let Some(mut run) = self.resting.take() else { return };
        self.timeline.follow_newest();
        match run.relax(ROUNDS) {
            Ok(()) => self.spawn(run, Goal::End),
            Err(error) => {
                self.resting = Some(run);
                self.fail(Place::Embedding, error.to_string(), None);
            }
        }
    }
}
