//! SLIM: Tutte's map on a circle, then one iteration per step. If rounding folds Tutte's map, the flattener computes a
//! planar map first, and the iterations start from that.

use std::time::Instant;

use super::stage::{Notes, RunStage, StageFailure, StageInput, StepState};
use super::task::Task;
use super::{Candidate, Ending, Flattener};
use crate::flatten::tutte::tutte;
use crate::mesh::DiskMesh;
use crate::nonlinear::slim::Slim;
use crate::problem::{BoundaryShape, Control, Embedding, Pins, Settings, SolveError, Stage};

/// Least relative gain of an iteration that is followed by another.
const TOLERANCE: f64 = 1e-6;

#[derive(Debug, Default)]
pub(super) struct Iterations {
    run: Option<Run>,
}

#[derive(Debug)]
struct Run {
    stage: SlimPhase,
    taken: usize,
    end: Option<End>,
    /// Notes on the next candidate.
    notes: Notes,
}

#[derive(Debug)]
enum SlimPhase {
    /// The flattener computes a planar map.
    Start(Box<Flattener>),
    Iterations(Box<Slim>),
}

/// Reason why no iteration follows.
#[derive(Debug)]
enum End {
    /// Maximum number of iterations reached.
    Limit,
    /// Further iterations are useless.
    Done,
}

impl Run {
    /// First step, and the run that continues from it.
    fn begin(from: StageInput<'_>, control: Control<'_>) -> Result<(Self, Candidate), SolveError> {
        let start = SlimPhase::Start(Box::new(to_planar_map(from.task)));
        let mut run = Self { stage: start, taken: 0, end: None, notes: Notes::default() };
        let tutte = match tutte(from.mesh, control) {
            Err(error) if error.is_failure_of_method() => Err(format!("Tutte's map failed ({error})")),
            other => Ok(other?),
        };
        let why = match tutte {
            Err(why) => why,
            Ok((solution, family)) => {
                run.look_for_start(from.mesh, &solution.embedding, control)?;
                if matches!(run.stage, SlimPhase::Start(_)) {
                    run.notes.say("rounding collapses or folds faces of Tutte's map".to_owned());
                }
                let candidate = Candidate::new(Stage::Convex(BoundaryShape::Circle), family, solution);
                let candidate = run.described(candidate, from.task);
                return Ok((run, candidate));
            }
        };
        run.notes.say(why);
        let candidate = run.step(from, control)?;
        Ok((run, candidate))
    }

    /// Starts the iterations if an embedding is a valid start.
    fn look_for_start(
        &mut self,
        mesh: &DiskMesh,
        embedding: &Embedding,
        control: Control<'_>,
    ) -> Result<(), SolveError> {
        match Slim::new(mesh, embedding, control) {
            Ok(slim) => self.stage = SlimPhase::Iterations(Box::new(slim)),
            Err(SolveError::NotPlanar) => {}
            Err(error) => return Err(error),
        }
        Ok(())
    }

    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, SolveError> {
        let candidate = match &mut self.stage {
            SlimPhase::Start(flattener) => {
                let step = flattener.step(from.mesh, control)?;
                let is_end = flattener.ending().is_some();
                if step.verdict.is_one_to_one() {
                    self.look_for_start(from.mesh, &step.candidate.solution.embedding, control)?;
                }
                if is_end && matches!(self.stage, SlimPhase::Start(_)) {
                    self.end = Some(End::Done);
                    self.notes.say("SLIM cannot start: no planar map was found".to_owned());
                }
                // Later solves by SLIM cannot reuse the factors.
                Candidate { prepared: None, ..step.candidate }
            }
            SlimPhase::Iterations(slim) => {
                let began = Instant::now();
                if let Some(reason) = why_last(slim.step(control))? {
                    self.end = Some(End::Done);
                    self.notes.say(format!("the last iteration{reason}"));
                }
                self.taken += 1;
                Candidate::one_to_one(Stage::Slim, slim.embedding(), &Pins::new()).since(began)
            }
        };
        Ok(self.described(candidate, from.task))
    }

    /// Candidate with its progress and notes.
    fn described(&mut self, candidate: Candidate, task: &Task) -> Candidate {
        self.notes.say(candidate.note);
        let mut progress = candidate.progress;
        if let SlimPhase::Iterations(slim) = &self.stage {
            progress = Some(slim.progress());
            if self.end.is_none() && self.taken >= task.settings.max_steps() {
                self.end = Some(End::Limit);
                self.notes.say(format!("the last of {} iterations: limit reached", self.taken));
            }
        }
        Candidate { progress, note: self.notes.take(), ..candidate }
    }
}

/// Flattener without pins, up to its first planar map: SLIM lowers the distortion itself.
fn to_planar_map(task: &Task) -> Flattener {
    let settings =
        Settings { size: task.settings.size, relax_rounds: Some(0), new_vertices: false, ..Settings::default() };
    Flattener::new(settings, Pins::new())
}

/// Reason why an iteration is the last, if it is.
fn why_last(gain: Result<Option<f64>, SolveError>) -> Result<Option<String>, SolveError> {
    Ok(match gain {
        Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
        Err(error) => Some(format!(": the next direction cannot be computed: {error}")),
        Ok(None) => Some(": no step lowers the energy".to_owned()),
        Ok(Some(gain)) if gain < TOLERANCE => Some(format!(": it lowered the energy by less than {TOLERANCE:.0e}")),
        Ok(Some(_)) => None,
    })
}

impl RunStage for Iterations {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        if let Some(run) = &mut self.run {
            return Ok(run.step(from, control)?);
        }
        let (run, candidate) = Run::begin(from, control)?;
        self.run = Some(run);
        Ok(candidate)
    }

    fn has_more(&self, _: &Task, latest: Option<&StepState>) -> bool {
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
