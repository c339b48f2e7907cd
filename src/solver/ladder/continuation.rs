//! Rung 4: one-to-one on the way to the constraints.

use std::sync::Arc;
use std::time::Instant;

use super::rung::{Failure, Footing, Latest, Rung, WayOn};
use super::task::Task;
use super::{Candidate, Ending, Step};
use crate::solver::continuation::Continuation;
use crate::solver::{Control, Method, SolveError};

/// Rounds of relaxing that follow: the first answer is not the best. More where springs have yet to pull.
const ROUNDS_AFTER_CONTINUATION: usize = 3;
const ROUNDS_WITH_SPRINGS: usize = 30;

pub(super) fn relax_rounds_after_continuation(task: &Task) -> usize {
    if task.has_springs() { ROUNDS_WITH_SPRINGS } else { ROUNDS_AFTER_CONTINUATION }
}

#[derive(Debug)]
pub(super) struct Continue {
    task: Arc<Task>,
    stage: Stage,
}

#[derive(Debug)]
enum Stage {
    Begin,
    UnderWay(Box<Continuation>),
    /// No step leads nearer to the targets.
    Stuck,
}

impl Continue {
    pub(super) fn new(task: Arc<Task>) -> Self {
        Self { task, stage: Stage::Begin }
    }
}

impl Rung for Continue {
    fn step(&mut self, Footing { mesh, latest }: Footing<'_>, control: Control<'_>) -> Result<Candidate, Failure> {
        let (began, held) = (Instant::now(), self.task.held());
        if let Stage::Begin = self.stage {
            let start = latest.ok_or(SolveError::NotPlanar)?.embedding.clone();
            self.stage = Stage::UnderWay(Box::new(Continuation::new(mesh, start, &held)));
        }
        let Stage::UnderWay(continuation) = &mut self.stage else { return Err(SolveError::Unmet.into()) };
        match continuation.step(mesh, control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled.into()),
            Ok(Some(candidate)) => return Ok(candidate.since(began)),
            // What cannot be solved is stuck, too.
            Ok(None) | Err(_) => {}
        }
        let is_crushed = continuation.go_back_to_sound();
        let (embedding, progress) = (continuation.embedding().clone(), continuation.progress(mesh));
        self.stage = Stage::Stuck;
        if is_crushed && !self.task.adds_vertices() {
            let candidate = Candidate::one_to_one(Method::Continuation, embedding, &held).since(began);
            return Ok(Candidate { progress: Some(progress), ..candidate });
        }
        let way_on = WayOn { embedding: Some(embedding), ..WayOn::default() };
        Err(Failure { error: SolveError::Unmet, way_on: Some(way_on) })
    }

    fn has_more(&self, _: Option<&Latest>) -> bool {
        true
    }

    fn relax_rounds_after(&self, _: &Step) -> usize {
        relax_rounds_after_continuation(&self.task)
    }

    fn ending(&self) -> Ending {
        Ending::Unmet
    }
}
