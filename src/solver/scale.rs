//! Size of an embedding: true scale, and the unit square of texture coordinates.

use glam::DVec2;

use crate::mesh::DiskMesh;

/// Scales an embedding about the origin so that its faces have the total area of the surface.
///
/// An embedding without area, or with one that is not finite, is left as it is.
pub fn to_true_area(mesh: &DiskMesh, embedding: &mut [DVec2]) {
    let in_plane: f64 = mesh
        .mesh()
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| embedding[v.index()]);
            (b - a).perp_dot(c - a).abs() / 2.0
        })
        .sum();
    let factor = (mesh.mesh().area() / in_plane).sqrt();
    if factor.is_finite() && factor > 0.0 {
        embedding.iter_mut().for_each(|z| *z *= factor);
    }
}

/// Moves and scales an embedding uniformly so that it fills the unit square's width or height from the origin on.
///
/// An embedding without extent, or with one that is not finite, is left as it is.
pub fn to_unit_square(embedding: &mut [DVec2]) {
    let low = embedding.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = embedding.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let extent = (high - low).max_element();
    if extent.is_finite() && extent > 0.0 {
        embedding.iter_mut().for_each(|z| *z = (*z - low) / extent);
    }
}
