//! The Delaunay triangulation of points in the plane (spade, exact predicates).

use glam::DVec2;
use spade::{DelaunayTriangulation, Point2, Triangulation as _};

use super::spade_points::spade_points;

/// Triangulates the convex hull of points, triangles counter-clockwise, corners by their places in the list.
///
/// `None` where a coordinate is not finite or too large, and where two points coincide.
///
/// # Panics
///
/// If there are 2³² points or more.
pub fn delaunay_triangles(points: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    let triangulation = DelaunayTriangulation::<Point2<f64>>::bulk_load_stable(spade_points(points.iter())).ok()?;
    if triangulation.num_vertices() != points.len() {
        return None;
    }
    let number = |index: usize| u32::try_from(index).expect("spade counts in 32 bits");
    let mut triangles: Vec<[u32; 3]> = triangulation
        .inner_faces()
        .map(|face| {
            let mut corners = face.vertices().map(|vertex| number(vertex.fix().index()));
            let least = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
            corners.rotate_left(least);
            corners
        })
        .collect();
    triangles.sort_unstable();
    Some(triangles)
}
