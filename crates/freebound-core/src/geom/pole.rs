//! Pole of inaccessibility: the point of a region that is farthest from its outline.
//!
//! A square cell with centre c and half diagonal r holds no point farther from the outline than the distance of c plus
//! r. Cells are split in four, the most promising first, until none can improve the best point by more than the
//! tolerance (V. Agafonkin, "A new algorithm for finding a visual center of a polygon", 2016).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec2;

use super::{Bounds, winding_number};

/// Tolerance of the distance, relative to the extent of the region.
const TOLERANCE: f64 = 5e-3;

/// Largest number of cells that are examined.
const MOST_CELLS: usize = 20_000;

/// Point inside a region, and its distance from the outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pole {
    /// The point.
    pub at: DVec2,
    /// Distance from the outline.
    pub distance: f64,
}

struct Cell {
    centre: DVec2,
    half: f64,
    distance: f64,
}

impl Cell {
    fn new(loops: &[Vec<DVec2>], centre: DVec2, half: f64) -> Self {
        Self { centre, half, distance: signed_distance(loops, centre) }
    }

    /// Largest distance of any point of the cell.
    fn most(&self) -> f64 {
        self.distance + self.half * std::f64::consts::SQRT_2
    }
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Cell {}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        self.most().total_cmp(&other.most())
    }
}

/// Pole of inaccessibility of a region, which lies to the left of its loops. `None` if the region has no inner point
/// that was found.
pub fn pole(loops: &[Vec<DVec2>]) -> Option<Pole> {
    let bounds = Bounds::of(loops.iter().flatten().copied());
    if !(bounds.low.is_finite() && bounds.high.is_finite()) {
        return None;
    }
    let (half, tolerance) = (bounds.extent() / 2.0, TOLERANCE * bounds.extent());
    let mut cells = BinaryHeap::from([Cell::new(loops, bounds.middle(), half)]);
    let mut best: Option<Pole> = None;
    let mut examined = 0;
    while let Some(cell) = cells.pop() {
        let reached = best.map_or(0.0, |best| best.distance);
        if (best.is_some() && cell.most() <= reached + tolerance) || examined > MOST_CELLS {
            break;
        }
        if cell.distance > reached {
            best = Some(Pole { at: cell.centre, distance: cell.distance });
        }
        let half = cell.half / 2.0;
        for (x, y) in [(-half, -half), (half, -half), (-half, half), (half, half)] {
            cells.push(Cell::new(loops, cell.centre + DVec2::new(x, y), half));
            examined += 1;
        }
    }
    best
}

/// Distance of a point from loops, negative outside their region.
fn signed_distance(loops: &[Vec<DVec2>], point: DVec2) -> f64 {
    let distance = loops.iter().map(|line| distance_to_loop(line, point)).fold(f64::INFINITY, f64::min);
    let winding: i64 = loops.iter().filter_map(|line| winding_number(line, point)).sum();
    if winding > 0 { distance } else { -distance }
}

/// Distance of a point from a closed polygon.
pub fn distance_to_loop(line: &[DVec2], point: DVec2) -> f64 {
    let to_edge = |place: usize| {
        let [from, to] = [line[place], line[(place + 1) % line.len()]];
        let along = to - from;
        let share = ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        point.distance(if share.is_finite() { from + along * share } else { from })
    };
    (0..line.len()).map(to_edge).fold(f64::INFINITY, f64::min)
}
