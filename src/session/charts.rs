//! Charts that are not shown. Each of them is solved in the background like the shown chart, and keeps its steps.
//!
//! The run of the session belongs to the shown chart. If another chart is shown, the two charts swap runs and steps, so
//! that nothing is solved twice. The other charts wait for a thread in the order of their numbers. A chart is solved
//! again if the document has changed for it.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::solving::{Next, Solved, Solving, StopReason, Task};
use super::stop::Goal;
use super::{Background, Document, Messages, Model, StopConditions, TIMELINE_BUDGET, Timeline, Wake};
use freebound_core::mesh::Charts;
use freebound_core::pipeline::{ChartOf, Outcome, Problem};
use freebound_io::NamedGroups;

/// Maximum number of charts that are solved at once beside the shown chart.
const AT_ONCE: usize = 2;

/// State of a chart relative to the document.
#[derive(Clone, Debug)]
pub enum ChartState {
    /// The chart waits for its turn or is being solved.
    Solving,
    /// The newest step of the chart belongs to the document.
    Solved(Arc<Outcome>),
    /// The solve failed for the current document.
    Failed,
}

/// Lock of a chart, or the reason why the chart cannot be locked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LockState {
    /// The chart is packed, and can be locked.
    Open,
    /// The chart stays where it was locked.
    Locked,
    /// Pins place the chart.
    Pinned,
    /// The chart shares the place of another.
    Stacked,
    /// There is no layout of all charts, or the chart has no finite coordinates in it.
    NoPlace,
}

/// Charts that are not shown.
pub(super) struct OtherCharts {
    wake: Wake,
    others: BTreeMap<usize, Other>,
    /// Charts being extracted from the mesh, by the mesh's revision and their number.
    forming: Background<(u64, usize), Model>,
    /// Chart that the user requested, until it is extracted.
    asked: Option<usize>,
    /// Names of the charts of a mesh.
    names: Option<(Arc<Charts>, Vec<String>)>,
}

/// Chart that is not shown.
struct Other {
    model: Arc<Model>,
    solving: Solving,
    /// Messages of its runs. They are not displayed while another chart is shown.
    messages: Messages,
}

/// Name of each chart: of the group of most of its faces.
fn names_of(model: &Model, charts: &Charts) -> Vec<String> {
    let Some(NamedGroups { names, of_face }) = model.source.named_groups() else { return Vec::new() };
    let name = |chart: usize| {
        let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
        let faces = charts.faces(chart).iter().filter_map(|&face| charts.whole().face_in_file(face));
        for group in faces.filter_map(|face| of_face.get(face.index())) {
            *counts.entry(*group).or_default() += 1;
        }
        // Of equally many faces, those of the first group count.
        let most = counts.into_iter().reduce(|most, other| if other.1 > most.1 { other } else { most });
        most.and_then(|(group, _)| names.get(group as usize).cloned()).unwrap_or_default()
    };
    (0..charts.count()).map(name).collect()
}

/// Memory budget for the steps of a chart that is not shown, bytes. All these charts together use at most the budget of
/// the shown chart.
fn share(of: &ChartOf) -> usize {
    TIMELINE_BUDGET / of.charts.count()
}

impl OtherCharts {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            wake: Arc::clone(wake),
            others: BTreeMap::new(),
            forming: Background::new("chart", wake),
            asked: None,
            names: None,
        }
    }

    /// Drops all charts, because another mesh is open or the mesh has another preparation.
    pub(super) fn forget(&mut self) {
        self.others.clear();
        self.forming.cancel();
        (self.asked, self.names) = (None, None);
    }

    /// Name of a chart by the groups of its file; empty if it has none.
    pub(super) fn name(&self, charts: &Arc<Charts>, chart: usize) -> Option<&str> {
        let (_, names) = self.names.as_ref().filter(|(of, _)| Arc::ptr_eq(of, charts))?;
        names.get(chart).map(String::as_str).filter(|name| !name.is_empty())
    }

    /// Finds the names of the charts once per mesh.
    pub(super) fn refresh_names(&mut self, model: &Model, charts: &Arc<Charts>) {
        if self.names.as_ref().is_none_or(|(of, _)| !Arc::ptr_eq(of, charts)) {
            self.names = Some((Arc::clone(charts), names_of(model, charts)));
        }
    }

    /// Model of a chart that is extracted.
    pub(super) fn model(&self, number: usize) -> Option<&Arc<Model>> {
        self.others.get(&number).map(|other| &other.model)
    }

    /// True if the user requested a chart that is not extracted yet.
    pub(super) fn is_asked(&self) -> bool {
        self.asked.is_some()
    }

    /// Cancels the request for a chart that is not extracted yet.
    pub(super) fn forget_asked(&mut self) {
        self.asked = None;
    }

    /// Swaps the shown chart `model` and its run with the chart `number`, whose run becomes the shown run.
    pub(super) fn exchange(&mut self, model: &Arc<Model>, solving: &mut Solving, number: usize) {
        let Some(of) = &model.prepared.chart else { return };
        let coming = self.others.remove(&number).map(|other| other.solving);
        let mut coming = coming.unwrap_or_else(|| Solving::new(Arc::clone(&self.wake), TIMELINE_BUDGET));
        coming.come_on_screen_after(solving, share(of));
        let going = std::mem::replace(solving, coming);
        let other = Other { model: Arc::clone(model), solving: going, messages: Messages::default() };
        self.others.insert(of.number, other);
    }

    /// Stores a chart with a map that was saved.
    pub(super) fn restore(&mut self, of: &ChartOf, outcome: Arc<Outcome>, task: Task, relaxed: usize) {
        let mut solving = Solving::new(Arc::clone(&self.wake), share(of));
        let (model, mut messages) = (Arc::clone(&task.model), Messages::default());
        solving.show_map(outcome, task, relaxed, &mut messages);
        self.others.insert(of.number, Other { model, solving, messages });
    }

    /// Model and steps of a chart that is extracted.
    pub(super) fn other(&self, number: usize) -> Option<(&Arc<Model>, &Timeline)> {
        self.others.get(&number).map(|other| (&other.model, other.solving.timeline()))
    }

    /// Restores a solution of a chart that is not shown.
    pub(super) fn show_again(&mut self, number: usize, solved: Solved, task: Task) {
        if let Some(other) = self.others.get_mut(&number) {
            other.solving.show_again(solved, task, &mut other.messages);
        }
    }

    fn running_count(&self) -> usize {
        self.others.values().filter(|other| other.solving.is_running()).count()
    }

    /// Requests a chart that is not extracted yet.
    pub(super) fn ask(&mut self, number: usize) {
        self.asked = Some(number);
    }

    /// Number of the requested chart, once it is extracted.
    pub(super) fn asked_and_formed(&self) -> Option<usize> {
        self.asked.filter(|&number| self.model(number).is_some())
    }

    /// Run of a chart that is extracted.
    pub(super) fn solving(&self, number: usize) -> Option<&Solving> {
        self.others.get(&number).map(|other| &other.solving)
    }

    /// Stores charts that were extracted from the mesh with this revision. `of` is the shown chart.
    pub(super) fn poll_forming(&mut self, of: &ChartOf, revision: u64) {
        while let Some(((of_mesh, number), formed)) = self.forming.poll() {
            if formed.is_err() {
                // The requested chart will not arrive.
                self.asked.take_if(|asked| *asked == number);
            }
            if let Some(model) = formed.ok().filter(|_| of_mesh == revision && number != of.number) {
                let solving = Solving::new(Arc::clone(&self.wake), share(of));
                let other = Other { model: Arc::new(model), solving, messages: Messages::default() };
                self.others.entry(number).or_insert(other);
            }
        }
    }

    /// Processes the results of the runs and continues them. New runs begin only if `is_at_rest`, with these stop
    /// conditions.
    pub(super) fn poll_runs(&mut self, document: &Document, of: &ChartOf, stop: StopConditions, is_at_rest: bool) {
        let mut free = AT_ONCE.saturating_sub(self.running_count());
        for (&number, other) in &mut self.others {
            let edits = document.edits_of(number, of);
            let (relaxed, problem) = (edits.relaxed, document.problem_with(edits));
            // A run of an outdated problem passes its place to the next run.
            let may_begin = is_at_rest && (free > 0 || other.solving.is_running());
            let has_begun = other.poll(problem, relaxed, may_begin.then_some(stop));
            free = free.saturating_sub(usize::from(has_begun));
        }
    }

    /// Extracts the next chart in the background.
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
    /// Processes the results of the chart's run and continues it. If the chart has to be solved again and `begin` holds
    /// conditions, a run with these conditions begins. `relaxed` relaxation rounds follow the end of the run. Returns
    /// true if a run has begun.
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
