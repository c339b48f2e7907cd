//! The solving of one mesh: its run takes steps in the background, and they come in one by one.
//!
//! ```text
//!           begin            step, run_on, end of a gesture
//! problem ────────▶ running ◀──────────────────────────────▶ resting
//!                      │ each step: outcome, ending
//!                      ▼
//!                   timeline
//! ```
//!
//! Another problem begins another run. Its first step begins another timeline; until it is there the old one stays on
//! the screen. [`Solving`] knows no session: one could have several of these, each with a mesh of its own.
//!
//! | file       | what it holds                                                             |
//! |------------|---------------------------------------------------------------------------|
//! | `mod`      | the part: what is asked of it and done with it                            |
//! | `running`  | what is to be solved; a run at rest and in the background, where it works |
//! | `incoming` | takes in steps, and a run that has come to rest                           |
//! | `rounds`   | rounds of relaxing that a person has asked for                            |
//! | `solved`   | what a run at rest has solved, to be shown again                          |

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

/// Steps that wait to be taken in before the background waits for the screen. None is ever dropped.
const STEPS_WAITING: usize = 8;

/// A run, its steps, and where it comes to rest.
pub(super) struct Solving {
    wake: Wake,
    timeline: Timeline,
    /// Changes with the step on the screen.
    outcome_revision: u64,
    /// What the run says after the newest step.
    ending: Option<Ending>,
    stop: StopConditions,
    /// What runs on the mesh have computed, for further ones.
    kept: SolverCache,
    /// The run that takes steps in the background.
    running: Option<Running>,
    /// The run that waits to be taken on.
    resting: Option<Resting>,
    /// Rounds of relaxing that it was asked for after its end.
    rounds: Rounds,
    /// Whether the targets changed since the first step under way began.
    is_outdated: bool,
    /// The message of the last solve, where it failed: the next one that succeeds takes it away.
    message: Option<u64>,
    /// What nothing was found for.
    failed: Option<Problem>,
}

/// What is asked.
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

    /// The steps.
    pub(super) fn timeline(&self) -> &Timeline {
        &self.timeline
    }

    /// Whether a run takes steps in the background.
    pub(super) fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// What the run solves that takes steps in the background.
    pub(super) fn running_problem(&self) -> Option<&Problem> {
        self.running.as_ref().map(|running| &running.problem)
    }

    /// Whether nothing was found for a problem.
    pub(super) fn has_failed(&self, problem: &Problem) -> bool {
        self.failed.as_ref().is_some_and(|failed| failed.has_steps_of(problem))
    }

    /// When a run that goes on by itself comes to rest.
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

    /// Kept from solves that succeeded, for problems where only targets differ.
    pub(super) fn prepared(&self) -> Option<&Arc<Prepared>> {
        self.kept.prepared.as_ref()
    }

    /// What a run that takes steps is doing.
    pub(super) fn phase(&self) -> Option<Phase> {
        self.running.as_ref()?.shared.phase()
    }

    /// Rounds of relaxing that the run was asked for after its end.
    pub(super) fn rounds_asked(&self) -> usize {
        self.rounds.asked()
    }

    /// Whether the run has come to its own end.
    pub(super) fn has_ended(&self) -> bool {
        self.ending.is_some()
    }

    /// Whether another run is to begin where targets changed while a first step was under way.
    pub(super) fn is_outdated(&self) -> bool {
        self.is_outdated
    }

    /// Whether a run has taken its first step alone, and has more.
    pub(super) fn is_at_first_step(&self) -> bool {
        self.timeline.records().len() == 1 && self.ending.is_none()
    }

    /// Why the run is at rest, however often it is asked to go on.
    pub(super) fn stopped_for_good(&self) -> Option<RunStop> {
        self.stop.reason_for_good(self.newest()?, self.ending)
    }

    /// Whether the newest step folds or crosses itself, and its run has not come to its own end.
    pub(super) fn can_go_on_from_fault(&self, problem: &Problem) -> bool {
        let is_open = self.ending.is_none() || problem.settings.method != Method::Auto;
        self.newest().is_some_and(|newest| is_open && !newest.step.verdict.planar)
    }

    /// Whether the newest step is one-to-one, its constraints met, and its run waits to be taken on.
    pub(super) fn can_relax(&self, problem: &Problem) -> bool {
        let is_met = self.newest().is_some_and(|newest| newest.step.unmet().is_empty());
        let waits = |resting: &Resting| resting.problem.has_steps_of(problem) && resting.run.can_relax();
        is_met && self.resting.as_ref().is_some_and(waits)
    }

    /// The count of changes of the step on the screen.
    pub(super) fn outcome_revision(&self) -> u64 {
        self.outcome_revision
    }

    /// The reason why the run is at rest, if a stop condition or its end holds.
    pub(super) fn stopped(&self) -> Option<RunStop> {
        self.stop.reason(self.newest()?, self.ending).filter(|_| !self.is_running())
    }
}

/// What is done.
impl Solving {
    /// Begins a run, or lets the first step that is under way finish where only targets differ.
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

    /// A run that has not begun.
    fn run_of(&self, Task { model, problem, .. }: &Task) -> Flattener {
        let options = model.flattener_options(problem).unwrap_or_else(|_| problem.options());
        Flattener::with_options(Options { cache: Some(self.kept.clone()), ..options })
    }

    /// Goes on with the run at rest, or begins one where the problem has changed since.
    pub(super) fn go_on(&mut self, task: Task, goal: Goal) {
        match self.resting.take() {
            Some(resting) if resting.problem.has_steps_of(&task.problem) => self.spawn(task, resting.run, goal),
            _ => self.begin(task, goal),
        }
    }

    /// Takes steps of a run in the background. A run that is under way is given up.
    fn spawn(&mut self, task: Task, mut run: Flattener, goal: Goal) {
        self.give_up();
        let has_delivered = run.step_count() > 0;
        let (sender, deliveries) = sync_channel(STEPS_WAITING);
        let shared = Arc::new(Shared::new(goal, &self.wake));
        let mut job = Background::new("solve", &self.wake);
        let (of_job, problem) = (Arc::clone(&shared), task.problem.clone());
        job.start((), move |cancel| {
            let result = take_steps(&mut run, &task, &of_job, &sender, cancel);
            (run, result)
        });
        self.running = Some(Running { job, deliveries, shared, problem, has_delivered, paused: None });
    }

    /// The step on the screen is the newest one from now on.
    pub(super) fn follow_newest(&mut self) {
        self.timeline.follow_newest();
    }

    /// Asks the run under way for another goal. Returns whether there is one; otherwise somebody has to
    /// [`go_on`](Self::go_on).
    pub(super) fn change_goal(&mut self, change: impl FnOnce(Goal) -> Goal) -> bool {
        self.running.as_mut().map(|running| running.set_goal(change)).is_some()
    }

    /// Lowers the distortion of the newest step, until all rounds are used up or nothing is gained. Returns whether it can.
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

    /// The run is at rest: rounds of relaxing that it was asked for and has not come to are cut short. Returns how many.
    fn cut_rounds(&mut self) -> usize {
        if self.has_ended() {
            self.rounds.end();
        }
        self.rounds.cut_short(self.newest_index())
    }

    /// Whether a run has come to rest that can be taken on.
    pub(super) fn is_resting(&self) -> bool {
        self.resting.is_some()
    }

    /// Takes up rounds of relaxing that were cut short, so many at most. Returns how many.
    pub(super) fn resume_rounds(&mut self, most: usize) -> usize {
        if self.running.is_none() { self.rounds.resume(most, self.newest_index()) } else { 0 }
    }

    /// Chooses where a run that goes on by itself comes to rest.
    pub(super) fn set_stop(&mut self, stop: StopConditions) {
        self.stop = stop;
        self.change_goal(|goal| if matches!(goal, Goal::Until(_)) { Goal::Until(stop) } else { goal });
    }

    /// Pauses the run: it comes to rest with the steps that it has.
    pub(super) fn pause(&mut self) {
        self.is_outdated = false;
        if let Some(running) = &mut self.running {
            running.paused = Some(Goal::Steps(0));
            running.job.interrupt();
        }
    }

    /// Gives up the run under way.
    pub(super) fn give_up(&mut self) {
        (self.running, self.is_outdated) = (None, false);
    }

    /// Gives up the run, under way or at rest.
    pub(super) fn give_up_all(&mut self) {
        self.give_up();
        self.resting = None;
    }

    /// Drops all that was solved: it belongs to another mesh, or to other faces.
    pub(super) fn forget(&mut self, messages: &mut Messages) {
        self.give_up_all();
        self.forget_message(messages);
        (self.timeline, self.ending, self.kept) = (self.timeline.begun_anew(), None, SolverCache::default());
        self.outcome_revision += 1;
    }

    /// Comes on the screen where `before` was, which keeps so many bytes of steps whole from now on.
    pub(super) fn come_on_screen_after(&mut self, before: &mut Self, bytes: usize) {
        before.timeline.set_budget(bytes);
        self.timeline.set_budget(TIMELINE_BUDGET);
        self.stop = before.stop;
        self.outcome_revision = self.outcome_revision.max(before.outcome_revision) + 1;
        self.message = None;
    }

    /// Keeps what a solve can begin with where only targets differ.
    pub(super) fn keep_prepared(&mut self, prepared: Arc<Prepared>) {
        self.kept.prepared = Some(prepared);
    }

    /// Puts a step on the screen.
    pub(super) fn show(&mut self, index: usize) {
        if self.timeline.show(index) {
            self.outcome_revision += 1;
        }
    }

    /// Compares the step on the screen with another one, or with none.
    pub(super) fn compare(&mut self, index: Option<usize>) {
        self.timeline.compare(index);
    }
}
