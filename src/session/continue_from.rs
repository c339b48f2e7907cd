//! Start of a run after an edit: the planar embedding that exists.
//!
//! An edit of a pin, or of the permission to split edges, continues from the existing embedding. A change of method,
//! weights, preparation, chart or picture solves from scratch, because only then the result shows the effect of the
//! change. If constraints are only added and the map already meets them, the map is unchanged. Pins at the current
//! positions of their vertices are an example.
//!
//! At least two pins have to stay at their targets. They keep the position and the size of the map while the other pins
//! move. Without them (mirrored, fitted or replaced targets) the map lies anywhere beside the targets, and all of it
//! would have to be dragged there.

use std::sync::Arc;

use super::Session;
use super::drag_request::Screen;
use super::solving::Beginning;
use freebound_core::pipeline::{Outcome, Problem};

impl Session {
    /// Embedding that a run of the document continues from after an edit. Prefers the shown embedding to the newest
    /// step. `None` if the run solves from scratch.
    pub(super) fn beginning(&self) -> Option<Beginning> {
        if !self.has_form_as_wanted() {
            return None;
        }
        let wanted = self.document.problem();
        if wanted.shaped_map_meets_pins() {
            // The run begins with that map, as the runs of charts that are not shown do.
            return None;
        }
        let newest = || {
            let newest = self.solving.newest().filter(|newest| wanted.continues_from(&newest.problem))?;
            Screen::of(newest, self.disk()?.vertex_count()).filter(|screen| screen.is_planar)
        };
        let serves = |screen: &Screen| screen.is_planar && wanted.continues_from(&screen.problem);
        let screen = self.screen().filter(serves).or_else(newest)?;
        // If constraints were only added, a map that meets them too is as good as before.
        let stays = screen.problem.targets.iter().all(|(vertex, target)| wanted.targets.get(vertex) == Some(target));
        Some(Beginning { embedding: screen.embedding, stays })
    }

    /// Shown embedding, if it is planar and the document's method made it. A run at the end of a drag continues from
    /// it.
    pub(super) fn planar_on_screen(&self) -> Option<Beginning> {
        let wanted = self.document.problem();
        let is_alike = |screen: &Screen| {
            let Problem { settings, frame, .. } = &screen.problem;
            screen.is_planar && settings.resolves_to(&wanted.settings) && *frame == wanted.frame
        };
        self.screen().filter(is_alike).map(|screen| Beginning { embedding: screen.embedding, stays: false })
    }

    /// True if the shown map continues one from before an edit. Solving from scratch may give another map.
    pub fn is_continued(&self) -> bool {
        self.outcome().is_some_and(|outcome| outcome.step.is_continued)
    }
}

impl Screen {
    /// State of the screen for a step, with the first `vertex_count` vertices. New vertices are dropped. The run checks
    /// if the embedding is one-to-one without them.
    pub(super) fn of(outcome: &Outcome, vertex_count: usize) -> Option<Self> {
        let (step, problem) = (&outcome.step, outcome.problem.clone());
        // A planar start sets constraints aside, so its pins are not at their targets.
        let is_planar = step.verdict.planar && !step.verdict.mirrored && !step.is_of_planar_start();
        let embedding = step.candidate.solution.embedding.get(..vertex_count)?.to_vec().into();
        Some(Self { embedding: Arc::new(embedding), problem, is_planar })
    }
}
