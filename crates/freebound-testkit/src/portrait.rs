//! A painted portrait: the sculpture of the face, stretched to other proportions, with hair, ears, neck and clothes,
//! seen from the front and coloured pixel by pixel.
//!
//! The stretching maps the picture to the sculpture's x and y, so that every feature of the sculpture has a known
//! position in the picture. The landmarks use this.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::relief::Relief;
use super::sculpt::{bump, ramp};
use freebound_core::geom::Picture;

/// Width and height of the face's portrait, pixels.
pub const PORTRAIT_SIZE: u32 = 768;

/// Half the picture's width and height, in the sculpture's units.
pub(super) const REACH: f64 = 1.5;
/// Height of the picture's middle.
pub(super) const MIDDLE: f64 = 0.01;

/// Heights in the picture and in the sculpture: crown, hairline, brow, eye, nose, mouth, chin and neck.
///
/// The nose ends closer above the mouth than on the mesh, so that the first solve folds there.
const HEIGHTS: [[f64; 2]; 9] = [
    [1.60, 1.50],
    [1.20, 1.13],
    [0.40, 0.34],
    [0.18, 0.125],
    [-0.30, -0.26],
    [-0.58, -0.56],
    [-0.87, -0.92],
    [-1.30, -1.30],
    [-1.60, -1.60],
];

/// Height in the sculpture of a height in the picture: a smooth rising curve through the table.
fn sculpture_height(y: f64) -> f64 {
    let slope = |i: usize| (HEIGHTS[i][1] - HEIGHTS[i + 1][1]) / (HEIGHTS[i][0] - HEIGHTS[i + 1][0]);
    let last = HEIGHTS.len() - 2;
    let i = HEIGHTS.iter().skip(1).position(|h| y >= h[0]).unwrap_or(last);
    // Harmonic means of the neighbouring slopes keep the curve rising (Fritsch and Butland 1984).
    let knot = |i: usize| {
        let (a, b) = (slope(i.saturating_sub(1)), slope(i.min(last)));
        2.0 * a * b / (a + b)
    };
    let [[y1, s1], [y0, s0]] = [HEIGHTS[i], HEIGHTS[i + 1]];
    let (width, t) = (y1 - y0, (y - y0) / (y1 - y0));
    let (m0, m1) = (knot(i + 1) * width, knot(i) * width);
    let (t2, t3) = (t * t, t * t * t);
    s0 * (2.0 * t3 - 3.0 * t2 + 1.0) + m0 * (t3 - 2.0 * t2 + t) + s1 * (3.0 * t2 - 2.0 * t3) + m1 * (t3 - t2)
}

/// Maps the picture's plane (x right, y up, in the sculpture's units) to x and y of the sculpture.
///
/// Eyes, nose and mouth are narrower in the picture; cheeks, ears and hair keep their width.
pub fn sculpture_from_plane(p: DVec2) -> DVec2 {
    let x = p.x.abs();
    let eyes = 0.10 * bump(p.y - 0.24, 0.22) * (1.0 - ramp(x, 0.40, 0.90));
    let nose_and_mouth = (0.14 * bump(p.y + 0.17, 0.17) + 0.08 * bump(p.y + 0.52, 0.15)) * (1.0 - ramp(x, 0.24, 0.58));
    DVec2::new(p.x * (1.0 + eyes + nose_and_mouth), sculpture_height(p.y))
}

/// Argument between −1.6 and 1.6 at which a rising function takes a value.
fn invert(rising: impl Fn(f64) -> f64, value: f64) -> f64 {
    let (mut low, mut high) = (-1.6, 1.6);
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        *(if rising(middle) < value { &mut low } else { &mut high }) = middle;
    }
    f64::midpoint(low, high)
}

/// Position in the picture of a point of the sculpture, given by its x and y: u and v in `[0, 1]`, v up.
pub fn picture_from_sculpture(p: DVec2) -> DVec2 {
    let y = invert(sculpture_height, p.y);
    let x = invert(|x| sculpture_from_plane(DVec2::new(x, y)).x, p.x);
    (DVec2::new(x, y - MIDDLE) / REACH + 1.0) / 2.0
}

/// Point of the plane at a position in a picture, in pixels from its upper left corner.
pub fn plane(size: usize, pixel: DVec2) -> DVec2 {
    let p = (2.0 * pixel / size as f64 - 1.0) * REACH;
    DVec2::new(p.x, MIDDLE - p.y)
}

/// A square painted portrait, `size` pixels wide. Its proportions are not those of the face mesh.
pub fn portrait(size: u32) -> Picture {
    let pixels_across = size;
    let size = size as usize;
    let relief = Relief::new(size.div_ceil(2).max(1));
    // The finest strokes are two pixels wide at 1024 pixels. Smaller pictures need several samples per pixel.
    let samples = (1024 / size.max(1)).clamp(1, 4);
    let rows: Vec<Vec<u8>> = (0..size)
        .into_par_iter()
        .map(|j| {
            let pixel = |i: usize| {
                let sample = |k: usize| {
                    let shift = (DVec2::new((k % samples) as f64, (k / samples) as f64) + 0.5) / samples as f64;
                    relief.colour(plane(size, DVec2::new(i as f64, j as f64) + shift))
                };
                let count = samples * samples;
                let mean = (0..count).map(sample).sum::<DVec3>() / count as f64;
                let [r, g, b] = mean.to_array().map(|c| (255.0 * c.clamp(0.0, 1.0)).round() as u8);
                [r, g, b, 255]
            };
            (0..size).flat_map(pixel).collect()
        })
        .collect();
    Picture { width: pixels_across, height: pixels_across, pixels: rows.concat() }
}
