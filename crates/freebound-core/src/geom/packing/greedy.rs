//! Placement of charts one after another.
//!
//! A chart goes where the largest share of the cells beside it is taken, over all its turns. So a chart fills the
//! bays, holes and corners that other charts leave. Only corners of the region of possible places are compared: a
//! place that can slide both ways along a row or a column touches less than one that cannot.

use std::collections::BTreeMap;
use std::ops::Range;

use super::page::{Page, Spot, Stencil};

/// Rule for the choice among possible places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rule {
    /// Largest share of taken cells beside the chart.
    Contact,
    /// Lowest upper end, then leftmost.
    Lowest,
}

/// Heights of a chart by which the next chart of about the same size may lie lower.
const SLACK: usize = 6;

/// Place of a chart: the number of its turn, and its spot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Placed {
    pub(crate) turn: usize,
    pub(crate) spot: Spot,
}

/// Chart that looks for a place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChartToPlace<'a> {
    /// Its turns.
    pub(crate) stencils: &'a [Stencil],
    /// Tiles in which it may lie.
    pub(crate) tiles: &'a Range<usize>,
}

/// Finds places for charts on one page.
pub(crate) struct Placer {
    page: Page,
    /// Possible columns of each row, as bits.
    fits: Vec<u64>,
    /// True for a row with a possible column.
    has_fit: Vec<bool>,
    /// Row at which the search for a place starts, for each range of tiles and each class of sizes.
    floors: BTreeMap<[usize; 3], usize>,
    /// Number of words that were read.
    pub(crate) work: u64,
}

impl Placer {
    /// Placer on a page, of which cells may be taken.
    pub(crate) fn new(page: Page) -> Self {
        let fits = vec![0; page.words() * page.height];
        Self { has_fit: vec![false; page.height], fits, floors: BTreeMap::new(), page, work: 0 }
    }

    /// Puts a chart at its best place. `None` if there is no place.
    pub(crate) fn put(&mut self, chart: ChartToPlace<'_>, rule: Rule) -> Option<Placed> {
        let best = match rule {
            Rule::Contact => self.most_contact(chart),
            Rule::Lowest => self.lowest(chart),
        }?;
        self.page.take(&chart.stencils[best.turn].mask, best.spot);
        Some(best)
    }

    /// Lowest place, searched from a little below the last place of a chart of about the same size. So the rows that
    /// are full are not read again for each of many charts.
    fn lowest(&mut self, ChartToPlace { stencils, tiles }: ChartToPlace<'_>) -> Option<Placed> {
        let class = (stencils[0].count.max(1).pow(2)).ilog2() as usize;
        let class = [tiles.start, tiles.end, class];
        let floor = self.floors.get(&class).copied().unwrap_or(1);
        let mut best: Option<((usize, usize), Placed)> = None;
        let words = self.page.words();
        let mut found = vec![0; words];
        for (turn, stencil) in stencils.iter().enumerate() {
            for row in self.page.starts(tiles.clone(), stencil.mask.height).filter(|&row| row >= floor) {
                let top = row + stencil.mask.height;
                if best.is_some_and(|(key, _)| key.0 < top) {
                    break;
                }
                if self.page.fits(stencil, row, &mut found, &mut self.work) {
                    let k = found.iter().position(|&word| word != 0).unwrap_or(0);
                    let column = 64 * k + found[k].trailing_zeros() as usize;
                    if best.is_none_or(|(key, _)| (top, column) < key) {
                        best = Some(((top, column), Placed { turn, spot: Spot { column, row } }));
                    }
                    break;
                }
            }
        }
        let (_, placed) = best?;
        let height = stencils[placed.turn].mask.height;
        self.floors.insert(class, floor.max(placed.spot.row.saturating_sub(SLACK * height)));
        Some(placed)
    }

    fn most_contact(&mut self, ChartToPlace { stencils, tiles }: ChartToPlace<'_>) -> Option<Placed> {
        let mut best: Option<(f64, Placed)> = None;
        for (turn, stencil) in stencils.iter().enumerate() {
            self.find_fits(stencil, tiles.clone());
            self.visit_corners(|page, spot, work| {
                let score = page.contact(stencil, spot, work) as f64 / stencil.rim_count as f64;
                if best.is_none_or(|(most, _)| score > most) {
                    best = Some((score, Placed { turn, spot }));
                }
            });
        }
        best.map(|(_, placed)| placed)
    }

    /// Computes all possible places of a stencil in these tiles.
    fn find_fits(&mut self, stencil: &Stencil, tiles: Range<usize>) {
        let words = self.page.words();
        self.has_fit.fill(false);
        for row in self.page.starts(tiles, stencil.mask.height) {
            let found = &mut self.fits[row * words..][..words];
            self.has_fit[row] = self.page.fits(stencil, row, found, &mut self.work);
        }
    }

    /// Visits possible places with an impossible neighbour in their row and one in their column.
    fn visit_corners(&mut self, mut visit: impl FnMut(&Page, Spot, &mut u64)) {
        let words = self.page.words();
        for row in 1..self.page.height - 1 {
            if !self.has_fit[row] {
                continue;
            }
            for k in 0..words {
                let word = |row: usize, k: usize| if self.has_fit[row] { self.fits[row * words + k] } else { 0 };
                let here = word(row, k);
                if here == 0 {
                    continue;
                }
                let left = here << 1 | if k > 0 { word(row, k - 1) >> 63 } else { 0 };
                let right = here >> 1 | if k + 1 < words { word(row, k + 1) << 63 } else { 0 };
                let mut corners = here & !(left & right) & !(word(row - 1, k) & word(row + 1, k));
                while corners != 0 {
                    let column = 64 * k + corners.trailing_zeros() as usize;
                    visit(&self.page, Spot { column, row }, &mut self.work);
                    corners &= corners - 1;
                }
            }
        }
    }
}
