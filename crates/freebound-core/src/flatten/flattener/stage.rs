//! What a stage is: from the latest step to a candidate, or to a reason why there is none.

use std::sync::Arc;

use super::task::Task;
use super::{Candidate, Ending, Step};
use crate::mesh::{DiskMesh, FaceId, Refinement};
use crate::problem::{Control, Embedding, Pins, SolveError};

pub(super) trait RunStage: std::fmt::Debug + Send {
    /// The next candidate. A step that is cancelled leaves the stage as it was.
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure>;

    /// Whether it has another step, on the way to what is asked for.
    fn has_more(&self, task: &Task, latest: Option<&StepState>) -> bool;

    /// Whether it is to be taken to its end before anything follows, even where it is solved already.
    fn improves(&self) -> bool {
        false
    }

    /// Takes in a step, its own or one of another stage of the same phase.
    fn observe(&mut self, _step: &Step) {}

    /// Rounds of relaxing that follow a step of its own, where nobody says how many.
    fn relax_rounds_after(&self, _task: &Task, _step: &Step) -> usize {
        0
    }

    /// Why the flattener ends where this was its last stage.
    fn ending(&self, _task: &Task) -> Ending {
        Ending::Done
    }
}

/// Goal of a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PhaseGoal {
    /// The request: planar, with the constraints met.
    Constraints,
    /// A planar embedding without the constraints, for the next phase to begin with.
    PlanarStart,
}

/// Start of a step.
#[derive(Clone, Copy)]
pub(super) struct StageInput<'a> {
    /// What the phase of the strategy is asked for.
    pub(super) task: &'a Task,
    pub(super) mesh: &'a DiskMesh,
    /// The latest step of the same phase of the strategy; of the phase before, where that leads here.
    pub(super) latest: Option<&'a StepState>,
}

/// Share of its phase's goal that a step has reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Attained {
    /// Not the goal.
    Nothing,
    /// Planar, but not at the targets of up to two pins: the coordinates there would fold faces.
    AllButPlace,
    /// The goal, but polygons are concave.
    AllButPolygons,
    /// The goal.
    Goal,
}

impl StepState {
    /// True if the step is the goal of its phase.
    pub(super) fn is_solved(&self) -> bool {
        self.attained == Attained::Goal
    }
}

/// Facts about the latest step that later stages need.
#[derive(Debug)]
pub(super) struct StepState {
    pub(super) embedding: Embedding,
    /// Start of the next stage, where it is not this step.
    pub(super) onward: Option<Embedding>,
    /// The pins in force.
    pub(super) pins: Pins,
    pub(super) has_simple_boundary: bool,
    pub(super) is_one_to_one: bool,
    pub(super) attained: Attained,
    /// Concave polygons, by their first faces.
    pub(super) concave_polygons: Vec<FaceId>,
    /// The mesh with new vertices that it is of.
    pub(super) refinement: Option<Arc<Refinement>>,
}

#[derive(Debug)]
pub(super) struct StageFailure {
    pub(super) error: SolveError,
    /// For the next sequence, where the failure is not the end.
    pub(super) handover: Option<Handover>,
}

/// What a stage without a candidate hands on.
#[derive(Debug, Default)]
pub(super) struct Handover {
    /// Why there was none.
    pub(super) note: Option<String>,
    /// Start of the next stage, where it is not the latest step.
    pub(super) embedding: Option<Embedding>,
}

impl From<SolveError> for StageFailure {
    fn from(error: SolveError) -> Self {
        Self { error, handover: None }
    }
}

impl StageFailure {
    /// A failure that other stages may make good.
    pub(super) fn of(what: &str, error: SolveError) -> Self {
        if error == SolveError::Cancelled {
            return error.into();
        }
        let note = Some(format!("{what} gave nothing: {error}"));
        Self { error, handover: Some(Handover { note, embedding: None }) }
    }

    /// The same of a stage that is tried where it may serve: that it did not is nothing to say.
    pub(super) fn in_silence(error: SolveError) -> Self {
        Self { error, handover: Some(Handover::default()) }
    }
}

/// What a stage found that is tried where it may serve; of its failures only the wish to stop counts.
pub(super) fn tried(found: Result<Option<Candidate>, SolveError>) -> Result<Option<Candidate>, SolveError> {
    match found {
        Err(SolveError::Cancelled) => Err(SolveError::Cancelled),
        found => Ok(found.ok().flatten()),
    }
}

/// Notes on the next step, each once.
#[derive(Debug, Default)]
pub(super) struct Notes(Vec<String>);

impl Notes {
    /// Adds a note, if there is one.
    pub(super) fn say(&mut self, note: impl Into<Option<String>>) {
        self.0.extend(note.into().filter(|note| !self.0.contains(note)));
    }

    /// All of them as one line.
    pub(super) fn take(&mut self) -> Option<String> {
        (!self.0.is_empty()).then(|| std::mem::take(&mut self.0).join("; "))
    }
}
