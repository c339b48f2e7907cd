//! Lee's virtual boundary: layers around the mesh on a convex shape, one solve, peeled.

use std::sync::Arc;

use super::Candidate;
use super::rung::{Failure, Footing, Latest, Rung};
use super::task::Task;
use crate::solver::{Control, Padded};

/// The solve: one step.
#[derive(Debug, Default)]
pub(super) struct Pad {
    is_done: bool,
}

impl Rung for Pad {
    fn step(&mut self, from: Footing<'_>, control: Control<'_>) -> Result<Candidate, Failure> {
        let settings = &from.task.settings;
        let padded = Padded::new(from.mesh, settings.layers);
        let (solution, outside) = padded.solve(settings, control)?;
        self.is_done = true;
        let candidate = Candidate::new(settings.method, settings.family(), solution);
        Ok(Candidate { outside: Some(Arc::new(outside)), ..candidate })
    }

    fn has_more(&self, _: &Task, latest: Option<&Latest>) -> bool {
        !self.is_done && latest.is_none()
    }
}
