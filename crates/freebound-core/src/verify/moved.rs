//! Verdict on charts that move among others that stay.
//!
//! A layout of planar charts whose triangles do not overlap is planar. If some charts move, the charts that stay need no
//! new proof among themselves. So the verdict of a move covers the moved charts, and their triangles against all others.
//! If only some vertices of a chart move, it covers the faces at these vertices.

use std::collections::BTreeSet;

use glam::DVec2;

use super::verdict;
use crate::geom::{Bounds, Orientation, orientation, overlaps};
use crate::mesh::{DiskMesh, VertexId};
use crate::parallel::prelude::*;
use crate::problem::Embedding;

/// Chart in the plane.
#[derive(Clone, Copy, Debug)]
pub struct ChartInPlane<'a> {
    /// Mesh of the chart.
    pub mesh: &'a DiskMesh,
    /// Position of each vertex of the mesh.
    pub coordinates: &'a Embedding,
}

/// Verdict on charts that moved. Charts have their places in the list that was judged.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MoveVerdict {
    /// Moved charts that are not planar by themselves, ascending.
    pub folded: Vec<usize>,
    /// Charts that overlap, in pairs, ascending. At least one of each pair has moved.
    pub overlapping: BTreeSet<[usize; 2]>,
}

impl MoveVerdict {
    /// True if the moved charts are planar and overlap no other chart.
    pub fn is_planar(&self) -> bool {
        self.folded.is_empty() && self.overlapping.is_empty()
    }
}

/// Overlapping triangles that are looked at. More would add few pairs of charts.
const MOST_OVERLAPS: usize = 1 << 12;

/// Judges charts that moved, by exact arithmetic: each by itself, and against all other charts. The list holds charts
/// with a place of their own; a chart that is stacked on another moves with it. `moved` are the places of the moved
/// charts in the list.
pub fn move_verdict(charts: &[ChartInPlane<'_>], moved: &BTreeSet<usize>) -> MoveVerdict {
    let numbers: Vec<usize> = moved.iter().copied().collect();
    let planar = |&chart: &usize| {
        let ChartInPlane { mesh, coordinates } = charts[chart];
        verdict::verdict(mesh, coordinates).planar
    };
    let are_planar: Vec<bool> = numbers.par_iter().map(planar).collect();
    let folded = numbers.into_iter().zip(are_planar).filter(|(_, planar)| !planar).map(|(chart, _)| chart).collect();
    let bounds: Vec<Bounds> = charts.par_iter().map(|chart| Bounds::of(chart.coordinates.iter().copied())).collect();
    let reach = moved.iter().fold(Bounds::EMPTY, |reach, &chart| reach.union(bounds[chart]));
    let mut near = ChartTriangles::default();
    for (number, chart) in charts.iter().enumerate().filter(|(number, _)| bounds[*number].meets(reach)) {
        let is_near = |corners: &[DVec2; 3]| moved.contains(&number) || Bounds::of(*corners).meets(reach);
        let at = |vertex| chart.coordinates[vertex];
        let own = chart.mesh.mesh().real_triangles().iter().map(|corners| corners.map(at)).filter(is_near);
        near.add(number, own);
    }
    let counts = |a: usize, b: usize| a != b && (moved.contains(&a) || moved.contains(&b));
    MoveVerdict { folded, overlapping: near.overlapping(counts) }
}

/// Triangles of charts in the plane.
#[derive(Default)]
struct ChartTriangles {
    triangles: Vec<[DVec2; 3]>,
    chart_of: Vec<usize>,
}

impl ChartTriangles {
    /// Adds triangles of a chart, without those that have no area.
    fn add(&mut self, chart: usize, triangles: impl IntoIterator<Item = [DVec2; 3]>) {
        self.triangles.extend(triangles.into_iter().filter_map(counter_clockwise));
        self.chart_of.resize(self.triangles.len(), chart);
    }

    /// Pairs of charts with triangles that overlap. `counts` decides which two charts count.
    fn overlapping(&self, counts: impl Fn(usize, usize) -> bool + Sync) -> BTreeSet<[usize; 2]> {
        let chart_of = &self.chart_of;
        let pairs = overlaps(&self.triangles, |a, b| counts(chart_of[a], chart_of[b]), MOST_OVERLAPS);
        let of_charts = |[a, b]: [usize; 2]| [chart_of[a].min(chart_of[b]), chart_of[a].max(chart_of[b])];
        pairs.into_iter().map(of_charts).collect()
    }
}

/// Judges a chart of which some vertices moved, by exact arithmetic: the faces at these vertices by themselves, which must
/// have the orientation of the other faces, and against all other charts. All other faces count as judged before. `chart`
/// is the place of the chart in the list, which holds charts with a place of their own.
///
/// The verdict says nothing about two faces of the chart itself that overlap. Beside a scan of all charts, its time grows
/// with the moved faces and those near them.
pub fn shaped_verdict(charts: &[ChartInPlane<'_>], chart: usize, moved: &[VertexId]) -> MoveVerdict {
    let ChartInPlane { mesh, coordinates } = charts[chart];
    let mut has_moved = vec![false; mesh.vertex_count()];
    for vertex in moved {
        has_moved[vertex.index()] = true;
    }
    let at = |corners: &[VertexId; 3]| corners.map(|vertex| coordinates[vertex]);
    let is_moved = |corners: &&[VertexId; 3]| corners.iter().any(|vertex| has_moved[vertex.index()]);
    let all = mesh.mesh().real_triangles();
    let triangles: Vec<[DVec2; 3]> = all.iter().filter(is_moved).map(at).collect();
    let turn = |[a, b, c]: [DVec2; 3]| orientation(a, b, c);
    let stays = all.iter().find(|corners| !is_moved(corners)).map(at);
    let wanted = stays.or(triangles.first().copied()).and_then(turn);
    let is_whole = |triangle: &[DVec2; 3]| {
        let own = turn(*triangle);
        own == wanted && own.is_some_and(|own| own != Orientation::Collinear)
    };
    let folded = if triangles.iter().all(is_whole) { Vec::new() } else { vec![chart] };
    let reach = Bounds::of(triangles.iter().flatten().copied());
    let near = |number: usize| {
        let ChartInPlane { mesh, coordinates } = charts[number];
        let is_away = number == chart || !Bounds::of(coordinates.iter().copied()).meets(reach);
        let corners = if is_away { &[] } else { mesh.mesh().real_triangles() };
        let corners = corners.iter().map(|corners| corners.map(|vertex| coordinates[vertex]));
        corners.filter(|corners| Bounds::of(*corners).meets(reach)).collect()
    };
    let others: Vec<Vec<[DVec2; 3]>> = (0..charts.len()).into_par_iter().map(near).collect();
    let mut near = ChartTriangles::default();
    near.add(chart, triangles);
    for (number, others) in others.into_iter().enumerate() {
        near.add(number, others);
    }
    MoveVerdict { folded, overlapping: near.overlapping(|a, b| (a == chart) != (b == chart)) }
}

/// Corners in counter-clockwise order; `None` if the triangle has no area or a corner is not finite.
fn counter_clockwise([a, b, c]: [DVec2; 3]) -> Option<[DVec2; 3]> {
    match orientation(a, b, c)? {
        Orientation::CounterClockwise => Some([a, b, c]),
        Orientation::Clockwise => Some([a, c, b]),
        Orientation::Collinear => None,
    }
}
