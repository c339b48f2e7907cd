//! Floater's shape-preserving weights (Floater 1997, "Parametrization and smooth approximation of surface
//! triangulations", §6), for a convex boundary.
//!
//! The one-ring of an interior vertex is flattened by the geodesic polar map: radii are kept, angles are scaled to sum
//! to 2π. For each neighbour, the ray through the centre leaves the ring between two other neighbours. The barycentric
//! coordinates of the centre in that triangle are averaged over all neighbours. The weights are positive and sum to 1.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::equations::Equations;
use crate::mesh::{DiskMesh, HalfedgeId, VertexId};

/// Shape-preserving coefficients of the interior vertices' equations. Boundary rows stay empty.
pub fn shape_preserving(mesh: &DiskMesh) -> Equations<f64> {
    shape_preserving_of(mesh, &|corners| mesh.shape(corners))
}

/// Shape-preserving coefficients, with `shape` in place of the triangles in space.
pub(crate) fn shape_preserving_of(mesh: &DiskMesh, shape: Shape<'_>) -> Equations<f64> {
    let mut coefficients = vec![0.0; mesh.link_count()];
    let mut bounded_corners = 0;
    for vertex in mesh.vertices().filter(|&v| mesh.boundary_place(v).is_none()) {
        let spokes: Vec<HalfedgeId> = mesh.outgoing(vertex).collect();
        let neighbours: Vec<VertexId> = spokes.iter().map(|&h| mesh.head(h)).collect();
        let (weights, fell_back) = ring_weights(shape, vertex, &neighbours);
        bounded_corners += usize::from(fell_back);
        for (h, weight) in spokes.iter().zip(weights) {
            coefficients[h.index()] = weight;
        }
    }
    Equations { coefficients, bounded_corners }
}

/// Shape of the triangle of three vertices.
pub(crate) type Shape<'a> = &'a dyn Fn([VertexId; 3]) -> [DVec3; 3];

/// Angle and radius of each neighbour in the flattened ring.
fn polar_map(shape: Shape<'_>, centre: VertexId, neighbours: &[VertexId]) -> Vec<(f64, f64)> {
    // Angle to the next neighbour, and the radius.
    let gap = |(&next, &previous): (&VertexId, &VertexId)| {
        let [at, a, b] = shape([centre, next, previous]);
        ((a - at).angle_between(b - at), at.distance(a))
    };
    let gaps: Vec<(f64, f64)> = neighbours.iter().zip(neighbours.iter().cycle().skip(1)).map(gap).collect();
    let total: f64 = gaps.iter().map(|(gap, _)| gap).sum();
    let mut angle = 0.0;
    gaps.into_iter()
        .map(|(gap, radius)| {
            let here = angle;
            angle += gap * TAU / total;
            (here, radius)
        })
        .collect()
}

/// Weights of an interior vertex's ring, given by its neighbours in order. Returns true with equal weights if the ring
/// is degenerate.
pub(crate) fn ring_weights(shape: Shape<'_>, centre: VertexId, neighbours: &[VertexId]) -> (Vec<f64>, bool) {
    let ring = polar_map(shape, centre, neighbours);
    let count = ring.len();
    let point = |i: usize| ring[i].1 * DVec2::from_angle(ring[i].0);
    let mut weights = vec![0.0; count];
    for own in 0..count {
        let opposite = (ring[own].0 + PI).rem_euclid(TAU);
        // The last neighbour at or before the opposite direction; the next neighbour lies behind that direction.
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
