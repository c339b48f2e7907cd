//! The charts that are not on the screen: each is solved in the background, as the one on the screen is, and keeps its steps.
//!
//! One chart is on the screen; the session's own run is its. When another takes its place, runs and steps change places with
//! it, so that nothing is solved twice. The others wait for a thread, the first ones first, and are solved again where
//! the document has changed for them.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::solving::{Next, Solving, StopReason, Task};
use super::stop::Goal;
use super::{Background, ChartEdits, Document, Messages, Model, StopConditions, TIMELINE_BUDGET, Timeline, Wake};
use freebound_core::pipeline::{ChartOf, Outcome, Problem};

/// The most charts that are solved at once beside the one on the screen.
const AT_ONCE: usize = 2;

/// How a chart stands to the document.
#[derive(Clone, Debug)]
pub enum ChartState {
    /// It waits for its turn, or is being solved.
    Solving,
    /// Its newest step belongs to the document.
    Solved(Arc<Outcome>),
    /// Nothing was found for the document as it is.
    Failed,
}

/// Charts that are not on the screen.
pub(super) struct OtherCharts {
    wake: Wake,
    others: BTreeMap<usize, Other>,
    /// Charts that are taken out of their mesh, by their number and the mesh's revision.
    forming: Background<(u64, usize), Model>,
    /// The chart that a person asked for, until it has been taken out.
    asked: Option<usize>,
}

/// A chart that is not on the screen.
struct Other {
    model: Arc<Model>,
    solving: Solving,
    /// What its runs have to say; nobody reads it while another chart is on the screen.
    messages: Messages,
}

/// Bytes that the steps of a chart which is not on the screen may take: together no more than those of the one that is.
fn share(of: &ChartOf) -> usize {
    TIMELINE_BUDGET / of.charts.count()
}

impl OtherCharts {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { wake: Arc::clone(wake), others: BTreeMap::new(), forming: Background::new("chart", wake), asked: None }
    }

    /// Drops all: another mesh is open, or the same one in another form.
    pub(super) fn forget(&mut self) {
        self.others.clear();
        self.forming.cancel();
        self.asked = None;
    }

    /// A chart that has been taken out of the mesh.
    pub(super) fn model(&self, number: usize) -> Option<&Arc<Model>> {
        self.others.get(&number).map(|other| &other.model)
    }

    /// Whether a person asked for a chart that is not there yet.
    pub(super) fn is_asked(&self) -> bool {
        self.asked.is_some()
    }

    /// Forgets the chart that a person asked for and that is not there yet.
    pub(super) fn forget_asked(&mut self) {
        self.asked = None;
    }

    /// Exchanges the chart on the screen, `model` with its run, for another one, whose run takes its place.
    pub(super) fn exchange(&mut self, model: &Arc<Model>, solving: &mut Solving, number: usize) {
        let Some(of) = &model.prepared.chart else { return };
        let coming = self.others.remove(&number).map(|other| other.solving);
        let mut coming = coming.unwrap_or_else(|| Solving::new(Arc::clone(&self.wake), TIMELINE_BUDGET));
        coming.come_on_screen_after(solving, share(of));
        let going = std::mem::replace(solving, coming);
        let other = Other { model: Arc::clone(model), solving: going, messages: Messages::default() };
        self.others.insert(of.number, other);
    }

    /// A chart that has been taken out of the mesh, with its steps.
    pub(super) fn other(&self, number: usize) -> Option<(&Arc<Model>, &Timeline)> {
        self.others.get(&number).map(|other| (&other.model, other.solving.timeline()))
    }

    fn running_count(&self) -> usize {
        self.others.values().filter(|other| other.solving.is_running()).count()
    }

    /// Notes the chart that a person asks for, until it has been taken out.
    pub(super) fn ask(&mut self, number: usize) {
        self.asked = Some(number);
    }

    /// The chart that a person asked for, once it has been taken out.
    pub(super) fn asked_and_formed(&self) -> Option<usize> {
        self.asked.filter(|&number| self.model(number).is_some())
    }

    /// The run of a chart that has been taken out.
    pub(super) fn solving(&self, number: usize) -> Option<&Solving> {
        self.others.get(&number).map(|other| &other.solving)
    }

    /// Takes in charts that were taken out of the mesh of a revision, while `of` is on the screen.
    pub(super) fn poll_forming(&mut self, of: &ChartOf, revision: u64) {
        while let Some(((of_mesh, number), formed)) = self.forming.poll() {
            if formed.is_err() {
                // Nobody waits for what does not come.
                self.asked.take_if(|asked| *asked == number);
            }
            if let Some(model) = formed.ok().filter(|_| of_mesh == revision && number != of.number) {
                let solving = Solving::new(Arc::clone(&self.wake), share(of));
                let other = Other { model: Arc::new(model), solving, messages: Messages::default() };
                self.others.entry(number).or_insert(other);
            }
        }
    }

    /// Takes in what the runs have done, and has them go on; new ones begin only at rest, to these conditions.
    pub(super) fn poll_runs(&mut self, document: &Document, of: &ChartOf, stop: StopConditions, is_at_rest: bool) {
        let mut free = AT_ONCE.saturating_sub(self.running_count());
        for (&number, other) in &mut self.others {
            let ChartEdits { targets, relaxed } = document.edits_of(number, of);
            let problem = document.problem_with(targets);
            // A run of what is wanted no more gives its place to the next.
            let may_begin = is_at_rest && (free > 0 || other.solving.is_running());
            let has_begun = other.poll(problem, relaxed, may_begin.then_some(stop));
            free = free.saturating_sub(usize::from(has_begun));
        }
    }

    /// Has the next chart taken out of the mesh.
    pub(super) fn form_next(&mut self, model: &Arc<Model>, of: &ChartOf, revision: u64) {
        let is_open = |number: &usize| *number != of.number && !self.others.contains_key(number);
        let next = self.asked.into_iter().chain(0..of.charts.count()).find(is_open);
        if let Some(number) = next.filter(|_| !self.forming.is_busy()) {
            let model = Arc::clone(model);
            self.forming.start((revision, number), move |_| model.of_chart(number));
        }
    }
}

impl Other {
    /// Takes in what its run has done, and has it go on; where it is to be solved anew, to these conditions, if it may. `relaxed`
    /// rounds of relaxing follow its end. Returns whether a run has begun.
    fn poll(&mut self, problem: Problem, relaxed: usize, begin: Option<StopConditions>) -> bool {
        let was_running = self.solving.is_running();
        let news = self.solving.poll(&mut self.messages);
        let Some(mesh) = self.model.disk().map(Arc::clone) else { return false };
        let rounds = relaxed.saturating_sub(self.solving.rounds_asked());
        let is_solved = self.solving.newest().is_some_and(|newest| newest.problem.has_steps_of(&problem));
        let is_under_way = self.solving.running_problem().is_some_and(|of| of.has_steps_of(&problem));
        let is_idle = !is_under_way && !is_solved && !self.solving.has_failed(&problem);
        let task = Task { model: Arc::clone(&self.model), mesh, problem, from: None };
        match (news.next, news.rest, begin) {
            (Some(Next::On(goal)), ..) => self.solving.go_on(task, goal),
            (None, Some(StopReason::ByItself), _) if rounds > 0 && is_solved && self.solving.has_ended() => {
                self.solving.relax(task, rounds, &mut self.messages);
            }
            (.., Some(stop)) if is_idle => self.solving.begin(task, Goal::Until(stop)),
            _ => {}
        }
        !was_running && self.solving.is_running()
    }
}
