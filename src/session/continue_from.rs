//! What a run of the document goes on from: the planar embedding that is there.
//!
//! An edit of a pin, and of whether edges may be split, goes on from it. A choice of method, weights, form, chart or picture
//! does not: what they mean shows only where the map is made by them alone. Where constraints are only added, and the map meets
//! them already, as those of vertices that are fixed where they lie, it stays as it is.
//!
//! At least two pins have to stay where they are. They hold the map in its place, at its size: from there the others go
//! their ways. Where none stays (targets that are mirrored, fitted or replaced), the map lies anywhere beside them, and the
//! whole of it would have to be dragged there.

use std::sync::Arc;

use super::Session;
use super::drag_request::Screen;
use super::solving::Beginning;
use freebound_core::pipeline::{Outcome, Problem};

impl Session {
    /// The embedding that a run of the document goes on from after an edit: that on the screen, or else that of the newest
    /// step. None where it is solved from scratch.
    pub(super) fn beginning(&self) -> Option<Beginning> {
        if !self.has_form_as_wanted() {
            return None;
        }
        let wanted = self.document.problem();
        let newest = || {
            let newest = self.solving.newest().filter(|newest| wanted.continues_from(&newest.problem))?;
            Screen::of(newest, self.disk()?.vertex_count()).filter(|screen| screen.is_planar)
        };
        let serves = |screen: &Screen| screen.is_planar && wanted.continues_from(&screen.problem);
        let screen = self.screen().filter(serves).or_else(newest)?;
        // Where constraints only came, the map is as good as it was where it meets them, too.
        let stays = screen.problem.targets.iter().all(|(vertex, target)| wanted.targets.get(vertex) == Some(target));
        Some(Beginning { embedding: screen.embedding, stays })
    }

    /// The embedding on the screen where it is planar, and made by the document's method: the end of a drag goes on from it.
    pub(super) fn planar_on_screen(&self) -> Option<Beginning> {
        let wanted = self.document.problem();
        let is_alike = |screen: &Screen| {
            let Problem { settings, frame, .. } = &screen.problem;
            screen.is_planar && settings.resolves_to(&wanted.settings) && *frame == wanted.frame
        };
        self.screen().filter(is_alike).map(|screen| Beginning { embedding: screen.embedding, stays: false })
    }

    /// Whether the map on the screen goes on from one that was there before an edit: solved from scratch, it may be another.
    pub fn is_continued(&self) -> bool {
        self.outcome().is_some_and(|outcome| outcome.step.is_continued)
    }
}

impl Screen {
    /// A step, on a mesh of so many vertices: of new ones it has nothing to say. Whether it is one-to-one without them, the run
    /// finds out.
    pub(super) fn of(outcome: &Outcome, vertex_count: usize) -> Option<Self> {
        let (step, problem) = (&outcome.step, outcome.problem.clone());
        // A planar start sets constraints aside: it is nothing to hold them where they are.
        let is_planar = step.verdict.planar && !step.verdict.mirrored && !step.is_of_planar_start();
        let embedding = step.candidate.solution.embedding.get(..vertex_count)?.to_vec().into();
        Some(Self { embedding: Arc::new(embedding), problem, is_planar })
    }
}
