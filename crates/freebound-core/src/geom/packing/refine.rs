//! Refinement of a layout on a finer grid: charts overlap a little there, and are separated.

#![expect(clippy::cast_possible_truncation, reason = "columns and rows of a page are far fewer than 2³¹")]

use std::ops::Range;

use glam::DVec2;

use super::mask::Mask;
use super::scene::{Grid, Layout, Place, Pose, Scene, TileCell};
use super::separate::{Board, Moves, Separator, Spot};
use crate::geom::Random;

/// First change of the scale. It is halved after a failure above a scale that fits.
pub(crate) const STEP: f64 = 0.005;

/// Number of failures after which no scale is taken to fit.
const MOST_FAILURES: usize = 10;

/// Number of failures after which every second attempt may rearrange charts: a chart that was too small for the
/// coarser grid can lie amid another one.
const STUCK: usize = 2;

/// Freedom of a refinement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Freedom {
    /// Charts may turn and move anywhere.
    Rearranged,
    /// Charts keep their turns and move a few cells.
    Kept,
}

/// Rules of a refinement.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Refinement {
    pub(crate) grid: Grid,
    pub(crate) freedom: Freedom,
    /// Largest number of words to read at one scale.
    pub(crate) work: u64,
    /// Smallest change of the scale.
    pub(crate) least_step: f64,
}

/// Refinement of layouts of one scene.
pub(crate) struct Refiner<'a> {
    pub(crate) scene: &'a Scene,
    /// Largest scale that is tried.
    pub(crate) highest: f64,
    pub(crate) is_cancelled: &'a dyn Fn() -> bool,
}

impl Refiner<'_> {
    /// Layout without overlap on a grid, near a given one, at the largest scale found. `None` if there is no such
    /// layout at scales a little below the given one, or if cancelled.
    pub(crate) fn refine(&self, start: &Layout, rules: Refinement) -> Option<Layout> {
        let taken = self.scene.taken(rules.grid);
        let mut found: Option<Layout> = None;
        let (mut scale, mut step, mut failures) = (start.scale, STEP, 0);
        while step >= rules.least_step && failures < MOST_FAILURES && !(self.is_cancelled)() {
            let is_stuck = found.is_none() && failures >= STUCK && failures % 2 == 0;
            let rules = if is_stuck { Refinement { freedom: Freedom::Rearranged, ..rules } } else { rules };
            let places = &found.as_ref().unwrap_or(start).places;
            let at = Layout { scale: scale.min(self.highest), places: places.clone() };
            if let Some(layout) = self.separated(&at, rules, &taken, Random(failures as u64)) {
                found = Some(layout);
            } else {
                failures += 1;
                step = if found.is_some() { step / 2.0 } else { step };
            }
            match &found {
                Some(layout) if layout.scale >= self.highest => break,
                Some(layout) => scale = layout.scale * (1.0 + step),
                None => scale *= 1.0 - STEP,
            }
        }
        found
    }

    /// Layout without overlap at the scale of a layout, near its places. `taken` has the cells of fixed shapes.
    fn separated(&self, start: &Layout, rules: Refinement, taken: &[Mask], random: Random) -> Option<Layout> {
        let (grid, Layout { places, scale }) = (rules.grid, start);
        let scale = *scale;
        let turns: Vec<Vec<usize>> =
            places.iter().enumerate().map(|(chart, place)| self.turns(chart, place.turn, rules.freedom)).collect();
        let masks_of = |(chart, turns): (usize, &Vec<usize>)| -> Vec<Mask> {
            turns.iter().map(|&turn| self.scene.mask(Pose { chart, turn, scale }, grid)).collect()
        };
        let masks: Vec<Vec<Mask>> = turns.iter().enumerate().map(masks_of).collect();
        let spot = |(chart, place): (usize, &Place)| {
            let cell = self.scene.cell(Pose { chart, turn: place.turn, scale }, place.centre, grid);
            let turn = turns[chart].iter().position(|&turn| turn == place.turn).unwrap_or(0);
            Spot { tile: place.tile, turn, x: cell.x as i32, y: cell.y as i32 }
        };
        let spots = places.iter().enumerate().map(spot).collect();
        let moves = match rules.freedom {
            Freedom::Rearranged => Moves::FAR,
            Freedom::Kept => Moves::NEAR,
        };
        let tiles: Vec<Range<usize>> = self.scene.charts.iter().map(|chart| chart.tiles.clone()).collect();
        let board = Board { masks: &masks, tiles: &tiles, taken, grid };
        let mut charts = Separator::new(board, spots, moves, random)?;
        if !charts.separate(rules.work, self.is_cancelled) {
            return None;
        }
        let place = |(chart, spot): (usize, &Spot)| {
            let cell = DVec2::new(f64::from(spot.x), f64::from(spot.y));
            let pose = Pose { chart, turn: turns[chart][spot.turn], scale };
            self.scene.place(pose, grid, TileCell { tile: spot.tile, cell })
        };
        Some(Layout { scale, places: charts.spots[..places.len()].iter().enumerate().map(place).collect() })
    }

    /// Turns among which a chart that has a certain turn may choose.
    fn turns(&self, chart: usize, turn: usize, freedom: Freedom) -> Vec<usize> {
        match freedom {
            Freedom::Rearranged => (0..self.scene.charts[chart].turns.len()).collect(),
            Freedom::Kept => vec![turn],
        }
    }
}
