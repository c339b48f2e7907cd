//! When a run that goes on by itself comes to rest.

use freebound_core::flatten::Ending;
use freebound_core::pipeline::Outcome;

/// At which steps a run comes to rest. Where its method has no further step, or has taken as many as it may, it always
/// does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StopConditions {
    /// Where the embedding is proved planar.
    pub planar: bool,
    /// Where the iteration gets no better.
    pub stalled: bool,
    /// Where the boundary crosses itself.
    pub crossing: bool,
    /// At this step.
    pub at_step: Option<usize>,
}

impl Default for StopConditions {
    fn default() -> Self {
        Self { planar: true, stalled: true, crossing: false, at_step: None }
    }
}

/// Why a run has come to rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunStop {
    /// It has come to its end.
    Ended(Ending),
    /// The boundary crosses itself.
    Crossing,
    /// The step that was asked for.
    AtStep,
}

impl RunStop {
    /// Words for the screen.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Ended(Ending::Planar) => "planar",
            Self::Ended(Ending::Done) => "the method has no further step",
            Self::Ended(Ending::Unmet) => "constraints cannot be met without new vertices",
            Self::Ended(Ending::Stalled) => "stalled: it gets no better",
            Self::Ended(Ending::Limit) => "the step limit is reached",
            Self::Crossing => "the boundary crosses itself",
            Self::AtStep => "the step to stop at is reached",
        }
    }
}

impl StopConditions {
    /// Why a run is at rest after a step, if it is. `ending` is what the run says after that step.
    pub fn reason(&self, outcome: &Outcome, ending: Option<Ending>) -> Option<RunStop> {
        self.reason_for_good(outcome, ending)
            .or_else(|| {
                (self.crossing && !outcome.step.verdict.boundary_crossings.is_empty()).then_some(RunStop::Crossing)
            })
            .or_else(|| (self.at_step == Some(outcome.step.index)).then_some(RunStop::AtStep))
    }

    /// The same for the reasons that hold however often the run is asked to go on.
    pub fn reason_for_good(&self, outcome: &Outcome, ending: Option<Ending>) -> Option<RunStop> {
        // Beyond the method's own ending the number of steps is the only limit that is left.
        let beyond = (outcome.step.index >= outcome.problem.settings.max_steps()).then_some(Ending::Limit);
        let ending = match ending? {
            Ending::Planar if !self.planar => beyond,
            Ending::Stalled if !self.stalled => beyond,
            ending => Some(ending),
        };
        ending.map(RunStop::Ended)
    }
}

/// How far a run is to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Goal {
    /// So many further steps.
    Steps(usize),
    /// Until one of these holds.
    Until(StopConditions),
    /// Until the run itself has come to its end.
    End,
}

impl Goal {
    /// Whether the run has gone far enough with this step.
    pub(super) fn is_reached(&self, outcome: &Outcome, ending: Option<Ending>) -> bool {
        match self {
            Self::Steps(left) => *left == 0,
            Self::Until(conditions) => conditions.reason(outcome, ending).is_some(),
            Self::End => ending.is_some(),
        }
    }
}
