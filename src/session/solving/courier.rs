//! The background's end of a run: it takes steps, and hands them over one by one.

use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::mesh::DiskMesh;
use crate::session::stop::Goal;
use crate::session::{Outcome, Problem, Wake};
use crate::solver::{Control, Ending, Ladder, Phase, SolveError};

/// Steps that wait to be taken in before the background waits for the screen. None is ever dropped.
const STEPS_WAITING: usize = 8;

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
}

impl Shared {
    /// How far the run is to go on.
    pub(super) fn goal(&self) -> Goal {
        *locked(&self.goal)
    }

    /// Asks for another goal.
    pub(super) fn change_goal(&self, change: impl FnOnce(Goal) -> Goal) {
        let mut goal = locked(&self.goal);
        *goal = change(*goal);
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

/// Takes the steps of a run.
pub(super) struct Courier {
    deliveries: SyncSender<Delivery>,
    shared: Arc<Shared>,
    wake: Wake,
    problem: Problem,
}

impl Courier {
    /// A courier, and where its deliveries arrive.
    pub(super) fn new(problem: Problem, goal: Goal, wake: &Wake) -> (Self, Receiver<Delivery>) {
        let (sender, receiver) = sync_channel(STEPS_WAITING);
        let shared = Arc::new(Shared { goal: Mutex::new(goal), phase: Mutex::new(None) });
        (Self { deliveries: sender, shared, wake: Arc::clone(wake), problem }, receiver)
    }

    /// What both ends know.
    pub(super) fn shared(&self) -> Arc<Shared> {
        Arc::clone(&self.shared)
    }

    /// Takes steps until the goal is reached, and hands each over. What nobody waits for any more is given up.
    ///
    /// # Errors
    ///
    /// What the run says.
    pub(super) fn take_steps(&self, run: &mut Ladder, mesh: &DiskMesh, cancel: &AtomicBool) -> Result<(), SolveError> {
        let report = |phase| *locked(&self.shared.phase) = Some(phase);
        let control = Control::new(cancel, &report);
        loop {
            let step = run.step(mesh, control)?;
            let outcome = Arc::new(Outcome::new(mesh, self.problem.clone(), step));
            let ending = run.ending();
            let is_reached = {
                let mut goal = locked(&self.shared.goal);
                goal.count_step();
                goal.is_reached(&outcome, ending)
            };
            self.deliveries.send(Delivery { outcome, ending }).map_err(|_| SolveError::Cancelled)?;
            (self.wake)();
            if is_reached {
                return Ok(());
            }
        }
    }
}
