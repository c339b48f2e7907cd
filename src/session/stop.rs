//! Stop conditions of a run.

use freebound_core::flatten::Ending;
use freebound_core::pipeline::Outcome;

/// Stop conditions of a run. A run always stops if its method has no further step or has reached its step limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StopConditions {
    /// True to stop if the embedding is proved planar.
    pub planar: bool,
    /// True to stop if the iteration no longer improves.
    pub stalled: bool,
    /// True to stop if the boundary crosses itself.
    pub crossing: bool,
    /// Index of the step to stop at.
    pub at_step: Option<usize>,
}

impl Default for StopConditions {
    fn default() -> Self {
        Self { planar: true, stalled: true, crossing: false, at_step: None }
    }
}

/// Reason for the stop of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunStop {
    /// The run has ended by itself.
    Ended(Ending),
    /// The boundary crosses itself.
    Crossing,
    /// The run has reached the step to stop at.
    AtStep,
}

impl RunStop {
    /// Text for the screen.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Ended(Ending::Planar) => "planar",
            Self::Ended(Ending::Done) => "the method has no further step",
            Self::Ended(Ending::Unmet) => "constraints cannot be met without new vertices",
            Self::Ended(Ending::Stalled) => "stalled: no further improvement",
            Self::Ended(Ending::Limit) => "the step limit is reached",
            Self::Crossing => "the boundary crosses itself",
            Self::AtStep => "the chosen step is reached",
        }
    }
}

impl StopConditions {
    /// Reason for a stop after a step, if there is one. `ending` is the run's ending after this step.
    pub fn reason(&self, outcome: &Outcome, ending: Option<Ending>) -> Option<RunStop> {
        self.reason_for_good(outcome, ending)
            .or_else(|| {
                (self.crossing && !outcome.step.verdict.boundary_crossings.is_empty()).then_some(RunStop::Crossing)
            })
            .or_else(|| (self.at_step == Some(outcome.step.index)).then_some(RunStop::AtStep))
    }

    /// Reason for a stop after a step that holds however often the run is continued.
    pub fn reason_for_good(&self, outcome: &Outcome, ending: Option<Ending>) -> Option<RunStop> {
        // If the ending is ignored, the number of steps is the only remaining limit.
        let beyond = (outcome.step.index >= outcome.problem.settings.max_steps()).then_some(Ending::Limit);
        let ending = match ending? {
            Ending::Planar if !self.planar => beyond,
            Ending::Stalled if !self.stalled => beyond,
            ending => Some(ending),
        };
        ending.map(RunStop::Ended)
    }
}

/// Goal of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Goal {
    /// Number of further steps.
    Steps(usize),
    /// Continue until a stop condition holds.
    Until(StopConditions),
    /// Continue until the run has ended by itself.
    End,
}

impl Goal {
    /// True if the run has reached its goal with this step.
    pub(super) fn is_reached(&self, outcome: &Outcome, ending: Option<Ending>) -> bool {
        match self {
            Self::Steps(left) => *left == 0,
            Self::Until(conditions) => conditions.reason(outcome, ending).is_some(),
            Self::End => ending.is_some(),
        }
    }
}
