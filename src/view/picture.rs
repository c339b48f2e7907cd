//! Picture with mipmaps for the graphics card; each pixel of a smaller size is the mean of a whole block.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::Revision;
use freebound_core::geom;

/// Picture behind the embedding and on the faces.
#[derive(Debug)]
pub struct PictureQuad {
    /// Revision of the picture.
    pub revision: Revision,
    /// Full size, then each time half the size, down to one pixel.
    sizes: Vec<Arc<geom::Picture>>,
}

impl PictureQuad {
    /// Computes the smaller sizes, which takes a while for a large picture. Returns `None` if the picture has no
    /// pixels or its buffer has the wrong length.
    pub fn new(picture: Arc<geom::Picture>) -> Option<Self> {
        let expected = 4 * picture.width as usize * picture.height as usize;
        if expected == 0 || picture.pixels.len() != expected {
            return None;
        }
        let smaller = |last: &Arc<geom::Picture>| (last.width.max(last.height) > 1).then(|| Arc::new(halved(last)));
        let sizes = std::iter::successors(Some(picture), smaller).collect();
        Some(Self { revision: Revision::fresh(), sizes })
    }

    /// Sizes with no side longer than `limit`, largest first; at least the size of one pixel. A picture that is too
    /// large for a card is thus shown with less detail.
    pub fn sizes_up_to(&self, limit: u32) -> &[Arc<geom::Picture>] {
        let is_too_long = |picture: &Arc<geom::Picture>| picture.width.max(picture.height) > limit;
        let first = self.sizes.partition_point(is_too_long);
        &self.sizes[first.min(self.sizes.len() - 1)..]
    }
}

/// Returns the picture in half the size, each pixel the mean of its block. If a side is odd, blocks differ by a
/// pixel.
fn halved(picture: &geom::Picture) -> geom::Picture {
    let [width, height] = [picture.width, picture.height].map(|side| (side / 2).max(1));
    let (columns, rows) = (blocks(picture.width, width), blocks(picture.height, height));
    let (columns, pixels, whole) = (&columns, &picture.pixels, picture.width as usize);
    let row = move |rows: Range<usize>| columns.iter().flat_map(move |block| mean(pixels, whole, [block, &rows]));
    geom::Picture { width, height, pixels: rows.into_par_iter().flat_map_iter(row).collect() }
}

/// Splits a side into `count` blocks of nearly equal length.
fn blocks(side: u32, count: u32) -> Vec<Range<usize>> {
    let (side, count) = (side as usize, count as usize);
    (0..count).map(|k| k * side / count..(k + 1) * side / count).collect()
}

/// Mean of a block of pixels. Each colour is weighted by its opacity, so transparent pixels contribute none.
fn mean(pixels: &[u8], width: usize, [columns, rows]: [&Range<usize>; 2]) -> [u8; 4] {
    let (mut sums, mut opacities, mut count) = ([0_u64; 3], 0_u64, 0_u64);
    for y in rows.clone() {
        let row = &pixels[4 * (y * width + columns.start)..4 * (y * width + columns.end)];
        for &[red, green, blue, opacity] in row.as_chunks::<4>().0 {
            let opacity = u64::from(opacity);
            for (sum, colour) in sums.iter_mut().zip([red, green, blue]) {
                *sum += opacity * u64::from(colour);
            }
            opacities += opacity;
            count += 1;
        }
    }
    let [red, green, blue] = sums.map(|sum| rounded(sum, opacities));
    [red, green, blue, rounded(opacities, count)]
}

/// Rounded quotient that fits a byte; 0 if the divisor is 0.
fn rounded(sum: u64, count: u64) -> u8 {
    let quotient = (sum + count / 2).checked_div(count).unwrap_or(0);
    u8::try_from(quotient).unwrap_or(u8::MAX)
}
