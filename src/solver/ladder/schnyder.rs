//! The end of rung 3: Schnyder's grid drawing, planar by theorem where every linear solve runs out of digits.

use std::time::Instant;

use super::rung::{Failure, Footing, Latest, Rung};
use super::task::Task;
use super::{Candidate, Step};
use crate::solver::{Control, Method, Pins, schnyder};

/// Rounds of relaxing after the drawing, whose faces are far from their shapes.
const ROUNDS: usize = 100;

/// The drawing: one step.
#[derive(Debug, Default)]
pub(super) struct Draw {
    is_done: bool,
}

impl Rung for Draw {
    fn step(&mut self, from: Footing<'_>, _: Control<'_>) -> Result<Candidate, Failure> {
        let began = Instant::now();
        self.is_done = true;
        Ok(Candidate::one_to_one(Method::Schnyder, schnyder(from.mesh), &Pins::new()).since(began))
    }

    fn has_more(&self, _: &Task, _: Option<&Latest>) -> bool {
        !self.is_done
    }

    fn relax_rounds_after(&self, _: &Task, _: &Step) -> usize {
        ROUNDS
    }
}
