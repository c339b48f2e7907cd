//! A run in the background, a run at rest, and how solving goes on.

use std::sync::Arc;
use std::sync::mpsc::Receiver;

use super::courier::{Delivery, Shared};
use crate::mesh::DiskMesh;
use crate::session::stop::Goal;
use crate::session::{Background, Problem};
use crate::solver::{Ladder, SolveError};

/// What is to be solved, and on which mesh.
#[derive(Clone, Debug)]
pub(in crate::session) struct Task {
    pub(in crate::session) mesh: Arc<DiskMesh>,
    pub(in crate::session) problem: Problem,
}

/// What a poll found that concerns others.
#[derive(Debug, Default)]
pub(in crate::session) struct News {
    /// Whether a run's first step has come in.
    pub(in crate::session) has_begun: bool,
    /// What is to be done now, with the problem as it is by then.
    pub(in crate::session) next: Option<Next>,
}

/// How solving goes on by itself.
#[derive(Clone, Copy, Debug)]
pub(in crate::session) enum Next {
    /// The problem is to be solved anew.
    Anew,
    /// The run is to be taken on.
    On(Goal),
}

/// A run with the steps that it takes in the background.
pub(super) struct Running {
    /// Gives the run back when it comes to rest.
    pub(super) job: Background<(), (Ladder, Result<(), SolveError>)>,
    pub(super) deliveries: Receiver<Delivery>,
    pub(super) shared: Arc<Shared>,
    pub(super) problem: Problem,
    /// Whether a step has come in.
    pub(super) has_delivered: bool,
    /// Once it was asked to pause: how far to go on after that; no step further, unless it was asked for.
    pub(super) paused: Option<Goal>,
}

/// A run at rest.
pub(super) struct Resting {
    pub(super) problem: Problem,
    pub(super) run: Ladder,
}

impl Running {
    /// Asks for another goal, after a pause where one was asked for.
    pub(super) fn set_goal(&mut self, change: impl FnOnce(Goal) -> Goal) {
        match &mut self.paused {
            Some(after) => *after = change(*after),
            None => self.shared.change_goal(change),
        }
    }

    /// Whether another problem only needs the first step again, with other targets of the same pins.
    pub(super) fn is_followed_by(&self, problem: &Problem) -> bool {
        self.paused.is_none() && !self.has_delivered && self.problem.differs_in_targets_alone(problem)
    }
}
