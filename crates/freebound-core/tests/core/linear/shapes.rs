//! Irregular surfaces that are hard to flatten.

use freebound_testkit::surfaces::disk;
use std::f64::consts::TAU;

use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::Embedding;
use glam::DVec3;

use freebound_testkit::Random;

/// Tube of radius 1, closed at the far end, with jittered rings of `around` vertices. A conformal map shrinks it by
/// a factor e per radius of its length.
pub(crate) fn finger(rings: u32, around: u32, random: &mut Random) -> DiskMesh {
    let spacing = TAU / f64::from(around);
    let mut positions = Vec::new();
    for ring in 0..rings {
        for k in 0..around {
            let mut jitter = || 0.5 * (random.unit() - 0.5);
            let angle = spacing * (f64::from(k) + jitter() + 0.5 * f64::from(ring % 2));
            let height = spacing * 0.87 * (f64::from(ring) + if ring == 0 { 0.0 } else { jitter() });
            let radius = 1.0 + 0.2 * jitter();
            positions.push(DVec3::new(radius * angle.cos(), radius * angle.sin(), height));
        }
    }
    let tip = u32::try_from(positions.len()).unwrap();
    positions.push(DVec3::new(0.0, 0.0, spacing * 0.87 * f64::from(rings)));
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for k in 0..around {
            let [a, b] = [k, (k + 1) % around].map(|k| ring * around + k);
            if ring + 1 == rings {
                triangles.push([a, b, tip]);
                continue;
            }
            let [c, d] = [k, (k + 1) % around].map(|k| (ring + 1) * around + k);
            if ring % 2 == 0 {
                triangles.extend([[a, b, c], [b, d, c]]);
            } else {
                triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
    }
    disk(&positions, &triangles)
}

/// Two different interior vertices.
pub(crate) fn interior_pair(mesh: &DiskMesh, random: &mut Random) -> [VertexId; 2] {
    let inside: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.boundary_place(v).is_none()).collect();
    let mut pick = || inside[random.below(u32::try_from(inside.len()).unwrap()) as usize];
    let first = pick();
    loop {
        let second = pick();
        if second != first {
            return [first, second];
        }
    }
}

/// Least and greatest area of an embedding's faces.
pub(crate) fn area_range(mesh: &DiskMesh, embedding: &Embedding) -> [f64; 2] {
    let area = |face| {
        let [a, b, c] = embedding.corners(mesh, face);
        (b - a).perp_dot(c - a).abs() / 2.0
    };
    mesh.faces().map(area).fold([f64::INFINITY, 0.0], |[low, high], area| [low.min(area), high.max(area)])
}
