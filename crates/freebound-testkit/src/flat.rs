//! Flat examples: an L and a spiral strip, in irregular triangulations of the plane z = 0.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::Random;
use super::fill::{Sheet, fill};
use freebound_core::mesh::TriMesh;

/// Rounds of settling: enough for good triangles, too few for a regular pattern.
const ROUNDS: usize = 5;

fn flat(p: DVec2) -> DVec3 {
    p.extend(0.0)
}

/// Fills a polygon and keeps its corners.
fn fill_polygon(outline: &[DVec2], spacing: f64, random: &mut Random) -> TriMesh {
    let mut plane = fill(outline, &|_| spacing, random);
    plane.settle(&Sheet { surface: &flat, chart: &DVec3::truncate, spacing: &|_| 1.0 }, ROUNDS);
    plane.raise(&flat)
}

/// Splits a side into pieces of about a spacing, with the first end and without the last.
pub(super) fn split_side(a: DVec2, b: DVec2, spacing: f64, random: &mut Random) -> Vec<DVec2> {
    let count = (a.distance(b) / spacing).round().max(1.0);
    let jitter = |k: usize, random: &mut Random| if k == 0 { 0.0 } else { random.between(-0.2, 0.2) };
    (0..count as usize).map(|k| a.lerp(b, (k as f64 + jitter(k, random)) / count)).collect()
}

/// An L with arms of width 1 and length 2.
pub(crate) fn ell() -> TriMesh {
    const SPACING: f64 = 0.068;
    let mut random = Random(0x0e11);
    let corners =
        [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)].map(|(x, y)| DVec2::new(x, y));
    let outline: Vec<DVec2> =
        (0..6).flat_map(|i| split_side(corners[i], corners[(i + 1) % 6], SPACING, &mut random)).collect();
    fill_polygon(&outline, SPACING, &mut random)
}

/// Three turns of an Archimedean spiral, a strip as wide as the gap beside it.
pub(crate) fn spiral() -> TriMesh {
    const TURNS: f64 = 3.0;
    const PITCH: f64 = 0.3;
    const INNER: f64 = 0.22;
    const HALF_WIDTH: f64 = 0.075;
    const SPACING: f64 = 0.045;
    let mut random = Random(0x5917);
    let at = |turn: f64, offset: f64| DVec2::from_angle(TAU * turn) * (INNER + PITCH * turn + offset);
    let steps = (TURNS * 180.0) as usize;
    let turn = |k: usize| TURNS * k as f64 / steps as f64;
    let outer: Vec<DVec2> = (0..=steps).map(|k| at(turn(k), HALF_WIDTH)).collect();
    let inner: Vec<DVec2> = (0..=steps).rev().map(|k| at(turn(k), -HALF_WIDTH)).collect();
    // Each of the four sides is split separately, so that the corners stay.
    let ends = [[outer[steps], inner[0]], [inner[steps], outer[0]]];
    let mut outline = Vec::new();
    for (line, [a, b]) in [outer, inner].iter().zip(ends) {
        outline.extend(walk_open(line, SPACING, &mut random));
        outline.extend(split_side(a, b, SPACING, &mut random));
    }
    fill_polygon(&outline, SPACING, &mut random)
}

/// Points along an open polyline, with the first end and without the last.
fn walk_open(line: &[DVec2], spacing: f64, random: &mut Random) -> Vec<DVec2> {
    let mut reached = vec![0.0];
    for (i, pair) in line.windows(2).enumerate() {
        reached.push(reached[i] + pair[0].distance(pair[1]));
    }
    let total = reached[line.len() - 1];
    let count = (total / spacing).round();
    let mut points = vec![line[0]];
    let mut i = 0;
    for k in 1..count as usize {
        let wanted = (k as f64 + random.between(-0.2, 0.2)) * total / count;
        while reached[i + 1] < wanted {
            i += 1;
        }
        points.push(line[i].lerp(line[i + 1], (wanted - reached[i]) / (reached[i + 1] - reached[i])));
    }
    points
}
