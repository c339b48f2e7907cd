//! The layout of all charts, once each is solved: for files, and proved in the background for the screen.

use std::sync::Arc;

use glam::DVec2;

use super::{Arrangement, Background, ChartState, Model, Outcome, Session, SolvedChart, Timeline, Wake, atlas};
use crate::geom::PackingOptions;
use crate::io::{Output, PackingReport, StepReport};
use crate::solver::AtlasVerdict;

/// All charts of a mesh, each with the step that is written.
#[derive(Clone, Debug)]
pub(super) struct SolvedAtlas {
    charts: Vec<Solved>,
    options: PackingOptions,
    arrangement: Arrangement,
}

/// One of them.
#[derive(Clone, Debug)]
struct Solved {
    model: Arc<Model>,
    outcome: Arc<Outcome>,
    steps: Vec<StepReport>,
    size: f64,
}

/// The layout as it would be written.
#[derive(Clone, Debug)]
pub struct AtlasView {
    /// The boundary of each chart, in texture coordinates.
    pub outlines: Vec<Vec<DVec2>>,
    /// The verdict on all charts together.
    pub verdict: AtlasVerdict,
    /// How they are packed; none where pins hold them all.
    pub packing: Option<PackingReport>,
    /// Pixels of the picture per unit of length on the surface, of each chart.
    pub densities: Vec<f64>,
}

/// Layouts that are made, by what they are made of.
pub(super) struct AtlasViews {
    making: Background<Made, AtlasView>,
    made: Option<(Made, AtlasView)>,
    /// What no layout could be made of: it is not tried again.
    failed: Option<Made>,
}

/// What a layout is made of: steps by their places in memory, which they keep while they are shown.
#[derive(Clone, Debug)]
struct Made {
    outcomes: Vec<Arc<Outcome>>,
    sizes: Vec<f64>,
    options: PackingOptions,
}

impl Made {
    fn is(&self, other: &Self) -> bool {
        let mut outcomes = self.outcomes.iter().zip(&other.outcomes);
        self.options == other.options
            && self.sizes == other.sizes
            && self.outcomes.len() == other.outcomes.len()
            && outcomes.all(|(own, other)| Arc::ptr_eq(own, other))
    }
}

impl Solved {
    fn chart(&self) -> SolvedChart<'_> {
        SolvedChart { model: &self.model, outcome: &self.outcome, steps: &self.steps, size: self.size }
    }
}

impl SolvedAtlas {
    /// The layout, proved as it is written.
    pub(super) fn output(&self) -> Output<'_> {
        let charts: Vec<SolvedChart<'_>> = self.charts.iter().map(Solved::chart).collect();
        atlas(&charts, self.options, self.arrangement)
    }

    fn view(&self) -> AtlasView {
        let output = self.output();
        let outline = |chart: &crate::io::OutputChart<'_>| {
            chart.mesh.boundary_loop().iter().map(|&vertex| chart.coordinates[vertex]).collect()
        };
        AtlasView {
            outlines: output.charts.iter().map(outline).collect(),
            packing: output.report.packing,
            densities: output.report.charts.iter().map(|chart| chart.density).collect(),
            verdict: output.report.atlas.expect("a layout of charts has a verdict"),
        }
    }
}

impl AtlasViews {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { making: Background::new("atlas", wake), made: None, failed: None }
    }
}

impl Session {
    /// How charts are packed: into the picture, where there is one.
    pub fn packing(&self) -> PackingOptions {
        let pixels = self.document().picture.as_ref().map(|picture| &picture.pixels);
        let picture = pixels.map(|pixels| [pixels.width, pixels.height]);
        let options = self.document().packing;
        PackingOptions { picture: picture.unwrap_or(options.picture), ..options }
    }

    /// All charts, each with its step.
    ///
    /// # Errors
    ///
    /// How many charts have none for the document as it is.
    pub(super) fn solved_atlas(&self) -> Result<SolvedAtlas, usize> {
        let solved = |(model, outcome, timeline): (&Arc<Model>, Arc<Outcome>, &Timeline)| {
            let steps = timeline.records()[..=outcome.step.index].to_vec();
            let size = model.chart.as_ref().map_or(1.0, |of| self.document().size_of(&of.charts, of.number));
            Solved { model: Arc::clone(model), outcome, steps, size }
        };
        let charts: Vec<Solved> = self.solved_charts().map(solved).collect();
        match self.charts().map_or(0, |charts| charts.count()) - charts.len() {
            0 => Ok(SolvedAtlas { charts, options: self.packing(), arrangement: Arrangement::AsGiven }),
            missing => Err(missing),
        }
    }

    /// The charts that are solved for the document as it is.
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

    /// What the layout of all charts is to be made of, once each is solved.
    fn to_be_made(&self) -> Option<Made> {
        let outcomes: Vec<Arc<Outcome>> = self.solved_charts().map(|(_, outcome, _)| outcome).collect();
        let is_whole = self.charts().is_some_and(|charts| charts.count() == outcomes.len());
        is_whole.then(|| Made { outcomes, sizes: self.sizes(), options: self.packing() })
    }

    /// Has the layout of all charts made, once each is solved.
    pub(super) fn poll_atlas(&mut self) {
        match self.charts.views.making.poll() {
            Some((key, Ok(view))) => self.charts.views.made = Some((key, view)),
            Some((key, Err(_))) => self.charts.views.failed = Some(key),
            None => {}
        }
        if self.charts().is_none() {
            self.charts.views.made = None;
            return;
        }
        // One after the other: steps may come faster than layouts.
        let Some(key) = self.to_be_made().filter(|_| !self.charts.views.making.is_busy()) else { return };
        let views = &self.charts.views;
        let known = views.made.iter().map(|(key, _)| key).chain(&views.failed);
        if known.into_iter().any(|known| known.is(&key)) {
            return;
        }
        if let Ok(solved) = self.solved_atlas() {
            self.charts.views.making.start(key, move |_| solved.view());
        }
    }

    /// The layout of all charts, where each is solved and it was made.
    pub fn atlas(&self) -> Option<&AtlasView> {
        let (key, view) = self.charts.views.made.as_ref()?;
        self.to_be_made().is_some_and(|now| key.is(&now)).then_some(view)
    }
}
