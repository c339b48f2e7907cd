//! The layout that a ladder was given to start from, as it is: its first step.

use std::time::Instant;

use super::Candidate;
use super::rung::{Failure, Footing, Latest, Rung};
use super::task::Task;
use crate::solver::{Control, Method, Pins, SolveError};

#[derive(Debug, Default)]
pub(super) struct Given;

impl Rung for Given {
    fn step(&mut self, from: Footing<'_>, _: Control<'_>) -> Result<Candidate, Failure> {
        let began = Instant::now();
        let start = from.task.start.as_ref().ok_or(SolveError::NotPlanar)?;
        let pins = if from.task.is_constrained() { from.task.held() } else { Pins::new() };
        Ok(Candidate::one_to_one(Method::Given, start.as_ref().clone(), &pins).since(began))
    }

    fn has_more(&self, task: &Task, latest: Option<&Latest>) -> bool {
        task.start.is_some() && latest.is_none()
    }
}
