//! Page as a picture: fills by exact coverage along scan lines, strokes by distance.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "pixel numbers and colours come from floats that were cut to their range before"
)]

use glam::DVec2;

use super::{Item, Page, Path, colours};
use crate::raster::Colour;
use freebound_core::geom::{Bounds, Picture};

/// Number of scan lines per row of pixels.
const SCAN_LINES: u32 = 4;

impl Page {
    /// Draws the page with `scale` pixels per point.
    pub fn picture(&self, scale: f64) -> Picture {
        let [width, height] = (self.size * scale).ceil().to_array().map(|length| length as u32);
        let [r, g, b] = colours::PAPER;
        let mut picture = Picture::filled(width, height, [r, g, b, 255]);
        for item in &self.items {
            match item {
                Item::Path(path) => draw(&mut picture, path, scale),
                Item::Words(words) => draw(&mut picture, &words.as_strokes(), scale),
                Item::Picture(area, source) => paste(&mut picture, *area, source, scale),
            }
        }
        picture
    }
}

/// Copies a picture into an area, sampled at the centre of each pixel.
fn paste(page: &mut Picture, area: Bounds, source: &Picture, scale: f64) {
    let (low, size) = (area.low * scale, area.size() * scale);
    let end = |high: f64, limit: u32| (high.round().max(0.0) as u32).min(limit);
    for y in low.y.round().max(0.0) as u32..end(low.y + size.y, page.height) {
        for x in low.x.round().max(0.0) as u32..end(low.x + size.x, page.width) {
            let share = (DVec2::new(f64::from(x), f64::from(y)) + 0.5 - low) / size;
            let [r, g, b] = source.sample(DVec2::new(share.x, 1.0 - share.y));
            let at = 4 * (y as usize * page.width as usize + x as usize);
            page.pixels[at..at + 4].copy_from_slice(&[r, g, b, 255]);
        }
    }
}

/// Fills and strokes a path.
fn draw(picture: &mut Picture, path: &Path, scale: f64) {
    let lines: Vec<Vec<DVec2>> =
        path.lines.iter().map(|line| line.iter().map(|&p| p * scale).collect::<Vec<_>>()).collect();
    if let Some(colour) = path.ink.fill {
        let Some(mut mask) = Mask::over(picture, &lines, 1.0) else { return };
        for line in &lines {
            mask.fill(line);
        }
        mask.blend(picture, colour);
    }
    if let Some((colour, width)) = path.ink.stroke {
        let half = (width * scale / 2.0).max(0.5);
        let Some(mut mask) = Mask::over(picture, &lines, half + 1.0) else { return };
        // A line thinner than a pixel is drawn one pixel wide, and fainter.
        let opacity = (width * scale).min(1.0) as f32;
        for line in &lines {
            for pair in line.windows(2) {
                mask.stroke([pair[0], pair[1]], half, opacity);
            }
            if let (true, Some(&first), Some(&last)) = (path.is_closed, line.first(), line.last()) {
                mask.stroke([last, first], half, opacity);
            }
        }
        mask.blend(picture, colour);
    }
}

/// Coverage of the pixels of a box.
struct Mask {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
    cover: Vec<f32>,
}

impl Mask {
    /// Mask of the pixels around lines. `None` if there are none.
    fn over(picture: &Picture, lines: &[Vec<DVec2>], margin: f64) -> Option<Self> {
        let bounds = Bounds::of(lines.iter().flatten().copied());
        let page = DVec2::new(f64::from(picture.width), f64::from(picture.height));
        let low = DVec2::ZERO.max((bounds.low - margin).floor());
        let high = page.min((bounds.high + margin).ceil());
        if high.cmple(low).any() {
            return None;
        }
        let [left, top, width, height] = [low.x, low.y, high.x - low.x, high.y - low.y].map(|x| x as usize);
        Some(Self { left, top, width, height, cover: vec![0.0; width * height] })
    }

    /// Covers the interior of a closed line by the nonzero rule.
    fn fill(&mut self, line: &[DVec2]) {
        let bounds = Bounds::of(line.iter().copied());
        let (low, high) = (bounds.low.y - self.top as f64, bounds.high.y - self.top as f64);
        let (first, last) = (low.floor().max(0.0) as usize, (high.ceil().max(0.0) as usize).min(self.height));
        let left = ((bounds.low.x - self.left as f64).floor().max(0.0) as usize).min(self.width);
        let right = ((bounds.high.x - self.left as f64).ceil().max(0.0) as usize).min(self.width);
        let mut row_cover = vec![0.0_f32; right.saturating_sub(left)];
        for row in first..last {
            row_cover.fill(0.0);
            for scan in 0..SCAN_LINES {
                let y = (self.top + row) as f64 + (f64::from(scan) + 0.5) / f64::from(SCAN_LINES);
                for [from, to] in spans(line, y) {
                    let origin = (self.left + left) as f64;
                    add_span(&mut row_cover, [from - origin, to - origin]);
                }
            }
            for (cover, add) in self.cover[row * self.width + left..].iter_mut().zip(&row_cover) {
                *cover = (*cover + add).min(1.0);
            }
        }
    }

    /// Covers a line segment with round ends.
    fn stroke(&mut self, [a, b]: [DVec2; 2], half: f64, opacity: f32) {
        let origin = DVec2::new(self.left as f64, self.top as f64);
        let (a, b) = (a - origin, b - origin);
        let (low, high) = (a.min(b) - half - 1.0, a.max(b) + half + 1.0);
        let range = |low: f64, high: f64, limit: usize| low.max(0.0) as usize..(high.max(0.0) as usize + 1).min(limit);
        let (along, length_squared) = (b - a, (b - a).length_squared().max(f64::MIN_POSITIVE));
        for y in range(low.y, high.y, self.height) {
            // The part of the segment near this row; no pixel beyond it is covered.
            let near = [-1.5 - half, 2.5 + half].map(|off| ((y as f64 + off - a.y) / along.y).clamp(0.0, 1.0));
            let ends = if along.y == 0.0 { [a.x, b.x] } else { near.map(|share| a.x + share * along.x) };
            let (from, to) = (ends[0].min(ends[1]) - half - 1.5, ends[0].max(ends[1]) + half + 1.5);
            for x in range(low.x.max(from), high.x.min(to), self.width) {
                let p = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let share = ((p - a).dot(along) / length_squared).clamp(0.0, 1.0);
                let cover = (half + 0.5 - p.distance(a + share * along)).clamp(0.0, 1.0) as f32 * opacity;
                let here = &mut self.cover[y * self.width + x];
                *here = here.max(cover);
            }
        }
    }

    /// Blends a colour over the picture, by coverage.
    fn blend(&self, picture: &mut Picture, colour: Colour) {
        for row in 0..self.height {
            let at = 4 * ((self.top + row) * picture.width as usize + self.left);
            let pixels = picture.pixels[at..at + 4 * self.width].chunks_exact_mut(4);
            for (pixel, &cover) in pixels.zip(&self.cover[row * self.width..]).filter(|(_, cover)| **cover > 0.0) {
                for (channel, wanted) in pixel.iter_mut().zip(colour) {
                    let mixed = f32::from(*channel) + (f32::from(wanted) - f32::from(*channel)) * cover;
                    *channel = mixed.round() as u8;
                }
            }
        }
    }
}

/// Intervals of a scan line inside a closed line, by the nonzero rule.
fn spans(line: &[DVec2], y: f64) -> Vec<[f64; 2]> {
    let mut crossings: Vec<(f64, i32)> = Vec::new();
    for (k, a) in line.iter().enumerate() {
        let b = line[(k + 1) % line.len()];
        if (a.y <= y) != (b.y <= y) {
            crossings.push((a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x), if b.y > a.y { 1 } else { -1 }));
        }
    }
    crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut winding = 0;
    let mut found = Vec::new();
    for pair in crossings.windows(2) {
        winding += pair[0].1;
        if winding != 0 {
            found.push([pair[0].0, pair[1].0]);
        }
    }
    found
}

/// Adds an interval of a single scan line to the coverage of a row.
fn add_span(row: &mut [f32], [from, to]: [f64; 2]) {
    let (from, to) = (from.max(0.0), to.min(row.len() as f64));
    let mut x = from.floor();
    while x < to {
        let share = (to.min(x + 1.0) - from.max(x)).max(0.0);
        row[x as usize] += share as f32 / SCAN_LINES as f32;
        x += 1.0;
    }
}
