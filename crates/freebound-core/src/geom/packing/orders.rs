//! Search over the orders in which charts are placed one after another.
//!
//! The first order is by size. A chart that finds no place moves forward in the next order (squeaky wheel
//! optimization, Joslin and Clements 1999), and random factors perturb the sizes. Whenever all charts find a place,
//! the scale grows.

use glam::DVec2;

use super::greedy::{ChartToPlace, Placed, Placer, Rule};
use super::mask::Mask;
use super::page::{Page, Stencil};
use super::scene::{Grid, Layout, Pose, Scene, TileCell};
use crate::geom::Random;

/// Factor of the scale from one attempt to the next while no scale is known that fits.
const DESCENT: f64 = 0.85;

/// Number of descents after which the gaps are taken not to fit.
const MOST_DESCENTS: usize = 80;

/// Ratio of the scales between which bisection stops.
const PRECISION: f64 = 1.005;

/// Growth of the scale after a success.
const GROWTH: f64 = 1.0025;

/// Growth of a chart's rank when the chart finds no place.
const PROMOTION: f64 = 1.3;

/// Range of the logarithm of the random factor of a rank.
const NOISE: f64 = 0.5;

/// Effort of a search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Number of words to read. A search ends after the attempt that exceeds it.
    pub(crate) work: u64,
    /// Rule for places.
    pub(crate) rule: Rule,
}

/// Search over orders on one grid.
pub(crate) struct OrderSearch<'a> {
    scene: &'a Scene,
    grid: Grid,
    effort: Effort,
    /// Page without the charts.
    page: Page,
    /// Number of cells that fixed shapes leave.
    room: usize,
    /// Factor of each chart's rank.
    ranks: Vec<f64>,
    random: Random,
    work: u64,
    is_cancelled: &'a dyn Fn() -> bool,
}

impl<'a> OrderSearch<'a> {
    /// Search with a seed of its own.
    pub(crate) fn new(scene: &'a Scene, grid: Grid, effort: Effort, is_cancelled: &'a dyn Fn() -> bool) -> Self {
        let ranks = vec![1.0; scene.charts.len()];
        let (mut page, taken) = (Page::new(grid), scene.taken(grid));
        for (tile, mask) in taken.iter().enumerate() {
            page.take_in(tile, mask);
        }
        let room = grid.columns * grid.rows * grid.tiles - taken.iter().map(Mask::count).sum::<usize>();
        Self { scene, grid, effort, page, room, ranks, random: Random(1), work: 0, is_cancelled }
    }

    /// Layout at the largest scale found between `lowest` and `highest`, starting at `first`. `None` if no scale was
    /// found or the search was cancelled.
    pub(crate) fn run(mut self, [lowest, first]: [f64; 2], highest: f64) -> Option<Layout> {
        let found = self.descend([lowest, first])?;
        let high = if found.scale < first { (found.scale / DESCENT).min(highest) } else { highest };
        let found = self.bisect(found, high)?;
        self.perturb(found, highest)
    }

    /// First layout at a scale of `first` or less, down to `lowest`.
    fn descend(&mut self, [lowest, first]: [f64; 2]) -> Option<Layout> {
        let mut scale = first;
        for _ in 0..MOST_DESCENTS {
            if (self.is_cancelled)() {
                return None;
            }
            if let Some(layout) = self.layout(scale) {
                return Some(layout);
            }
            if scale <= lowest {
                return None;
            }
            scale = (scale * DESCENT).max(lowest);
        }
        None
    }

    /// Better layout by bisection between the scale of a layout and `high`.
    fn bisect(&mut self, mut found: Layout, mut high: f64) -> Option<Layout> {
        while high > found.scale * PRECISION {
            if (self.is_cancelled)() {
                return None;
            }
            let middle = f64::midpoint(found.scale, high);
            match self.layout(middle) {
                Some(layout) => found = layout,
                None => high = middle,
            }
        }
        Some(found)
    }

    /// Better layout by perturbed orders.
    fn perturb(&mut self, mut found: Layout, highest: f64) -> Option<Layout> {
        let mut scale = (found.scale * GROWTH).min(highest);
        let mut stencils = self.stencils(scale);
        while self.work < self.effort.work && scale > found.scale && self.has_room(&stencils) {
            if (self.is_cancelled)() {
                return None;
            }
            let order = self.order(&stencils, NOISE);
            if let Some(placed) = self.attempt(&stencils, &order) {
                found = self.found(scale, &placed);
                scale = (scale * GROWTH).min(highest);
                stencils = self.stencils(scale);
            }
        }
        Some(found)
    }

    /// Layout at a scale by the order of sizes.
    fn layout(&mut self, scale: f64) -> Option<Layout> {
        let stencils = self.stencils(scale);
        let order = self.order(&stencils, 0.0);
        let placed = self.attempt(&stencils, &order)?;
        Some(self.found(scale, &placed))
    }

    /// Stencils of all charts in all turns.
    fn stencils(&mut self, scale: f64) -> Vec<Vec<Stencil>> {
        let of_chart = |chart: usize| {
            let turns = 0..self.scene.charts[chart].turns.len();
            turns.map(|turn| Stencil::new(self.scene.mask(Pose { chart, turn, scale }, self.grid))).collect()
        };
        let stencils: Vec<Vec<Stencil>> = (0..self.scene.charts.len()).map(of_chart).collect();
        self.work += stencils.iter().flatten().map(Stencil::words).sum::<u64>();
        stencils
    }

    /// Charts by falling rank: their size times their factor times a random factor.
    fn order(&mut self, stencils: &[Vec<Stencil>], noise: f64) -> Vec<usize> {
        let mut rank = |chart: usize| {
            let size = stencils[chart][0].count as f64;
            size * self.ranks[chart] * (1.0 + noise * (self.random.unit() - 0.5))
        };
        let ranks: Vec<f64> = (0..stencils.len()).map(&mut rank).collect();
        let mut order: Vec<usize> = (0..stencils.len()).collect();
        order.sort_by(|&a, &b| ranks[b].total_cmp(&ranks[a]).then(a.cmp(&b)));
        order
    }

    /// Places of all charts in an order. Promotes the first chart that finds none.
    fn attempt(&mut self, stencils: &[Vec<Stencil>], order: &[usize]) -> Option<Vec<Placed>> {
        if !self.has_room(stencils) {
            return None;
        }
        let mut page = Placer::new(self.page.clone());
        let mut places = vec![None; order.len()];
        for &chart in order {
            let candidate = ChartToPlace { stencils: &stencils[chart], tiles: &self.scene.charts[chart].tiles };
            places[chart] = page.put(candidate, self.effort.rule);
            if places[chart].is_none() {
                self.ranks[chart] *= PROMOTION;
                break;
            }
        }
        self.work += page.work + (self.grid.columns * self.grid.rows * self.grid.tiles / 16 + order.len()) as u64;
        places.into_iter().collect()
    }

    /// True if all tiles have as many free cells as all charts.
    fn has_room(&self, stencils: &[Vec<Stencil>]) -> bool {
        let least = |of: &Vec<Stencil>| of.iter().map(|stencil| stencil.count).min().unwrap_or(0);
        stencils.iter().map(least).sum::<usize>() <= self.room
    }

    fn found(&self, scale: f64, placed: &[Placed]) -> Layout {
        let place = |(chart, placed): (usize, &Placed)| {
            // The page has a border of one cell.
            let [tile, row] = self.page.tile_of(placed.spot.row);
            let cell = DVec2::new((placed.spot.column - 1) as f64, row as f64);
            self.scene.place(Pose { chart, turn: placed.turn, scale }, self.grid, TileCell { tile, cell })
        };
        Layout { scale, places: placed.iter().enumerate().map(place).collect() }
    }
}
