//! A cube without its bottom, each side triangulated irregularly, after the paper's figure 3.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::Random;
use super::fill::{Sheet, fill};
use freebound_core::mesh::TriMesh;

/// Spacing of the vertices. The cube has unit edges.
const SPACING: f64 = 0.085;

/// Rounds of settling: enough for good triangles, too few for a regular pattern.
const ROUNDS: usize = 4;

/// Origin and the two directions of each side.
const SIDES: [[DVec3; 3]; 5] = [
    [DVec3::Y, DVec3::Z, DVec3::X],
    [DVec3::ZERO, DVec3::X, DVec3::Y],
    [DVec3::Z, DVec3::X, DVec3::Y],
    [DVec3::ZERO, DVec3::Y, DVec3::Z],
    [DVec3::X, DVec3::Y, DVec3::Z],
];

/// Inner points of the cube's edge between two corners, identical from both sides that share it.
fn edge_points(a: DVec3, b: DVec3) -> Vec<DVec3> {
    let (low, high) = if (a.x, a.y, a.z) < (b.x, b.y, b.z) { (a, b) } else { (b, a) };
    let seed = [low, high].iter().fold(0xc0be, |s, p| 31 * s + (4.0 * p.x + 2.0 * p.y + p.z) as u64);
    let mut random = Random(seed);
    let count = (1.0 / SPACING).round();
    let mut points: Vec<DVec3> =
        (1..count as usize).map(|k| low.lerp(high, (k as f64 + random.between(-0.25, 0.25)) / count)).collect();
    if low != a {
        points.reverse();
    }
    points
}

/// The open cube, from (0, 0, 0) to (1, 1, 1), y up.
pub(crate) fn cube() -> TriMesh {
    let mut random = Random(0xc0be);
    let mut number: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for [origin, u, v] in SIDES {
        // The cross product u × v may point inwards; then the two directions are swapped.
        let outwards = (origin + (u + v) / 2.0 - DVec3::splat(0.5)).dot(u.cross(v)) > 0.0;
        let [u, v] = if outwards { [u, v] } else { [v, u] };
        let lift = |p: DVec2| origin + p.x * u + p.y * v;
        let drop = |x: DVec3| DVec2::new((x - origin).dot(u), (x - origin).dot(v));
        let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        let mut outline = Vec::new();
        for k in 0..4 {
            let (a, b) = (corners[k], corners[(k + 1) % 4]);
            outline.push(a);
            outline.extend(edge_points(lift(a), lift(b)).into_iter().map(drop));
        }
        let mut plane = fill(&outline, &|_| SPACING, &mut random);
        plane.settle(&Sheet { surface: &lift, chart: &drop, spacing: &|_| 1.0 }, ROUNDS);
        let mut weld = |p: DVec2| {
            let x = lift(p);
            // Adding zero turns −0 into 0.
            let key = (x + 0.0).to_array().map(f64::to_bits);
            *number.entry(key).or_insert_with(|| {
                positions.push(x);
                u32::try_from(positions.len() - 1).expect("an example is small")
            })
        };
        let ids: Vec<u32> = plane.points.iter().map(|&p| weld(p)).collect();
        triangles.extend(plane.triangles.iter().map(|t| t.map(|w| ids[w as usize])));
    }
    TriMesh::new(positions, &triangles)
}
