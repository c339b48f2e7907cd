//! A picture in memory.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "pixel numbers and colours come from floats that were cut to their range before"
)]

use std::fmt;

use glam::DVec2;

/// A picture of 8-bit sRGB colours with opacity, row by row from the top.
#[derive(Clone, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue, opacity of each pixel: 4 × width × height bytes.
    pub pixels: Vec<u8>,
}

/// Its size alone: what fails says what it holds, and millions of numbers say nothing.
impl fmt::Debug for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Picture").field("width", &self.width).field("height", &self.height).finish_non_exhaustive()
    }
}

impl Picture {
    /// A picture of one colour.
    pub fn filled(width: u32, height: u32, colour: [u8; 4]) -> Self {
        Self { width, height, pixels: colour.repeat(width as usize * height as usize) }
    }

    /// Colour of a pixel, `None` outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let at = 4 * (y as usize * self.width as usize + x as usize);
        Some([self.pixels[at], self.pixels[at + 1], self.pixels[at + 2], self.pixels[at + 3]])
    }

    /// Colour at texture coordinates, v up, between the centres of pixels in proportion; beyond the edges the nearest.
    pub fn sample(&self, uv: DVec2) -> [u8; 3] {
        let size = DVec2::new(f64::from(self.width), f64::from(self.height));
        let at = (DVec2::new(uv.x, 1.0 - uv.y) * size - 0.5).clamp(DVec2::ZERO, size - 1.0);
        let (low, share) = (at.floor(), at - at.floor());
        let colour = |x: f64, y: f64| self.pixel(x as u32, y as u32).unwrap_or([0; 4]).map(f64::from);
        let far = (low + 1.0).min(size - 1.0);
        let rows = [low.y, far.y].map(|y| mix(colour(low.x, y), colour(far.x, y), share.x));
        let [r, g, b, _] = mix(rows[0], rows[1], share.y).map(|channel| channel.round() as u8);
        [r, g, b]
    }

    /// This picture on the left, another on the right, top aligned; white where one is less high.
    #[must_use]
    pub fn beside(&self, right: &Self) -> Self {
        let mut both = Self::filled(self.width + right.width, self.height.max(right.height), [255; 4]);
        let row = 4 * both.width as usize;
        for (part, start) in [(self, 0), (right, 4 * self.width as usize)] {
            let length = 4 * part.width as usize;
            if length == 0 {
                continue;
            }
            for (y, source) in part.pixels.chunks_exact(length).enumerate() {
                both.pixels[y * row + start..y * row + start + length].copy_from_slice(source);
            }
        }
        both
    }
}

/// The mean of two colours by the share of the second.
fn mix(a: [f64; 4], b: [f64; 4], share: f64) -> [f64; 4] {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * share)
}
