//! Rung 1: one linear solve, by the method that was asked for; in a ladder the natural boundary (paper §3.3).

use std::sync::Arc;

use super::Candidate;
use super::rung::{Failure, Footing, Latest, Rung};
use super::task::Task;
use crate::solver::{Control, Method, Prepared, SolveError};

#[derive(Debug)]
pub(super) struct Natural {
    /// Equations and factors, kept from an earlier solve, or made by a step that came to no end.
    pub(super) prepared: Option<Arc<Prepared>>,
}

impl Rung for Natural {
    fn step(&mut self, from: Footing<'_>, control: Control<'_>) -> Result<Candidate, Failure> {
        let Task { settings, pins, .. } = from.task;
        let prepared = match self.prepared.take().filter(|prepared| prepared.serves(settings, pins)) {
            Some(prepared) => prepared,
            None => Arc::new(Prepared::new(from.mesh, settings, pins, control).map_err(failure)?),
        };
        let solved = prepared.solve_unplaced(from.mesh, pins, control);
        if solved.is_err() {
            self.prepared = Some(Arc::clone(&prepared));
        }
        let solution = solved.map_err(failure)?;
        let rung = match settings.method {
            Method::Auto | Method::Iterate | Method::VirtualBoundary => Method::Natural,
            other => other,
        };
        Ok(Candidate { prepared: Some(prepared), ..Candidate::new(rung, settings.family(), solution) })
    }

    fn has_more(&self, _: &Task, latest: Option<&Latest>) -> bool {
        latest.is_none()
    }
}

/// Other rungs may make good what is wrong with the system, but not what the user got wrong.
fn failure(error: SolveError) -> Failure {
    if error.is_failure_of_method() { Failure::of("the natural boundary", error) } else { error.into() }
}
