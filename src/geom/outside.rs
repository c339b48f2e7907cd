//! The outside of a simple polygon, triangulated: the pockets up to its convex hull, or everything up to a frame.
//!
//! A constrained Delaunay triangulation (spade, exact predicates) of the polygon's corners and the frame's, without
//! new points. Its triangles lie either inside the polygon or outside.

use glam::DVec2;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};

use super::spade_points::spade_points;

/// Triangulates the region between a simple polygon, counter-clockwise, and the convex hull of polygon and frame.
///
/// Corners of the frame, which must lie outside the polygon's hull, are numbered after those of the polygon. Triangles
/// are counter-clockwise. `None` where a coordinate is not finite or beyond what the triangulation can represent, and
/// where the polygon is not simple.
///
/// # Panics
///
/// If there are 2³² points or more.
pub fn outside_triangles(polygon: &[DVec2], frame: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    let count = polygon.len();
    let points = spade_points(polygon.iter().chain(frame));
    let sides = (0..count).map(|k| [k, (k + 1) % count]).collect();
    let mut conflicts = 0;
    let total = points.len();
    let triangulation =
        ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(points, sides, |_| conflicts += 1).ok()?;
    if conflicts > 0 || triangulation.num_vertices() != total {
        return None;
    }
    let corners = triangulation.inner_faces().map(|face| face.vertices().map(|vertex| vertex.fix().index()));
    let outside = corners.filter(|&corners| !is_inside(corners, count));
    let mut triangles: Vec<[u32; 3]> =
        outside.map(|corners| corners.map(|c| u32::try_from(c).expect("spade counts in 32 bits"))).collect();
    // The same triangles in the same order, however the triangulation came about.
    for triangle in &mut triangles {
        let least = (0..3).min_by_key(|&k| triangle[k]).unwrap_or(0);
        triangle.rotate_left(least);
    }
    triangles.sort_unstable();
    Some(triangles)
}

/// Whether a counter-clockwise triangle that crosses no side of the polygon lies inside: its corners then follow each
/// other as they do along the polygon, and outside the other way round.
fn is_inside([a, b, c]: [usize; 3], count: usize) -> bool {
    let descents = usize::from(a > b) + usize::from(b > c) + usize::from(c > a);
    a.max(b).max(c) < count && descents == 1
}
