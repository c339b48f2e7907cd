//! Part: the page, with all charts as they lie on it, and moves of charts. Each frame of a move is judged exactly.
//!
//! ```text
//! move_charts ──▶ job: the charts at their new places, with a verdict ──▶ accepted, or kept back by other charts
//!                 a newer request replaces one that waits
//! end_move    ──▶ edit of the document, once the newest request is judged
//! ```

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::{DAffine2, DVec2};

use super::atlas_view::{AtlasKey, AtlasView};
use super::{Background, Model, Wake};
use freebound_core::geom::Bounds;
use freebound_core::mesh::{Charts, DiskMesh, VertexId};
use freebound_core::pipeline::{Outcome, SolvedChart, StackedOn};
use freebound_core::problem::Embedding;
use freebound_core::verify::{ChartInPlane, MoveVerdict, move_verdict, shaped_verdict};

/// All charts as they lie on the page. The page's plane has its height as unit: x is u times the aspect, y is v.
#[derive(Clone, Debug)]
pub struct ChartPage {
    /// Charts by their numbers.
    pub charts: Vec<PageChart>,
    /// Width over height of the page.
    pub aspect: f64,
    /// Numbers of the charts in the mesh.
    pub(super) of: Arc<Charts>,
    /// Number of changes of the page.
    pub revision: u64,
    /// True if the layout is proved planar, false if it is not planar. `None` while it is being checked.
    pub is_planar: Option<bool>,
}

/// Chart on the page.
#[derive(Clone, Debug)]
pub struct PageChart {
    /// Model of the chart.
    pub model: Arc<Model>,
    /// Step that is laid out.
    pub outcome: Arc<Outcome>,
    /// Texture coordinates of the vertices of the step's mesh, v up.
    pub coordinates: Arc<Embedding>,
    /// Place on another chart. `None` for a chart with a place of its own.
    pub stacked: Option<StackedOn>,
}

/// Chart and its movement in the page's plane.
pub type ChartMove = (usize, DAffine2);

/// Number of a chart, and vertices by their numbers on that chart.
pub type ChartVertices = (usize, Vec<VertexId>);

/// Movement with a fixed point: `by` moves directions from there.
pub fn movement_about(fixed: DVec2, by: DAffine2) -> DAffine2 {
    DAffine2::from_translation(fixed) * by * DAffine2::from_translation(-fixed)
}

impl PageChart {
    /// Mesh of the step.
    ///
    /// # Panics
    ///
    /// Never: only a disk has an outcome.
    pub fn mesh(&self) -> &DiskMesh {
        let disk = self.model.disk().expect("only a disk has an outcome");
        self.outcome.step.candidate.mesh(disk)
    }

    /// Chart with its step, for a layout.
    pub(super) fn solved(&self) -> SolvedChart<'_> {
        SolvedChart::new(&self.model.prepared, &self.outcome)
    }

    /// Number of vertices of the chart without new vertices.
    pub(super) fn given_count(&self) -> usize {
        self.model.prepared.chart.as_ref().map_or(0, |of| of.chart.vertex_of.len())
    }

    /// Coordinates after a movement in the plane of a page.
    fn moved(&self, by: DAffine2, aspect: f64) -> Embedding {
        let plane = DVec2::new(aspect, 1.0);
        self.coordinates.iter().map(|uv| by.transform_point2(*uv * plane) / plane).collect()
    }
}

impl ChartPage {
    /// Chart that lends its place: the chart itself, or the chart that it is stacked on.
    pub fn place_of(&self, chart: usize) -> usize {
        self.charts.get(chart).and_then(|chart| chart.stacked).map_or(chart, |on| on.chart)
    }

    /// All charts at the places of these charts: the charts themselves, and those stacked with them.
    pub fn with_stacks(&self, charts: &BTreeSet<usize>) -> BTreeSet<usize> {
        let places: BTreeSet<usize> = charts.iter().map(|&chart| self.place_of(chart)).collect();
        (0..self.charts.len()).filter(|&chart| places.contains(&self.place_of(chart))).collect()
    }

    /// Bounds of a chart in the page's plane.
    pub fn bounds_of(&self, chart: usize) -> Bounds {
        let plane = DVec2::new(self.aspect, 1.0);
        let finite = |uv: &&DVec2| uv.is_finite();
        let points = self.charts.get(chart).into_iter().flat_map(|chart| chart.coordinates.iter());
        Bounds::of(points.filter(finite).map(|uv| *uv * plane))
    }

    /// Verdict on charts at other coordinates. A chart that was folded before does not count, nor do charts that overlapped
    /// before if `move_together` says that they move by the same movement.
    pub(super) fn judge(
        &self,
        moved: &[(usize, Arc<Embedding>)],
        move_together: impl Fn(usize, usize) -> bool,
    ) -> MoveVerdict {
        let of_moved: BTreeMap<usize, &Embedding> = moved.iter().map(|(chart, at)| (*chart, &**at)).collect();
        let (own, charts) = self.in_plane(|chart| of_moved.get(&chart).copied());
        let places = own.iter().enumerate().filter(|(_, chart)| of_moved.contains_key(chart));
        let MoveVerdict { folded, overlapping } = move_verdict(&charts, &places.map(|(place, _)| place).collect());
        let is_new_fold = |chart: &usize| self.charts[*chart].outcome.step.verdict.planar;
        let is_new_overlap = |[a, b]: &[usize; 2]| self.is_planar == Some(true) || !move_together(*a, *b);
        let overlapping = overlapping.into_iter().map(|pair| pair.map(|place| own[place]));
        MoveVerdict {
            folded: folded.into_iter().map(|place| own[place]).filter(is_new_fold).collect(),
            overlapping: overlapping.filter(is_new_overlap).collect(),
        }
    }

    /// Verdict on a chart of which some vertices moved, at these coordinates. All its other faces count as judged before.
    pub(super) fn judge_shaped(&self, chart: usize, coordinates: &Embedding, moved: &[VertexId]) -> MoveVerdict {
        let (own, charts) = self.in_plane(|other| (other == chart).then_some(coordinates));
        let Some(place) = own.iter().position(|&other| other == chart) else { return MoveVerdict::default() };
        let MoveVerdict { folded, overlapping } = shaped_verdict(&charts, place, moved);
        MoveVerdict {
            folded: folded.into_iter().map(|place| own[place]).collect(),
            overlapping: overlapping.into_iter().map(|pair| pair.map(|place| own[place])).collect(),
        }
    }

    /// Charts with a place of their own, by their numbers and in the plane of texture coordinates. A chart that is stacked
    /// on another has the coordinates of the other. `moved` returns the coordinates of a chart that lies elsewhere now.
    fn in_plane<'a>(&'a self, moved: impl Fn(usize) -> Option<&'a Embedding>) -> (Vec<usize>, Vec<ChartInPlane<'a>>) {
        let own = self.charts.iter().enumerate().filter(|(_, chart)| chart.stacked.is_none());
        let in_plane = |(number, chart): (usize, &'a PageChart)| {
            let coordinates = moved(number).unwrap_or(&chart.coordinates);
            (number, ChartInPlane { mesh: chart.mesh(), coordinates })
        };
        own.map(in_plane).unzip()
    }

    /// Page with charts at other coordinates.
    fn with(&self, moved: &[(usize, Arc<Embedding>)]) -> Self {
        let mut page = self.clone();
        for (chart, coordinates) in moved {
            page.charts[*chart].coordinates = Arc::clone(coordinates);
        }
        page
    }
}

/// Movement of charts that was judged.
#[derive(Clone, Debug)]
pub struct JudgedMove {
    /// Movement of each chart, stacked charts included.
    pub moves: Vec<ChartMove>,
    /// Coordinates of each moved chart.
    pub coordinates: Vec<(usize, Arc<Embedding>)>,
    /// Verdict on the moved charts.
    pub verdict: MoveVerdict,
}

impl JudgedMove {
    /// Moves charts of a page and judges them.
    fn new(page: &ChartPage, moves: Vec<ChartMove>) -> Self {
        let coordinates: Vec<(usize, Arc<Embedding>)> =
            moves.iter().map(|&(chart, by)| (chart, Arc::new(page.charts[chart].moved(by, page.aspect)))).collect();
        let movement = |chart: usize| moves.iter().find(|(other, _)| *other == chart).map(|(_, by)| *by);
        let verdict = page.judge(&coordinates, |a, b| movement(a) == movement(b));
        Self { moves, coordinates, verdict }
    }
}

/// Request to move charts.
#[derive(Clone, Debug, PartialEq)]
struct MoveRequest {
    moves: Vec<ChartMove>,
    /// True if charts may come to overlap.
    insists: bool,
}

/// Frame of a gesture on the page, with its verdict.
pub trait JudgedFrame: Clone {
    /// Verdict on the charts that the frame changes.
    fn verdict(&self) -> &MoveVerdict;
}

impl JudgedFrame for JudgedMove {
    fn verdict(&self) -> &MoveVerdict {
        &self.verdict
    }
}

/// Frames of a gesture on the page in progress.
#[derive(Clone, Debug)]
pub struct JudgedFrames<F> {
    /// Newest frame that was accepted.
    pub accepted: Option<F>,
    /// Frame that the user asked for, if other charts keep it back.
    pub kept_back: Option<F>,
    /// Newest accepted frame without overlaps.
    last_planar: Option<F>,
}

impl<F> Default for JudgedFrames<F> {
    fn default() -> Self {
        Self { accepted: None, kept_back: None, last_planar: None }
    }
}

impl<F: JudgedFrame> JudgedFrames<F> {
    /// Accepts a frame, or keeps it back if it is not planar and the user does not insist. Overlaps that were accepted
    /// before end if the user no longer insists. Returns true if the frame is accepted.
    pub(super) fn take(&mut self, frame: F, insists: bool) -> bool {
        let is_planar = frame.verdict().is_planar();
        if !is_planar && !insists {
            if self.accepted.as_ref().is_some_and(|accepted| !accepted.verdict().is_planar()) {
                self.accepted = self.last_planar.clone();
            }
            self.kept_back = Some(frame);
            return false;
        }
        if is_planar {
            self.last_planar = Some(frame.clone());
        }
        (self.accepted, self.kept_back) = (Some(frame), None);
        true
    }
}

/// Move of charts in progress.
pub type MoveState = JudgedFrames<JudgedMove>;

/// The page, and the move of charts in progress.
pub(super) struct PagePart {
    page: Option<ChartPage>,
    key: Option<AtlasKey>,
    /// True if the page shows the end of a move, and its layout in the written form is not there yet.
    is_provisional: bool,
    job: Background<MoveRequest, JudgedMove>,
    /// Newest request, while an older one is being judged.
    waiting: Option<MoveRequest>,
    state: Option<MoveState>,
    /// True if the move ends once its newest request is judged.
    is_ending: bool,
}

impl PagePart {
    pub(super) fn new(wake: &Wake) -> Self {
        let job = Background::new("move charts", wake);
        Self { page: None, key: None, is_provisional: false, job, waiting: None, state: None, is_ending: false }
    }

    pub(super) fn page(&self) -> Option<&ChartPage> {
        self.page.as_ref()
    }

    pub(super) fn state(&self) -> Option<&MoveState> {
        self.state.as_ref()
    }

    /// True while a move is being judged.
    pub(super) fn is_busy(&self) -> bool {
        self.job.is_busy()
    }

    /// True if a move has ended, and its newest request is not judged yet.
    pub(super) fn is_ending(&self) -> bool {
        self.is_ending
    }

    /// True if the page needs the layout with this key in its written form.
    pub(super) fn needs(&self, key: &AtlasKey) -> bool {
        self.is_provisional || !self.shows(key)
    }

    /// True if the page shows the layout with this key.
    pub(super) fn shows(&self, key: &AtlasKey) -> bool {
        self.key.as_ref().is_some_and(|own| own.is(key))
    }

    /// Drops the page.
    pub(super) fn forget(&mut self) {
        (self.page, self.key, self.is_provisional) = (None, None, false);
        self.give_up();
    }

    /// Puts charts of a layout on the page.
    pub(super) fn put(&mut self, key: AtlasKey, of: Arc<Charts>, models: Vec<Arc<Model>>, view: &AtlasView) {
        self.is_provisional = false;
        let chart = |(number, model): (usize, Arc<Model>)| PageChart {
            model,
            outcome: Arc::clone(&key.outcomes[number]),
            coordinates: Arc::clone(&view.coordinates[number]),
            stacked: view.stacked[number],
        };
        let page = ChartPage {
            charts: models.into_iter().enumerate().map(chart).collect(),
            aspect: view.aspect,
            of,
            revision: 0,
            is_planar: Some(view.verdict.planar),
        };
        self.set(key, page);
    }

    /// Replaces the page. A page with the same numbers keeps its revision, so that nothing is drawn anew.
    fn set(&mut self, key: AtlasKey, page: ChartPage) {
        let before = self.page.as_ref();
        let is_same = before.is_some_and(|before| {
            let charts = before.charts.iter().zip(&page.charts);
            let is_same = |(a, b): (&PageChart, &PageChart)| {
                let is_there = Arc::ptr_eq(&a.coordinates, &b.coordinates) || a.coordinates == b.coordinates;
                Arc::ptr_eq(&a.outcome, &b.outcome) && is_there && a.stacked == b.stacked
            };
            Arc::ptr_eq(&before.of, &page.of)
                && before.charts.len() == page.charts.len()
                && before.aspect.to_bits() == page.aspect.to_bits()
                && charts.into_iter().all(is_same)
        });
        if !is_same {
            // A move in progress began at other places.
            self.give_up();
        }
        let before = self.page.as_ref();
        let revision = before.map_or(0, |before| before.revision) + u64::from(!is_same);
        self.page = Some(ChartPage { revision, ..page });
        self.key = Some(key);
    }

    /// Shows the end of a move on the page at once. `key` is the key of the layout after the move.
    pub(super) fn put_moved(&mut self, key: AtlasKey, judged: &JudgedMove) {
        let Some(page) = &self.page else { return };
        let is_planar = page.is_planar.filter(|planar| *planar && judged.verdict.is_planar());
        let page = ChartPage { is_planar, ..page.with(&judged.coordinates) };
        self.set(key, page);
        self.is_provisional = true;
    }

    /// Moves charts, at the next frame that is judged. Charts that would overlap others stay at their last place, unless
    /// the user insists.
    pub(super) fn follow(&mut self, moves: Vec<ChartMove>, insists: bool) {
        self.state.get_or_insert_default();
        self.is_ending = false;
        self.waiting = Some(MoveRequest { moves, insists });
        self.start_next();
    }

    /// Ends the move once its newest request is judged.
    pub(super) fn end(&mut self) {
        self.is_ending = self.state.is_some();
    }

    /// Drops the move. Returns true if there was one.
    pub(super) fn give_up(&mut self) -> bool {
        self.job.cancel();
        (self.waiting, self.is_ending) = (None, false);
        self.state.take().is_some()
    }

    fn start_next(&mut self) {
        if self.job.is_busy() {
            return;
        }
        let (Some(request), Some(page)) = (self.waiting.take(), self.page.clone()) else { return };
        self.job.start(request.clone(), move |_| JudgedMove::new(&page, request.moves));
    }

    /// Takes the move that was judged, and judges the next. Returns the state at the end of the move.
    pub(super) fn poll(&mut self) -> Option<MoveState> {
        if let Some((request, judged)) = self.job.poll()
            && let (Some(state), Ok(judged)) = (&mut self.state, judged)
        {
            state.take(judged, request.insists);
        }
        self.start_next();
        let has_ended = self.is_ending && !self.job.is_busy();
        let state = self.state.take_if(|_| has_ended)?;
        self.is_ending = false;
        Some(state)
    }
}
