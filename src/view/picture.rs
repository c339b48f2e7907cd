//! A picture as a graphics card takes it: with its smaller sizes, each pixel the mean of a whole block.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::Revision;
use freebound_core::geom;

/// A picture behind the embedding and on the faces.
#[derive(Debug)]
pub struct PictureQuad {
    /// Which picture this is.
    pub revision: Revision,
    /// As it is, then in half the size and so on, down to one pixel.
    sizes: Vec<Arc<geom::Picture>>,
}

impl PictureQuad {
    /// A picture with all its smaller sizes, which takes a while where it is large. `None` where it has not as many pixels
    /// as it should, or none.
    pub fn new(picture: Arc<geom::Picture>) -> Option<Self> {
        let expected = 4 * picture.width as usize * picture.height as usize;
        if expected == 0 || picture.pixels.len() != expected {
            return None;
        }
        let smaller = |last: &Arc<geom::Picture>| (last.width.max(last.height) > 1).then(|| Arc::new(halved(last)));
        let sizes = std::iter::successors(Some(picture), smaller).collect();
        Some(Self { revision: Revision::fresh(), sizes })
    }

    /// Those sizes that have no side longer than `limit`, the largest first: a picture that a card does not take is shown
    /// with less detail rather than not at all. One pixel is always among them.
    pub fn sizes_up_to(&self, limit: u32) -> &[Arc<geom::Picture>] {
        let is_too_long = |picture: &Arc<geom::Picture>| picture.width.max(picture.height) > limit;
        let first = self.sizes.partition_point(is_too_long);
        &self.sizes[first.min(self.sizes.len() - 1)..]
    }
}

/// The picture in half the size, each pixel the mean of those that it stands for. Where a side is odd, blocks differ by a
/// pixel.
fn halved(picture: &geom::Picture) -> geom::Picture {
    let [width, height] = [picture.width, picture.height].map(|side| (side / 2).max(1));
    let (columns, rows) = (blocks(picture.width, width), blocks(picture.height, height));
    let (columns, pixels, whole) = (&columns, &picture.pixels, picture.width as usize);
    let row = move |rows: Range<usize>| columns.iter().flat_map(move |block| mean(pixels, whole, [block, &rows]));
    geom::Picture { width, height, pixels: rows.into_par_iter().flat_map_iter(row).collect() }
}

/// A side cut into blocks as equal as they can be.
fn blocks(side: u32, count: u32) -> Vec<Range<usize>> {
    let (side, count) = (side as usize, count as usize);
    (0..count).map(|k| k * side / count..(k + 1) * side / count).collect()
}

/// The mean of a block of pixels. Each colour counts by its opacity: what cannot be seen lends no colour.
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

/// A quotient of a byte's size; 0 where there is nothing to divide by.
fn rounded(sum: u64, count: u64) -> u8 {
    let quotient = (sum + count / 2).checked_div(count).unwrap_or(0);
    u8::try_from(quotient).unwrap_or(u8::MAX)
}
