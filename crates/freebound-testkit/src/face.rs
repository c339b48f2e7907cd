//! The face mesh: rays from inside the sculpture meet its surface, and the mask is the part within a wavy rim.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::Random;
use super::caps::{project, rim, stretch, unproject};
use super::fill::{Sheet, fill, walk_along};
use super::sculpt::distance;
use freebound_core::mesh::TriMesh;

/// Origin of the rays.
const CENTRE: DVec3 = DVec3::new(0.0, -0.02, -0.12);

/// Edge length away from the features.
const COARSE: f64 = 0.056;
/// Growth of the edge length with the distance from a feature.
const GROWTH: f64 = 0.20;

/// Rounds of settling. The first rounds move points to the regions in which the sculpture needs them.
const ROUNDS: usize = 14;

/// Region, mirrored at x = 0, that needs short edges.
struct Feature {
    centre: DVec3,
    half_axes: DVec3,
    spacing: f64,
}

const fn feature(centre: [f64; 3], half_axes: [f64; 3], spacing: f64) -> Feature {
    Feature { centre: DVec3::from_array(centre), half_axes: DVec3::from_array(half_axes), spacing }
}

const FEATURES: [Feature; 6] = [
    // Eye, brow, bridge, tip and wings of the nose, mouth, chin.
    feature([0.295, 0.130, 0.50], [0.165, 0.075, 0.20], 0.0102),
    feature([0.290, 0.340, 0.50], [0.250, 0.070, 0.20], 0.034),
    feature([0.0, 0.02, 0.66], [0.090, 0.200, 0.15], 0.028),
    feature([0.0, -0.270, 0.74], [0.180, 0.090, 0.20], 0.0155),
    feature([0.0, -0.560, 0.63], [0.265, 0.090, 0.20], 0.0130),
    feature([0.0, -0.860, 0.55], [0.200, 0.120, 0.20], 0.033),
];

/// Wanted edge length at a point of the surface.
fn spacing(p: DVec3) -> f64 {
    let q = DVec3::new(p.x.abs(), p.y, p.z);
    let wanted = |f: &Feature| {
        let outside = (((q - f.centre) / f.half_axes).length() - 1.0).max(0.0) * f.half_axes.min_element();
        f.spacing + GROWTH * outside
    };
    FEATURES.iter().map(wanted).fold(COARSE, f64::min)
}

/// The outermost point of the sculpture on the ray in a direction.
fn surface(p: DVec2) -> DVec3 {
    let direction = unproject(p);
    let at = |t: f64| distance(CENTRE + t * direction);
    let mut t = 1.35;
    let mut d = at(t);
    // The sculpture's distance may overshoot near thin parts. Near the surface, a grazing ray may take longer steps.
    let mut pace = 0.8;
    for _ in 0..60 {
        if d.abs() < 1e-7 {
            break;
        }
        let next = t - pace * d;
        let d_next = at(next);
        let slope = (d - d_next) / (t - next);
        pace = if d_next.abs() < 0.01 && slope > 0.0 { (1.0 / slope).clamp(0.8, 4.0) } else { 0.8 };
        (t, d) = (next, d_next);
    }
    CENTRE + t * direction
}

/// Polar angle of the rim from +z, radians; a turn of 0 is +x, a quarter is up.
fn rim_angle(turn: f64) -> f64 {
    let a = TAU * turn;
    let up = a.sin();
    let base = 106.0 - if up > 0.0 { 30.0 } else { 31.0 } * up * up;
    (base + 2.2 * (7.0 * a + 0.6).sin() + 1.3 * (11.0 * a + 2.0).cos()).to_radians()
}

/// Half width of the tabulated part of the chart.
const REACH: f64 = 1.6;
/// Number of cells in a row of the table.
const CELLS: usize = 110;

/// Wanted edge lengths in cells of the chart. Evaluating the sculpture at every tried point would be too slow.
fn spacing_table() -> Vec<f64> {
    let centre = |i: usize| REACH * (2.0 * (i as f64 + 0.5) / CELLS as f64 - 1.0);
    let place = |k: usize| DVec2::new(centre(k % CELLS), centre(k / CELLS));
    (0..CELLS * CELLS).into_par_iter().map(|k| spacing(surface(place(k)))).collect()
}

/// Mask, y up, that looks to +z.
pub(crate) fn face() -> TriMesh {
    let mut random = Random(0xface);
    let table = spacing_table();
    let in_chart = |p: DVec2| {
        let [i, j] =
            ((p + REACH) / (2.0 * REACH) * CELLS as f64).to_array().map(|x| (x.max(0.0) as usize).min(CELLS - 1));
        table[j * CELLS + i] / (0.8 * stretch(p))
    };
    let outline = walk_along(&rim(rim_angle), &|p| COARSE / (0.8 * stretch(p)), &mut random);
    let mut plane = fill(&outline, &in_chart, &mut random);
    plane.settle(&Sheet { surface: &surface, chart: &|x| project(x - CENTRE), spacing: &spacing }, ROUNDS);
    plane.raise(&surface)
}
