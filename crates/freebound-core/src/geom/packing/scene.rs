//! Charts, page and gap of one packing task, and layouts of the charts.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "columns and rows of a page are far fewer than 2³²"
)]

use glam::DVec2;

use std::ops::Range;

use super::mask::{Mask, bounds};
use super::tiles::corner_of_tile;
use crate::geom::Bounds;

/// Rounding of a position in pixels, relative to the page and to the chart's distance from the origin.
///
/// A position is a sum of a few products, each with a relative error of at most 2⁻⁵³, so 2⁻⁴⁰ is ample. On a page of
/// 1024 pixels the margin is 10⁻⁹ pixels.
const ROUNDING: f64 = 1.0 / (1_u64 << 40) as f64;

/// Margin around charts on coarse grids in cells. With it, a layout of the coarsest grid shrinks by about 1 % until it
/// fits on the finest grid; without it, by 4 %.
const SAMPLED_MARGIN: f64 = 0.2;

/// Chart to be packed.
pub(crate) struct Chart {
    /// Edges of the boundary in the units of the chart.
    pub(crate) edges: Vec<[DVec2; 2]>,
    /// Turns in which the chart may lie.
    pub(crate) turns: Vec<DVec2>,
    /// Tiles in which the chart may lie.
    pub(crate) tiles: Range<usize>,
}

/// Packing task.
pub(crate) struct Scene {
    pub(crate) charts: Vec<Chart>,
    /// Edges of each fixed shape, in widths and heights of the page.
    pub(crate) fixed: Vec<Vec<[DVec2; 2]>>,
    /// Number of tiles, each of the size of the page.
    pub(crate) tiles: usize,
    /// Width and height of the page in pixels.
    pub(crate) picture: DVec2,
    /// Gap in pixels.
    pub(crate) gap: f64,
}

/// Cells of all tiles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    /// Side of a cell in pixels: a power of two, so that conversions are exact.
    pub(crate) cell: f64,
    /// Number of columns of a tile.
    pub(crate) columns: usize,
    /// Number of rows of a tile.
    pub(crate) rows: usize,
    pub(crate) tiles: usize,
    /// Rule by which a chart takes cells.
    pub(crate) cover: Cover,
}

/// Rule by which a chart takes cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cover {
    /// All cells that the chart with half of the gap touches: proves the gap.
    Touched,
    /// Cells whose centres the chart with half of the gap and a small margin covers: has about the right area on
    /// coarse grids.
    Sampled,
}

/// Place of a chart in a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) tile: usize,
    /// Number of the chart's turn.
    pub(crate) turn: usize,
    /// Centre of the chart's bounding box in pixels, from the lower left corner of the tile.
    pub(crate) centre: DVec2,
}

/// Cell of a tile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TileCell {
    pub(crate) tile: usize,
    /// Column and row.
    pub(crate) cell: DVec2,
}

/// Places of all charts at one scale.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    /// Pixels per unit of the charts.
    pub(crate) scale: f64,
    pub(crate) places: Vec<Place>,
}

/// Chart turned and scaled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose {
    pub(crate) chart: usize,
    /// Number of the chart's turn.
    pub(crate) turn: usize,
    /// Pixels per unit of the chart.
    pub(crate) scale: f64,
}

impl Scene {
    /// Grid with cells of a side of `cell` pixels.
    pub(crate) fn grid(&self, cell: f64, cover: Cover) -> Grid {
        let [columns, rows] = (self.picture / cell).to_array().map(|cells| cells.floor().max(1.0) as usize);
        Grid { cell, columns, rows, tiles: self.tiles, cover }
    }

    /// Mask of a chart on a grid.
    pub(crate) fn mask(&self, pose: Pose, grid: Grid) -> Mask {
        let edges = self.edges(pose, grid.cell);
        match grid.cover {
            Cover::Touched => Mask::touched(&edges, self.margin(&edges, grid)),
            Cover::Sampled => Mask::sampled(&edges, self.gap / 2.0 / grid.cell + SAMPLED_MARGIN),
        }
    }

    /// Cells of each tile that fixed shapes take. Empty if there are no fixed shapes.
    pub(crate) fn taken(&self, grid: Grid) -> Vec<Mask> {
        let tiles = 0..if self.fixed.is_empty() { 0 } else { grid.tiles };
        tiles.map(|tile| self.taken_of(tile, grid)).collect()
    }

    fn taken_of(&self, tile: usize, grid: Grid) -> Mask {
        let corner = corner_of_tile(tile);
        let mut mask = Mask::empty(grid.columns, grid.rows);
        for edges in &self.fixed {
            let edges: Vec<[DVec2; 2]> =
                edges.iter().map(|edge| edge.map(|point| (point - corner) * self.picture / grid.cell)).collect();
            match grid.cover {
                Cover::Touched => mask.add_touched(&edges, self.margin(&edges, grid)),
                Cover::Sampled => mask.add_sampled(&edges, self.gap / 2.0 / grid.cell + SAMPLED_MARGIN),
            }
        }
        mask
    }

    /// Edges of a turned and scaled chart in units of `unit` pixels, a power of two.
    fn edges(&self, Pose { chart, turn, scale }: Pose, unit: f64) -> Vec<[DVec2; 2]> {
        let Chart { edges, turns, .. } = &self.charts[chart];
        edges.iter().map(|edge| edge.map(|point| turns[turn].rotate(point) * (scale / unit))).collect()
    }

    /// Half of the gap, and more than rounding can move a point of the chart, in cells.
    fn margin(&self, edges: &[[DVec2; 2]], grid: Grid) -> f64 {
        let Bounds { low, high } = bounds(edges);
        let farthest = low.abs().max(high.abs()).max_element();
        let page = self.picture.max_element() / grid.cell;
        self.gap / 2.0 / grid.cell + (page + farthest) * ROUNDING
    }

    /// Translation in pixels that brings a turned and scaled chart to the cells of its mask at a column and row.
    pub(crate) fn low(&self, pose: Pose, grid: Grid, cell: DVec2) -> DVec2 {
        let edges = self.edges(pose, grid.cell);
        (cell + self.margin(&edges, grid) - bounds(&edges).low) * grid.cell
    }

    /// Size of a chart with its gap in pixels.
    fn size(&self, pose: Pose) -> DVec2 {
        bounds(&self.edges(pose, 1.0)).size() + self.gap
    }

    /// Place of a chart whose mask has its lower left cell at a column and row of a tile.
    pub(crate) fn place(&self, pose: Pose, grid: Grid, TileCell { tile, cell }: TileCell) -> Place {
        Place { tile, turn: pose.turn, centre: cell * grid.cell + self.size(pose) / 2.0 }
    }

    /// Column and row nearest to a centre in pixels for the lower left cell of the chart's mask.
    pub(crate) fn cell(&self, pose: Pose, centre: DVec2, grid: Grid) -> DVec2 {
        ((centre - self.size(pose) / 2.0) / grid.cell).round()
    }
}
