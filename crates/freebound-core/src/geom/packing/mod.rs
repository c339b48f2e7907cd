//! Packing of charts into a picture by their shapes, all scaled by one factor, as large as found.
//!
//! | module | content |
//! |---|---|
//! | `shape` | shapes: closed loops |
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
//! # Proof of the gap
//!
//! Let g be the gap and h the side of a cell of the finest grid. The mask of a chart holds every closed cell whose
//! distance to the placed chart is at most g/2 + m, with m > 0 larger than the rounding of any position. Take points p
//! and q of two charts, and let c be the midpoint of p and q. If |p − q| < g, then c is within g/2 of both charts, so
//! the cell that holds c belongs to both masks. Masks of a layout have no common cell; so |p − q| ≥ g, and charts do
//! not touch even if g = 0. All cells of a mask lie on the page, so a point of the page's edge has a distance of at
//! least g/2 to every chart: otherwise a cell beyond the edge would belong to the mask, and masks hold all such cells
//! before they are placed.

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
mod turns;

pub use shape::ChartShape;

use std::cell::Cell;

use glam::{DVec2, UVec2};

use task::Task;

/// Most times that the picture is doubled.
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

/// Size of the picture, and rules for packing shapes into it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
}

impl PackingOptions {
    /// Longest side of a picture in pixels.
    pub const LONGEST_SIDE: u32 = 1 << 16;

    /// Widest gap in pixels.
    pub const WIDEST_GAP: u32 = 1 << 10;

    /// Range of the size of a chart relative to other charts.
    pub const SIZES: std::ops::RangeInclusive<f64> = 0.01..=100.0;
}

impl Default for PackingOptions {
    fn default() -> Self {
        Self { picture: [1024; 2], gap: 4, rotations: Rotations::default() }
    }
}

/// Packed shapes.
#[derive(Clone, Debug, PartialEq)]
pub struct Packing {
    /// Width and height of the picture in pixels: the given size, doubled until the gaps fit.
    pub picture: UVec2,
    /// Pixels per unit of the shapes.
    pub scale: f64,
    /// Placement of each shape.
    pub places: Vec<Packed>,
}

/// Placement of a shape: point `z` comes to `turn · z · scale + low`, with a complex product.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Packed {
    /// Complex factor of length 1 that turns the shape. Exact for quarter turns.
    pub turn: DVec2,
    /// Translation in pixels after turning and scaling, from the lower left corner of the picture.
    pub low: DVec2,
}

impl Packed {
    /// Position in pixels of a point of the shape.
    pub fn position(&self, point: DVec2, scale: f64) -> DVec2 {
        self.turn.rotate(point) * scale + self.low
    }
}

/// Packs shapes. `None` if `is_cancelled` returned true.
pub fn pack(shapes: &[ChartShape], options: PackingOptions, is_cancelled: &dyn Fn() -> bool) -> Option<Packing> {
    let side = |pixels: u32| pixels.clamp(1, PackingOptions::LONGEST_SIDE);
    let mut picture = UVec2::from_array(options.picture.map(side));
    let gap = f64::from(options.gap.min(PackingOptions::WIDEST_GAP));
    let was_cancelled = Cell::new(false);
    let is_cancelled = || {
        was_cancelled.set(was_cancelled.get() || is_cancelled());
        was_cancelled.get()
    };
    let mut task = Task::new(shapes, gap, options.rotations);
    for _ in 0..MOST_DOUBLINGS {
        task.page = picture.as_dvec2();
        let solved = if is_cancelled() { None } else { task.solve(&is_cancelled) };
        match solved {
            _ if was_cancelled.get() => return None,
            Some((scale, places)) => return Some(Packing { picture, scale, places }),
            None => picture *= 2,
        }
    }
    // Only sizes beyond the range of numbers come here: nothing fits, and nothing is proved.
    let places = vec![Packed { turn: DVec2::X, low: DVec2::splat(gap) }; shapes.len()];
    Some(Packing { picture, scale: 0.0, places })
}
