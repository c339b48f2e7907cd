//! State of the work on the screen.

use std::sync::Arc;

use super::first_map::CHECKING;
use super::unwrapping::SEARCHING;
use super::{Preview, Session};
use freebound_core::pipeline::Outcome;
use freebound_core::problem::Phase;

/// Work in the background.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Busy {
    /// Reading and diagnosing a mesh.
    Loading,
    /// Reading or computing something for the mesh, with a description.
    Job(&'static str),
    /// Solving, with the phase if it is known.
    Solving(Option<Phase>),
    /// Writing a file.
    Saving,
}

/// State of the screen relative to the document.
#[derive(Clone, Copy, Debug)]
pub enum Status<'a> {
    /// A gesture is in progress, or its run has no step yet. The screen shows the preview, if there is one.
    Preview(Option<&'a Preview>),
    /// A run is in progress and has at most one step.
    Solving,
    /// The shown step is outdated, and its replacement is being computed.
    Following,
    /// The shown step is outdated or missing, and nothing is being computed.
    Stale,
    /// The shown step belongs to the document and is the first of its run, which can be continued.
    Held,
    /// The shown step belongs to the document.
    Current,
}

impl Session {
    /// State of the screen relative to the document.
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
            // There is neither a preview nor a run in progress, so further steps need a request.
            Status::Held
        } else {
            Status::Current
        }
    }

    /// True if a drag has edited the document and has not ended. Similar edits belong to the drag until then.
    pub fn is_in_gesture(&self) -> bool {
        self.history.is_in_gesture()
    }

    /// Work in the background that is worth waiting for.
    pub fn busy(&self) -> Option<Busy> {
        if self.files.is_loading() {
            Some(Busy::Loading)
        } else if self.layout_check.decides_for().is_some() {
            Some(Busy::Job(CHECKING))
        } else if self.unwrapping.is_busy() {
            Some(Busy::Job(SEARCHING))
        } else if let Some(what) = self.jobs.words() {
            Some(Busy::Job(what))
        } else if self.charts.is_asked() {
            Some(Busy::Job("extracting the chart from the mesh"))
        } else if self.is_running() {
            Some(Busy::Solving(self.solving.phase()))
        } else {
            (self.files.is_saving() || self.files.is_awaiting()).then_some(Busy::Saving)
        }
    }

    /// True if files are being written, and no other work is waited for.
    pub(super) fn is_only_saving(&self) -> bool {
        self.busy() == Some(Busy::Saving)
    }

    /// True if the shown outcome belongs to the current document.
    pub fn is_current(&self) -> bool {
        let is_solved = |outcome: &Arc<Outcome>| outcome.problem.has_steps_of(&self.document.problem());
        self.has_form_as_wanted() && self.outcome().is_some_and(is_solved)
    }

    /// True if a frame of a drag or a brush, or a drag's column or verdict, is being computed. This work is not waited for, because it
    /// lasts as long as the drag.
    pub fn is_following(&self) -> bool {
        self.drag.is_busy() || self.brushing.is_busy()
    }
}
