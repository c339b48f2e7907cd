//! The run of the open document: its steps are taken in the background, and come in one by one.
//!
//! ```text
//!            begin            step, run_on, end of a gesture
//! document ────────▶ running ◀──────────────────────────────▶ resting
//!                       │ each step: outcome, ending
//!                       ▼
//!                    timeline
//! ```
//!
//! Whatever changes the document begins another run. Its first step begins another timeline; until it is there the old
//! one stays on the screen.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::state::{REPORT_IT, lost};
use super::stop::Goal;
use super::{Document, Job, JobContext, Outcome, Place, Poll, Problem, Session, Severity, Stop, Timeline, Wake};
use crate::mesh::DiskMesh;
use crate::solver::{Control, Ending, Ladder, Phase, SolveError, are_held_alike};

/// Steps that wait to be taken in before the background waits for the screen. None is ever dropped.
const STEPS_WAITING: usize = 8;

/// A step on its way to the timeline.
struct Delivery {
    outcome: Arc<Outcome>,
    /// What the run says after this step.
    ending: Option<Ending>,
}

/// A run with the steps that it takes in the background.
pub(super) struct Running {
    /// Gives the run back when it comes to rest.
    job: Job<Phase, (Ladder, Result<(), SolveError>)>,
    deliveries: Receiver<Delivery>,
    goal: Arc<Mutex<Goal>>,
    /// What it was begun for.
    document: Document,
    /// Whether a step has come in.
    has_delivered: bool,
    phase: Option<Phase>,
    /// Once it was asked to pause: how far to go on after that; no step further, unless it was asked for.
    paused: Option<Goal>,
}

impl Running {
    /// What the background does.
    pub(super) fn phase(&self) -> Option<Phase> {
        self.phase
    }

    fn goal(&self) -> MutexGuard<'_, Goal> {
        locked(&self.goal)
    }

    /// Asks for another goal, after a pause where one was asked for.
    fn set_goal(&mut self, change: impl FnOnce(Goal) -> Goal) {
        if let Some(after) = &mut self.paused {
            *after = change(*after);
        } else {
            let mut goal = self.goal();
            *goal = change(*goal);
        }
    }

    /// Whether another document only needs the first step again, with other targets of the same pins.
    fn is_followed_by(&self, document: &Document) -> bool {
        let only_targets_differ = self.document.run_settings() == document.run_settings()
            && self.document.frame() == document.frame()
            && are_held_alike(&self.document.pins(), &document.pins());
        self.paused.is_none() && !self.has_delivered && only_targets_differ
    }
}

/// A goal is a plain value: it is whole even where a thread died beside it.
fn locked(goal: &Mutex<Goal>) -> MutexGuard<'_, Goal> {
    goal.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The background's end of it all.
struct Courier {
    deliveries: SyncSender<Delivery>,
    goal: Arc<Mutex<Goal>>,
    wake: Wake,
    problem: Problem,
}

impl Courier {
    /// Takes steps until the goal is reached, and hands each over. What nobody waits for any more is given up.
    fn take_steps(&self, run: &mut Ladder, mesh: &DiskMesh, context: &JobContext<Phase>) -> Result<(), SolveError> {
        let report = |phase| context.report(phase);
        let control = Control::new(context.cancel_flag(), &report);
        loop {
            let step = run.step(mesh, control)?;
            let outcome = Arc::new(Outcome::new(mesh, self.problem.clone(), step));
            let ending = run.ending();
            let is_reached = {
                let mut goal = locked(&self.goal);
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

impl Session {
    /// Begins a run of the document as it is now. While a gesture goes on it takes only its first step, which is
    /// linear: then a pin that is dragged is followed at the pace of the solver.
    pub(super) fn solve(&mut self) {
        let goal = if self.history.is_in_gesture() { Goal::Steps(1) } else { Goal::Until(self.stop) };
        self.end_preview();
        self.begin(goal);
    }

    /// Begins a run of the document as it is now. What a drag shows stays until its first step is there.
    pub(super) fn run_document(&mut self) {
        self.timeline.follow_newest();
        self.begin(Goal::Until(self.stop));
    }

    /// Begins a run that shows its first step and waits.
    pub(super) fn solve_first_step(&mut self) {
        self.begin(Goal::Steps(1));
    }

    /// Begins a run, or lets the first step that is under way finish where only targets differ.
    fn begin(&mut self, goal: Goal) {
        self.resting = None;
        if !self.bring_faces() {
            return;
        }
        if let Some(running) = &mut self.running
            && running.is_followed_by(&self.document)
        {
            self.solve_again = running.document.targets != self.document.targets;
            running.set_goal(|_| goal);
            return;
        }
        let (settings, pins) = (self.document.run_settings(), self.document.pins());
        self.spawn(Ladder::new(settings, pins).with_kept(&self.kept), goal);
    }

    /// Takes steps of a run in the background. A run that is under way is given up.
    pub(super) fn spawn(&mut self, mut run: Ladder, goal: Goal) {
        self.running = None;
        self.solve_again = false;
        let Some(disk) = self.model.as_ref().and_then(|model| model.disk()).map(Arc::clone) else { return };
        // A run is only ever spawned for the document as it is.
        let document = self.document.clone();
        let has_delivered = run.step_count() > 0;
        let (sender, deliveries) = sync_channel(STEPS_WAITING);
        let goal = Arc::new(Mutex::new(goal));
        let courier = Courier {
            deliveries: sender,
            goal: Arc::clone(&goal),
            wake: Arc::clone(&self.wake),
            problem: document.problem(),
        };
        let work = move |context: &JobContext<Phase>| {
            let result = courier.take_steps(&mut run, &disk, context);
            (run, result)
        };
        match Job::spawn("solve", self.waker(), work) {
            Ok(job) => {
                let (phase, paused) = (None, None);
                self.running = Some(Running { job, deliveries, goal, document, has_delivered, phase, paused });
            }
            Err(error) => self.fail(Place::Embedding, format!("no thread to solve with: {error}"), None),
        }
    }

    /// Takes one further step, whether or not the method has ended. A run that goes on by itself comes to rest after
    /// the step that it is taking.
    pub(super) fn step(&mut self) {
        self.timeline.follow_newest();
        match &mut self.running {
            Some(running) => running.set_goal(|goal| match goal {
                Goal::Steps(left) => Goal::Steps(left + 1),
                Goal::Until(_) | Goal::End => Goal::Steps(1),
            }),
            None => self.go_on(Goal::Steps(1)),
        }
    }

    /// Goes on until something stops it.
    pub(super) fn run_on(&mut self) {
        let goal = Goal::Until(self.stop);
        self.timeline.follow_newest();
        if let Some(running) = &mut self.running {
            running.set_goal(|_| goal);
        } else if self.can_run() {
            self.go_on(goal);
        }
    }

    /// The end of a gesture: where only the first step was taken, or none, the others follow.
    pub(super) fn end_gesture(&mut self) {
        let was_in_gesture = self.history.is_in_gesture();
        self.history.end_gesture(&self.document);
        self.follow_job = None;
        if !was_in_gesture {
            return;
        }
        if self.running.is_none() && self.is_current() {
            // It ended where it began, or the steps were taken while the pointer rested.
            self.end_preview();
        }
        let is_solved = self.running.is_some() || self.is_current();
        if !is_solved {
            self.run_document();
        } else if !self.solve_again {
            self.run_on();
        }
    }

    pub(super) fn set_stop(&mut self, stop: super::StopConditions) {
        self.stop = stop;
        if let Some(running) = &mut self.running {
            running.set_goal(|goal| if matches!(goal, Goal::Until(_)) { Goal::Until(stop) } else { goal });
        }
    }

    /// Pauses the run: it comes to rest with the steps that it has.
    pub(super) fn pause(&mut self) {
        self.solve_again = false;
        if let Some(running) = &mut self.running {
            running.paused = Some(Goal::Steps(0));
            running.job.cancel();
        }
    }

    /// Goes on with the run at rest, or begins one where the document has changed since.
    fn go_on(&mut self, goal: Goal) {
        match self.resting.take() {
            Some(run) if self.document.is_solved_by(run.settings(), run.pins()) => self.spawn(run, goal),
            _ => self.begin(goal),
        }
    }

    /// Whether a run that goes on by itself would take a step.
    pub fn can_run(&self) -> bool {
        let is_disk = self.model.as_ref().is_some_and(|model| model.disk().is_some());
        is_disk && !(self.is_current() && self.stopped_for_good().is_some())
    }

    fn stopped_for_good(&self) -> Option<Stop> {
        let newest = self.timeline.outcome(self.timeline.newest()?)?;
        self.stop.reason_for_good(newest, self.ending)
    }

    /// Why the run is at rest, where that is not because of a person's wish.
    pub fn stopped(&self) -> Option<Stop> {
        let newest = self.timeline.outcome(self.timeline.newest()?)?;
        self.stop.reason(newest, self.ending).filter(|_| self.running.is_none())
    }

    pub(super) fn poll_running(&mut self) {
        let Some(running) = &mut self.running else { return };
        running.phase = running.job.latest_progress().or(running.phase);
        // Looked at before the deliveries: those of a job that has ended are then all there.
        let end = running.job.poll();
        let deliveries: Vec<Delivery> = running.deliveries.try_iter().collect();
        running.has_delivered |= !deliveries.is_empty();
        let has_news = !deliveries.is_empty();
        for delivery in deliveries {
            self.take_step(delivery);
        }
        if has_news && self.solve_again {
            self.running = None;
            return self.solve();
        }
        match end {
            Poll::Running => {}
            Poll::Lost => {
                self.running = None;
                self.fail(Place::Embedding, lost("solving"), Some(REPORT_IT));
            }
            Poll::Done((run, result)) => self.take_back(run, result),
        }
    }

    /// Takes in a step of the document's run. The first one begins a timeline.
    fn take_step(&mut self, Delivery { outcome, ending }: Delivery) {
        self.forget_solve_message();
        if outcome.step.index == 0 {
            // What was written no longer shows what is on the screen.
            self.messages.retain(|message| message.severity != Severity::Note);
            self.kept.prepared.clone_from(&outcome.step.prepared);
            (self.preview, self.verdict_job) = (None, None);
            self.timeline = Timeline::default();
        }
        if let Some(start) = &outcome.step.planar_start {
            self.kept.planar_start = Some(Arc::clone(start));
        }
        self.ending = ending;
        if self.timeline.push(outcome) {
            self.outcome_revision += 1;
        }
    }

    /// Takes back a run that has come to rest, and lets it go on where the goal has changed meanwhile.
    fn take_back(&mut self, run: Ladder, result: Result<(), SolveError>) {
        let Some(running) = self.running.take() else { return };
        self.resting = Some(run);
        let goal = match result {
            Ok(()) | Err(SolveError::Cancelled) if running.paused.is_some() => {
                running.paused.filter(|goal| *goal != Goal::Steps(0))
            }
            Ok(()) => Some(*running.goal()).filter(|goal| {
                let newest = self.timeline.newest().and_then(|newest| self.timeline.outcome(newest));
                newest.is_some_and(|newest| !goal.is_reached(newest, self.ending))
            }),
            Err(SolveError::Cancelled) => None,
            Err(error) => {
                self.tell_solve_error(&error);
                None
            }
        };
        if std::mem::take(&mut self.solve_again) {
            self.solve();
        } else if let Some(goal) = goal {
            self.go_on(goal);
        }
    }

    /// Says what went wrong; where constraints cannot be met, which.
    fn tell_solve_error(&mut self, error: &SolveError) {
        self.forget_solve_message();
        self.fail(Place::Embedding, error.to_string(), None);
        self.solve_message = Some(self.next_message);
        if *error != SolveError::Unmet {
            return;
        }
        self.ending = Some(Ending::Unmet);
        let newest = self.timeline.newest().and_then(|newest| self.timeline.outcome(newest));
        let unmet = newest.map(|newest| newest.step.unmet()).unwrap_or_default();
        let remedy = if self.document.settings.new_vertices {
            "move these pins"
        } else {
            "allow new vertices, or move these pins"
        };
        if let Some(message) = self.messages.last_mut() {
            (message.vertices, message.remedy) = (unmet, Some(remedy.to_owned()));
        }
    }

    /// Takes away what a solve before said.
    fn forget_solve_message(&mut self) {
        if let Some(stale) = self.solve_message.take() {
            self.messages.retain(|message| message.id != stale);
        }
    }
}
