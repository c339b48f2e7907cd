//! What a session says of the solving on the screen.

use std::sync::Arc;

use crate::session::timeline::Timeline;
use crate::session::{Outcome, Session, Stop, StopConditions};

impl Session {
    /// The steps that there are, and which of them is on the screen.
    pub fn timeline(&self) -> &Timeline {
        &self.solving.timeline
    }

    /// The step on the screen.
    pub fn outcome(&self) -> Option<&Arc<Outcome>> {
        self.timeline().outcome(self.timeline().shown()?)
    }

    /// The step that the one on the screen is compared with.
    pub fn compared(&self) -> Option<&Arc<Outcome>> {
        self.timeline().outcome(self.timeline().compared()?)
    }

    /// Changes whenever another step is on the screen, or none any more.
    pub fn outcome_revision(&self) -> u64 {
        self.solving.outcome_revision
    }

    /// When a run that goes on by itself comes to rest.
    pub fn stop_conditions(&self) -> StopConditions {
        self.solving.stop_conditions()
    }

    /// Whether a run takes steps in the background.
    pub fn is_running(&self) -> bool {
        self.solving.is_running()
    }

    /// Why the run is at rest, where that is not because of a person's wish.
    pub fn stopped(&self) -> Option<Stop> {
        let solving = &self.solving;
        solving.stop.reason(solving.newest()?, solving.ending).filter(|_| !self.is_running())
    }
}
