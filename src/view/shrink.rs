//! Pictures that are larger than a graphics card takes: made smaller by the mean of whole blocks of pixels.

use std::ops::Range;

use rayon::prelude::*;

use super::Picture;

impl Picture {
    /// The picture with no side longer than `limit`, by the least whole factor. `None` where it is no longer as it is.
    ///
    /// What comes back covers the same area: where the factor does not divide a side, blocks differ by a pixel.
    pub fn shrunk(&self, limit: u32) -> Option<Self> {
        let size = self.size;
        let factor = size[0].max(size[1]).div_ceil(limit.max(1));
        if factor <= 1 {
            return None;
        }
        self.resampled(size.map(|side| side.div_ceil(factor)))
    }

    /// The same picture in half the size and so on, down to one pixel: what a graphics card takes where the pixels of the
    /// screen are larger.
    pub fn smaller_ones(&self) -> Vec<Self> {
        let mut pictures: Vec<Self> = Vec::new();
        loop {
            let last = pictures.last().unwrap_or(self);
            if last.size == [1, 1] {
                return pictures;
            }
            let Some(half) = last.resampled(last.size.map(|side| (side / 2).max(1))) else { return pictures };
            pictures.push(half);
        }
    }

    /// The picture in a smaller size, each pixel the mean of those that it stands for.
    fn resampled(&self, small: [u32; 2]) -> Option<Self> {
        let (size, pixels) = (self.size, &self.pixels);
        let (columns, rows) = (blocks(size[0], small[0]), blocks(size[1], small[1]));
        let (columns, width) = (&columns, size[0] as usize);
        let row = move |rows: Range<usize>| columns.iter().flat_map(move |block| mean(pixels, width, [block, &rows]));
        Self::new(small, rows.into_par_iter().flat_map_iter(row).collect())
    }
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
