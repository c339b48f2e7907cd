//! Packing task on a page of one size: turns, grids and budgets.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "there are few tiles, and other casts saturate"
)]

use glam::DVec2;

use super::greedy::Rule;
use super::orders::{Effort, OrderSearch};
use super::refine::{self, Freedom, Refinement, Refiner};
use super::scene::{Chart, Cover, Grid, Layout, Place, Pose, Scene};
use super::{ChartShape, Packed, PackingInput, PackingOptions, Rotations, single, turns};
use crate::geom::{Bounds, least_box_turn};

/// Number of cells of the finest grid in one tile, at most.
const FINEST_CELLS: f64 = (1_u64 << 22) as f64;

/// Number of cells of the finest grid in all tiles, at most.
const MOST_CELLS: f64 = (1_u64 << 24) as f64;

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

/// Scale of layouts on coarse grids, at most, relative to a density that is asked for. Layouts shrink a little on finer
/// grids.
const HEADROOM: f64 = 1.02;

/// Scale of layouts on coarse grids, at least, relative to a density that is asked for. Below it, finer grids are not
/// tried.
const LEAST_SHARE: f64 = 0.985;

/// Smallest scale of the search over orders, relative to a density that is asked for. Perturbed orders gain less.
const LOWEST_SHARE: f64 = 0.9;

/// Smallest scale of charts beside fixed shapes, relative to the first scale that is tried.
const LEAST_BESIDE: f64 = 0.01;

/// Scale relative to the bound of charts in several tiles, from which a chart that fills a tile counts as the limit.
const LIMITED: f64 = 0.98;

/// Rounding of the placement of a single chart, relative to the page.
const ROUNDING: f64 = 1.0 / (1_u64 << 40) as f64;

/// Area by which scales are chosen: charts without area count as thin.
fn nominal_area(shape: &ChartShape) -> f64 {
    shape.area().max(Bounds::of(shape.vertices()).size().max_element().powi(2) * THINNEST)
}

/// Areas and pixels that must hold them.
#[derive(Clone, Copy, Debug)]
struct TileLoad {
    area: f64,
    pixels: f64,
}

/// Packing task on a page of a certain size.
#[derive(Clone)]
pub(crate) struct Task<'a> {
    shapes: &'a [ChartShape],
    /// Tile of each shape that must lie in a certain one.
    tile_of: Vec<Option<usize>>,
    /// Shapes that do not move, in widths and heights of the page.
    fixed: &'a [ChartShape],
    /// Number of tiles.
    tiles: usize,
    /// Corners of the hull of each shape.
    hulls: Vec<Vec<DVec2>>,
    /// Nominal area of all shapes.
    area: f64,
    /// Width and height of the page in pixels.
    pub(crate) page: DVec2,
    /// Gap in pixels.
    gap: f64,
    rotations: Rotations,
    /// Scale that is asked for. Without one, the largest scale is searched for.
    pub(crate) density: Option<f64>,
}

impl<'a> Task<'a> {
    /// Task on a page that is still to be set.
    pub(crate) fn new(input: PackingInput<'a>, options: PackingOptions) -> Self {
        let PackingInput { shapes, tiles, fixed } = input;
        let hulls = shapes.iter().map(ChartShape::hull).collect();
        let area = shapes.iter().map(nominal_area).sum();
        let (gap, rotations) = (f64::from(options.gap), options.rotations);
        let density = options.density.filter(|density| density.is_finite() && *density > 0.0);
        let last = options.tiles.clamp(1, PackingOptions::MOST_TILES) as usize - 1;
        let tile_of = |k: usize| tiles.get(k).copied().flatten().map(|tile| last.min(tile as usize));
        let tile_of = (0..shapes.len()).map(tile_of).collect();
        Self { shapes, tile_of, fixed, tiles: last + 1, hulls, area, page: DVec2::ZERO, gap, rotations, density }
    }

    /// Scale and placements. `None` if not even the gaps fit, no layout is found at the density, or if cancelled.
    pub(crate) fn solve(&self, is_cancelled: &dyn Fn() -> bool) -> Option<(f64, Vec<Packed>)> {
        match (self.shapes, self.fixed) {
            ([], _) => Some((self.page.max_element(), Vec::new())),
            ([_], []) => self.alone(),
            _ if self.tiles > 1 && self.tile_of.iter().all(Option::is_none) => self.in_any_tiles(is_cancelled),
            _ => self.together(self.tiles, is_cancelled),
        }
    }

    /// Placements of charts that may lie in any of several tiles. If a chart that fills a tile limits the scale, the
    /// others take as few tiles as found.
    fn in_any_tiles(&self, is_cancelled: &dyn Fn() -> bool) -> Option<(f64, Vec<Packed>)> {
        if let Some(density) = self.density {
            return self.in_few_tiles(density, is_cancelled);
        }
        let found = self.together(self.tiles, is_cancelled)?;
        let scale = found.0;
        if scale < LIMITED * self.highest_scale(&self.charts(self.tiles), self.tiles) {
            return Some(found);
        }
        let at_scale = Self { density: Some(scale), ..self.clone() };
        at_scale.in_few_tiles(scale, is_cancelled).or(Some(found))
    }

    /// Placements at a density in about the least number of tiles: the number grows from the one that the area needs
    /// until all charts fit, and then shrinks by bisection.
    fn in_few_tiles(&self, density: f64, is_cancelled: &dyn Fn() -> bool) -> Option<(f64, Vec<Packed>)> {
        let needed = self.shapes.iter().map(ChartShape::area).sum::<f64>() * density * density / self.pixels();
        // The cast saturates, also for numbers that are not finite.
        let least = needed.ceil().max(1.0) as usize;
        let (mut low, mut high) = (least.min(self.tiles), self.tiles);
        let mut found = None;
        for step in (0..usize::BITS).map(|power| (1_usize << power) - 1) {
            let tiles = (least.min(self.tiles) + step).min(self.tiles);
            found = self.together(tiles, is_cancelled);
            if found.is_some() || tiles == self.tiles {
                high = tiles;
                break;
            }
            low = tiles + 1;
        }
        while found.is_some() && low < high {
            let middle = usize::midpoint(low, high);
            match self.together(middle, is_cancelled) {
                Some(better) => (found, high) = (Some(better), middle),
                None => low = middle + 1,
            }
        }
        found
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
        let of_point = self.density.unwrap_or(1.0);
        let rounding = (self.page.max_element() + farthest * limit(room).unwrap_or(of_point)) * ROUNDING;
        let largest = limit((room - 2.0 * rounding).max(DVec2::ZERO)).unwrap_or(of_point);
        let scale = self.density.unwrap_or(largest);
        let low = hull.iter().map(|&corner| turn.rotate(corner) * scale).reduce(DVec2::min)?;
        (scale > 0.0 && scale <= largest).then(|| {
            (
                scale,
                vec![Packed { turn, low: self.gap / 2.0 + rounding - low, tile: self.tile_of[0].unwrap_or(0) as u32 }],
            )
        })
    }

    /// Scale above which a chart is larger than the page in all of its turns, or charts have more area than the page.
    fn highest_scale(&self, charts: &[Chart], tiles: usize) -> f64 {
        let room = self.page - self.gap;
        let of_chart = |(chart, hull): (&Chart, &Vec<DVec2>)| {
            let scales = chart.turns.iter().map(|&turn| single::largest_scale(turns::size_of(hull, turn), room));
            scales.fold(0.0, f64::max)
        };
        let by_size = charts.iter().zip(&self.hulls).map(of_chart).fold(f64::INFINITY, f64::min);
        let TileLoad { area, pixels } = self.heaviest(tiles, ChartShape::area);
        let by_area = if area > 0.0 && area.is_finite() { (pixels / area).sqrt() } else { f64::INFINITY };
        Some(by_size.min(by_area)).filter(|scale| scale.is_finite()).unwrap_or(self.density.unwrap_or(1.0))
    }

    /// Tiles with the most area for their pixels: one of those that charts must lie in, or all of them.
    fn heaviest(&self, tiles: usize, area: impl Fn(&ChartShape) -> f64) -> TileLoad {
        let mut of_tile = vec![0.0; tiles];
        for (shape, tile) in self.shapes.iter().zip(&self.tile_of) {
            if let Some(tile) = tile {
                of_tile[*tile] += area(shape);
            }
        }
        let all = TileLoad { area: self.shapes.iter().map(&area).sum(), pixels: self.pixels() * tiles as f64 };
        let loads = of_tile.into_iter().map(|area| TileLoad { area, pixels: self.pixels() });
        loads.fold(all, |a, b| if b.area * a.pixels > a.area * b.pixels { b } else { a })
    }

    /// Placements of charts in a number of tiles.
    fn together(&self, tiles: usize, is_cancelled: &dyn Fn() -> bool) -> Option<(f64, Vec<Packed>)> {
        let fixed = self.fixed.iter().map(|shape| shape.edges().collect()).collect();
        let scene = Scene { charts: self.charts(tiles), fixed, tiles, picture: self.page, gap: self.gap };
        let largest = self.highest_scale(&scene.charts, tiles);
        if largest <= 0.0 || self.density.is_some_and(|density| density > largest) {
            return None;
        }
        let finest = scene.grid(self.finest_cell(tiles), Cover::Touched);
        let refiner = Refiner { scene: &scene, highest: self.density.unwrap_or(largest), is_cancelled };
        let shaped = if self.shapes.len() <= MANY { self.coarse_to_fine(&refiner, finest, largest) } else { None };
        let found = match shaped {
            Some(found) => found,
            None if self.density.is_some() && self.shapes.len() <= MANY => return None,
            None => self.ordered(&refiner, finest, Effort { work: 0, rule: Rule::Lowest })?,
        };
        let is_enough = self.density.is_none_or(|density| found.scale >= density);
        is_enough.then(|| (found.scale, packed(&scene, &found, finest)))
    }

    /// Side of the smallest cells that a number of tiles are divided into.
    fn finest_cell(&self, tiles: usize) -> f64 {
        let of_all = self.pixels() * tiles as f64 / MOST_CELLS;
        cell_of((self.pixels() / FINEST_CELLS).max(of_all))
    }

    /// True if the fixed shapes leave some of a tile free, whatever the gap is.
    pub(crate) fn has_room(&self) -> bool {
        if self.fixed.is_empty() {
            return true;
        }
        let fixed = self.fixed.iter().map(|shape| shape.edges().collect()).collect();
        let scene = Scene { charts: Vec::new(), fixed, tiles: self.tiles, picture: self.page, gap: 0.0 };
        let grid = scene.grid(self.finest_cell(self.tiles), Cover::Sampled);
        scene.taken(grid).iter().any(|taken| taken.count() < grid.columns * grid.rows)
    }

    /// Layout by the best order of placement that a search finds.
    fn ordered(&self, refiner: &Refiner<'_>, grid: Grid, effort: Effort) -> Option<Layout> {
        let TileLoad { area, pixels } = self.heaviest(refiner.scene.tiles, nominal_area);
        let cover = (FIRST_COVER * pixels / area).sqrt();
        let is_guessed = self.density.is_none() && self.area > 0.0;
        let first = if is_guessed { cover.min(refiner.highest) } else { refiner.highest };
        let share = if effort.work > 0 { LOWEST_SHARE } else { 1.0 };
        let beside = if self.fixed.is_empty() { 0.0 } else { first * LEAST_BESIDE };
        let lowest = self.density.map_or(beside, |density| density * share);
        OrderSearch::new(refiner.scene, grid, effort, refiner.is_cancelled).run([lowest, first], refiner.highest)
    }

    /// Layout on the finest grid, refined from one on a coarse grid. `largest` bounds the scale on coarse grids.
    fn coarse_to_fine(&self, on_finest: &Refiner<'_>, finest: Grid, largest: f64) -> Option<Layout> {
        let budget = Budget::of(self.shapes.len());
        let mut cell = self.coarsest_cell(on_finest.scene.tiles).max(finest.cell);
        let highest = self.density.map_or(largest, |density| largest.min(density * HEADROOM));
        let refiner = &Refiner { highest, ..*on_finest };
        let coarsest = refiner.scene.grid(cell, Cover::Sampled);
        let mut layout = self.ordered(refiner, coarsest, Effort { work: budget.orders, rule: Rule::Contact })?;
        let (mut freedom, mut least_step) = (Freedom::Rearranged, LEAST_STEP);
        while cell > 2.0 * finest.cell {
            self.is_near(&layout).then_some(())?;
            cell /= 2.0;
            let grid = refiner.scene.grid(cell, Cover::Sampled);
            let rules = Refinement { grid, freedom, work: budget.refinement, least_step };
            layout = refiner.refine(&layout, rules).unwrap_or(layout);
            (freedom, least_step) = (Freedom::Kept, refine::STEP);
        }
        self.is_near(&layout).then_some(())?;
        let work = budget.refinement;
        on_finest.refine(&layout, Refinement { grid: finest, freedom: Freedom::Kept, work, least_step: LEAST_STEP })
    }

    /// True if a layout on a coarse grid has about the scale that is asked for, or none is.
    fn is_near(&self, layout: &Layout) -> bool {
        self.density.is_none_or(|density| layout.scale >= density * LEAST_SHARE)
    }

    /// Side of a cell of the coarsest grid in pixels.
    fn coarsest_cell(&self, tiles: usize) -> f64 {
        let cells = COARSEST_CELLS.max(CELLS_OF_CHART * self.shapes.len() as f64);
        let across = cell_of((self.page.min_element() / NARROWEST).powi(2));
        cell_of(self.pixels() * tiles as f64 / cells).min(across)
    }

    /// Area of one tile in pixels.
    fn pixels(&self) -> f64 {
        self.page.x * self.page.y
    }

    /// Charts with their turns and tiles.
    fn charts(&self, tiles: usize) -> Vec<Chart> {
        let steps = match self.shapes.len() {
            0..=150 => 4,
            151..=MANY => 2,
            _ => 1,
        };
        let chart = |((shape, hull), tile): ((&ChartShape, &Vec<DVec2>), &Option<usize>)| {
            let mut turns = match self.rotations {
                Rotations::None => vec![DVec2::X],
                Rotations::Quarter => turns::QUARTERS.to_vec(),
                Rotations::Free => self.free_turns(shape, hull, steps),
            };
            // A strip across a narrow page would need masks many times as large as the page.
            let scale = |turn: &DVec2| single::largest_scale(turns::size_of(hull, *turn), self.page);
            let largest = turns.iter().map(scale).fold(0.0, f64::max);
            turns.retain(|turn| scale(turn) >= SMALLEST_TURN * largest);
            Chart { edges: shape.edges().collect(), turns, tiles: tile.map_or(0..tiles, |tile| tile..tile + 1) }
        };
        self.shapes.iter().zip(&self.hulls).zip(&self.tile_of).map(chart).collect()
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
        Packed { turn: scene.charts[chart].turns[place.turn], low, tile: place.tile as u32 }
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
