//! Actions on meshes with several charts: the shown chart, the charts in the background, and their layout.

use std::sync::Arc;

use super::atlas_view::{AtlasKey, ChartResult, SolvedAtlas};
use super::{AtlasView, ChartState, Command, LockState, Model, Session, Timeline};
use freebound_core::geom::PackingOptions;
use freebound_core::mesh::Charts;
use freebound_core::pipeline::Outcome;
use freebound_core::problem::Embedding;

impl Session {
    /// Charts of the open mesh, if it has several.
    pub fn charts(&self) -> Option<&Arc<Charts>> {
        self.model()?.prepared.chart.as_ref().map(|of| &of.charts)
    }

    /// Number of the shown chart.
    pub fn chart_on_screen(&self) -> Option<usize> {
        self.model()?.prepared.chart.as_ref().map(|of| of.number)
    }

    /// State of a chart relative to the document.
    pub fn chart_state(&self, number: usize) -> ChartState {
        let Some(of) = self.model().and_then(|model| model.prepared.chart.as_ref()) else { return ChartState::Failed };
        let (solving, is_running) = if of.number == number {
            (&self.solving, self.is_running())
        } else {
            match self.charts.solving(number) {
                Some(solving) => (solving, solving.is_running()),
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

    /// Shows another chart, as an edit. A chart that is not extracted from the mesh yet is shown once it is extracted.
    pub(super) fn show_chart(&mut self, number: usize) {
        let model = self.model().filter(|_| self.has_numbers_as_wanted());
        let Some(of) = model.and_then(|model| model.prepared.chart.clone()) else { return };
        let from = of.charts.pick(self.document.chart);
        self.charts.forget_asked();
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
            self.charts.ask(number);
            return;
        }
        self.end_gesture();
        self.apply(Command::ShowChart { to: number, from, chart: Some(number) });
        self.follow_chart();
    }

    /// Sets the packing options, as an edit. No chart is solved again.
    pub(super) fn set_packing(&mut self, options: PackingOptions) {
        self.apply(Command::SetPacking(options));
    }

    /// Sets the relative size of a chart, as an edit. No chart is solved again.
    pub(super) fn set_chart_size(&mut self, chart: usize, size: f64) {
        let first_face = self.charts().filter(|charts| chart < charts.count()).map(|charts| charts.first_face(chart));
        if let Some(first_face) = first_face.filter(|_| PackingOptions::SIZES.contains(&size)) {
            #[expect(clippy::float_cmp, reason = "the size without an entry")]
            let size = (size != 1.0).then_some(size);
            self.apply(Command::SetSize { first_face, size });
        }
    }

    /// Locks a chart where it lies in the layout, or unlocks it, as an edit. No chart is solved again. A chart that
    /// cannot be locked, see [`lock_state`](Self::lock_state), stays unlocked.
    pub(super) fn lock_chart(&mut self, chart: usize, lock: bool) {
        let Some(charts) = self.charts().filter(|charts| chart < charts.count()) else { return };
        let first_face = charts.first_face(chart);
        let place = match (self.lock_state(chart), lock) {
            (LockState::Open, true) => self.atlas().map(|atlas| Arc::new(atlas.coordinates[chart].clone())),
            (LockState::Locked, false) => None,
            _ => return,
        };
        self.apply(Command::SetLock { first_face, place });
    }

    /// Lock of a chart, or the reason why it cannot be locked.
    pub fn lock_state(&self, chart: usize) -> LockState {
        self.lock_state_in(chart, self.atlas())
    }

    /// [`lock_state`](Self::lock_state) with the present layout of all charts, if there is one.
    pub fn lock_state_in(&self, chart: usize, atlas: Option<&AtlasView>) -> LockState {
        let Some(of) = self.model().and_then(|model| model.prepared.chart.as_ref()) else { return LockState::NoPlace };
        if chart >= of.charts.count() {
            return LockState::NoPlace;
        }
        let has_pins = !self.document().edits_of(chart, of).targets.is_empty();
        let is_locked = self.document().lock_of(&of.charts, chart).is_some();
        match atlas {
            _ if is_locked => LockState::Locked,
            _ if has_pins => LockState::Pinned,
            Some(atlas) if atlas.stacked[chart].is_some() => LockState::Stacked,
            Some(atlas) if atlas.coordinates[chart].iter().all(|uv| uv.is_finite()) => LockState::Open,
            _ => LockState::NoPlace,
        }
    }

    /// Coordinates where each chart is locked.
    fn locks(&self) -> Vec<Option<Arc<Embedding>>> {
        let of = |charts: &Arc<Charts>| {
            (0..charts.count()).map(|number| self.document.lock_of(charts, number).cloned()).collect()
        };
        self.charts().map(of).unwrap_or_default()
    }

    /// Relative size of each chart in the packing.
    pub fn sizes(&self) -> Vec<f64> {
        let of =
            |charts: &Arc<Charts>| (0..charts.count()).map(|number| self.document.size_of(charts, number)).collect();
        self.charts().map(of).unwrap_or_default()
    }

    /// Solves for the chart that the document shows, unless it is solved or its run is in progress.
    pub(super) fn follow_chart(&mut self) {
        self.drag.end();
        let is_there = self.bring_form();
        let problem = self.document.problem();
        let is_under_way = self.solving.running_problem().is_some_and(|of| of.has_steps_of(&problem));
        if !is_there || !(self.is_current() || is_under_way) {
            self.solve();
        }
    }

    /// Processes the results of the charts in the background and starts their next runs.
    pub(super) fn poll_charts(&mut self) {
        // With another preparation the document has other charts.
        let Some(model) = self.model().filter(|_| self.has_numbers_as_wanted()).cloned() else { return };
        let Some(of) = model.prepared.chart.clone() else { return };
        let revision = self.model_revision();
        self.charts.poll_forming(&of, revision);
        let (stop, is_at_rest) = (self.solving.stop_conditions(), !self.history.is_in_gesture());
        self.charts.poll_runs(&self.document, &of, stop, is_at_rest);
        self.charts.form_next(&model, &of, revision);
        if let Some(number) = self.charts.asked_and_formed() {
            self.show_chart(number);
        }
    }
}

/// Layout of all charts.
impl Session {
    /// Packing options; the picture sets the size, if there is one.
    pub fn packing(&self) -> PackingOptions {
        let pixels = self.document().picture.as_ref().map(|picture| &picture.pixels);
        let picture = pixels.map(|pixels| [pixels.width, pixels.height]);
        let options = self.document().packing;
        PackingOptions { picture: picture.unwrap_or(options.picture), ..options }
    }

    /// Collects all charts, each with its step.
    ///
    /// # Errors
    ///
    /// Number of charts without a step for the current document.
    pub(super) fn solved_atlas(&self) -> Result<SolvedAtlas, usize> {
        let solved = |(model, outcome, timeline): (&Arc<Model>, Arc<Outcome>, &Timeline)| {
            let steps = timeline.records()[..=outcome.step.index].to_vec();
            let size = model.prepared.chart.as_ref().map_or(1.0, |of| self.document().size_of(&of.charts, of.number));
            let locked = model.prepared.chart.as_ref().and_then(|of| self.document().lock_of(&of.charts, of.number));
            ChartResult { model: Arc::clone(model), outcome, steps, size, locked: locked.cloned() }
        };
        let charts: Vec<ChartResult> = self.solved_charts().map(solved).collect();
        match self.charts().map_or(0, |charts| charts.count()) - charts.len() {
            0 => Ok(SolvedAtlas::new(charts, self.packing())),
            missing => Err(missing),
        }
    }

    /// Charts that are solved for the current document: model, step and timeline of each.
    fn solved_charts(&self) -> impl Iterator<Item = (&Arc<Model>, Arc<Outcome>, &Timeline)> {
        let count = self.charts().map_or(0, |charts| charts.count());
        (0..count).filter_map(|number| self.solved_chart(number))
    }

    fn solved_chart(&self, number: usize) -> Option<(&Arc<Model>, Arc<Outcome>, &Timeline)> {
        let ChartState::Solved(newest) = self.chart_state(number) else { return None };
        if self.chart_on_screen() == Some(number) {
            let shown = self.outcome().filter(|_| self.is_current())?;
            return Some((self.model()?, Arc::clone(shown), self.timeline()));
        }
        let (model, timeline) = self.charts.other(number)?;
        Some((model, newest, timeline))
    }

    /// Key of the layout of all charts, once each is solved.
    fn to_be_made(&self) -> Option<AtlasKey> {
        let outcomes: Vec<Arc<Outcome>> = self.solved_charts().map(|(_, outcome, _)| outcome).collect();
        let is_whole = self.charts().is_some_and(|charts| charts.count() == outcomes.len());
        is_whole.then(|| AtlasKey { outcomes, sizes: self.sizes(), locks: self.locks(), options: self.packing() })
    }

    /// Computes the layout of all charts in the background, once each of them is solved.
    pub(super) fn poll_atlas(&mut self) {
        self.atlas_views.poll();
        if self.charts().is_none() {
            self.atlas_views.forget();
            return;
        }
        // Only one layout at a time: steps may arrive faster than layouts are computed.
        let Some(key) = self.to_be_made().filter(|_| !self.atlas_views.is_busy()) else { return };
        if self.atlas_views.knows(&key) {
            return;
        }
        if let Ok(solved) = self.solved_atlas() {
            self.atlas_views.make(key, solved);
        }
    }

    /// Layout of all charts, if each is solved and the layout is computed.
    pub fn atlas(&self) -> Option<&AtlasView> {
        let (key, view) = self.atlas_views.made()?;
        self.to_be_made().is_some_and(|now| key.is(&now)).then_some(view)
    }
}
