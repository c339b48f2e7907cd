//! SLIM: Tutte's map on a circle, then one iteration a step.

use std::time::Instant;

use super::rung::{Failure, Footing, Latest, Rung};
use super::task::Task;
use super::{Candidate, Ending};
use crate::solver::slim::{Slim, tutte};
use crate::solver::{BoundaryShape, Control, Method, Pins, SolveError};

/// An iteration that gains a smaller share of the energy is the last.
const TOLERANCE: f64 = 1e-6;

#[derive(Debug, Default)]
pub(super) struct Iterations {
    run: Option<Run>,
}

#[derive(Debug)]
struct Run {
    /// None where the start is folded.
    slim: Option<Slim>,
    taken: usize,
    end: Option<End>,
}

/// Why no iteration follows.
#[derive(Debug)]
enum End {
    /// As many as allowed.
    Limit,
    /// There is no sense in going on, for this reason.
    Reason(String),
}

impl Run {
    /// The first step, and the run that goes on from it.
    fn begin(from: Footing<'_>, control: Control<'_>) -> Result<(Self, Candidate), SolveError> {
        let (solution, family) = tutte(from.mesh, control)?;
        let mut run = match Slim::new(from.mesh, &solution.embedding) {
            Ok(slim) => Self { slim: Some(slim), taken: 0, end: None },
            Err(SolveError::NotPlanar) => {
                let reason = "SLIM cannot begin: rounding leaves faces of Tutte's map without area, or folded";
                Self { slim: None, taken: 0, end: Some(End::Reason(reason.to_owned())) }
            }
            Err(error) => return Err(error),
        };
        run.look_at_limit(from.task);
        let progress = run.slim.as_ref().map(Slim::progress);
        let candidate = Candidate::new(Method::Convex(BoundaryShape::Circle), family, solution);
        let candidate = Candidate { progress, note: run.note(), ..candidate };
        Ok((run, candidate))
    }

    fn iterate(&mut self, task: &Task, control: Control<'_>) -> Result<Candidate, SolveError> {
        let began = Instant::now();
        let slim = self.slim.as_mut().ok_or(SolveError::NotPlanar)?;
        let reason = match slim.step(control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            Err(error) => Some(format!("the last iteration, for the next direction cannot be computed: {error}")),
            Ok(None) => Some("the last iteration: no step lowers the energy any more".to_owned()),
            Ok(Some(gain)) if gain < TOLERANCE => {
                Some(format!("the last iteration: it gained less than {TOLERANCE:.0e} of the energy"))
            }
            Ok(Some(_)) => None,
        };
        let progress = Some(slim.progress());
        let candidate = Candidate::one_to_one(Method::Slim, slim.embedding(), &Pins::new()).since(began);
        self.taken += 1;
        self.end = reason.map(End::Reason);
        self.look_at_limit(task);
        Ok(Candidate { progress, note: self.note(), ..candidate })
    }

    fn look_at_limit(&mut self, task: &Task) {
        if self.end.is_none() && self.taken >= task.settings.max_steps() {
            self.end = Some(End::Limit);
        }
    }

    fn note(&self) -> Option<String> {
        match self.end.as_ref()? {
            End::Limit => Some(format!("the last of {} iterations, as many as it may take", self.taken)),
            End::Reason(reason) => Some(reason.clone()),
        }
    }
}

impl Rung for Iterations {
    fn step(&mut self, from: Footing<'_>, control: Control<'_>) -> Result<Candidate, Failure> {
        if let Some(run) = &mut self.run {
            return Ok(run.iterate(from.task, control)?);
        }
        let (run, candidate) = Run::begin(from, control)?;
        self.run = Some(run);
        Ok(candidate)
    }

    fn has_more(&self, _: &Task, latest: Option<&Latest>) -> bool {
        self.run.as_ref().map_or(latest.is_none(), |run| run.end.is_none())
    }

    fn improves(&self) -> bool {
        self.run.as_ref().is_some_and(|run| run.end.is_none())
    }

    fn ending(&self, _: &Task) -> Ending {
        let is_at_limit = self.run.as_ref().is_some_and(|run| matches!(run.end, Some(End::Limit)));
        if is_at_limit { Ending::Limit } else { Ending::Done }
    }
}
