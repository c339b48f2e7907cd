//! Run in the background with its thread, stopped run, and continuation of the solving.

use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{Receiver, SyncSender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::session::stop::Goal;
use crate::session::{Background, Model, Wake};
use freebound_core::flatten::{Ending, Flattener};
use freebound_core::mesh::DiskMesh;
use freebound_core::pipeline::{Outcome, Problem};
use freebound_core::problem::{Control, Embedding, Phase, SolveError, Stage};

/// Problem to be solved, and its mesh.
#[derive(Clone, Debug)]
pub(in crate::session) struct Task {
    pub(in crate::session) model: Arc<Model>,
    pub(in crate::session) mesh: Arc<DiskMesh>,
    pub(in crate::session) problem: Problem,
    /// Embedding to continue from. `None` solves from scratch.
    pub(in crate::session) from: Option<Beginning>,
}

/// Planar embedding to continue from.
#[derive(Clone, Debug)]
pub(in crate::session) struct Beginning {
    pub(in crate::session) embedding: Arc<Embedding>,
    /// True if the embedding is returned unchanged when it meets all constraints.
    pub(in crate::session) stays: bool,
}

impl Beginning {
    /// Prepares a flattener that continues from the embedding.
    pub(super) fn begin(&self, run: Flattener) -> Flattener {
        if self.stays { run.warm_start(&self.embedding) } else { run.continue_from(&self.embedding) }
    }
}

/// Events of a poll that concern the session.
#[derive(Debug, Default)]
pub(in crate::session) struct News {
    /// True if the first step of a run has arrived.
    pub(in crate::session) has_begun: bool,
    /// Kind of the stop, if the run has stopped and is not continued.
    pub(in crate::session) rest: Option<StopReason>,
    /// Number of requested relaxation rounds that were not taken.
    pub(in crate::session) rounds_cut: usize,
    /// Continuation of the solving, with the problem of the document at that time.
    pub(in crate::session) next: Option<Next>,
}

/// Kind of a run's stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::session) enum StopReason {
    /// A stop condition or the end of the method stopped the run.
    ByItself,
    /// The user or an error stopped the run.
    Elsewhere,
}

/// Continuation of the solving.
#[derive(Clone, Copy, Debug)]
pub(in crate::session) enum Next {
    /// Solve the problem again.
    Anew,
    /// Continue the run to this goal.
    On(Goal),
}

/// Run in progress, with its channel.
pub(super) struct Running {
    /// Job that returns the run when it stops.
    pub(super) job: Background<(), (Flattener, Result<(), SolveError>)>,
    pub(super) deliveries: Receiver<Delivery>,
    pub(super) shared: Arc<Shared>,
    pub(super) model: Arc<Model>,
    pub(super) problem: Problem,
    /// True if a step has arrived.
    pub(super) has_delivered: bool,
    /// Goal after a requested pause: no step, unless steps are requested meanwhile. `None` without a pause.
    pub(super) paused: Option<Goal>,
}

/// Stopped run.
pub(super) struct Resting {
    pub(super) problem: Problem,
    pub(super) run: Flattener,
}

impl Running {
    /// Changes the goal. During a pause the goal after the pause changes.
    pub(super) fn set_goal(&mut self, change: impl FnOnce(Goal) -> Goal) {
        if let Some(after) = &mut self.paused {
            *after = change(*after);
        } else {
            let mut goal = locked(&self.shared.goal);
            *goal = change(*goal);
        }
    }

    /// True if the run continues to its end or to a stop condition, and is not paused.
    pub(super) fn goes_on_by_itself(&self) -> bool {
        self.paused.is_none() && !matches!(self.shared.goal(), Goal::Steps(_))
    }

    /// True if another problem only needs the first step again, with other targets of the same pins.
    pub(super) fn is_followed_by(&self, problem: &Problem) -> bool {
        self.paused.is_none() && !self.has_delivered && self.problem.differs_in_targets_alone(problem)
    }
}

/// Step that the background delivers.
pub(super) struct Delivery {
    pub(super) outcome: Arc<Outcome>,
    /// Ending of the run after this step.
    pub(super) ending: Option<Ending>,
}

/// State shared with the background.
pub(super) struct Shared {
    goal: Mutex<Goal>,
    /// Phase of the background.
    phase: Mutex<Option<Phase>>,
    wake: Wake,
}

impl Shared {
    pub(super) fn new(goal: Goal, wake: &Wake) -> Self {
        Self { goal: Mutex::new(goal), phase: Mutex::new(None), wake: Arc::clone(wake) }
    }

    /// Goal of the run.
    pub(super) fn goal(&self) -> Goal {
        *locked(&self.goal)
    }

    /// Phase of the background, once it is known.
    pub(super) fn phase(&self) -> Option<Phase> {
        *locked(&self.phase)
    }
}

/// Locks a value. Poisoning is ignored, because plain values are valid even after a panic.
fn locked<T>(value: &Mutex<T>) -> MutexGuard<'_, T> {
    value.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Delivers a step. Cancels the run if the receiver is gone.
fn deliver(delivery: Delivery, shared: &Shared, deliveries: &SyncSender<Delivery>) -> Result<(), SolveError> {
    deliveries.send(delivery).map_err(|_| SolveError::Cancelled)?;
    (shared.wake)();
    Ok(())
}

/// Takes steps until the goal is reached, and delivers each of them. Runs in the background. The run is cancelled if
/// the receiver is gone.
pub(super) fn take_steps(
    run: &mut Flattener,
    Task { mesh, problem, from, .. }: &Task,
    shared: &Shared,
    deliveries: &SyncSender<Delivery>,
    cancel: &AtomicBool,
) -> Result<(), SolveError> {
    let report = |phase| *locked(&shared.phase) = Some(phase);
    let control = Control::new(cancel, &report);
    if run.step_count() == 0
        && from.is_none()
        && let Some(outcome) = Outcome::of_shaped_map(mesh, problem)
    {
        let fresh = std::mem::replace(run, problem.flattener());
        *run = fresh.resume_after(&outcome.step, &[Stage::Saved]);
        let ending = run.ending();
        if ending.is_none() {
            // Nothing changes the map that the user shaped unless the user asks for it.
            *locked(&shared.goal) = Goal::Steps(0);
        }
        return deliver(Delivery { outcome: Arc::new(outcome), ending }, shared, deliveries);
    }
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
        deliver(Delivery { outcome, ending }, shared, deliveries)?;
        if is_reached {
            return Ok(());
        }
    }
}
