//! Places of tiles in the plane of texture coordinates.

use glam::DVec2;

/// UDIM number of the tile at the origin.
pub const FIRST_UDIM_TILE: u32 = 1001;

/// Number of tiles in a row.
const ROW: usize = 10;

/// Lower left corner of a tile, in widths and heights of the picture. The corner of tile 0 is the origin. Ten tiles
/// form a row from left to right, and rows go up (UDIM).
pub fn corner_of_tile(tile: usize) -> DVec2 {
    DVec2::new((tile % ROW) as f64, (tile / ROW) as f64)
}
