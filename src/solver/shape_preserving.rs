//! Floater's shape-preserving weights (Floater 1997, "Parametrization and smooth approximation of surface
//! triangulations", §6), for a convex boundary.
//!
//! The one-ring of an interior vertex is flattened by the geodesic polar map: radii kept, angles scaled to sum to 2π.
//! For each neighbour the ray through the centre leaves the ring between two others; the barycentric coordinates of
//! the centre in that triangle are averaged over all neighbours. The weights are positive and sum to 1.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::equations::Equations;
use crate::mesh::{DiskMesh, HalfedgeId};

/// Shape-preserving coefficients of the interior vertices' equations. Boundary rows stay empty.
pub fn shape_preserving(mesh: &DiskMesh) -> Equations<f64> {
    let mut coefficients = vec![0.0; mesh.link_count()];
    let mut bounded_corners = 0;
    for vertex in mesh.vertices().filter(|&v| mesh.boundary_place(v).is_none()) {
        let spokes: Vec<HalfedgeId> = mesh.outgoing(vertex).collect();
        let centre = mesh.position(vertex);
        let arms: Vec<_> = spokes.iter().map(|&h| mesh.position(mesh.head(h)) - centre).collect();
        let (weights, fell_back) = ring_weights(&arms);
        bounded_corners += usize::from(fell_back);
        for (h, weight) in spokes.iter().zip(weights) {
            coefficients[h.index()] = weight;
        }
    }
    Equations { coefficients, bounded_corners }
}

/// Angle and radius of each neighbour in the flattened ring.
fn polar_map(arms: &[glam::DVec3]) -> Vec<(f64, f64)> {
    let gaps: Vec<f64> = arms.iter().zip(arms.iter().cycle().skip(1)).map(|(a, b)| a.angle_between(*b)).collect();
    let total: f64 = gaps.iter().sum();
    let mut angle = 0.0;
    arms.iter()
        .zip(gaps)
        .map(|(arm, gap)| {
            let here = angle;
            angle += gap * TAU / total;
            (here, arm.length())
        })
        .collect()
}

/// Weights of an interior vertex's ring, given by the edges to its neighbours, and whether a degenerate ring made them equal.
pub(super) fn ring_weights(arms: &[glam::DVec3]) -> (Vec<f64>, bool) {
    let ring = polar_map(arms);
    let count = ring.len();
    let point = |i: usize| ring[i].1 * DVec2::from_angle(ring[i].0);
    let mut weights = vec![0.0; count];
    for own in 0..count {
        let opposite = (ring[own].0 + PI).rem_euclid(TAU);
        // The last neighbour at or before the opposite direction; the next one lies behind it.
        let before = ring.partition_point(|&(angle, _)| angle <= opposite).saturating_sub(1);
        let after = (before + 1) % count;
        let [a, b, c] = [point(own), point(before), point(after)];
        let shares = [b.perp_dot(c), c.perp_dot(a), a.perp_dot(b)].map(|area| area.max(0.0));
        let total: f64 = shares.iter().sum();
        if !(total > 0.0 && total.is_finite()) {
            return (vec![1.0 / count as f64; count], true);
        }
        for (index, share) in [own, before, after].into_iter().zip(shares) {
            weights[index] += share / total / count as f64;
        }
    }
    (weights, false)
}
