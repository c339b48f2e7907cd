//! A run in the background with what works there, a run at rest, and how solving goes on.

use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{Receiver, SyncSender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::session::stop::Goal;
use crate::session::{Background, Model, Wake};
use freebound_core::flatten::{Ending, Flattener};
use freebound_core::mesh::DiskMesh;
use freebound_core::pipeline::{Outcome, Problem};
use freebound_core::problem::{Control, Embedding, Phase, SolveError};

/// What is to be solved, and on which mesh.
#[derive(Clone, Debug)]
pub(in crate::session) struct Task {
    pub(in crate::session) model: Arc<Model>,
    pub(in crate::session) mesh: Arc<DiskMesh>,
    pub(in crate::session) problem: Problem,
    /// What to go on from; none where it is solved from scratch.
    pub(in crate::session) from: Option<Beginning>,
}

/// A planar embedding to go on from.
#[derive(Clone, Debug)]
pub(in crate::session) struct Beginning {
    pub(in crate::session) embedding: Arc<Embedding>,
    /// Whether it stays as it is where it meets all constraints.
    pub(in crate::session) stays: bool,
}

impl Beginning {
    /// A run that goes on from it.
    pub(super) fn begin(&self, run: Flattener) -> Flattener {
        if self.stays { run.warm_start(&self.embedding) } else { run.continue_from(&self.embedding) }
    }
}

/// What a poll found that concerns others.
#[derive(Debug, Default)]
pub(in crate::session) struct News {
    /// Whether a run's first step has come in.
    pub(in crate::session) has_begun: bool,
    /// How the run has come to rest, where it has and is to stay there.
    pub(in crate::session) rest: Option<StopReason>,
    /// Rounds of relaxing that it was asked for and has not come to.
    pub(in crate::session) rounds_cut: usize,
    /// What is to be done now, with the problem as it is by then.
    pub(in crate::session) next: Option<Next>,
}

/// How a run has come to rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::session) enum StopReason {
    /// It went on by itself until something held that stops it.
    ByItself,
    /// Where a person wanted it, or because of a fault.
    Elsewhere,
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
    pub(super) job: Background<(), (Flattener, Result<(), SolveError>)>,
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
    pub(super) run: Flattener,
}

impl Running {
    /// Asks for another goal, after a pause where one was asked for.
    pub(super) fn set_goal(&mut self, change: impl FnOnce(Goal) -> Goal) {
        if let Some(after) = &mut self.paused {
            *after = change(*after);
        } else {
            let mut goal = locked(&self.shared.goal);
            *goal = change(*goal);
        }
    }

    /// Whether it was asked to come to its end, or to a stop condition, and not to pause.
    pub(super) fn goes_on_by_itself(&self) -> bool {
        self.paused.is_none() && !matches!(self.shared.goal(), Goal::Steps(_))
    }

    /// Whether another problem only needs the first step again, with other targets of the same pins.
    pub(super) fn is_followed_by(&self, problem: &Problem) -> bool {
        self.paused.is_none() && !self.has_delivered && self.problem.differs_in_targets_alone(problem)
    }
}

/// A step on its way to the timeline.
pub(super) struct Delivery {
    pub(super) outcome: Arc<Outcome>,
    /// What the run says after this step.
    pub(super) ending: Option<Ending>,
}

/// What both ends know of a run under way.
pub(super) struct Shared {
    goal: Mutex<Goal>,
    /// What the background does.
    phase: Mutex<Option<Phase>>,
    wake: Wake,
}

impl Shared {
    pub(super) fn new(goal: Goal, wake: &Wake) -> Self {
        Self { goal: Mutex::new(goal), phase: Mutex::new(None), wake: Arc::clone(wake) }
    }

    /// How far the run is to go on.
    pub(super) fn goal(&self) -> Goal {
        *locked(&self.goal)
    }

    /// What the background does, once that is known.
    pub(super) fn phase(&self) -> Option<Phase> {
        *locked(&self.phase)
    }
}

/// Both are plain values: they are whole even where a thread died beside them.
fn locked<T>(value: &Mutex<T>) -> MutexGuard<'_, T> {
    value.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The background's end of a run: takes steps until the goal is reached, and hands each over. What nobody waits for any
/// more is given up.
pub(super) fn take_steps(
    run: &mut Flattener,
    Task { mesh, problem, .. }: &Task,
    shared: &Shared,
    deliveries: &SyncSender<Delivery>,
    cancel: &AtomicBool,
) -> Result<(), SolveError> {
    let report = |phase| *locked(&shared.phase) = Some(phase);
    let control = Control::new(cancel, &report);
    loop {
        let step = run.step(mesh, control)?;
        let outcome = Arc::new(Outcome::new(mesh, problem.clone(), step));
        let ending = run.ending();
        let is_reached = {
            let mut goal = locked(&shared.goal);
            if let Goal::Steps(left) = &mut *goal {
                *left = left.saturating_sub(1);
            }
            goal.is_reached(&outcome, ending)
        };
        deliveries.send(Delivery { outcome, ending }).map_err(|_| SolveError::Cancelled)?;
        (shared.wake)();
        if is_reached {
            return Ok(());
        }
    }
}
