//! Page: free cells of the picture, and all places where a mask fits.
//!
//! Level `j` of a page has a bit for each cell at which a run of `2ʲ` free cells starts. A run of any length `n` is
//! free if two runs of level `⌊log₂ n⌋` are: one at its start, one at its end. So one run of a mask costs two
//! shifted words for 64 places.

#![expect(clippy::cast_possible_truncation, reason = "columns and rows of a page are far fewer than 2³²")]

use std::ops::Range;

use super::mask::Mask;
use super::scene::Grid;

/// Run of marked cells in a row of a mask.
#[derive(Clone, Copy, Debug)]
struct Run {
    row: u32,
    start: u32,
    length: u32,
}

/// Mask with what the search for places needs.
#[derive(Clone, Debug)]
pub(crate) struct Stencil {
    /// Cells that the chart takes.
    pub(crate) mask: Mask,
    /// Runs of the mask, longest first: long runs exclude most places.
    runs: Vec<Run>,
    /// Cells beside the mask, in a frame with one more column and row on each side.
    rim: Mask,
    /// Number of cells of the rim.
    pub(crate) rim_count: usize,
    /// Number of cells of the mask.
    pub(crate) count: usize,
}

impl Stencil {
    pub(crate) fn new(mask: Mask) -> Self {
        let mut runs: Vec<Run> = (0..mask.height).flat_map(|row| runs(&mask, row)).collect();
        runs.sort_by_key(|run| (std::cmp::Reverse(run.length), run.row, run.start));
        let rim = rim(&mask);
        Self { runs, rim_count: rim.count(), count: mask.count(), rim, mask }
    }

    /// Number of words of the stencil, as a measure of the work to make it.
    pub(crate) fn words(&self) -> u64 {
        (self.mask.bits.len() + self.rim.bits.len() + self.runs.len()) as u64
    }
}

/// Runs of a row from left to right.
fn runs(mask: &Mask, row: usize) -> Vec<Run> {
    let bit = |column: usize| column < mask.width && mask.row(row)[column / 64] >> (column % 64) & 1 == 1;
    let mut found = Vec::new();
    let mut start = None;
    for column in 0..=mask.width {
        match (start, bit(column)) {
            (None, true) => start = Some(column),
            (Some(first), false) => {
                found.push(Run { row: row as u32, start: first as u32, length: (column - first) as u32 });
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// Cells that share an edge with a mask and are not part of it.
fn rim(mask: &Mask) -> Mask {
    let mut rim = Mask::empty(mask.width + 2, mask.height + 2);
    let inner = |row: usize| (1..=mask.height).contains(&row).then(|| mask.row(row - 1));
    for row in 0..rim.height {
        let word = |of: Option<&[u64]>, k: usize| of.and_then(|of| of.get(k)).copied().unwrap_or(0);
        let (below, here, above) = (row.checked_sub(1).and_then(inner), inner(row), inner(row + 1));
        for k in 0..rim.words {
            // Column c of the mask is column c + 1 of the rim.
            let before = |of, shift: u32| match k {
                0 => word(of, 0) << shift,
                _ => word(of, k) << shift | word(of, k - 1) >> (64 - shift),
            };
            let left = word(here, k);
            let all = before(below, 1) | before(above, 1) | left | before(here, 2);
            rim.bits[row * rim.words + k] = all & !before(here, 1);
        }
    }
    rim
}

/// Place of a mask on a page: column and row of its lower left cell, in the frame of the page with its borders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Spot {
    pub(crate) column: usize,
    pub(crate) row: usize,
}

/// Free cells of all tiles, one above the other. Each tile has a border of one taken cell; two tiles share a row of it.
#[derive(Clone, Debug)]
pub(crate) struct Page {
    /// Rows of all tiles with their borders.
    pub(crate) height: usize,
    /// Rows of one tile without its border.
    rows: usize,
    words: usize,
    /// Bits of each level, row by row.
    levels: Vec<Vec<u64>>,
    /// Number of levels with a bit in each row.
    heights: Vec<usize>,
}

impl Page {
    /// Free page of all tiles of a grid.
    pub(crate) fn new(Grid { columns, rows, tiles, .. }: Grid) -> Self {
        let (width, height) = (columns + 2, tiles * (rows + 1) + 1);
        let words = width.div_ceil(64);
        let levels = vec![vec![0; words * height]; columns.ilog2() as usize + 1];
        let mut page = Self { height, rows, words, levels, heights: vec![0; height] };
        for row in page.starts(0..tiles, 1) {
            for column in 1..=columns {
                page.levels[0][row * words + column / 64] |= 1 << (column % 64);
            }
            page.update(row);
        }
        page
    }

    /// Rows at which masks of a height lie within one of these tiles, in order.
    pub(crate) fn starts(&self, tiles: Range<usize>, height: usize) -> impl Iterator<Item = usize> + use<> {
        let (stride, count) = (self.rows + 1, (self.rows + 1).saturating_sub(height));
        tiles.flat_map(move |tile| (0..count).map(move |row| 1 + tile * stride + row))
    }

    /// Tile of a row of cells, and the number of the row in the tile.
    pub(crate) fn tile_of(&self, row: usize) -> [usize; 2] {
        [(row - 1) / (self.rows + 1), (row - 1) % (self.rows + 1)]
    }

    /// Takes the cells of a mask that covers a whole tile.
    pub(crate) fn take_in(&mut self, tile: usize, mask: &Mask) {
        self.take(mask, Spot { column: 1, row: 1 + tile * (self.rows + 1) });
    }

    /// Computes the higher levels of a row from its free cells.
    fn update(&mut self, row: usize) {
        let range = row * self.words..(row + 1) * self.words;
        for level in 1..self.levels.len() {
            let (lower, upper) = self.levels.split_at_mut(level);
            let (source, target) = (&lower[level - 1][range.clone()], &mut upper[0][range.clone()]);
            target.copy_from_slice(source);
            and_shifted(target, source, 1 << (level - 1), 0);
        }
        let is_empty = |bits: &Vec<u64>| bits[range.clone()].iter().all(|&word| word == 0);
        self.heights[row] = self.levels.iter().position(is_empty).unwrap_or(self.levels.len());
    }

    /// Takes the cells of a mask.
    pub(crate) fn take(&mut self, mask: &Mask, spot: Spot) {
        let (first, shift) = (spot.column / 64, spot.column % 64);
        for row in 0..mask.height {
            let start = (spot.row + row) * self.words + first;
            let cells = &mut self.levels[0];
            for (k, &word) in mask.row(row).iter().enumerate() {
                cells[start + k] &= !(word << shift);
                // Zero if the word does not reach into the next one, which may be beyond the page.
                let carried = if shift > 0 { word >> (64 - shift) } else { 0 };
                if carried != 0 {
                    cells[start + k + 1] &= !carried;
                }
            }
            self.update(spot.row + row);
        }
    }

    /// Computes the columns where a stencil fits with its lowest row at `row`, as bits. Returns false if there are
    /// none. `work` grows by the number of words that were read.
    pub(crate) fn fits(&self, stencil: &Stencil, row: usize, found: &mut [u64], work: &mut u64) -> bool {
        let (mut first, mut last) = (0, self.words);
        // Most rows of a full page end at the longest run of the mask.
        if stencil.runs.first().is_some_and(|run| !self.has_run(row, *run)) {
            return false;
        }
        found.fill(u64::MAX);
        // Column 0 is the border. A mask may have no cell in its first column.
        found[0] = u64::MAX - 1;
        for run in &stencil.runs {
            if !self.has_run(row, *run) {
                return false;
            }
            let level = run.length.ilog2() as usize;
            let source = &self.levels[level][(row + run.row as usize) * self.words..][..self.words];
            let start = run.start as usize;
            and_shifted(&mut found[..last], source, start, first);
            and_shifted(&mut found[..last], source, start + run.length as usize - (1 << level), first);
            *work += 2 * (last - first) as u64;
            while first < last && found[first] == 0 {
                first += 1;
            }
            while first < last && found[last - 1] == 0 {
                last -= 1;
            }
            if first == last {
                return false;
            }
        }
        found[last..].fill(0);
        true
    }

    /// True if the row of a run has free cells in a row for half of the run's length or more.
    fn has_run(&self, row: usize, run: Run) -> bool {
        (run.length.ilog2() as usize) < self.heights[row + run.row as usize]
    }

    /// Number of taken cells beside a stencil at a spot.
    pub(crate) fn contact(&self, stencil: &Stencil, spot: Spot, work: &mut u64) -> usize {
        let rim = &stencil.rim;
        let (column, row) = (spot.column - 1, spot.row - 1);
        let (first, shift) = (column / 64, column % 64);
        let mut free = 0;
        for k in 0..rim.height {
            let source = &self.levels[0][(row + k) * self.words..][..self.words];
            for (j, &word) in rim.row(k).iter().enumerate() {
                free += (word & shifted(source, first + j, shift)).count_ones();
            }
        }
        *work += (rim.height * rim.words) as u64;
        stencil.rim_count - free as usize
    }

    /// Number of words in a row.
    pub(crate) fn words(&self) -> usize {
        self.words
    }
}

/// Word `k` of bits shifted down by less than 64.
fn shifted(source: &[u64], k: usize, shift: usize) -> u64 {
    let low = source.get(k).copied().unwrap_or(0);
    if shift == 0 { low } else { low >> shift | source.get(k + 1).copied().unwrap_or(0) << (64 - shift) }
}

/// Keeps bit `x` of `target` if bit `x + shift` of `source` is set, from word `first` of the target on.
fn and_shifted(target: &mut [u64], source: &[u64], shift: usize, first: usize) {
    let (skip, shift) = (shift / 64, shift % 64);
    for (k, word) in target.iter_mut().enumerate().skip(first) {
        *word &= shifted(source, k + skip, shift);
    }
}
