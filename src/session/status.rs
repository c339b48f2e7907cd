//! The state of the work on the screen, in one word.

use super::{Preview, Session};
use crate::solver::Verdict;

/// How what the screen shows stands to the document.
#[derive(Clone, Copy, Debug)]
pub enum Status<'a> {
    /// A gesture goes on: the screen shows the first, linear solve alone, as a preview where there is one.
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
        let is_first = self.timeline.records().len() <= 1;
        let is_current = self.is_current();
        if self.is_preview() {
            Status::Preview(self.preview())
        } else if self.is_running() && is_first {
            Status::Solving
        } else if !is_current && self.is_at_work() {
            if self.outcome().is_some() { Status::Following } else { Status::Solving }
        } else if !is_current {
            Status::Stale
        } else if self.is_held() {
            Status::Held
        } else {
            Status::Current
        }
    }

    /// The verdict on what the screen shows: on the preview, where there is one, as soon as it is proved; otherwise on
    /// the step.
    pub fn verdict_shown(&self) -> Option<&Verdict> {
        match self.preview() {
            Some(preview) => preview.verdict().map(AsRef::as_ref),
            None => self.outcome().map(|outcome| &outcome.step.verdict),
        }
    }

    /// Whether anything is under way in the background that changes what the screen shows or what files hold.
    pub fn is_at_work(&self) -> bool {
        self.busy().is_some() || self.is_following()
    }
}
