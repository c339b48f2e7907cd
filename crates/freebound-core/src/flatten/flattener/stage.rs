//! Interface of a stage: from the latest step to a candidate, or to the reason why there is none.

use std::sync::Arc;

use super::task::Task;
use super::{Candidate, Ending, Step};
use crate::mesh::{DiskMesh, FaceId, Refinement};
use crate::problem::{Control, Embedding, Pins, SolveError};

pub(super) trait RunStage: std::fmt::Debug + Send {
    /// Next candidate. A cancelled step leaves the stage unchanged.
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure>;

    /// True if the stage has another step towards the goal.
    fn has_more(&self, task: &Task, latest: Option<&StepState>) -> bool;

    /// True if the stage must finish before anything follows, even if the goal is reached.
    fn improves(&self) -> bool {
        false
    }

    /// Records a step of this stage or of another stage of the phase.
    fn observe(&mut self, _step: &Step) {}

    /// Default number of rounds of relaxing after a step of this stage.
    fn relax_rounds_after(&self, _task: &Task, _step: &Step) -> usize {
        0
    }

    /// Reason for the end of the flattener if this is its last stage.
    fn ending(&self, _task: &Task) -> Ending {
        Ending::Done
    }
}

/// Goal of a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PhaseGoal {
    /// The request: planar, with the constraints met.
    Constraints,
    /// Planar embedding without the constraints, from which the next phase starts.
    PlanarStart,
}

/// Start of a step.
#[derive(Clone, Copy)]
pub(super) struct StageInput<'a> {
    /// Request for the current phase of the strategy.
    pub(super) task: &'a Task,
    pub(super) mesh: &'a DiskMesh,
    /// Latest step of the current phase, or of the previous phase if that leads to this one.
    pub(super) latest: Option<&'a StepState>,
}

/// Part of its phase's goal that a step has reached.
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
    /// Start of the next stage, if that is not this step.
    pub(super) onward: Option<Embedding>,
    /// Active pins.
    pub(super) pins: Pins,
    pub(super) has_simple_boundary: bool,
    pub(super) is_one_to_one: bool,
    pub(super) attained: Attained,
    /// Concave polygons, by their first faces.
    pub(super) concave_polygons: Vec<FaceId>,
    /// Mesh with new vertices, if the embedding has such.
    pub(super) refinement: Option<Arc<Refinement>>,
}

#[derive(Debug)]
pub(super) struct StageFailure {
    pub(super) error: SolveError,
    /// Data for the next sequence, if the failure is not the end.
    pub(super) handover: Option<Handover>,
}

/// Data that a stage without a candidate passes on.
#[derive(Debug, Default)]
pub(super) struct Handover {
    /// Reason for the lack of a candidate.
    pub(super) note: Option<String>,
    /// Start of the next stage, if that is not the latest step.
    pub(super) embedding: Option<Embedding>,
}

impl From<SolveError> for StageFailure {
    fn from(error: SolveError) -> Self {
        Self { error, handover: None }
    }
}

impl StageFailure {
    /// Failure of a stage named `what` that other stages may replace.
    pub(super) fn of(what: &str, error: SolveError) -> Self {
        if error == SolveError::Cancelled {
            return error.into();
        }
        let note = Some(format!("{what} failed: {error}"));
        Self { error, handover: Some(Handover { note, embedding: None }) }
    }

    /// Failure of an optional stage, which needs no note.
    pub(super) fn in_silence(error: SolveError) -> Self {
        Self { error, handover: Some(Handover::default()) }
    }
}

/// Result of an optional stage. Every failure except cancellation means that there is no candidate.
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

    /// All notes as one line.
    pub(super) fn take(&mut self) -> Option<String> {
        (!self.0.is_empty()).then(|| std::mem::take(&mut self.0).join("; "))
    }
}
