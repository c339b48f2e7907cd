//! Separation of overlapping charts by guided local search.
//!
//! Charts with overlaps move one after another to places with less overlap: the number of common cells of two charts
//! times the weight of the pair, summed over pairs. Weights of pairs that stay in overlap grow, others shrink, so the
//! search leaves local minima (guided local search: Voudouris and Tsang 1999; for nesting: Umetani et al. 2009;
//! sampled places: Gardeyn, Vanden Berghe and Wauters 2025).

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "columns and rows of a page are far fewer than 2³¹"
)]

use std::ops::Range;

use super::mask::Mask;
use super::scene::Grid;
use crate::geom::Random;

/// Factors by which the weight of a pair grows: without overlap, and with the largest one. The factor is linear in
/// the overlap in between.
const GROWTH: [f32; 2] = [1.2, 2.0];

/// Factor by which the weight of a pair without overlap shrinks. Weights are at least 1.
const DECAY: f32 = 0.95;

/// Largest weight. Sums of overlaps times weights stay finite.
const HEAVIEST: f32 = 1e12;

/// Random places that are compared for a chart.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moves {
    /// Number of places on the whole page.
    pub(crate) anywhere: usize,
    /// Number of places near the chart.
    pub(crate) nearby: usize,
    /// Largest shift of a place near the chart, and largest step of a descent, in cells.
    pub(crate) reach: i32,
}

impl Moves {
    /// Moves that may rearrange charts.
    pub(crate) const FAR: Self = Self { anywhere: 20, nearby: 10, reach: i32::MAX };

    /// Moves that keep the arrangement.
    pub(crate) const NEAR: Self = Self { anywhere: 0, nearby: 4, reach: 8 };
}

/// Number of compared places from which descent starts.
const DESCENTS: usize = 3;

/// Directions of descent.
const DIRECTIONS: [[i32; 2]; 8] = [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1], [1, -1], [-1, 1]];

/// Place of a chart: its tile, the number of its mask, and the column and row of the mask's lower left cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Spot {
    pub(crate) tile: usize,
    pub(crate) turn: usize,
    pub(crate) x: i32,
    pub(crate) y: i32,
}

/// Charts, and the tiles where they may lie.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Board<'a> {
    /// Masks of each chart.
    pub(crate) masks: &'a [Vec<Mask>],
    /// Tiles of each chart.
    pub(crate) tiles: &'a [Range<usize>],
    /// Cells of each tile that fixed shapes take; empty if there are none.
    pub(crate) taken: &'a [Mask],
    pub(crate) grid: Grid,
}

/// Charts in tiles of cells, possibly in overlap.
pub(crate) struct Separator<'a> {
    board: Board<'a>,
    /// Columns and rows of a tile.
    size: [i32; 2],
    /// Place of each chart, then of the cells that are taken in each tile. The latter do not move.
    pub(crate) spots: Vec<Spot>,
    /// Weight of each pair of charts, twice.
    weights: Vec<f32>,
    /// Pairs whose weight may be more than 1.
    heavy: Vec<[usize; 2]>,
    /// Charts by the part of the page where their boxes lie.
    buckets: Buckets,
    moves: Moves,
    random: Random,
    /// Number of words that were read.
    pub(crate) work: u64,
}

/// Spot with its weighted overlap.
#[derive(Clone, Copy)]
struct Rated {
    cost: f32,
    spot: Spot,
}

impl<'a> Separator<'a> {
    /// Charts at their places, moved into their tiles. `None` if a chart's mask is larger than a tile.
    pub(crate) fn new(board: Board<'a>, mut spots: Vec<Spot>, moves: Moves, random: Random) -> Option<Self> {
        spots.extend((0..board.taken.len()).map(|tile| Spot { tile, turn: 0, x: 0, y: 0 }));
        let count = spots.len();
        let Grid { columns, rows, tiles, .. } = board.grid;
        let size = [columns, rows].map(|side| side as i32);
        let (weights, buckets) = (vec![1.0; count * count], Buckets::new([size[0], size[1] * tiles as i32], count));
        let mut all = Self { board, size, spots, weights, heavy: Vec::new(), buckets, moves, random, work: 0 };
        for chart in 0..count {
            let spot = all.spots[chart];
            let room = all.room(chart, spot.turn)?;
            all.spots[chart] = Spot { x: spot.x.clamp(0, room[0]), y: spot.y.clamp(0, room[1]), ..spot };
            all.buckets.insert(chart, all.area(chart, all.spots[chart]));
        }
        Some(all)
    }

    /// Moves charts until none overlap. False if they still do after reading `work` words, or if cancelled.
    pub(crate) fn separate(&mut self, work: u64, is_cancelled: &dyn Fn() -> bool) -> bool {
        loop {
            let mut charts = self.reweigh();
            if charts.is_empty() {
                return true;
            }
            if self.work > work || is_cancelled() {
                return false;
            }
            charts.retain(|&chart| chart < self.board.masks.len());
            for last in (1..charts.len()).rev() {
                charts.swap(self.random.index(last + 1), last);
            }
            for chart in charts {
                self.improve(chart);
            }
        }
    }

    /// Mask of a chart in one of its turns, or taken cells of a tile.
    fn mask(&self, chart: usize, turn: usize) -> &'a Mask {
        let Board { masks, taken, .. } = self.board;
        masks.get(chart).map_or_else(|| &taken[chart - masks.len()], |masks| &masks[turn])
    }

    /// Largest column and row at which a chart lies in a tile. `None` if it is larger than the tile.
    fn room(&self, chart: usize, turn: usize) -> Option<[i32; 2]> {
        let mask = self.mask(chart, turn);
        let room = [self.size[0] - mask.width as i32, self.size[1] - mask.height as i32];
        (room[0] >= 0 && room[1] >= 0).then_some(room)
    }

    /// Cells of the box of a chart at a spot, with all tiles one above the other.
    fn area(&self, chart: usize, spot: Spot) -> Area {
        let (mask, low) = (self.mask(chart, spot.turn), spot.y + spot.tile as i32 * self.size[1]);
        Area { low: [spot.x, low], high: [spot.x + mask.width as i32, low + mask.height as i32] }
    }

    /// Updates the weights of all pairs, and returns the charts in overlap, in order.
    fn reweigh(&mut self) -> Vec<usize> {
        let overlaps = self.overlaps();
        for [first, second] in std::mem::take(&mut self.heavy) {
            if self.common(first, self.spots[first], second) == 0 {
                self.scale_weight(first, second, DECAY);
                if self.weights[first * self.spots.len() + second] > 1.0 {
                    self.heavy.push([first, second]);
                }
            }
        }
        let most = overlaps.iter().map(|overlap| overlap.1).max().unwrap_or(1);
        for &([first, second], common) in &overlaps {
            let share = common as f32 / most as f32;
            self.scale_weight(first, second, GROWTH[0] + (GROWTH[1] - GROWTH[0]) * share);
            self.heavy.push([first, second]);
        }
        let mut charts: Vec<usize> = overlaps.iter().flat_map(|overlap| overlap.0).collect();
        charts.sort_unstable();
        charts.dedup();
        charts
    }

    /// Pairs of charts in overlap, each once, with their numbers of common cells.
    fn overlaps(&mut self) -> Vec<([usize; 2], u32)> {
        let mut overlaps = Vec::new();
        for chart in 0..self.spots.len() {
            let spot = self.spots[chart];
            let area = self.area(chart, spot);
            for bucket in self.buckets.range(area) {
                for k in 0..self.buckets.len(bucket) {
                    let other = self.buckets.chart(bucket, k);
                    if other < chart && self.is_first(bucket, area, other) {
                        let common = self.common(chart, spot, other);
                        if common > 0 {
                            overlaps.push(([chart, other], common));
                        }
                    }
                }
            }
        }
        overlaps
    }

    /// True if a bucket holds the lower left cell of the box that an area has in common with another chart's box. So
    /// a pair that shares several buckets counts in one of them.
    fn is_first(&self, bucket: [usize; 2], area: Area, other: usize) -> bool {
        let of = self.area(other, self.spots[other]);
        self.buckets.of([area.low[0].max(of.low[0]), area.low[1].max(of.low[1])]) == bucket
    }

    fn scale_weight(&mut self, first: usize, second: usize, factor: f32) {
        let count = self.spots.len();
        for pair in [first * count + second, second * count + first] {
            self.weights[pair] = (self.weights[pair] * factor).clamp(1.0, HEAVIEST);
        }
    }

    /// Moves a chart to the best place found, if that is better than its own.
    fn improve(&mut self, chart: usize) {
        let spot = self.spots[chart];
        let cost = self.cost(chart, spot, f32::INFINITY);
        if cost == 0.0 {
            return;
        }
        let mask = self.mask(chart, spot.turn);
        let step = (mask.width.min(mask.height) as i32 / 4).clamp(1, self.moves.reach);
        let mut best = self.descend(chart, Rated { cost, spot }, step.min(4));
        if best.cost > 0.0 {
            for start in self.samples(chart) {
                let found = self.descend(chart, start, step);
                best = if found.cost < best.cost { found } else { best };
            }
        }
        self.buckets.remove(chart, self.area(chart, spot));
        self.spots[chart] = best.spot;
        self.buckets.insert(chart, self.area(chart, best.spot));
    }

    /// Best random places of a chart, the best first.
    fn samples(&mut self, chart: usize) -> Vec<Rated> {
        let mut tops: Vec<Rated> = Vec::with_capacity(DESCENTS + 1);
        let moves = self.moves;
        for number in 0..moves.anywhere + moves.nearby {
            let spot = if number < moves.anywhere { self.anywhere(chart) } else { self.nearby(chart) };
            let Some(spot) = spot else { continue };
            let bound = if tops.len() == DESCENTS { tops[DESCENTS - 1].cost } else { f32::INFINITY };
            let cost = self.cost(chart, spot, bound);
            if cost < bound {
                tops.push(Rated { cost, spot });
                tops.sort_by(|a, b| a.cost.total_cmp(&b.cost));
                tops.truncate(DESCENTS);
            }
        }
        tops
    }

    /// Random place of a chart in one of its tiles in a random turn. `None` if the turn does not fit.
    fn anywhere(&mut self, chart: usize) -> Option<Spot> {
        let turn = self.random.index(self.board.masks[chart].len());
        let tiles = self.board.tiles[chart].clone();
        let tile = if tiles.len() > 1 { tiles.start + self.random.index(tiles.len()) } else { tiles.start };
        let room = self.room(chart, turn)?;
        let [x, y] = room.map(|room| self.random.index(room as usize + 1) as i32);
        Some(Spot { tile, turn, x, y })
    }

    /// Random place of a chart near its present one, in its present turn or a random one.
    fn nearby(&mut self, chart: usize) -> Option<Spot> {
        let here = self.spots[chart];
        let turns = [here.turn, self.random.index(self.board.masks[chart].len())];
        let turn = turns[self.random.index(2)];
        let room = self.room(chart, turn)?;
        let (old, new) = (self.mask(chart, here.turn), self.mask(chart, turn));
        let reach = self.moves.reach.min(new.width.max(new.height) as i32 / 2 + 2);
        let mut shifted = |from: i32, old: usize, new: usize| {
            from + (old as i32 - new as i32) / 2 + self.random.index(2 * reach as usize + 1) as i32 - reach
        };
        let x = shifted(here.x, old.width, new.width).clamp(0, room[0]);
        let y = shifted(here.y, old.height, new.height).clamp(0, room[1]);
        Some(Spot { turn, x, y, ..here })
    }

    /// Descent in steps of `step` cells, halved down to one cell whenever no direction is better.
    fn descend(&mut self, chart: usize, mut best: Rated, mut step: i32) -> Rated {
        let Some(room) = self.room(chart, best.spot.turn) else { return best };
        while step > 0 && best.cost > 0.0 {
            let better = DIRECTIONS.iter().find_map(|&[x, y]| {
                let spot = Spot { x: best.spot.x + x * step, y: best.spot.y + y * step, ..best.spot };
                let is_inside = (0..=room[0]).contains(&spot.x) && (0..=room[1]).contains(&spot.y);
                let cost = if is_inside { self.cost(chart, spot, best.cost) } else { f32::INFINITY };
                (cost < best.cost).then_some(Rated { cost, spot })
            });
            match better {
                Some(better) => best = better,
                None => step /= 2,
            }
        }
        best
    }

    /// Weighted overlap of a chart at a spot with all other charts; at least `bound` if it is not less than that.
    fn cost(&mut self, chart: usize, spot: Spot, bound: f32) -> f32 {
        let count = self.spots.len();
        let area = self.area(chart, spot);
        let mut sum = 0.0;
        for bucket in self.buckets.range(area) {
            self.work += 2 + self.buckets.len(bucket) as u64;
            for k in 0..self.buckets.len(bucket) {
                let other = self.buckets.chart(bucket, k);
                if other == chart || !self.is_first(bucket, area, other) {
                    continue;
                }
                let common = self.common(chart, spot, other);
                if common > 0 {
                    sum += common as f32 * self.weights[chart * count + other];
                    if sum >= bound {
                        return sum;
                    }
                }
            }
        }
        sum
    }

    /// Number of cells that a chart at a spot has in common with another chart at its place.
    fn common(&mut self, chart: usize, spot: Spot, other: usize) -> u32 {
        let at = self.spots[other];
        if at.tile != spot.tile {
            return 0;
        }
        let (first, second) = (self.mask(chart, spot.turn), self.mask(other, at.turn));
        let is_beside = at.x >= spot.x + first.width as i32 || spot.x >= at.x + second.width as i32;
        let is_above = at.y >= spot.y + first.height as i32 || spot.y >= at.y + second.height as i32;
        if is_beside || is_above {
            return 0;
        }
        let (left, right) = (Put { mask: first, spot }, Put { mask: second, spot: at });
        let (left, right) = if at.x < spot.x { (right, left) } else { (left, right) };
        let (common, words) = common_cells(left, right);
        self.work += words;
        common
    }
}

/// Box of cells: the lowest column and row, and those after the last ones.
#[derive(Clone, Copy, Debug)]
struct Area {
    low: [i32; 2],
    high: [i32; 2],
}

/// Charts by squares of the page that their boxes touch.
#[derive(Clone, Debug)]
struct Buckets {
    /// Binary logarithm of the side of a square in cells.
    shift: u32,
    /// Number of squares in a row.
    columns: usize,
    charts: Vec<Vec<u32>>,
}

impl Buckets {
    /// Empty squares, about one for each chart.
    fn new(size: [i32; 2], count: usize) -> Self {
        let cells = size[0] as usize * size[1] as usize;
        let shift = (cells / count.max(1)).max(1).ilog2() / 2;
        let [columns, rows] = size.map(|side| (side as usize >> shift) + 1);
        Self { shift, columns, charts: vec![Vec::new(); columns * rows] }
    }

    /// Square of a cell: its column and row.
    fn of(&self, cell: [i32; 2]) -> [usize; 2] {
        cell.map(|coordinate| coordinate as usize >> self.shift)
    }

    /// Squares that a box touches.
    fn range(&self, area: Area) -> impl Iterator<Item = [usize; 2]> + use<> {
        let (low, high) = (self.of(area.low), self.of(area.high.map(|end| end - 1)));
        (low[1]..=high[1]).flat_map(move |row| (low[0]..=high[0]).map(move |column| [column, row]))
    }

    fn len(&self, [column, row]: [usize; 2]) -> usize {
        self.charts[row * self.columns + column].len()
    }

    fn chart(&self, [column, row]: [usize; 2], k: usize) -> usize {
        self.charts[row * self.columns + column][k] as usize
    }

    fn insert(&mut self, chart: usize, area: Area) {
        for [column, row] in self.range(area) {
            self.charts[row * self.columns + column].push(chart as u32);
        }
    }

    fn remove(&mut self, chart: usize, area: Area) {
        for [column, row] in self.range(area) {
            self.charts[row * self.columns + column].retain(|&other| other != chart as u32);
        }
    }
}

/// Mask at a place.
#[derive(Clone, Copy)]
struct Put<'a> {
    mask: &'a Mask,
    spot: Spot,
}

/// Number of common cells of two masks whose boxes overlap, the left one first, and of words that were read.
fn common_cells(left: Put<'_>, right: Put<'_>) -> (u32, u64) {
    let (Put { mask: left, spot: at }, Put { mask: right, spot: to }) = (left, right);
    let shift = (to.x - at.x) as usize;
    let low = at.y.max(to.y);
    let high = (at.y + left.height as i32).min(to.y + right.height as i32);
    let rows = (high - low) as usize;
    let words = (left.words - shift / 64).min(right.words);
    let rows_of =
        |mask: &'_ Mask, from: i32| (low - from) as usize * mask.words..((low - from) as usize + rows) * mask.words;
    let (left_rows, right_rows) = (&left.bits[rows_of(left, at.y)], &right.bits[rows_of(right, to.y)]);
    let common =
        if left.words == 1 && right.words == 1 {
            count_ones(left_rows.iter().zip(right_rows).map(|(&left, &right)| (left >> shift) & right))
        } else {
            let pairs = left_rows.chunks_exact(left.words).zip(right_rows.chunks_exact(right.words));
            count_ones(pairs.flat_map(|(left, right)| {
                (0..words).map(move |k| shifted(left, k + shift / 64, shift % 64) & right[k])
            }))
        };
    (common, (rows * words) as u64)
}

/// Word `k` of bits shifted down by less than 64.
fn shifted(source: &[u64], k: usize, shift: usize) -> u64 {
    let high = if shift == 0 { 0 } else { source.get(k + 1).copied().unwrap_or(0) << (64 - shift) };
    source[k] >> shift | high
}

/// Number of ones in words. Sums bytes of up to 31 words before they can overflow.
fn count_ones(mut words: impl Iterator<Item = u64>) -> u32 {
    let mut sum = 0;
    loop {
        let mut bytes = 0_u64;
        let mut count = 0;
        for word in words.by_ref().take(31) {
            bytes += ones_in_bytes(word);
            count += 1;
        }
        let pairs = (bytes & 0x00ff_00ff_00ff_00ff) + ((bytes >> 8) & 0x00ff_00ff_00ff_00ff);
        sum += (pairs.wrapping_mul(0x0001_0001_0001_0001) >> 48) as u32;
        if count < 31 {
            return sum;
        }
    }
}

/// Number of ones in each byte of a word.
fn ones_in_bytes(word: u64) -> u64 {
    let pairs = word - ((word >> 1) & 0x5555_5555_5555_5555);
    let nibbles = (pairs & 0x3333_3333_3333_3333) + ((pairs >> 2) & 0x3333_3333_3333_3333);
    (nibbles + (nibbles >> 4)) & 0x0f0f_0f0f_0f0f_0f0f
}
