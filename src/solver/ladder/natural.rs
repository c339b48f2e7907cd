//! Rung 1: one linear solve, by the method that was asked for; in a ladder the natural boundary (paper §3.3).

use std::sync::Arc;

use super::Candidate;
use super::rung::{Failure, Footing, Latest, Rung};
use super::task::Task;
use crate::solver::{Control, Method, Prepared, SolveError};

#[derive(Debug)]
pub(super) struct Natural {
    task: Arc<Task>,
    /// Equations and factors, kept from an earlier solve or made by this one.
    prepared: Option<Arc<Prepared>>,
}

impl Natural {
    pub(super) fn new(task: Arc<Task>, prepared: Option<Arc<Prepared>>) -> Self {
        Self { task, prepared }
    }
}

impl Rung for Natural {
    fn step(&mut self, from: Footing<'_>, control: Control<'_>) -> Result<Candidate, Failure> {
        let Task { settings, pins } = &*self.task;
        let prepared = match self.prepared.take().filter(|prepared| prepared.serves(settings, pins)) {
            Some(prepared) => prepared,
            None => Arc::new(Prepared::new(from.mesh, settings, pins, control).map_err(failure)?),
        };
        self.prepared = Some(Arc::clone(&prepared));
        let solution = prepared.solve(from.mesh, pins, control).map_err(failure)?;
        let rung = match settings.method {
            Method::Auto | Method::Iterate | Method::VirtualBoundary => Method::Natural,
            other => other,
        };
        Ok(Candidate { prepared: Some(prepared), ..Candidate::new(rung, settings.family, solution) })
    }

    fn has_more(&self, latest: Option<&Latest>) -> bool {
        latest.is_none()
    }
}

/// Other rungs may make good what is wrong with the system, but not what the user got wrong.
fn failure(error: SolveError) -> Failure {
    match error {
        SolveError::Singular { .. } | SolveError::ResidualTooLarge { .. } | SolveError::Linear { .. } => {
            Failure::of("the natural boundary", error)
        }
        other => other.into(),
    }
}
