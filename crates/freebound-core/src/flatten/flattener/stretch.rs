//! Stretch minimising: a sequence of solves, each of less stretch.
//!
//! Each step already computes the solve after it. If that solve has no less stretch, the step is the last, and its
//! note tells.

use std::mem;

use super::stage::{RunStage, StageFailure, StageInput, StepState};
use super::task::Task;
use super::{Candidate, Ending};
use crate::linear::{LessStretched, StretchMinimising};
use crate::problem::{BoundaryShape, Control, Family, Solution, SolveError, Stage, fixed_pins};

/// Least relative decrease of the stretch that is not mere rounding.
const LEAST_FALL: f64 = 1e-9;

#[derive(Debug, Default)]
pub(super) struct Stretch {
    run: Option<Run>,
}

/// Run of the minimisation.
#[derive(Debug)]
struct Run {
    shape: BoundaryShape,
    minimising: StretchMinimising,
    next: Next,
    /// Number of solves after the first.
    taken: usize,
}

/// Next step.
#[derive(Debug)]
enum Next {
    Solved(Box<LessStretched>),
    /// No solve has less stretch.
    Minimum,
    /// Maximum number of solves reached.
    Limit,
}

impl Run {
    fn begin(from: StageInput<'_>, shape: BoundaryShape, control: Control<'_>) -> Result<Self, SolveError> {
        let minimising = StretchMinimising::new(from.mesh, &shape, from.task.settings.spacing, control)?;
        let first = minimising.first(from.mesh, control)?;
        Ok(Self { shape, minimising, next: Next::Solved(Box::new(first)), taken: 0 })
    }

    /// Next step after a solve, with a note.
    fn outlook(
        &self,
        solved: &LessStretched,
        from: StageInput<'_>,
        control: Control<'_>,
    ) -> Result<(Next, String), SolveError> {
        let stretch = format!("L² stretch {:.6}", solved.stretch);
        if !solved.stretch.is_finite() {
            let why = "a face has no area, so its stretch is undefined";
            return Ok((Next::Minimum, format!("L² stretch infinite: {why}")));
        }
        if self.taken >= from.task.settings.max_steps() {
            return Ok((Next::Limit, format!("{stretch}: solve limit reached")));
        }
        match self.minimising.after(solved, from.mesh, control) {
            Err(SolveError::Cancelled) => Err(SolveError::Cancelled),
            Err(error) => Ok((Next::Minimum, format!("{stretch}: the next solve failed: {error}"))),
            Ok(after) if after.stretch < (1.0 - LEAST_FALL) * solved.stretch => {
                Ok((Next::Solved(Box::new(after)), stretch))
            }
            Ok(after) => {
                Ok((Next::Minimum, format!("{stretch}, the minimum: the next solve would give {:.6}", after.stretch)))
            }
        }
    }

    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, SolveError> {
        let Next::Solved(solved) = &self.next else { return Err(SolveError::Cancelled) };
        let (next, note) = self.outlook(solved, from, control)?;
        let Next::Solved(solved) = mem::replace(&mut self.next, next) else { unreachable!("it was matched above") };
        self.taken += 1;
        let LessStretched { embedding, linear, seconds, .. } = *solved;
        let pins = fixed_pins(self.minimising.places.keys().map(|&vertex| (vertex, embedding[vertex])));
        let solution =
            Solution { embedding, pins, gauge_completed: true, linear: Some(linear), convergence: None, seconds };
        let stage = Stage::Stretch(self.shape.clone());
        Ok(Candidate { note: Some(note), ..Candidate::new(stage, Family::MeanValue, solution) })
    }
}

impl RunStage for Stretch {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        let shape = from.task.settings.method.boundary_shape().cloned().unwrap_or_default();
        let run = match &mut self.run {
            Some(run) => run,
            none => none.insert(Run::begin(from, shape, control)?),
        };
        Ok(run.step(from, control)?)
    }

    fn has_more(&self, _: &Task, latest: Option<&StepState>) -> bool {
        self.run.as_ref().map_or(latest.is_none(), |run| matches!(run.next, Next::Solved(_)))
    }

    fn improves(&self) -> bool {
        self.run.as_ref().is_some_and(|run| matches!(run.next, Next::Solved(_)))
    }

    fn ending(&self, _: &Task) -> Ending {
        let is_at_limit = self.run.as_ref().is_some_and(|run| matches!(run.next, Next::Limit));
        if is_at_limit { Ending::Limit } else { Ending::Done }
    }
}
