//! Packing of charts into pictures by their shapes, all scaled by one factor, as large as found.
//!
//! | module | content |
//! |---|---|
//! | `shape` | shapes: closed loops |
//! | `tiles` | places of tiles |
//! | `turns` | turns in which a chart is tried |
//! | `task` | grids, budgets and the steps below |
//! | `single` | a chart alone on its page |
//! | `scene` | task, grids, layouts |
//! | `mask` | cells that a chart touches |
//! | `page` | free cells, and all places where a mask fits |
//! | `greedy` | placement of charts one after another |
//! | `orders` | search over orders of placement |
//! | `separate` | separation of charts in overlap |
//! | `refine` | a layout on a finer grid |
//!
//! # Method
//!
//! 1. On a coarse grid, charts are placed one after another in many orders, at ever larger scales.
//! 2. The best layout goes to finer and finer grids. Charts that overlap there are separated, and the scale changes
//!    a little until they can be.
//! 3. On the finest grid, masks are conservative, so a layout without common cells is proved.
//!
//! Many charts are placed on the finest grid at once. Work is limited by counts of words read and not by time, and
//! random numbers have fixed seeds, so the same charts give the same packing.
//!
//! The cells of all tiles form one grid. A mask lies within one tile. Fixed shapes take cells in every grid before the
//! charts are placed.
//!
//! If the options give a density, it bounds the scale from above, and layouts at smaller scales are rejected. The
//! picture is then doubled. If the doubled picture would be longer than [`PackingOptions::LONGEST_SIDE`], the largest
//! scale is searched for instead.
//!
//! # Proof of the gap
//!
//! Let g be the gap and h the side of a cell of the finest grid. The mask of a chart holds every closed cell whose
//! distance to the placed chart is at most g/2 + m, with m > 0 larger than the rounding of any position. Take points p
//! and q of two charts, and let c be the midpoint of p and q. If |p − q| < g, then c is within g/2 of both charts, so
//! the cell that holds c belongs to both masks. Masks of a layout have no common cell; so |p − q| ≥ g, and charts do
//! not touch even if g = 0. All cells of a mask lie in one tile, so a point of the tile's edge has a distance of at
//! least g/2 to every chart: otherwise a cell beyond the edge would belong to the mask, and masks hold all such cells
//! before they are placed. So charts of two tiles are at least g apart too. If g = 0, the margin m keeps them from
//! touching the edge, and so each other.
//!
//! A fixed shape takes all cells of a tile within g/2 + m of it. If a point of a chart and a point of a fixed shape are
//! nearer than g, their midpoint lies in the tile of the chart, so the same proof holds. Fixed shapes may overlap each
//! other.

mod greedy;
mod mask;
mod orders;
mod page;
mod refine;
mod scene;
mod separate;
mod shape;
mod single;
mod task;
mod tiles;
mod turns;

pub use shape::ChartShape;
pub use tiles::{FIRST_UDIM_TILE, corner_of_tile};

use std::cell::Cell;

use glam::{DVec2, UVec2};

use task::Task;

/// Most times that the picture is doubled until the gaps fit.
const MOST_DOUBLINGS: usize = 14;

/// Rotations that the packer may use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Rotations {
    /// Charts keep their orientation.
    None,
    /// Rotations by multiples of 90°, without rounding.
    Quarter,
    /// Any rotation.
    #[default]
    Free,
}

/// Charts of one shape that share a place in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Stacking {
    /// Every chart has a place of its own.
    #[default]
    None,
    /// Charts with congruent surfaces share a place.
    Congruent,
    /// Charts with congruent or mirrored surfaces share a place.
    Mirrored,
}

/// Size and number of pictures, and rules for packing shapes into them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default))]
pub struct PackingOptions {
    /// Width and height of the picture in pixels, clamped to 1 to [`LONGEST_SIDE`](Self::LONGEST_SIDE).
    pub picture: [u32; 2],
    /// Least distance between charts in pixels; half of it between a chart and the edge of the picture. Clamped to at
    /// most [`WIDEST_GAP`](Self::WIDEST_GAP).
    pub gap: u32,
    /// Rotations that are allowed.
    pub rotations: Rotations,
    /// Pixels per unit of the shapes. The picture is doubled until the shapes fit, up to
    /// [`LONGEST_SIDE`](Self::LONGEST_SIDE). Default: the largest density that is found. Densities that are not
    /// positive and finite are ignored.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub density: Option<f64>,
    /// Largest number of tiles that shapes may lie in, each of them a picture of this size. Clamped to 1 to
    /// [`MOST_TILES`](Self::MOST_TILES). With a density, as few tiles as found are used. Default: 1.
    pub tiles: u32,
    /// Charts that share a place. The packer of shapes ignores this field: charts are stacked before.
    pub stack: Stacking,
}

impl PackingOptions {
    /// Longest side of a picture in pixels.
    pub const LONGEST_SIDE: u32 = 1 << 16;

    /// Widest gap in pixels.
    pub const WIDEST_GAP: u32 = 1 << 10;

    /// Largest number of tiles.
    pub const MOST_TILES: u32 = 1000;

    /// Range of the size of a chart relative to other charts.
    pub const SIZES: std::ops::RangeInclusive<f64> = 0.01..=100.0;
}

impl Default for PackingOptions {
    fn default() -> Self {
        Self {
            picture: [1024; 2],
            gap: 4,
            rotations: Rotations::default(),
            density: None,
            tiles: 1,
            stack: Stacking::None,
        }
    }
}

/// Shapes to be packed.
#[derive(Clone, Copy, Debug, Default)]
pub struct PackingInput<'a> {
    /// Shapes that are packed.
    pub shapes: &'a [ChartShape],
    /// Tile in which each shape must lie, below the number of tiles; `None` for any tile. An empty list stands for any
    /// tile for all.
    pub tiles: &'a [Option<u32>],
    /// Shapes that do not move, in widths and heights of the picture; [`corner_of_tile`] has the places of the tiles.
    /// The packed shapes keep the gap to them.
    pub fixed: &'a [ChartShape],
}

/// Packed shapes.
#[derive(Clone, Debug, PartialEq)]
pub struct Packing {
    /// Width and height of the picture in pixels: the given size, doubled until the gaps fit, or until the shapes fit
    /// at the density of the options.
    pub picture: UVec2,
    /// Pixels per unit of the shapes. Less than the density of the options if the shapes do not fit into the largest
    /// picture at that density.
    pub scale: f64,
    /// Placement of each shape.
    pub places: Vec<Packed>,
}

/// Placement of a shape: point `z` comes to `turn · z · scale + low` in its tile, with a complex product.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Packed {
    /// Complex factor of length 1 that turns the shape. Exact for quarter turns.
    pub turn: DVec2,
    /// Translation in pixels after turning and scaling, from the lower left corner of the tile.
    pub low: DVec2,
    /// Number of the tile, from 0.
    pub tile: u32,
}

impl Packed {
    /// Position in pixels of a point of the shape, from the lower left corner of the tile.
    pub fn position(&self, point: DVec2, scale: f64) -> DVec2 {
        self.turn.rotate(point) * scale + self.low
    }
}

/// Packs shapes into tiles, around shapes that do not move. `None` if `is_cancelled` returned true. If the shapes that
/// do not move leave no room, the scale of the packing is 0.
pub fn pack(input: PackingInput<'_>, options: PackingOptions, is_cancelled: &dyn Fn() -> bool) -> Option<Packing> {
    let side = |pixels: u32| pixels.clamp(1, PackingOptions::LONGEST_SIDE);
    let mut picture = UVec2::from_array(options.picture.map(side));
    let was_cancelled = Cell::new(false);
    let is_cancelled = || {
        was_cancelled.set(was_cancelled.get() || is_cancelled());
        was_cancelled.get()
    };
    let mut task = Task::new(input, PackingOptions { gap: options.gap.min(PackingOptions::WIDEST_GAP), ..options });
    let mut doublings = 0;
    // Fixed shapes grow with the picture, so a larger one only makes the gaps smaller.
    let is_long = |picture: UVec2| !input.fixed.is_empty() && picture.max_element() > PackingOptions::LONGEST_SIDE;
    while doublings < MOST_DOUBLINGS && !is_long(picture) {
        task.page = picture.as_dvec2();
        let solved = if is_cancelled() { None } else { task.solve(&is_cancelled) };
        match solved {
            _ if was_cancelled.get() => return None,
            Some((scale, places)) => return Some(Packing { picture, scale, places }),
            // A larger picture makes no room where the fixed shapes leave none.
            None if !task.has_room() => break,
            None if task.density.is_none() => (picture, doublings) = (picture * 2, doublings + 1),
            None if picture.max_element() > PackingOptions::LONGEST_SIDE / 2 => task.density = None,
            None => picture *= 2,
        }
    }
    // Only sizes beyond the range of numbers and pages without room come here: nothing fits, and nothing is proved.
    let places = vec![Packed { turn: DVec2::X, low: DVec2::ZERO, tile: 0 }; input.shapes.len()];
    Some(Packing { picture, scale: 0.0, places })
}
