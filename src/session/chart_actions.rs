//! Actions on meshes with several charts: the shown chart, the charts in the background, and their layout.

use std::sync::Arc;

use glam::{DAffine2, DVec2};

use super::atlas_view::{AtlasKey, ChartResult, SolvedAtlas};
use super::chart_layout::ChartLayout;
use super::page::movement_about;
use super::{AtlasView, ChartState, Command, LockState, Model, Session, Timeline};
use freebound_core::geom::{PackingOptions, Stacking};
use freebound_core::mesh::Charts;
use freebound_core::pipeline::Outcome;

impl Session {
    /// Charts of the open mesh, if it has several.
    pub fn charts(&self) -> Option<&Arc<Charts>> {
        self.model()?.prepared.chart.as_ref().map(|of| &of.charts)
    }

    /// Number of the shown chart.
    pub fn chart_on_screen(&self) -> Option<usize> {
        self.model()?.prepared.chart.as_ref().map(|of| of.number)
    }

    /// Name of a chart in the file, by the groups, objects or nodes of its faces. `None` if it has none.
    pub fn chart_name(&self, number: usize) -> Option<&str> {
        self.charts.name(self.charts()?, number)
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
        let problem = self.document.problem_with(self.document.edits_of(number, of));
        let newest = solving.newest().filter(|outcome| outcome.problem.has_steps_of(&problem));
        match newest {
            Some(outcome) if !is_running => ChartState::Solved(Arc::clone(outcome)),
            None if solving.has_failed(&problem) && !is_running => ChartState::Failed,
            _ => ChartState::Solving,
        }
    }

    /// Number of charts that are solved, and number of all charts.
    pub fn solved_count(&self) -> [usize; 2] {
        [self.solved_charts().count(), self.charts().map_or(0, |charts| charts.count())]
    }

    /// First chart whose solve failed.
    pub fn failed_chart(&self) -> Option<usize> {
        let count = self.charts().map_or(0, |charts| charts.count());
        (0..count).find(|&chart| matches!(self.chart_state(chart), ChartState::Failed))
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
    pub(super) fn set_packing(&mut self, packing: PackingOptions) {
        let before = &self.document.layout;
        let mut layout = ChartLayout { packing, ..before.clone() };
        if packing.stack == Stacking::None && before.packing.stack != Stacking::None {
            layout.stacked.clear();
        }
        let sides = |options: &PackingOptions| options.picture.map(u64::from);
        let ([w, h], [w_before, h_before]) = (sides(&packing), sides(&before.packing));
        if w * h_before != w_before * h {
            // Places belong to a page of the shape before.
            layout.placed.clear();
        }
        self.apply(Command::SetLayout(Box::new(layout)));
    }

    /// Sets the relative size of a chart, as an edit. A chart that is placed grows or shrinks where it lies.
    pub(super) fn set_chart_size(&mut self, chart: usize, size: f64) {
        let Some(charts) = self.charts().filter(|charts| chart < charts.count()).map(Arc::clone) else { return };
        if !PackingOptions::SIZES.contains(&size) {
            return;
        }
        if self.has_placed_charts() && self.can_move_charts() {
            let (before, middle) = (self.document.layout.size_of(&charts, chart), self.middle_on_page(chart));
            let by = movement_about(middle, DAffine2::from_scale(DVec2::splat(size / before)));
            self.move_charts(&[(chart, by)], false);
            return self.end_move();
        }
        let mut layout = self.document.layout.clone();
        layout.set_size(charts.first_face(chart), size);
        self.apply(Command::SetLayout(Box::new(layout)));
    }

    /// Centre of a chart's box in the page's plane.
    fn middle_on_page(&self, chart: usize) -> DVec2 {
        self.page().map_or(DVec2::ZERO, |page| page.bounds_of(chart).middle())
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
        let is_locked = self.document().layout.lock_of(&of.charts, chart).is_some();
        match atlas {
            _ if is_locked => LockState::Locked,
            _ if has_pins => LockState::Pinned,
            Some(atlas) if atlas.stacked[chart].is_some() => LockState::Stacked,
            Some(atlas) if atlas.coordinates[chart].iter().all(|uv| uv.is_finite()) => LockState::Open,
            _ => LockState::NoPlace,
        }
    }

    /// Relative size of each chart in the packing.
    pub fn sizes(&self) -> Vec<f64> {
        let of = |charts: &Arc<Charts>| {
            (0..charts.count()).map(|number| self.document.layout.size_of(charts, number)).collect()
        };
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
        let is_ready = self.has_numbers_as_wanted() && self.first_map_work().is_none();
        let Some(model) = self.model().filter(|_| is_ready).cloned() else { return };
        let Some(of) = model.prepared.chart.clone() else { return };
        let revision = self.model_revision();
        self.charts.refresh_names(&model, &of.charts);
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
        let options = self.document().layout.packing;
        PackingOptions { picture: picture.unwrap_or(options.picture), ..options }
    }

    /// Collects all charts, each with its step.
    ///
    /// # Errors
    ///
    /// Number of charts without a step for the current document.
    pub(super) fn solved_atlas(&self) -> Result<SolvedAtlas, usize> {
        let layout = &self.document().layout;
        let solved = |(model, outcome, timeline): (&Arc<Model>, Arc<Outcome>, &Timeline)| {
            let steps = timeline.records()[..=outcome.step.index].to_vec();
            let of = model.prepared.chart.as_ref();
            ChartResult {
                model: Arc::clone(model),
                outcome,
                steps,
                size: of.map_or(1.0, |of| layout.size_of(&of.charts, of.number)),
                place: of.and_then(|of| layout.place_of(&of.charts, of.number)).map(Arc::clone),
                stacked_on: of.and_then(|of| layout.stacked_on(&of.charts, of.number)),
            }
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

    /// Models of all charts, once each is solved.
    pub(super) fn solved_models(&self) -> Vec<Arc<Model>> {
        self.solved_charts().map(|(model, ..)| Arc::clone(model)).collect()
    }

    /// Key of the layout of all charts, once each is solved.
    pub(super) fn atlas_key(&self) -> Option<AtlasKey> {
        let outcomes: Vec<Arc<Outcome>> = self.solved_charts().map(|(_, outcome, _)| outcome).collect();
        let charts = self.charts().filter(|charts| charts.count() == outcomes.len())?;
        let layout = &self.document.layout;
        Some(AtlasKey {
            outcomes,
            sizes: self.sizes(),
            places: (0..charts.count()).map(|chart| layout.place_of(charts, chart).cloned()).collect(),
            locks: (0..charts.count()).map(|chart| layout.lock_of(charts, chart).is_some()).collect(),
            stacked_on: (0..charts.count()).map(|chart| layout.stacked_on(charts, chart)).collect(),
            options: self.packing(),
        })
    }

    /// Computes the layout of all charts in the background, once each of them is solved.
    pub(super) fn poll_atlas(&mut self) {
        self.atlas_views.poll();
        if self.charts().is_none() {
            self.atlas_views.forget();
            return;
        }
        // Only one layout at a time: steps may arrive faster than layouts are computed.
        let Some(key) = self.atlas_key().filter(|_| !self.atlas_views.is_busy()) else { return };
        if self.atlas_views.knows(&key) {
            return;
        }
        if let Ok(solved) = self.solved_atlas() {
            self.atlas_views.make(key, solved);
        }
    }

    /// Layout of all charts, if each is solved and the layout is computed.
    pub fn atlas(&self) -> Option<&AtlasView> {
        self.atlas_views.find(&self.atlas_key()?).map(AsRef::as_ref)
    }

    /// Layout of all charts that was computed last. It may belong to the document before an edit.
    pub fn newest_atlas(&self) -> Option<&AtlasView> {
        self.atlas_views.newest().map(AsRef::as_ref)
    }
}
