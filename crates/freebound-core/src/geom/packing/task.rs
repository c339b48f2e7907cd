//! Packing task on a page of one size: turns, grids and budgets.

use glam::DVec2;

use super::greedy::Rule;
use super::orders::{Effort, OrderSearch};
use super::refine::{self, Freedom, Refinement, Refiner};
use super::scene::{Chart, Cover, Grid, Layout, Place, Pose, Scene};
use super::{ChartShape, Packed, Rotations, single, turns};
use crate::geom::{Bounds, least_box_turn};

/// Number of cells of the finest grid, at most, unless a cell of a pixel needs more.
const FINEST_CELLS: f64 = (1_u64 << 22) as f64;

/// Number of cells of the coarsest grid for few charts.
const COARSEST_CELLS: f64 = (1_u64 << 14) as f64;

/// Number of cells of the coarsest grid for each of many charts.
const CELLS_OF_CHART: f64 = 150.0;

/// Number of cells across the coarsest grid, at least, if the finest grid has as many.
const NARROWEST: f64 = 16.0;

/// Smallest change of the scale on the first finer grid, where charts are rearranged, and on the finest one.
const LEAST_STEP: f64 = 0.001;

/// Number of charts above which charts are only placed one after another.
const MANY: usize = 1200;

/// Scale at which a chart alone fits the page in one of its turns, relative to that of its best turn, below which the
/// turn is not tried.
const SMALLEST_TURN: f64 = 0.2;

/// Share of the area of all charts above which a chart is large.
const LARGE: f64 = 0.1;

/// Share of the page that charts cover at the first scale that is tried.
const FIRST_COVER: f64 = 0.7;

/// Area of a chart relative to the square of its longest side, at least, for the choice of the first scale.
const THINNEST: f64 = 1e-3;

/// Rounding of the placement of a single chart, relative to the page.
const ROUNDING: f64 = 1.0 / (1_u64 << 40) as f64;

/// Area by which scales are chosen: charts without area count as thin.
fn nominal_area(shapes: &[ChartShape]) -> f64 {
    let of_shape =
        |shape: &ChartShape| shape.area().max(Bounds::of(shape.vertices()).size().max_element().powi(2) * THINNEST);
    shapes.iter().map(of_shape).sum()
}

/// Packing task on a page of a certain size.
pub(crate) struct Task<'a> {
    shapes: &'a [ChartShape],
    /// Corners of the hull of each shape.
    hulls: Vec<Vec<DVec2>>,
    /// Nominal area of all shapes.
    area: f64,
    /// Width and height of the page in pixels.
    pub(crate) page: DVec2,
    /// Gap in pixels.
    gap: f64,
    rotations: Rotations,
}

impl<'a> Task<'a> {
    /// Task on a page that is still to be set.
    pub(crate) fn new(shapes: &'a [ChartShape], gap: f64, rotations: Rotations) -> Self {
        let hulls = shapes.iter().map(ChartShape::hull).collect();
        Self { shapes, hulls, area: nominal_area(shapes), page: DVec2::ZERO, gap, rotations }
    }

    /// Scale and placements. `None` if not even the gaps fit, or if cancelled.
    pub(crate) fn solve(&self, is_cancelled: &dyn Fn() -> bool) -> Option<(f64, Vec<Packed>)> {
        match self.shapes {
            [] => Some((self.page.max_element(), Vec::new())),
            [_] => self.alone(),
            _ => self.together(is_cancelled),
        }
    }

    /// Placement of a single chart.
    fn alone(&self) -> Option<(f64, Vec<Packed>)> {
        let room = self.page - self.gap;
        if room.min_element() <= 0.0 {
            return None;
        }
        let hull = &self.hulls[0];
        let turn = match self.rotations {
            Rotations::None => DVec2::X,
            Rotations::Quarter => single::best_quarter(hull, room),
            Rotations::Free => single::best_turn(hull, room),
        };
        let size = turns::size_of(hull, turn);
        let limit = |room: DVec2| Some(single::largest_scale(size, room)).filter(|scale| scale.is_finite());
        let farthest = hull.iter().map(|corner| corner.length()).fold(0.0, f64::max);
        let rounding = (self.page.max_element() + farthest * limit(room).unwrap_or(1.0)) * ROUNDING;
        let scale = limit((room - 2.0 * rounding).max(DVec2::ZERO)).unwrap_or(1.0);
        let low = hull.iter().map(|&corner| turn.rotate(corner) * scale).reduce(DVec2::min)?;
        (scale > 0.0).then(|| (scale, vec![Packed { turn, low: self.gap / 2.0 + rounding - low }]))
    }

    /// Scale above which a chart is larger than the page in all of its turns, or charts have more area than the page.
    fn highest_scale(&self, charts: &[Chart]) -> f64 {
        let room = self.page - self.gap;
        let of_chart = |(chart, hull): (&Chart, &Vec<DVec2>)| {
            let scales = chart.turns.iter().map(|&turn| single::largest_scale(turns::size_of(hull, turn), room));
            scales.fold(0.0, f64::max)
        };
        let by_size = charts.iter().zip(&self.hulls).map(of_chart).fold(f64::INFINITY, f64::min);
        let area: f64 = self.shapes.iter().map(ChartShape::area).sum();
        let by_area =
            if area > 0.0 && area.is_finite() { (self.page.x * self.page.y / area).sqrt() } else { f64::INFINITY };
        Some(by_size.min(by_area)).filter(|scale| scale.is_finite()).unwrap_or(1.0)
    }

    /// Placements of several charts.
    fn together(&self, is_cancelled: &dyn Fn() -> bool) -> Option<(f64, Vec<Packed>)> {
        let scene = Scene { charts: self.charts(), picture: self.page, gap: self.gap };
        let highest = self.highest_scale(&scene.charts);
        if highest <= 0.0 {
            return None;
        }
        let finest = scene.grid(cell_of(self.pixels() / FINEST_CELLS), Cover::Touched);
        let refiner = Refiner { scene: &scene, highest, is_cancelled };
        let shaped = if self.shapes.len() <= MANY { self.coarse_to_fine(&refiner, finest) } else { None };
        let found = match shaped {
            Some(found) => found,
            None => self.ordered(&refiner, finest, Effort { work: 0, rule: Rule::Lowest })?,
        };
        Some((found.scale, packed(&scene, &found, finest)))
    }

    /// Layout by the best order of placement that a search finds.
    fn ordered(&self, refiner: &Refiner<'_>, grid: Grid, effort: Effort) -> Option<Layout> {
        let cover = (FIRST_COVER * self.pixels() / self.area).sqrt();
        let first = if self.area > 0.0 { cover.min(refiner.highest) } else { refiner.highest };
        OrderSearch::new(refiner.scene, grid, effort, refiner.is_cancelled).run(first, refiner.highest)
    }

    /// Layout on the finest grid, refined from one on a coarse grid.
    fn coarse_to_fine(&self, refiner: &Refiner<'_>, finest: Grid) -> Option<Layout> {
        let budget = Budget::of(self.shapes.len());
        let mut cell = self.coarsest_cell().max(finest.cell);
        let coarsest = refiner.scene.grid(cell, Cover::Sampled);
        let mut layout = self.ordered(refiner, coarsest, Effort { work: budget.orders, rule: Rule::Contact })?;
        let (mut freedom, mut least_step) = (Freedom::Rearranged, LEAST_STEP);
        while cell > 2.0 * finest.cell {
            cell /= 2.0;
            let grid = refiner.scene.grid(cell, Cover::Sampled);
            let rules = Refinement { grid, freedom, work: budget.refinement, least_step };
            layout = refiner.refine(&layout, rules).unwrap_or(layout);
            (freedom, least_step) = (Freedom::Kept, refine::STEP);
        }
        let work = budget.refinement;
        refiner.refine(&layout, Refinement { grid: finest, freedom: Freedom::Kept, work, least_step: LEAST_STEP })
    }

    /// Side of a cell of the coarsest grid in pixels.
    fn coarsest_cell(&self) -> f64 {
        let cells = COARSEST_CELLS.max(CELLS_OF_CHART * self.shapes.len() as f64);
        let across = cell_of((self.page.min_element() / NARROWEST).powi(2));
        cell_of(self.pixels() / cells).min(across)
    }

    /// Area of the page in pixels.
    fn pixels(&self) -> f64 {
        self.page.x * self.page.y
    }

    /// Charts with their turns.
    fn charts(&self) -> Vec<Chart> {
        let steps = match self.shapes.len() {
            0..=150 => 4,
            151..=MANY => 2,
            _ => 1,
        };
        let chart = |(shape, hull): (&ChartShape, &Vec<DVec2>)| {
            let mut turns = match self.rotations {
                Rotations::None => vec![DVec2::X],
                Rotations::Quarter => turns::QUARTERS.to_vec(),
                Rotations::Free => self.free_turns(shape, hull, steps),
            };
            // A strip across a narrow page would need masks many times as large as the page.
            let scale = |turn: &DVec2| single::largest_scale(turns::size_of(hull, *turn), self.page);
            let largest = turns.iter().map(scale).fold(0.0, f64::max);
            turns.retain(|turn| scale(turn) >= SMALLEST_TURN * largest);
            Chart { edges: shape.edges().collect(), turns }
        };
        self.shapes.iter().zip(&self.hulls).map(chart).collect()
    }

    /// Turns of a chart: around the one with the least bounding box, and for a large chart around the one with which
    /// it alone fills the page best.
    fn free_turns(&self, shape: &ChartShape, hull: &[DVec2], steps: usize) -> Vec<DVec2> {
        let mut turns = turns::fan(least_box_turn(hull), steps);
        if shape.area() > LARGE * self.area {
            turns.extend(turns::fan(single::best_turn(hull, self.page), 1));
        }
        turns
    }
}

/// Placements of a layout on the finest grid.
fn packed(scene: &Scene, layout: &Layout, grid: Grid) -> Vec<Packed> {
    let packed = |(chart, place): (usize, &Place)| {
        let pose = Pose { chart, turn: place.turn, scale: layout.scale };
        let low = scene.low(pose, grid, scene.cell(pose, place.centre, grid));
        Packed { turn: scene.charts[chart].turns[place.turn], low }
    };
    layout.places.iter().enumerate().map(packed).collect()
}

/// Limits of the work for a number of charts, in words.
struct Budget {
    orders: u64,
    /// For one scale of a refinement.
    refinement: u64,
}

impl Budget {
    fn of(count: usize) -> Self {
        let count = count as u64;
        let million = 1_000_000;
        Self { orders: (50 + 4 * count).min(500) * million, refinement: (3 + count / 6).min(30) * million }
    }
}

/// Side of a cell in pixels: the smallest power of two whose square is at least `area`.
fn cell_of(area: f64) -> f64 {
    let mut cell = 2.0_f64.powi(-8);
    while cell * cell < area {
        cell *= 2.0;
    }
    cell
}
