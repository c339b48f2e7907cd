//! Stage 2: mean-value iterations (paper §4), until they no longer improve or reach their maximum number.

use super::stage::{RunStage, StageFailure, StageInput, StepState};
use super::task::{Task, gauge_in};
use super::{Candidate, Ending, Step};
use crate::linear::Iteration;
use crate::problem::{Control, Family, Method, SolveError, Stage};

/// Most iterations of a flattener that has other methods for the constraints.
const ITERATIONS_WITH_CONSTRAINTS: usize = 8;

/// Steps without an improvement after which an iteration that hardly moves has stalled.
const PATIENCE: usize = 5;

/// Steps without an improvement after which an iteration has stalled although it moves: it cycles.
const LONG_PATIENCE: usize = 12;

/// Largest move of a vertex that counts as hardly any, as a share of the embedding's diameter.
const STILL: f64 = 1e-3;

/// Ratio of defects to the fewest defects so far above which a step counts as slow.
const SLOW: f64 = 0.9;

#[derive(Debug, Default)]
pub(super) struct Iterate {
    iteration: Option<Iteration>,
    /// Improvement of the steps since the last linear solve.
    stall: Stall,
    /// Number of iterations since the last linear solve.
    taken: usize,
}

impl Iterate {
    /// Reason why further iterations are useless, if they are.
    fn end(&self, task: &Task) -> Option<Ending> {
        // With constraints the iteration seldom meets them, and continuation always starts from scratch.
        let gives_way = task.settings.method == Method::Auto && task.is_constrained();
        let is_enough = gives_way && (self.stall.is_slow || self.taken >= ITERATIONS_WITH_CONSTRAINTS);
        if is_enough || self.stall.is_reached() {
            Some(Ending::Stalled)
        } else {
            (self.taken >= task.settings.max_steps()).then_some(Ending::Limit)
        }
    }

    fn iterated(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, SolveError> {
        let StageInput { task, mesh, latest } = from;
        let Some(latest) = latest else { return Err(SolveError::Cancelled) };
        let Task { settings, pins: asked, .. } = task;
        let pins = if latest.pins.len() >= 2 { latest.pins.clone() } else { gauge_in(mesh, &latest.embedding) };
        if self.iteration.as_ref().is_none_or(|iteration| !iteration.serves(&pins)) {
            let treatment = settings.treatment_on(&Stage::Iterate, asked.len());
            self.iteration = Some(Iteration::new(mesh, &latest.embedding, &pins, treatment, control)?);
        }
        let iteration = self.iteration.as_mut().expect("made above");
        let mut solution = iteration.step(mesh, &latest.embedding, control)?;
        if self.taken == 0 {
            solution.seconds.analyze = iteration.analyze_seconds();
        }
        Ok(Candidate::new(Stage::Iterate, Family::MeanValue, solution))
    }
}

impl RunStage for Iterate {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        self.iterated(from, control).map_err(|error| StageFailure::of("the iteration", error))
    }

    fn has_more(&self, task: &Task, latest: Option<&StepState>) -> bool {
        latest.is_some() && self.end(task).is_none()
    }

    fn observe(&mut self, step: &Step) {
        match step.candidate.stage {
            Stage::Iterate => self.taken += 1,
            Stage::Relax => {}
            // A linear solve restarts the count of iterations.
            _ => (self.stall, self.taken) = (Stall::default(), 0),
        }
        if step.candidate.stage != Stage::Iterate {
            // The factors of the iteration need as much memory as those of a later stage.
            self.iteration = None;
        }
        self.stall.observe(step);
    }

    fn ending(&self, task: &Task) -> Ending {
        self.end(task).unwrap_or(Ending::Done)
    }
}

/// Improvement of the steps.
#[derive(Debug, Default)]
struct Stall {
    best: Option<usize>,
    steps_since: usize,
    is_still: bool,
    /// True if the last step has hardly fewer defects than the best one before it, or no fewer.
    is_slow: bool,
}

impl Stall {
    fn observe(&mut self, step: &Step) {
        let count = step.verdict.defect_count();
        self.is_slow = self.best.is_some_and(|best| count as f64 > SLOW * best as f64);
        if self.best.is_none_or(|best| count < best) {
            self.best = Some(count);
            self.steps_since = 0;
        } else {
            self.steps_since += 1;
        }
        let limit = STILL * step.candidate.solution.embedding.bounds().diameter();
        self.is_still = step.max_move.is_some_and(|moved| moved <= limit);
    }

    fn is_reached(&self) -> bool {
        self.steps_since >= LONG_PATIENCE || (self.steps_since >= PATIENCE && self.is_still)
    }
}
