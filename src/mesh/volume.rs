//! Which side of an open surface is the outside, as far as its shape says.

use glam::DVec3;

use super::DiskMesh;

/// Volume between a surface and the fan from the centroid of its boundary, relative to its area^1.5: positive where
/// the faces look away from that volume, near 0 where the surface is flat. A whole ball has 1 / (6 √π) = 0.094.
///
/// The centroid is the mean of the boundary's edges by their lengths, so that it does not depend on how finely the
/// boundary is divided. Seen from it the fan has no volume, so that the surface's tetrahedra are all there is to add.
pub fn relative_volume(mesh: &DiskMesh) -> f64 {
    let origin = boundary_centroid(mesh);
    let (mut volume, mut area) = (0.0, 0.0);
    for face in mesh.faces() {
        let [a, b, c] = mesh.mesh().corners(face).map(|corner| corner - origin);
        volume += a.dot(b.cross(c)) / 6.0;
        area += (b - a).cross(c - a).length() / 2.0;
    }
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
