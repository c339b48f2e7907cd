//! Picture in memory.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "pixel numbers and colours come from floats that were cut to their range before"
)]

use std::fmt;

use glam::DVec2;

/// Picture of 8-bit sRGB colours with opacity, row by row from the top.
#[derive(Clone, PartialEq, Eq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Red, green, blue and opacity of each pixel: 4 × width × height bytes.
    pub pixels: Vec<u8>,
}

/// Prints only the size: the pixels would flood a failure message with millions of numbers.
impl fmt::Debug for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Picture").field("width", &self.width).field("height", &self.height).finish_non_exhaustive()
    }
}

impl Picture {
    /// Picture of one colour.
    pub fn filled(width: u32, height: u32, colour: [u8; 4]) -> Self {
        Self { width, height, pixels: colour.repeat(width as usize * height as usize) }
    }

    /// Colour of a pixel, counted from the top left. `None` outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let at = 4 * (y as usize * self.width as usize + x as usize);
        Some([self.pixels[at], self.pixels[at + 1], self.pixels[at + 2], self.pixels[at + 3]])
    }

    /// Colour at texture coordinates, v up, interpolated bilinearly between pixel centres. Points beyond the edges
    /// get the colour of the nearest edge point.
    pub fn sample(&self, uv: DVec2) -> [u8; 3] {
        let [r, g, b, _] = self.sample_with_opacity(uv);
        [r, g, b]
    }

    /// Colour and opacity at texture coordinates, as [`sample`](Self::sample) finds them.
    pub fn sample_with_opacity(&self, uv: DVec2) -> [u8; 4] {
        let size = DVec2::new(f64::from(self.width), f64::from(self.height));
        let at = (DVec2::new(uv.x, 1.0 - uv.y) * size - 0.5).clamp(DVec2::ZERO, size - 1.0);
        let (low, share) = (at.floor(), at - at.floor());
        let colour = |x: f64, y: f64| self.pixel(x as u32, y as u32).unwrap_or([0; 4]).map(f64::from);
        let far = (low + 1.0).min(size - 1.0);
        let rows = [low.y, far.y].map(|y| mix(colour(low.x, y), colour(far.x, y), share.x));
        mix(rows[0], rows[1], share.y).map(|channel| channel.round() as u8)
    }

    /// Picture with `self` on the left and `right` on the right, aligned at the top, padded with white.
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

/// Linear interpolation between two colours; `share` is the weight of the second.
fn mix(a: [f64; 4], b: [f64; 4], share: f64) -> [f64; 4] {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * share)
}
