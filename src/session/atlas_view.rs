//! Layout of all charts, once each of them is solved. Layouts are written to files, and proved in the background for
//! the screen.

use std::sync::Arc;

use glam::DVec2;

use super::{Background, Model, SolvedModel, Wake, finished_atlas};
use freebound_core::geom::PackingOptions;
use freebound_core::pipeline::{Arrangement, LaidChart, Outcome, PackingSummary, StackedOn};
use freebound_core::problem::Embedding;
use freebound_core::verify::AtlasVerdict;
use freebound_io::{Output, StepReport};

/// Number of layouts that are kept, so that undo returns to them at once.
const LAYOUTS_KEPT: usize = 4;

/// All charts of a mesh, each with the step that is written.
#[derive(Clone, Debug)]
pub(super) struct SolvedAtlas {
    charts: Vec<ChartResult>,
    options: PackingOptions,
    arrangement: Arrangement,
}

/// Chart with the step that is written.
#[derive(Clone, Debug)]
pub(super) struct ChartResult {
    pub(super) model: Arc<Model>,
    pub(super) outcome: Arc<Outcome>,
    pub(super) steps: Vec<StepReport>,
    pub(super) size: f64,
    /// Place where the chart stays.
    pub(super) place: Option<Arc<Embedding>>,
    /// Chart whose place the chart shares.
    pub(super) stacked_on: Option<usize>,
}

/// Layout in the form in which it would be written.
#[derive(Clone, Debug)]
pub struct AtlasView {
    /// Boundary of each chart, in texture coordinates.
    pub outlines: Vec<Vec<DVec2>>,
    /// Verdict on all charts together.
    pub verdict: AtlasVerdict,
    /// Summary of the packing. `None` if pins hold all charts.
    pub packing: Option<PackingSummary>,
    /// Density of each chart: pixels of the picture per unit of length on the surface.
    pub densities: Vec<f64>,
    /// UDIM number of the tile of each chart, if it has one.
    pub tiles: Vec<Option<u32>>,
    /// Place of each chart on another. `None` for a chart with a place of its own.
    pub stacked: Vec<Option<StackedOn>>,
    /// Texture coordinates of the vertices of each chart, v up. New vertices follow behind those of the chart.
    pub coordinates: Vec<Arc<Embedding>>,
    /// Width over height of the page.
    pub aspect: f64,
}

/// Layout of all charts, computed in the background and kept with its key.
pub(super) struct AtlasViews {
    job: Background<AtlasKey, AtlasView>,
    /// Newest layouts, the last one first.
    made: Vec<(AtlasKey, Arc<AtlasView>)>,
    /// Key of the last layout that failed. A failed layout is not tried again.
    failed: Option<AtlasKey>,
}

/// Inputs of a layout. Steps are compared by their addresses, which stay valid while the key holds them.
#[derive(Clone, Debug)]
pub(super) struct AtlasKey {
    pub(super) outcomes: Vec<Arc<Outcome>>,
    pub(super) sizes: Vec<f64>,
    /// Place where each chart stays.
    pub(super) places: Vec<Option<Arc<Embedding>>>,
    /// Charts that are locked there.
    pub(super) locks: Vec<bool>,
    /// Chart whose place each chart shares.
    pub(super) stacked_on: Vec<Option<usize>>,
    pub(super) options: PackingOptions,
}

impl AtlasKey {
    pub(super) fn is(&self, other: &Self) -> bool {
        let mut outcomes = self.outcomes.iter().zip(&other.outcomes);
        let mut places = self.places.iter().zip(&other.places);
        let is_same_place = |(own, other): (&Option<Arc<Embedding>>, &Option<Arc<Embedding>>)| match (own, other) {
            (Some(own), Some(other)) => Arc::ptr_eq(own, other),
            (own, other) => own.is_none() && other.is_none(),
        };
        self.options == other.options
            && self.sizes == other.sizes
            && self.outcomes.len() == other.outcomes.len()
            && (&self.locks, &self.stacked_on) == (&other.locks, &other.stacked_on)
            && places.all(is_same_place)
            && outcomes.all(|(own, other)| Arc::ptr_eq(own, other))
    }
}

impl ChartResult {
    fn chart(&self) -> SolvedModel<'_> {
        let Self { model, outcome, steps, size, place, stacked_on } = self;
        let (locked, stacked_on) = (place.as_deref(), *stacked_on);
        SolvedModel { model, outcome, steps, size: *size, tile: None, locked, stacked_on, keeps_materials: false }
    }
}

impl SolvedAtlas {
    /// Collects all charts with their results and the packing options.
    pub(super) fn new(charts: Vec<ChartResult>, options: PackingOptions) -> Self {
        Self { charts, options, arrangement: Arrangement::AsGiven }
    }

    /// Layout in its written form, with its proof.
    pub(super) fn output(&self) -> Output<'_> {
        let charts: Vec<SolvedModel<'_>> = self.charts.iter().map(ChartResult::chart).collect();
        finished_atlas(&charts, self.options, self.arrangement)
    }

    fn view(&self) -> AtlasView {
        let output = self.output();
        let outline = |chart: &LaidChart<'_>| {
            chart.mesh.boundary_loop().iter().map(|&vertex| chart.coordinates[vertex]).collect()
        };
        AtlasView {
            coordinates: output.charts.iter().map(|laid| Arc::new(laid.coordinates.clone())).collect(),
            aspect: output.aspect,
            tiles: output.report.charts.iter().map(|chart| chart.tile).collect(),
            stacked: output.report.charts.iter().map(|chart| chart.stacked).collect(),
            outlines: output.charts.iter().map(outline).collect(),
            packing: output.report.packing,
            densities: output.report.charts.iter().map(|chart| chart.density).collect(),
            verdict: output.report.atlas.expect("a layout of charts has a verdict"),
        }
    }
}

impl AtlasViews {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { job: Background::new("atlas", wake), made: Vec::new(), failed: None }
    }

    /// Stores the layout that was computed, or its failure.
    pub(super) fn poll(&mut self) {
        match self.job.poll() {
            Some((key, Ok(view))) => {
                self.made.insert(0, (key, Arc::new(view)));
                self.made.truncate(LAYOUTS_KEPT);
            }
            Some((key, Err(_))) => self.failed = Some(key),
            None => {}
        }
    }

    /// Drops the stored layouts.
    pub(super) fn forget(&mut self) {
        self.made.clear();
    }

    /// True while a layout is being computed.
    pub(super) fn is_busy(&self) -> bool {
        self.job.is_busy()
    }

    /// True if the layout with this key was computed or failed.
    pub(super) fn knows(&self, key: &AtlasKey) -> bool {
        self.find(key).is_some() || self.failed.as_ref().is_some_and(|failed| failed.is(key))
    }

    /// Computes a layout in the background.
    pub(super) fn make(&mut self, key: AtlasKey, solved: SolvedAtlas) {
        self.job.start(key, move |_| solved.view());
    }

    /// Stored layout with this key.
    pub(super) fn find(&self, key: &AtlasKey) -> Option<&Arc<AtlasView>> {
        self.made.iter().find(|(own, _)| own.is(key)).map(|(_, view)| view)
    }

    /// Layout that was computed last.
    pub(super) fn newest(&self) -> Option<&Arc<AtlasView>> {
        self.made.first().map(|(_, view)| view)
    }
}
