//! Caps of a ball: one that ends before the equator, and a bumpy one that reaches far past it.
//!
//! The ball is charted by stereographic projection from the south pole, which keeps angles. So a triangulation that
//! is good in the chart is good on the ball.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::Random;
use super::fill::{Sheet, fill, walk_along};
use freebound_core::mesh::TriMesh;

/// Rounds of settling: enough for good triangles, too few for a regular pattern.
const ROUNDS: usize = 6;

/// Maps the chart to the unit sphere. The origin goes to the pole +z.
pub(super) fn unproject(p: DVec2) -> DVec3 {
    let q = p.length_squared();
    DVec3::new(2.0 * p.x, 2.0 * p.y, 1.0 - q) / (1.0 + q)
}

/// Maps space to the chart, along the ray from the centre.
pub(super) fn project(x: DVec3) -> DVec2 {
    x.truncate() / (x.length() + x.z)
}

/// Scale of the map from the chart to the sphere.
pub(super) fn stretch(p: DVec2) -> f64 {
    2.0 / (1.0 + p.length_squared())
}

/// Closed curve in the chart. `angle` is its polar angle from +z, in radians, for each turn in `[0, 1)`.
pub(super) fn rim(angle: impl Fn(f64) -> f64) -> Vec<DVec2> {
    const STEPS: usize = 2000;
    (0..STEPS)
        .map(|k| {
            let turn = k as f64 / STEPS as f64;
            DVec2::from_angle(TAU * turn) * (angle(turn) / 2.0).tan()
        })
        .collect()
}

fn cap(rim: &[DVec2], spacing: f64, seed: u64, surface: &(dyn Fn(DVec2) -> DVec3 + Sync)) -> TriMesh {
    let mut random = Random(seed);
    let in_chart = |p: DVec2| spacing / stretch(p);
    let outline = walk_along(rim, &in_chart, &mut random);
    let mut plane = fill(&outline, &in_chart, &mut random);
    plane.settle(&Sheet { surface, chart: &project, spacing: &|_| 1.0 }, ROUNDS);
    plane.raise(surface)
}

/// A cap down to 75° from the pole.
pub(crate) fn dome() -> TriMesh {
    cap(&rim(|_| 75_f64.to_radians()), 0.072, 0xd03e, &unproject)
}

/// Spacing of the vertices of the bumpy cap.
const BUMPY_SPACING: f64 = 0.085;

/// Approximate number of vertices of the bumpy cap at that spacing.
const BUMPY_COUNT: f64 = 1280.0;

/// Ball with bumps, open below about 130° from the pole, with a wavy rim.
pub(crate) fn bumpy_cap() -> TriMesh {
    bumpy(BUMPY_SPACING, 0xb3b7)
}

/// Bumpy cap with about this number of vertices. Each seed gives other positions.
pub fn bumpy_cap_of(vertices: usize, seed: u64) -> TriMesh {
    bumpy(BUMPY_SPACING * (BUMPY_COUNT / vertices as f64).sqrt(), seed)
}

fn bumpy(spacing: f64, seed: u64) -> TriMesh {
    let rim = rim(|turn| (130.0 + 5.0 * (5.0 * TAU * turn).sin() + 3.0 * (2.0 * TAU * turn).cos()).to_radians());
    cap(&rim, spacing, seed, &|p| {
        let x = unproject(p);
        x * bumps(x)
    })
}

/// Distance of the bumpy surface from the centre, in a direction.
pub(super) fn bumps(x: DVec3) -> f64 {
    let coarse = (3.1 * x.x + 0.4).sin() * (2.7 * x.y - 0.9).sin() + (3.4 * x.z + 1.3).sin() * (2.9 * x.x - 2.2).cos();
    let fine = (7.3 * x.x + 1.1).sin() * (6.7 * x.y + 0.2).sin() * (6.1 * x.z - 0.7).cos();
    1.0 + 0.11 * coarse + 0.09 * fine
}
