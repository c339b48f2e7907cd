//! Runs that solve the document.

use std::sync::Arc;

use super::past::{BUDGET_OF_ONE, Solution, State};
use super::solving::{Beginning, Next, StopReason, Task};
use super::stop::Goal;
use super::{Command, Session};
use freebound_core::problem::{Method, Settings};

/// Number of relaxation rounds of one request.
const RELAX_ROUNDS: usize = 20;

impl Session {
    /// Task of the document, if the mesh is a disk and has the wanted preparation.
    pub(super) fn task(&mut self) -> Option<Task> {
        let has_form = self.bring_form();
        let mesh = self.disk().filter(|_| has_form)?.clone();
        Some(Task { model: self.model()?.clone(), mesh, problem: self.document.problem(), from: None })
    }

    /// Starts a run of the current document, from the existing embedding if possible. During a gesture the run takes
    /// only its first step, so that the result follows the drag at the speed of the solver.
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

    /// Starts a run of the current document. The preview stays until the first step arrives. If the shown embedding is
    /// planar, the run continues from it.
    fn run_document(&mut self) {
        self.solving.follow_newest();
        let (goal, from) = (Goal::Until(self.stop_conditions()), self.planar_on_screen());
        if let Some(task) = self.task() {
            self.solving.begin(Task { from, ..task }, goal);
        }
    }

    /// Starts a run. If only targets differ from the run in progress, its first step is finished before.
    pub(super) fn begin(&mut self, goal: Goal) {
        if let Some(task) = self.task() {
            self.solving.begin(task, goal);
        }
    }

    /// Continues the stopped run, or starts a run if the document has changed since.
    fn go_on(&mut self, goal: Goal) {
        let from = self.beginning();
        if let Some(task) = self.task() {
            self.solving.go_on(Task { from, ..task }, goal);
        }
    }

    /// Takes one more step, even if the method has ended. A run in progress stops after its current step. The history
    /// remembers the number of steps for the next time that the document has this state.
    pub(super) fn step(&mut self) {
        self.layout_check.end_wait();
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

    /// Continues until a stop condition holds, and resumes relaxation that was paused.
    pub(super) fn run_on(&mut self) {
        self.layout_check.end_wait();
        if !self.is_running() && self.can_run() {
            self.resume_relaxing(usize::MAX);
        }
        self.run_further();
    }

    /// Continues until a stop condition holds.
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

    /// Lowers the distortion of the newest step at the user's request. Every step is one-to-one and meets the
    /// constraints exactly. The request is an edit: it applies to later runs and can be undone.
    pub(super) fn relax(&mut self) {
        self.solving.follow_newest();
        self.remember();
        if self.relax_by(RELAX_ROUNDS) {
            let rounds = self.document.relaxed.saturating_add(RELAX_ROUNDS);
            self.history.apply(Command::SetRelaxed(rounds), &mut self.document);
        }
    }

    /// Resumes at most `most` relaxation rounds that a pause cut short, as an edit. Returns true if there are any.
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
            // Keep the redo stack, because nothing new was requested.
            self.history.amend(relaxed, &mut self.document);
            return true;
        }
        self.history.apply(relaxed, &mut self.document)
    }

    /// Takes a stopped run to the state that the user took it to before: by relaxation rounds of the document that the
    /// run lacks, and by single steps.
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

    /// Records that the run stopped earlier than before, so that it is not taken further again.
    fn stay_here(&mut self) {
        let newest = self.timeline().newest().unwrap_or(0);
        self.history.set_taken_to(self.history.taken_to().min(newest));
    }

    /// Takes all steps of the automatic method until the embedding is planar or no stage is left. Another method is
    /// replaced by the automatic one, as an edit.
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

    /// Adds relaxation rounds after the newest step. Returns true if they begin.
    fn relax_by(&mut self, rounds: usize) -> bool {
        match self.task().filter(|_| self.can_relax()) {
            Some(task) => self.solving.relax(task, rounds, &mut self.messages),
            None => false,
        }
    }

    /// Solves from scratch, ignoring the current embedding and dropping the requested relaxation.
    pub(super) fn solve_from_scratch(&mut self) {
        self.layout_check.end_wait();
        self.apply(Command::Together(vec![Command::SetRelaxed(0), Command::SetShaped(None)]));
        self.history.set_taken_to(0);
        self.solve_from(None);
    }

    /// Ends a gesture. If no step or only the first one was taken, the remaining steps follow.
    pub(super) fn end_gesture(&mut self) {
        let was_in_gesture = self.history.is_in_gesture();
        self.history.end_gesture(&mut self.document);
        self.drag.stop_following();
        if !was_in_gesture {
            return;
        }
        if !self.is_running() && self.is_current() {
            // The gesture ended where it began, or the steps were taken while the pointer paused.
            self.drag.end();
        }
        if !self.is_running() && !self.is_current() {
            self.run_document();
        } else if !self.solving.is_outdated() {
            self.run_further();
        }
    }

    /// Restores the steps after a gesture was cancelled. Steps that still belong to the document are kept.
    pub(super) fn give_up_drag(&mut self) {
        if self.is_current() && !self.solving.is_outdated() {
            self.drag.end();
            self.run_further();
        } else if !self.recall() {
            self.solve();
        }
    }

    /// Takes all steps of the run while the pointer pauses during a drag.
    pub(super) fn rest(&mut self) {
        if self.history.is_in_gesture() && self.preview().is_some() && !self.is_running() {
            self.drag.stop_following();
            self.run_document();
        }
    }

    /// Processes the results of the run.
    pub(super) fn poll_solving(&mut self) {
        let news = self.solving.poll(&mut self.messages);
        if news.has_begun {
            self.drag.end_preview();
        }
        // Relaxation rounds of an opened project stay: there is no step in the history to change.
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

    /// Drops all solutions, because they belong to another mesh or preparation.
    pub(super) fn forget_steps(&mut self) {
        self.solving.forget(&mut self.messages);
        self.drag.end();
    }

    /// True if a run until the stop conditions would take a step.
    pub fn can_run(&self) -> bool {
        self.disk().is_some() && !(self.is_current() && self.solving.stopped_for_good().is_some())
    }

    /// True if the newest step is not planar and the automatic method has steps left.
    pub fn can_repair(&self) -> bool {
        let is_at_rest = !self.is_running() && self.preview().is_none() && !self.history.is_in_gesture();
        is_at_rest && self.is_current() && self.solving.can_go_on_from_fault(&self.document.problem())
    }

    /// True if the newest step is one-to-one and meets its constraints, and its run can be continued.
    pub fn can_relax(&self) -> bool {
        self.is_current() && self.solving.can_relax(&self.document.problem())
    }
}

/// Solutions of earlier documents.
impl Session {
    /// Stores the solution of the current document before an edit, if its run has stopped.
    pub(super) fn remember(&mut self) {
        let place = self.history.depth();
        if !self.history.can_redo() {
            self.history.past_mut().forget_beyond(place);
        }
        if self.history.is_in_gesture() && !self.is_current() {
            return;
        }
        self.history.past_mut().forget(place, Solution::Shown);
        let mesh = self.disk().filter(|_| self.has_form_as_wanted()).cloned();
        let solved = self.solving.solved(&self.document.problem(), BUDGET_OF_ONE);
        if let (Some(mesh), Some(solved)) = (mesh, solved) {
            self.history.past_mut().keep(
                place,
                Solution::Shown,
                State { mesh, relaxed: self.document.relaxed, solved },
            );
        }
    }

    /// Stores the solutions of charts that are not shown, before an edit of these charts.
    pub(super) fn remember_charts(&mut self, charts: impl IntoIterator<Item = usize>) {
        let place = self.history.depth();
        for chart in charts {
            let solved =
                self.charts.solving(chart).zip(self.task_of_chart(chart)).and_then(|(solving, (task, relaxed))| {
                    let solved = solving.solved(&task.problem, BUDGET_OF_ONE)?;
                    Some(State { mesh: task.mesh, relaxed, solved })
                });
            if let Some(state) = solved {
                self.history.past_mut().keep(place, Solution::Chart(chart), state);
            }
        }
    }

    /// Restores the stored solutions of charts that are not shown.
    pub(super) fn recall_charts(&mut self) {
        let place = self.history.depth();
        for chart in self.history.past_mut().charts(Some(place)) {
            let Some((task, relaxed)) = self.task_of_chart(chart) else { continue };
            if let Some(solved) = self.history.past_mut().take(place, Solution::Chart(chart), &task, relaxed) {
                self.charts.show_again(chart, solved, task);
            }
        }
    }

    /// Task of a chart that is not shown, and its number of relaxation rounds.
    fn task_of_chart(&self, chart: usize) -> Option<(Task, usize)> {
        let of = self.model()?.prepared.chart.as_ref().filter(|of| of.number != chart)?;
        let (edits, model) = (self.document.edits_of(chart, of), self.charts.model(chart)?);
        let (relaxed, mesh) = (edits.relaxed, Arc::clone(model.disk()?));
        let problem = self.document.problem_with(edits);
        Some((Task { model: Arc::clone(model), mesh, problem, from: None }, relaxed))
    }

    /// Shows the stored solution of the document. Returns false if none is stored.
    pub(super) fn recall(&mut self) -> bool {
        let Some(task) = self.task() else { return false };
        let (place, relaxed) = (self.history.depth(), self.document.relaxed);
        let Some(solved) = self.history.past_mut().take(place, Solution::Shown, &task, relaxed) else { return false };
        self.drag.end();
        self.solving.show_again(solved, task, &mut self.messages);
        true
    }
}
