//! The charts that are not on the screen: each is solved in the background, as the one on the screen is, and keeps its steps.
//!
//! One chart is on the screen; the session's own run is its. When another takes its place, runs and steps change places with
//! it, so that nothing is solved twice. The others wait for a thread, the first ones first, and are solved again where
//! the document has changed for them.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::atlas_view::AtlasViews;
use super::model::ChartOf;
use super::solving::{Next, Rest, Solving, Task};
use super::stop::Goal;
use super::{
    Background, ChartEdits, Command, Messages, Model, Outcome, Problem, Session, StopConditions, TIMELINE_BUDGET,
    Timeline, Wake,
};
use crate::geom::PackingOptions;
use crate::mesh::Charts;

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
    /// How all of them lie together.
    pub(super) views: AtlasViews,
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
        Self {
            wake: Arc::clone(wake),
            others: BTreeMap::new(),
            forming: Background::new("chart", wake),
            asked: None,
            views: AtlasViews::new(wake),
        }
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
        let Some(of) = &model.chart else { return };
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
}

impl Session {
    /// The charts of the open mesh, where it has several.
    pub fn charts(&self) -> Option<&Arc<Charts>> {
        self.model()?.chart.as_ref().map(|of| &of.charts)
    }

    /// The chart on the screen.
    pub fn chart_on_screen(&self) -> Option<usize> {
        self.model()?.chart.as_ref().map(|of| of.number)
    }

    /// How a chart stands to the document.
    pub fn chart_state(&self, number: usize) -> ChartState {
        let Some(of) = self.model().and_then(|model| model.chart.as_ref()) else { return ChartState::Failed };
        let (solving, is_running) = if of.number == number {
            (&self.solving, self.is_running())
        } else {
            match self.charts.others.get(&number) {
                Some(other) => (&other.solving, other.solving.is_running()),
                None => return ChartState::Solving,
            }
        };
        let problem = self.document.problem_with(self.document.edits_of(number, of).targets);
        let newest = solving.newest().filter(|outcome| outcome.problem.has_steps_of(&problem));
        match newest {
            Some(outcome) if !is_running => ChartState::Solved(Arc::clone(outcome)),
            None if solving.has_failed(&problem) && !is_running => ChartState::Failed,
            _ => ChartState::Solving,
        }
    }

    /// Puts another chart on the screen, as an edit; once it has been taken out of the mesh, where it has not yet.
    pub(super) fn show_chart(&mut self, number: usize) {
        let model = self.model().filter(|_| self.has_numbers_as_wanted());
        let Some(of) = model.and_then(|model| model.chart.clone()) else { return };
        let from = of.charts.pick(self.document.chart);
        self.charts.asked = None;
        if number >= of.charts.count() {
            return;
        }
        if number == from {
            if !self.has_chart_as_wanted() {
                self.follow_chart();
            }
            return;
        }
        if number != of.number && self.charts.model(number).is_none() {
            self.charts.asked = Some(number);
            return;
        }
        self.end_gesture();
        self.apply(Command::ShowChart { to: number, from, chart: Some(number) });
        self.follow_chart();
    }

    /// Chooses how charts are packed, as an edit. No chart is solved anew for it.
    pub(super) fn set_packing(&mut self, options: PackingOptions) {
        self.apply(Command::SetPacking(options));
    }

    /// Chooses how large a chart is packed, as an edit. No chart is solved anew for it.
    pub(super) fn set_chart_size(&mut self, chart: usize, size: f64) {
        let first_face = self.charts().filter(|charts| chart < charts.count()).map(|charts| charts.first_face(chart));
        if let Some(first_face) = first_face.filter(|_| PackingOptions::SIZES.contains(&size)) {
            #[expect(clippy::float_cmp, reason = "the size without an entry")]
            let size = (size != 1.0).then_some(size);
            self.apply(Command::SetSize { first_face, size });
        }
    }

    /// How many times as large as the others each chart is packed.
    pub fn sizes(&self) -> Vec<f64> {
        let of =
            |charts: &Arc<Charts>| (0..charts.count()).map(|number| self.document.size_of(charts, number)).collect();
        self.charts().map(of).unwrap_or_default()
    }

    /// Solves for what the document wants on the screen, where it is not there, or on its way.
    pub(super) fn follow_chart(&mut self) {
        self.drag.end();
        let is_there = self.bring_form();
        let problem = self.document.problem();
        let is_under_way = self.solving.running_problem().is_some_and(|of| of.has_steps_of(&problem));
        if !is_there || !(self.is_current() || is_under_way) {
            self.solve();
        }
    }

    /// Takes in what was done to the charts that are not on the screen, and has more done.
    pub(super) fn poll_charts(&mut self) {
        // In another form the document has other charts.
        let model = self.model().filter(|_| self.has_numbers_as_wanted());
        let Some(of) = model.and_then(|model| model.chart.clone()) else { return };
        let revision = self.model_revision();
        while let Some(((of_mesh, number), formed)) = self.charts.forming.poll() {
            if formed.is_err() {
                // Nobody waits for what does not come.
                self.charts.asked.take_if(|asked| *asked == number);
            }
            if let Some(model) = formed.ok().filter(|_| of_mesh == revision && number != of.number) {
                let solving = Solving::new(Arc::clone(&self.charts.wake), share(&of));
                let other = Other { model: Arc::new(model), solving, messages: Messages::default() };
                self.charts.others.entry(number).or_insert(other);
            }
        }
        let mut free = AT_ONCE.saturating_sub(self.charts.running_count());
        let (stop, is_at_rest) = (self.solving.stop_conditions(), !self.history.is_in_gesture());
        for (&number, other) in &mut self.charts.others {
            let ChartEdits { targets, relaxed } = self.document.edits_of(number, &of);
            let problem = self.document.problem_with(targets);
            // A run of what is wanted no more gives its place to the next.
            let may_begin = is_at_rest && (free > 0 || other.solving.is_running());
            let has_begun = other.poll(problem, relaxed, may_begin.then_some(stop));
            free = free.saturating_sub(usize::from(has_begun));
        }
        self.form_next(&of, revision);
        if let Some(number) = self.charts.asked.filter(|&number| self.charts.model(number).is_some()) {
            self.show_chart(number);
        }
    }

    /// Has the next chart taken out of the mesh.
    fn form_next(&mut self, of: &ChartOf, revision: u64) {
        let is_open = |number: &usize| *number != of.number && !self.charts.others.contains_key(number);
        let next = self.charts.asked.into_iter().chain(0..of.charts.count()).find(is_open);
        if let (Some(number), Some(model)) = (next.filter(|_| !self.charts.forming.is_busy()), self.model().cloned()) {
            self.charts.forming.start((revision, number), move |_| model.of_chart(number));
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
            (None, Some(Rest::ByItself), _) if rounds > 0 && is_solved && self.solving.has_ended() => {
                self.solving.relax(task, rounds, &mut self.messages);
            }
            (.., Some(stop)) if is_idle => self.solving.begin(task, Goal::Until(stop)),
            _ => {}
        }
        !was_running && self.solving.is_running()
    }
}
