//! The state of the work on the screen, in one word, and the questions that it is made of.

use std::sync::Arc;

use super::{Preview, Session};
use freebound_core::pipeline::Outcome;
use freebound_core::problem::Phase;

/// What goes on in the background.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Busy {
    /// Reading and diagnosing a mesh.
    Loading,
    /// Reading or computing something for the mesh; what it is, in words.
    Job(&'static str),
    /// Solving; the phase where it is known.
    Solving(Option<Phase>),
    /// Writing a file.
    Saving,
}

/// How what the screen shows stands to the document.
#[derive(Clone, Copy, Debug)]
pub enum Status<'a> {
    /// A gesture goes on, or the run after it has no step yet: the screen shows what follows the pointer, as a preview where
    /// there is one.
    Preview(Option<&'a Preview>),
    /// A run is under way, and has given one step at most.
    Solving,
    /// The document has changed since the step on the screen; what replaces it is on its way.
    Following,
    /// The step on the screen does not belong to the document, or there is none, and nothing is on its way.
    Stale,
    /// The step on the screen belongs to the document, and is its run's first; the run waits to be taken on.
    Held,
    /// The step on the screen belongs to the document.
    Current,
}

impl Session {
    /// How what the screen shows stands to the document.
    pub fn status(&self) -> Status<'_> {
        let is_first = self.timeline().records().len() <= 1;
        let is_current = self.is_current();
        let is_at_work = self.busy().is_some() || self.is_following();
        let is_in_gesture = self.history.is_in_gesture();
        let is_preview = self.preview().is_some() && (is_in_gesture || is_at_work);
        if is_preview || (is_in_gesture && self.solving.is_at_first_step()) {
            Status::Preview(self.preview())
        } else if self.is_running() && is_first {
            Status::Solving
        } else if !is_current && is_at_work {
            if self.outcome().is_some() { Status::Following } else { Status::Solving }
        } else if !is_current {
            Status::Stale
        } else if self.solving.is_at_first_step() {
            // Neither a preview nor running: nobody else takes the steps.
            Status::Held
        } else {
            Status::Current
        }
    }

    /// Whether a drag goes on that has edited the document: until it ends, edits like its own are part of it.
    pub fn is_in_gesture(&self) -> bool {
        self.history.is_in_gesture()
    }

    /// What goes on in the background that is worth waiting for.
    pub fn busy(&self) -> Option<Busy> {
        if self.files.is_loading() {
            Some(Busy::Loading)
        } else if let Some(what) = self.jobs.words() {
            Some(Busy::Job(what))
        } else if self.charts.is_asked() {
            Some(Busy::Job("taking the chart out of the mesh"))
        } else if self.is_running() {
            Some(Busy::Solving(self.solving.phase()))
        } else {
            self.files.is_saving().then_some(Busy::Saving)
        }
    }

    /// Whether the outcome on the screen belongs to the document as it is now.
    pub fn is_current(&self) -> bool {
        let is_solved = |outcome: &Arc<Outcome>| outcome.problem.has_steps_of(&self.document.problem());
        self.has_form_as_wanted() && self.outcome().is_some_and(is_solved)
    }

    /// Whether what a drag needs is being computed: its next frame, its column, or the verdict on its preview. That is no
    /// work to wait for: it goes on as long as the drag.
    pub fn is_following(&self) -> bool {
        self.drag.is_busy()
    }
}
