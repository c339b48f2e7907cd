//! Rung 2: mean-value iterations (paper §4), until they get no better or are as many as allowed.

use std::sync::Arc;

use super::rung::{Failure, Footing, Latest, Rung};
use super::stall::Stall;
use super::task::Task;
use super::{Candidate, Ending, Step, gauge_in};
use crate::solver::scale::complete_gauge;
use crate::solver::{Control, Family, Iteration, Method, SolveError};

/// The most iterations of a ladder that has other ways to the constraints.
const ITERATIONS_WITH_CONSTRAINTS: usize = 8;

#[derive(Debug)]
pub(super) struct Iterate {
    task: Arc<Task>,
    iteration: Option<Iteration>,
    /// What has become of the steps since the last linear solve, and how many of them were iterations.
    stall: Stall,
    taken: usize,
}

impl Iterate {
    pub(super) fn new(task: Arc<Task>) -> Self {
        Self { task, iteration: None, stall: Stall::default(), taken: 0 }
    }

    /// Why there is no sense in going on.
    fn end(&self) -> Option<Ending> {
        // With constraints the iteration seldom arrives, and continuation always begins anew.
        let gives_way = self.task.settings.method == Method::Auto && self.task.is_constrained();
        let is_enough = gives_way && (self.stall.is_slow() || self.taken >= ITERATIONS_WITH_CONSTRAINTS);
        if is_enough || self.stall.is_reached() {
            Some(Ending::Stalled)
        } else {
            (self.taken >= self.task.settings.max_steps).then_some(Ending::Limit)
        }
    }

    fn iterated(
        &mut self,
        Footing { mesh, latest }: Footing<'_>,
        control: Control<'_>,
    ) -> Result<Candidate, SolveError> {
        let Some(latest) = latest else { return Err(SolveError::Cancelled) };
        let Task { settings, pins: asked } = &*self.task;
        let pins = if latest.pins.len() >= 2 { latest.pins.clone() } else { gauge_in(mesh, &latest.embedding) };
        if self.iteration.as_ref().is_none_or(|iteration| !iteration.serves(&pins)) {
            let treatment = settings.treatment_on(Method::Iterate, asked.len());
            self.iteration = Some(Iteration::new(mesh, &latest.embedding, &pins, treatment, control)?);
        }
        let iteration = self.iteration.as_ref().expect("made above");
        let mut solution = iteration.step(mesh, &latest.embedding, control)?;
        if self.taken == 0 {
            solution.seconds.analyze = iteration.analyze_seconds();
        }
        if self.task.has_open_gauge() {
            complete_gauge(mesh, &mut solution.embedding, asked, settings.size);
            solution.gauge_completed = true;
            for (vertex, pin) in &mut solution.pins {
                pin.target = solution.embedding[vertex];
            }
        }
        Ok(Candidate::new(Method::Iterate, Family::MeanValue, solution))
    }
}

impl Rung for Iterate {
    fn step(&mut self, from: Footing<'_>, control: Control<'_>) -> Result<Candidate, Failure> {
        self.iterated(from, control).map_err(|error| Failure::of("the iteration", error))
    }

    fn has_more(&self, latest: Option<&Latest>) -> bool {
        latest.is_some() && self.end().is_none()
    }

    fn look_at(&mut self, step: &Step) {
        match step.rung {
            Method::Iterate => self.taken += 1,
            Method::Relax => {}
            // A linear solve, from which iterations count anew.
            _ => (self.stall, self.taken) = (Stall::default(), 0),
        }
        self.stall.look_at(step);
    }

    fn ending(&self) -> Ending {
        self.end().unwrap_or(Ending::Done)
    }
}
