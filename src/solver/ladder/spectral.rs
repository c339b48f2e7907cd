//! The spectral conformal map: one step, which no pin has a part in.

use super::Candidate;
use super::rung::{Failure, Footing, Latest, Rung};
use super::task::Task;
use crate::solver::{Control, Family, Method, Spectral, spectral};

#[derive(Debug, Default)]
pub(super) struct Eigenvector {
    is_done: bool,
}

impl Rung for Eigenvector {
    fn step(&mut self, from: Footing<'_>, control: Control<'_>) -> Result<Candidate, Failure> {
        let Spectral { solution, eigenvalue } = spectral(from.mesh, control)?;
        self.is_done = true;
        let note = solution
            .convergence
            .map(|found| format!("eigenvalue {eigenvalue:.3e} after {} solves: {}", found.steps, found.stop.words()));
        Ok(Candidate { note, ..Candidate::new(Method::Spectral, Family::default(), solution) })
    }

    fn has_more(&self, _: &Task, _: Option<&Latest>) -> bool {
        !self.is_done
    }
}
