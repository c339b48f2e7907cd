//! Stroke of a brush on a chart of the page: where the chart lies, and its last frame that overlaps no other chart.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec2;

use super::action::BrushDab;
use super::page::{ChartPage, JudgedFrame, JudgedFrames, PageChart};
use freebound_core::bijective::Brush;
use freebound_core::geom::{Bounds, Similarity};
use freebound_core::mesh::VertexId;
use freebound_core::problem::Embedding;
use freebound_core::verify::MoveVerdict;

/// Root mean square of the distances between a chart on the page and the similar image of its map, relative to the
/// image's diameter, up to which the chart counts as similar to its map.
const SAME_PLACE: f64 = 1e-6;

/// Similarity from the plane of a chart's map to the page's plane, with or without a reflection.
#[derive(Clone, Copy, Debug)]
pub struct ChartPlacement {
    /// Similarity of the map, or of the map reflected in the vertical axis.
    similarity: Similarity,
    is_mirrored: bool,
}

impl ChartPlacement {
    /// Placement of a chart on a page with this width over height. `None` if the chart is not similar to its map there.
    pub(super) fn of(chart: &PageChart, aspect: f64) -> Option<Self> {
        let map = &chart.outcome.step.candidate.solution.embedding;
        let plane = DVec2::new(aspect, 1.0);
        let fitted = |is_mirrored: bool| {
            let image = chart.coordinates.iter().map(|uv| *uv * plane);
            let pairs = map.iter().map(|z| reflected(*z, is_mirrored)).zip(image).map(|(from, to)| [from, to]);
            let pairs: Vec<[DVec2; 2]> = pairs.filter(|[from, to]| from.is_finite() && to.is_finite()).collect();
            let similarity = Similarity::fitting(&pairs)?;
            let spread = Bounds::of(pairs.iter().map(|[_, to]| *to)).diameter();
            Some((Self { similarity, is_mirrored }, similarity.error(&pairs) / spread))
        };
        let fits = [false, true].into_iter().filter_map(fitted);
        let (placement, error) = fits.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        (error <= SAME_PLACE).then_some(placement)
    }

    /// Position in the page's plane of a point of the map.
    pub fn to_page(&self, point: DVec2) -> DVec2 {
        self.similarity.apply(reflected(point, self.is_mirrored))
    }

    /// Point of the map at a position in the page's plane.
    pub fn from_page(&self, at: DVec2) -> DVec2 {
        reflected(self.similarity.inverse().apply(at), self.is_mirrored)
    }

    /// Length on the page of a unit of the map.
    pub fn scale(&self) -> f64 {
        self.similarity.factor()
    }

    /// Brush in the plane of the map, for a brush in the page's plane.
    pub(super) fn dab_from_page(&self, BrushDab { brush, at, begins }: BrushDab) -> BrushDab {
        let brush = Brush { radius: brush.radius / self.scale(), ..brush };
        BrushDab { brush, at: self.from_page(at), begins }
    }
}

/// Charts that lie on a chart, each with the vertex of the chart under each of its vertices: the one at the same place.
fn stacked_on(page: &ChartPage, chart: usize) -> Vec<(usize, Vec<VertexId>)> {
    let bits = |uv: &DVec2| [uv.x.to_bits(), uv.y.to_bits()];
    let own = &page.charts[chart].coordinates;
    let members = page.charts.iter().enumerate().filter(|(_, other)| other.stacked.is_some_and(|on| on.chart == chart));
    let members: Vec<(usize, &PageChart)> = members.collect();
    if members.is_empty() {
        return Vec::new();
    }
    let at: HashMap<[u64; 2], VertexId> =
        own.iter().enumerate().map(|(vertex, uv)| (bits(uv), VertexId::from_index(vertex))).collect();
    let under = |(number, member): (usize, &PageChart)| {
        let vertices = member.coordinates.iter().map(|uv| at.get(&bits(uv)).copied());
        Some((number, vertices.collect::<Option<Vec<VertexId>>>()?))
    };
    members.into_iter().filter_map(under).collect()
}

fn reflected(point: DVec2, is_mirrored: bool) -> DVec2 {
    if is_mirrored { DVec2::new(-point.x, point.y) } else { point }
}

/// Chart of the page that a brush shapes.
#[derive(Clone, Debug)]
pub struct PageStroke {
    among: AmongCharts,
    /// Charts that lie on the chart, each with the vertex of the chart under each of its vertices.
    stacked: Vec<(usize, Vec<VertexId>)>,
    /// True if the chart may come to overlap others.
    insists: bool,
    frames: JudgedFrames<ShapedFrame>,
}

/// Frame of a stroke, judged.
#[derive(Clone, Debug)]
pub(super) struct ShapedFrame {
    pub(super) map: Arc<Embedding>,
    pub(super) coordinates: Arc<Embedding>,
    verdict: MoveVerdict,
}

impl JudgedFrame for ShapedFrame {
    fn verdict(&self) -> &MoveVerdict {
        &self.verdict
    }
}

/// Chart among the charts of the page, for verdicts on its frames.
#[derive(Clone, Debug)]
pub(super) struct AmongCharts {
    page: ChartPage,
    chart: usize,
    placement: ChartPlacement,
    /// Coordinates from which vertices have moved.
    begin: Arc<Embedding>,
}

impl AmongCharts {
    /// Frame with this map, judged among the other charts. `moved` are the vertices that may have moved.
    pub(super) fn judge(&self, map: &Embedding, moved: &[VertexId]) -> ShapedFrame {
        let plane = DVec2::new(self.page.aspect, 1.0);
        let mut coordinates = Embedding::clone(&self.begin);
        for &vertex in moved {
            coordinates[vertex] = self.placement.to_page(map[vertex]) / plane;
        }
        let verdict = self.page.judge_shaped(self.chart, &coordinates, moved);
        ShapedFrame { map: Arc::new(map.clone()), coordinates: Arc::new(coordinates), verdict }
    }
}

impl PageStroke {
    /// Stroke on a chart. `None` if the chart is not similar to its map on the page.
    pub(super) fn new(page: &ChartPage, chart: usize) -> Option<Self> {
        let on_page = page.charts.get(chart)?;
        let placement = ChartPlacement::of(on_page, page.aspect)?;
        let stacked = stacked_on(page, chart);
        let begin = Arc::clone(&on_page.coordinates);
        let among = AmongCharts { page: page.clone(), chart, placement, begin };
        Some(Self { among, stacked, insists: false, frames: JudgedFrames::default() })
    }

    /// The chart.
    pub fn chart(&self) -> usize {
        self.among.chart
    }

    /// Place of the chart on the page at the beginning of the stroke.
    pub fn placement(&self) -> ChartPlacement {
        self.among.placement
    }

    /// Number of changes of the page that the stroke is on.
    pub(super) fn revision(&self) -> u64 {
        self.among.page.revision
    }

    /// Texture coordinates of the chart in the newest accepted frame.
    pub fn coordinates(&self) -> Option<&Arc<Embedding>> {
        self.frames.accepted.as_ref().map(|frame| &frame.coordinates)
    }

    /// Texture coordinates of a chart that lies on the chart, for coordinates of the chart.
    pub fn stacked_coordinates<'a>(
        &'a self,
        coordinates: &'a Embedding,
    ) -> impl Iterator<Item = (usize, Embedding)> + 'a {
        let of = |under: &Vec<VertexId>| under.iter().map(|&vertex| coordinates[vertex]).collect();
        self.stacked.iter().map(move |(chart, under)| (*chart, of(under)))
    }

    /// Verdict on the newest frame, if other charts keep it back.
    pub fn kept_back(&self) -> Option<&MoveVerdict> {
        self.frames.kept_back.as_ref().map(JudgedFrame::verdict)
    }

    /// Verdict on the newest accepted frame.
    pub fn verdict(&self) -> Option<&MoveVerdict> {
        self.frames.accepted.as_ref().map(JudgedFrame::verdict)
    }

    pub(super) fn set_insists(&mut self, insists: bool) {
        self.insists = insists;
    }

    pub(super) fn among(&self) -> AmongCharts {
        self.among.clone()
    }

    /// Accepts a frame, or keeps it back. Returns true if the frame is accepted.
    pub(super) fn take(&mut self, frame: ShapedFrame) -> bool {
        self.frames.take(frame, self.insists)
    }

    /// Begins anew from the newest accepted frame. Returns its map, or the map before the stroke.
    pub(super) fn begin_again(&mut self) -> Arc<Embedding> {
        let on_page = &self.among.page.charts[self.among.chart];
        if let Some(frame) = &self.frames.accepted {
            self.among.begin = Arc::clone(&frame.coordinates);
            Arc::clone(&frame.map)
        } else {
            self.among.begin = Arc::clone(&on_page.coordinates);
            Arc::new(on_page.outcome.step.candidate.solution.embedding.clone())
        }
    }

    /// Map and coordinates of the newest accepted frame; `None` if the stroke changes nothing.
    pub(super) fn into_shaped(self) -> Option<(Arc<Embedding>, Arc<Embedding>)> {
        let before = &self.among.page.charts[self.among.chart].outcome.step.candidate.solution.embedding;
        self.frames.accepted.filter(|frame| *frame.map != *before).map(|frame| (frame.map, frame.coordinates))
    }
}
