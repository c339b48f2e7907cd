//! Solving of one mesh: a run takes steps in the background, and its steps arrive one by one.
//!
//! ```text
//!           begin            step, run_on, end of a gesture
//! problem ────────▶ running ◀──────────────────────────────▶ resting
//!                      │ each step: outcome, ending
//!                      ▼
//!                   timeline
//! ```
//!
//! A changed problem starts a new run. The first step of the run starts a new timeline; until then the old one stays on
//! the screen. [`Solving`] does not depend on the session, which could own several of them, each with its own mesh.
//!
//! | file       | content                                                        |
//! |------------|----------------------------------------------------------------|
//! | `mod`      | the part: its queries and operations                           |
//! | `running`  | task of a run; stopped run, and run with its background thread |
//! | `incoming` | arrival of steps and of stopped runs                           |
//! | `rounds`   | relaxation rounds that the user requested                      |
//! | `solved`   | solution of a stopped run, to be shown again                   |

mod incoming;
mod rounds;
mod running;
mod solved;

use std::sync::Arc;
use std::sync::mpsc::sync_channel;

use self::rounds::Rounds;
pub(super) use self::running::{Beginning, Next, StopReason, Task};
use self::running::{Resting, Running, Shared, take_steps};
pub(super) use self::solved::Solved;
use super::stop::Goal;
use super::timeline::{TIMELINE_BUDGET, Timeline};
use super::{Background, MessagePlace, Messages, RunStop, StopConditions, Wake};
use freebound_core::flatten::{Ending, Flattener, Options, Prepared, SolverCache};
use freebound_core::pipeline::{Outcome, Problem};
use freebound_core::problem::{Method, Phase};

/// Maximum number of steps in the channel. The background waits if it is full; no step is dropped.
const STEPS_WAITING: usize = 8;

/// Run with its steps and stop conditions.
pub(super) struct Solving {
    wake: Wake,
    timeline: Timeline,
    /// Number of changes of the shown step.
    outcome_revision: u64,
    /// Ending of the run after the newest step.
    ending: Option<Ending>,
    stop: StopConditions,
    /// Solver data of runs on the mesh, reused by further runs.
    kept: SolverCache,
    /// Run in progress in the background.
    running: Option<Running>,
    /// Stopped run that can be continued.
    resting: Option<Resting>,
    /// Relaxation rounds requested after the end of the run.
    rounds: Rounds,
    /// True if the targets changed since the first step in progress began.
    is_outdated: bool,
    /// Message of the last solve, if it failed. The next success dismisses it.
    message: Option<u64>,
    /// Problem whose solve failed.
    failed: Option<Problem>,
}

/// Queries of the run.
impl Solving {
    pub(super) fn new(wake: Wake, budget: usize) -> Self {
        Self {
            wake,
            timeline: Timeline::with_budget(budget),
            outcome_revision: 0,
            ending: None,
            stop: StopConditions::default(),
            kept: SolverCache::default(),
            running: None,
            resting: None,
            rounds: Rounds::default(),
            is_outdated: false,
            message: None,
            failed: None,
        }
    }

    /// Steps of the run.
    pub(super) fn timeline(&self) -> &Timeline {
        &self.timeline
    }

    /// True if a run takes steps in the background.
    pub(super) fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Problem of the run in progress.
    pub(super) fn running_problem(&self) -> Option<&Problem> {
        self.running.as_ref().map(|running| &running.problem)
    }

    /// True if the solve of this problem failed.
    pub(super) fn has_failed(&self, problem: &Problem) -> bool {
        self.failed.as_ref().is_some_and(|failed| failed.has_steps_of(problem))
    }

    /// Stop conditions of runs.
    pub(super) fn stop_conditions(&self) -> StopConditions {
        self.stop
    }

    /// The newest step.
    pub(super) fn newest(&self) -> Option<&Arc<Outcome>> {
        self.timeline.outcome(self.timeline.newest()?)
    }

    fn newest_index(&self) -> usize {
        self.timeline.newest().unwrap_or(0)
    }

    /// Factors of former solves, for problems that differ only in their targets.
    pub(super) fn prepared(&self) -> Option<&Arc<Prepared>> {
        self.kept.prepared.as_ref()
    }

    /// Phase of the run in progress.
    pub(super) fn phase(&self) -> Option<Phase> {
        self.running.as_ref()?.shared.phase()
    }

    /// Number of relaxation rounds requested after the end of the run.
    pub(super) fn rounds_asked(&self) -> usize {
        self.rounds.asked()
    }

    /// True if the run has ended by itself.
    pub(super) fn has_ended(&self) -> bool {
        self.ending.is_some()
    }

    /// True if targets changed during the first step, so that another run has to follow.
    pub(super) fn is_outdated(&self) -> bool {
        self.is_outdated
    }

    /// True if the run has taken only its first step and has further ones.
    pub(super) fn is_at_first_step(&self) -> bool {
        self.timeline.records().len() == 1 && self.ending.is_none()
    }

    /// Reason for the stop of the run, if continuing it would not take further steps.
    pub(super) fn stopped_for_good(&self) -> Option<RunStop> {
        self.stop.reason_for_good(self.newest()?, self.ending)
    }

    /// True if the newest step is not planar and further steps are possible.
    pub(super) fn can_go_on_from_fault(&self, problem: &Problem) -> bool {
        let is_open = self.ending.is_none() || problem.settings.method != Method::Auto;
        self.newest().is_some_and(|newest| is_open && !newest.step.verdict.planar)
    }

    /// True if the newest step meets its constraints and its run can relax.
    pub(super) fn can_relax(&self, problem: &Problem) -> bool {
        let is_met = self.newest().is_some_and(|newest| newest.step.unmet().is_empty());
        let waits = |resting: &Resting| resting.problem.has_steps_of(problem) && resting.run.can_relax();
        is_met && self.resting.as_ref().is_some_and(waits)
    }

    /// Number of changes of the shown step.
    pub(super) fn outcome_revision(&self) -> u64 {
        self.outcome_revision
    }

    /// Reason for the stop of the run: a stop condition or its ending.
    pub(super) fn stopped(&self) -> Option<RunStop> {
        self.stop.reason(self.newest()?, self.ending).filter(|_| !self.is_running())
    }
}

/// Operations on the run.
impl Solving {
    /// Starts a run. If only targets differ from the run in progress, its first step is finished before.
    pub(super) fn begin(&mut self, task: Task, goal: Goal) {
        (self.resting, self.failed) = (None, None);
        if let Some(running) = &mut self.running
            && running.is_followed_by(&task.problem)
        {
            self.is_outdated = running.problem.targets != task.problem.targets;
            running.set_goal(|_| goal);
            return;
        }
        let run = self.run_of(&task);
        let run = match &task.from {
            Some(beginning) => beginning.begin(run),
            None => run,
        };
        self.rounds = Rounds::default();
        self.spawn(task, run, goal);
    }

    /// Flattener of a task, without steps.
    fn run_of(&self, Task { model, problem, .. }: &Task) -> Flattener {
        let options = model.flattener_options(problem).unwrap_or_else(|_| problem.options());
        Flattener::with_options(Options { cache: Some(self.kept.clone()), ..options })
    }

    /// Continues the stopped run, or starts a run if the problem has changed.
    pub(super) fn go_on(&mut self, task: Task, goal: Goal) {
        match self.resting.take() {
            Some(resting) if resting.problem.has_steps_of(&task.problem) => self.spawn(task, resting.run, goal),
            _ => self.begin(task, goal),
        }
    }

    /// Takes the steps of a run in the background. A run in progress is dropped.
    fn spawn(&mut self, task: Task, mut run: Flattener, goal: Goal) {
        self.give_up();
        let has_delivered = run.step_count() > 0;
        let (sender, deliveries) = sync_channel(STEPS_WAITING);
        let shared = Arc::new(Shared::new(goal, &self.wake));
        let mut job = Background::new("solve", &self.wake);
        let (of_job, model, problem) = (Arc::clone(&shared), Arc::clone(&task.model), task.problem.clone());
        job.start((), move |cancel| {
            let result = take_steps(&mut run, &task, &of_job, &sender, cancel);
            (run, result)
        });
        self.running = Some(Running { job, deliveries, shared, model, problem, has_delivered, paused: None });
    }

    /// Shows the newest step from now on.
    pub(super) fn follow_newest(&mut self) {
        self.timeline.follow_newest();
    }

    /// Changes the goal of the run in progress. Returns false if there is none; then the caller has to
    /// [`go_on`](Self::go_on).
    pub(super) fn change_goal(&mut self, change: impl FnOnce(Goal) -> Goal) -> bool {
        self.running.as_mut().map(|running| running.set_goal(change)).is_some()
    }

    /// Lowers the distortion of the newest step until all rounds are used or nothing is gained. Returns true if this is
    /// possible.
    pub(super) fn relax(&mut self, task: Task, rounds: usize, messages: &mut Messages) -> bool {
        let Some(mut resting) = self.resting.take() else { return false };
        match resting.run.relax(rounds) {
            Ok(()) => {
                self.rounds.begin(rounds, self.newest_index());
                self.ending = None;
                self.spawn(task, resting.run, Goal::End);
                true
            }
            Err(error) => {
                self.resting = Some(resting);
                messages.fail(MessagePlace::Embedding, error.to_string(), None);
                false
            }
        }
    }

    /// Cuts short the relaxation rounds that the stopped run has not taken. Returns their number.
    fn cut_rounds(&mut self) -> usize {
        if self.has_ended() {
            self.rounds.end();
        }
        self.rounds.cut_short(self.newest_index())
    }

    /// True if a stopped run can be continued.
    pub(super) fn is_resting(&self) -> bool {
        self.resting.is_some()
    }

    /// Resumes at most `most` relaxation rounds that were cut short. Returns their number.
    pub(super) fn resume_rounds(&mut self, most: usize) -> usize {
        if self.running.is_none() { self.rounds.resume(most, self.newest_index()) } else { 0 }
    }

    /// Sets the stop conditions of runs.
    pub(super) fn set_stop(&mut self, stop: StopConditions) {
        self.stop = stop;
        self.change_goal(|goal| if matches!(goal, Goal::Until(_)) { Goal::Until(stop) } else { goal });
    }

    /// Pauses the run. Its finished steps are kept.
    pub(super) fn pause(&mut self) {
        self.is_outdated = false;
        if let Some(running) = &mut self.running {
            running.paused = Some(Goal::Steps(0));
            running.job.interrupt();
        }
    }

    /// Drops the run in progress.
    pub(super) fn give_up(&mut self) {
        (self.running, self.is_outdated) = (None, false);
    }

    /// Drops the run, in progress or stopped.
    pub(super) fn give_up_all(&mut self) {
        self.give_up();
        self.resting = None;
    }

    /// Drops all solutions, because they belong to another mesh or preparation.
    pub(super) fn forget(&mut self, messages: &mut Messages) {
        self.give_up_all();
        self.forget_message(messages);
        (self.timeline, self.ending, self.kept) = (self.timeline.begun_anew(), None, SolverCache::default());
        self.outcome_revision += 1;
    }

    /// Becomes the shown run in place of `before`, whose memory budget becomes `bytes`.
    pub(super) fn come_on_screen_after(&mut self, before: &mut Self, bytes: usize) {
        before.timeline.set_budget(bytes);
        self.timeline.set_budget(TIMELINE_BUDGET);
        self.stop = before.stop;
        self.outcome_revision = self.outcome_revision.max(before.outcome_revision) + 1;
        self.message = None;
    }

    /// Stores factors for problems that differ only in their targets.
    pub(super) fn keep_prepared(&mut self, prepared: Arc<Prepared>) {
        self.kept.prepared = Some(prepared);
    }

    /// Shows a step.
    pub(super) fn show(&mut self, index: usize) {
        if self.timeline.show(index) {
            self.outcome_revision += 1;
        }
    }

    /// Compares the shown step with another step, or ends the comparison.
    pub(super) fn compare(&mut self, index: Option<usize>) {
        self.timeline.compare(index);
    }
}
