//! Volume of an open surface, which shows the side that is its outside.

use crate::parallel::prelude::*;
use glam::DVec3;

use super::{DiskMesh, FaceId};

/// Number of faces summed by one task, independent of the number of threads.
const FACES_PER_TASK: usize = 16_384;

/// Volume between a surface and the fan from the centroid of its boundary, relative to its area^1.5.
///
/// Positive if the faces point away from that volume, near 0 if the surface is flat. A whole ball has 1 / (6 √π) =
/// 0.094.
///
/// The centroid is the mean of the boundary's edges, weighted by length, so it does not depend on the subdivision of
/// the boundary. Relative to the centroid the fan has no volume, so only the tetrahedra of the surface are summed.
pub fn relative_volume(mesh: &DiskMesh) -> f64 {
    let origin = boundary_centroid(mesh);
    let count = mesh.face_count();
    let of_task = |task: usize| {
        let faces = task * FACES_PER_TASK..count.min((task + 1) * FACES_PER_TASK);
        faces.fold((0.0, 0.0), |(volume, area), face| {
            let [a, b, c] = mesh.mesh().corners(FaceId::from_index(face)).map(|corner| corner - origin);
            (volume + a.dot(b.cross(c)) / 6.0, area + (b - a).cross(c - a).length() / 2.0)
        })
    };
    let parts: Vec<(f64, f64)> = (0..count.div_ceil(FACES_PER_TASK)).into_par_iter().map(of_task).collect();
    let (volume, area) = parts.iter().fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
    let relative = volume / area.powf(1.5);
    if relative.is_finite() { relative } else { 0.0 }
}

fn boundary_centroid(mesh: &DiskMesh) -> DVec3 {
    let around = mesh.boundary_loop();
    let ends = around.iter().zip(around.iter().cycle().skip(1)).map(|(&a, &b)| (mesh.position(a), mesh.position(b)));
    let (sum, length) = ends.fold((DVec3::ZERO, 0.0), |(sum, length), (a, b)| {
        let edge = a.distance(b);
        (sum + a.midpoint(b) * edge, length + edge)
    });
    if length > 0.0 { sum / length } else { mesh.position(around[0]) }
}
