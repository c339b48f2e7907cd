//! Charts of a local map moved beside others that they can be joined with.
//!
//! A chart that lies over its neighbour at one border can often continue another neighbour, across a seam of the cut.
//! The smaller of the two is turned and shifted so that their common border fits best (B. Horn, "Closed-form solution
//! of absolute orientation", 1987, in the plane). They can be joined if the border fits closely and no face of one then
//! lies over a face of the other.

use std::collections::BTreeMap;

use glam::DVec2;

use super::joining::Meeting;
use crate::geom::{Bounds, double_area, overlaps};

/// Distance between the two sides of a border that fits, at most, relative to its shortest edge.
const FIT: f64 = 0.25;

/// Factor of the size of a face whose overlaps with others count: rounding can make neighbours overlap.
const SHRUNK: f64 = 1.0 - 1e-6;

/// Charts in the plane, each without folds and overlaps.
pub(super) struct LocalCharts {
    /// Position of each vertex of the opened part.
    pub(super) positions: Vec<DVec2>,
    /// Triangles of each chart, by vertices of the opened part.
    pub(super) triangles: Vec<Vec<[u32; 3]>>,
}

impl LocalCharts {
    /// Moves the smaller of two charts to the other and makes them one. False if they do not fit; then nothing moves.
    pub(super) fn bring_together(&mut self, meeting: &Meeting) -> bool {
        let [kept, gone] = meeting.charts.map(|chart| chart as usize);
        let moves_kept = self.triangles[kept].len() < self.triangles[gone].len();
        let (still, moving) = if moves_kept { (gone, kept) } else { (kept, gone) };
        let spans: Vec<[[u32; 2]; 2]> =
            meeting.spans.iter().map(|span| span.map(|[a, b]| if moves_kept { [b, a] } else { [a, b] })).collect();
        let Some(moved) = self.moved(moving, &spans).filter(|moved| self.has_room(still, moving, moved)) else {
            return false;
        };
        for (vertex, position) in moved {
            self.positions[vertex as usize] = position;
        }
        // At a closed line, more than two vertices can become one.
        let mut name = BTreeMap::new();
        for end in meeting.ends() {
            let [a, b] = end.map(|vertex| final_name(&name, vertex));
            if a != b {
                name.insert(a.max(b), a.min(b));
            }
        }
        let taken = std::mem::take(&mut self.triangles[gone]);
        self.triangles[kept].extend(taken);
        for vertex in self.triangles[kept].iter_mut().flatten() {
            *vertex = final_name(&name, *vertex);
        }
        true
    }

    /// Positions of a chart that is moved to another along a border. `spans` has the vertices of the other chart first.
    /// `None` if the border does not fit, or a face would fold.
    fn moved(&self, chart: usize, spans: &[[[u32; 2]; 2]]) -> Option<BTreeMap<u32, DVec2>> {
        let at = |vertex: u32| self.positions[vertex as usize];
        let ends: Vec<[u32; 2]> = spans.iter().flatten().copied().collect();
        let middle = |side: usize| ends.iter().map(|end| at(end[side])).sum::<DVec2>() / ends.len() as f64;
        let [to, from] = [0, 1].map(middle);
        let turn: DVec2 = ends
            .iter()
            .map(|&[still, moving]| {
                let [there, here] = [at(still) - to, at(moving) - from];
                DVec2::new(here.dot(there), here.perp_dot(there))
            })
            .sum();
        let turn = turn.try_normalize()?;
        let vertices = self.triangles[chart].iter().flatten();
        let mut moved: BTreeMap<u32, DVec2> =
            vertices.map(|&vertex| (vertex, to + turn.rotate(at(vertex) - from))).collect();
        let shortest = spans.iter().map(|[[a, _], [b, _]]| at(*a).distance(at(*b))).fold(f64::INFINITY, f64::min);
        let mut place_of = BTreeMap::new();
        for [still, moving] in ends {
            let place = moved.get_mut(&moving)?;
            // A vertex cannot go to two places.
            let is_elsewhere = place_of.insert(moving, at(still)).is_some_and(|place| place != at(still));
            if is_elsewhere || (*place - at(still)).length() > FIT * shortest {
                return None;
            }
        }
        moved.extend(place_of);
        let is_positive = |corners: &[u32; 3]| double_area(corners.map(|vertex| moved[&vertex])) > 0.0;
        self.triangles[chart].iter().all(is_positive).then_some(moved)
    }

    /// True if no face of a moved chart lies over a face of another chart.
    fn has_room(&self, still: usize, moving: usize, moved: &BTreeMap<u32, DVec2>) -> bool {
        let around = Bounds::of(moved.values().copied());
        let shrunk = |corners: [DVec2; 3]| {
            let middle = corners.iter().sum::<DVec2>() / 3.0;
            corners.map(|corner| middle + SHRUNK * (corner - middle))
        };
        let of_moving = self.triangles[moving].iter().map(|corners| shrunk(corners.map(|vertex| moved[&vertex])));
        let of_still = self.triangles[still].iter().map(|corners| corners.map(|v| self.positions[v as usize]));
        let mut triangles: Vec<[DVec2; 3]> = of_moving.collect();
        let count = triangles.len();
        triangles.extend(of_still.filter(|corners| Bounds::of(*corners).meets(around)));
        overlaps(&triangles, |a, b| (a < count) != (b < count), 1).is_empty()
    }
}

/// Last of the names that follow one another from a vertex.
fn final_name(name: &BTreeMap<u32, u32>, vertex: u32) -> u32 {
    std::iter::successors(Some(vertex), |vertex| name.get(vertex).copied()).last().unwrap_or(vertex)
}
