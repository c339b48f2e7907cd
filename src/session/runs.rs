//! How the document is solved: a run takes its steps.

use super::past::{BUDGET_OF_ONE, State};
use super::solving::{Beginning, Next, StopReason, Task};
use super::stop::Goal;
use super::{Command, Session};
use freebound_core::problem::{Method, Settings};

/// The most rounds of relaxing that are asked for at once.
const RELAX_ROUNDS: usize = 20;

impl Session {
    /// What is to be solved, once the mesh is there with its faces as the document wants them.
    pub(super) fn task(&mut self) -> Option<Task> {
        let has_form = self.bring_form();
        let mesh = self.disk().filter(|_| has_form)?.clone();
        Some(Task { model: self.model()?.clone(), mesh, problem: self.document.problem(), from: None })
    }

    /// Begins a run of the document as it is now, from what is there where that serves. While a gesture goes on it takes only
    /// its first step: then what is dragged is followed at the pace of the solver.
    pub(super) fn solve(&mut self) {
        self.solve_from(self.beginning());
    }

    fn solve_from(&mut self, from: Option<Beginning>) {
        let goal = if self.history.is_in_gesture() { Goal::Steps(1) } else { Goal::Until(self.stop_conditions()) };
        self.drag.end();
        if let Some(task) = self.task() {
            self.solving.begin(Task { from, ..task }, goal);
        }
    }

    /// Begins a run of the document as it is now. What a drag shows stays until its first step is there. Where what is on the
    /// screen is planar, the run goes on from it.
    fn run_document(&mut self) {
        self.solving.follow_newest();
        let (goal, from) = (Goal::Until(self.stop_conditions()), self.planar_on_screen());
        if let Some(task) = self.task() {
            self.solving.begin(Task { from, ..task }, goal);
        }
    }

    /// Begins a run, or lets the first step that is under way finish where only targets differ.
    pub(super) fn begin(&mut self, goal: Goal) {
        if let Some(task) = self.task() {
            self.solving.begin(task, goal);
        }
    }

    /// Goes on with the run at rest, or begins one where the document has changed since.
    fn go_on(&mut self, goal: Goal) {
        let from = self.beginning();
        if let Some(task) = self.task() {
            self.solving.go_on(Task { from, ..task }, goal);
        }
    }

    /// Takes one further step, whether or not the method has ended. A run that goes on by itself comes to rest after
    /// the step that it is taking. How far it was taken so is remembered for when the document is as it is again.
    pub(super) fn step(&mut self) {
        self.solving.follow_newest();
        if !self.resume_relaxing(1)
            && let Some(newest) = self.timeline().newest().filter(|_| self.is_current())
        {
            self.history.set_taken_to(self.history.taken_to().max(newest) + 1);
        }
        let one_more = |goal| if let Goal::Steps(left) = goal { Goal::Steps(left + 1) } else { Goal::Steps(1) };
        if !self.solving.change_goal(one_more) {
            self.go_on(Goal::Steps(1));
        }
    }

    /// Goes on until something stops it, and takes up relaxing that was paused.
    pub(super) fn run_on(&mut self) {
        if !self.is_running() && self.can_run() {
            self.resume_relaxing(usize::MAX);
        }
        self.run_further();
    }

    /// Goes on until something stops it.
    fn run_further(&mut self) {
        self.solving.follow_newest();
        let goal = Goal::Until(self.stop_conditions());
        if self.solving.change_goal(|_| goal) {
            return;
        }
        if self.can_run() {
            self.go_on(goal);
        } else {
            self.go_on_as_before();
        }
    }

    /// Lowers the distortion of the newest step on a person's wish, one-to-one throughout, constraints exact. The wish is
    /// an edit: it holds for the runs that follow, and is undone and repeated with the others.
    pub(super) fn relax(&mut self) {
        self.solving.follow_newest();
        self.remember();
        if self.relax_by(RELAX_ROUNDS) {
            let rounds = self.document.relaxed.saturating_add(RELAX_ROUNDS);
            self.history.apply(Command::SetRelaxed(rounds), &mut self.document);
        }
    }

    /// Takes up rounds of relaxing that a pause has cut short, so many at most: a wish like the first. Returns whether
    /// there are any.
    fn resume_relaxing(&mut self, most: usize) -> bool {
        if self.is_current() {
            self.remember();
        }
        let rounds = if self.is_current() { self.solving.resume_rounds(most) } else { 0 };
        if rounds == 0 {
            return false;
        }
        let relaxed = Command::SetRelaxed(self.document.relaxed.saturating_add(rounds));
        if self.history.can_redo() {
            // What can be repeated stays so: nothing new was asked for.
            self.history.amend(relaxed, &mut self.document);
            return true;
        }
        self.history.apply(relaxed, &mut self.document)
    }

    /// Takes a run that has come to rest as far as a person had taken it: by rounds of relaxing that the document has and
    /// it was not asked for yet, and by single steps.
    fn go_on_as_before(&mut self) {
        let rounds = self.document.relaxed.saturating_sub(self.solving.rounds_asked());
        if rounds > 0 && self.solving.has_ended() && self.relax_by(rounds) {
            return;
        }
        let newest = self.timeline().newest().filter(|_| self.is_current());
        let left = newest.map_or(0, |newest| self.history.taken_to().saturating_sub(newest));
        if left > 0 && self.solving.is_resting() {
            self.go_on(Goal::Steps(left));
        }
    }

    /// The run rests where it was not taken as far as it was before: it is not to go there again.
    fn stay_here(&mut self) {
        let newest = self.timeline().newest().unwrap_or(0);
        self.history.set_taken_to(self.history.taken_to().min(newest));
    }

    /// Takes all steps of the flattener, until the embedding is planar or nothing is left to try. Another method gives way
    /// to it, as an edit.
    pub(super) fn repair(&mut self) {
        if !self.can_repair() {
            return;
        }
        self.solving.follow_newest();
        let before = self.document.settings.clone();
        if before.method == Method::Auto {
            return self.go_on(Goal::End);
        }
        let family = before.family.filter(|family| family.power().is_some());
        let settings = Settings { method: Method::Auto, family, ..before };
        let edits = std::iter::once(Command::SetSettings(settings)).chain(self.drop_relaxing());
        if self.apply(Command::Together(edits.collect())) {
            self.drag.end();
            self.begin(Goal::End);
        }
    }

    /// Lets rounds of relaxing follow the newest step. Returns whether they do.
    fn relax_by(&mut self, rounds: usize) -> bool {
        match self.task().filter(|_| self.can_relax()) {
            Some(task) => self.solving.relax(task, rounds, &mut self.messages),
            None => false,
        }
    }

    /// Solves from scratch what is asked for, whatever was there, and without the relaxing that was asked for afterwards.
    pub(super) fn solve_from_scratch(&mut self) {
        self.apply(Command::SetRelaxed(0));
        self.history.set_taken_to(0);
        self.solve_from(None);
    }

    /// The end of a gesture: where only the first step was taken, or none, the others follow.
    pub(super) fn end_gesture(&mut self) {
        let was_in_gesture = self.history.is_in_gesture();
        self.history.end_gesture(&mut self.document);
        self.drag.stop_following();
        if !was_in_gesture {
            return;
        }
        if !self.is_running() && self.is_current() {
            // It ended where it began, or the steps were taken while the pointer rested.
            self.drag.end();
        }
        if !self.is_running() && !self.is_current() {
            self.run_document();
        } else if !self.solving.is_outdated() {
            self.run_further();
        }
    }

    /// A gesture was given up and the document is as it was before: so are the steps, where they are its own still.
    pub(super) fn give_up_drag(&mut self) {
        if self.is_current() && !self.solving.is_outdated() {
            self.drag.end();
            self.run_further();
        } else if !self.recall() {
            self.solve();
        }
    }

    /// The pointer rests in the middle of a drag: the whole run is worth taking.
    pub(super) fn rest(&mut self) {
        if self.history.is_in_gesture() && self.preview().is_some() && !self.is_running() {
            self.drag.stop_following();
            self.run_document();
        }
    }

    /// Takes in what the run has done.
    pub(super) fn poll_solving(&mut self) {
        let news = self.solving.poll(&mut self.messages);
        if news.has_begun {
            self.drag.end_preview();
        }
        // What an opened project asks for stays: there is no step of the history that it could be a part of.
        if news.rounds_cut > 0 && self.history.can_undo() {
            let relaxed = self.document.relaxed.saturating_sub(news.rounds_cut);
            self.history.amend(Command::SetRelaxed(relaxed), &mut self.document);
        }
        match (news.next, news.rest) {
            (Some(Next::Anew), _) => self.solve(),
            (Some(Next::On(goal)), _) => self.go_on(goal),
            (None, Some(StopReason::ByItself)) if !self.history.is_in_gesture() => self.go_on_as_before(),
            (None, Some(StopReason::Elsewhere)) => self.stay_here(),
            (None, _) => {}
        }
    }

    /// Drops all that was solved: it belongs to another mesh, or to other faces.
    pub(super) fn forget_steps(&mut self) {
        self.solving.forget(&mut self.messages);
        self.drag.end();
    }

    /// Whether a run that goes on by itself would take a step.
    pub fn can_run(&self) -> bool {
        self.disk().is_some() && !(self.is_current() && self.solving.stopped_for_good().is_some())
    }

    /// Whether the newest step is at fault, and the flattener has steps left that it has not taken.
    pub fn can_repair(&self) -> bool {
        let is_at_rest = !self.is_running() && self.preview().is_none() && !self.history.is_in_gesture();
        is_at_rest && self.is_current() && self.solving.can_go_on_from_fault(&self.document.problem())
    }

    /// Whether the newest step is one-to-one, its constraints met, and its run waits to be taken on.
    pub fn can_relax(&self) -> bool {
        self.is_current() && self.solving.can_relax(&self.document.problem())
    }
}

/// Solutions of earlier documents.
impl Session {
    /// Keeps what is solved for the document as it is, where a run has come to rest with it: it is about to become another.
    pub(super) fn remember(&mut self) {
        let place = self.history.depth();
        if !self.history.can_redo() {
            self.history.past_mut().forget_beyond(place);
        }
        if self.history.is_in_gesture() && !self.is_current() {
            return;
        }
        self.history.past_mut().forget(place);
        let mesh = self.disk().filter(|_| self.has_form_as_wanted()).cloned();
        let solved = self.solving.solved(&self.document.problem(), BUDGET_OF_ONE);
        if let (Some(mesh), Some(solved)) = (mesh, solved) {
            self.history.past_mut().keep(place, State { mesh, relaxed: self.document.relaxed, solved });
        }
    }

    /// Shows what was solved for the document when it was as it is again. Returns whether that is kept.
    pub(super) fn recall(&mut self) -> bool {
        let Some(task) = self.task() else { return false };
        let (place, relaxed) = (self.history.depth(), self.document.relaxed);
        let Some(solved) = self.history.past_mut().take(place, &task, relaxed) else { return false };
        self.drag.end();
        self.solving.show_again(solved, task, &mut self.messages);
        true
    }
}
