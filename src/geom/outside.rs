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

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "areas of polygons with small whole corners are exact")]
mod tests {
    use super::*;
    use crate::geom::{Orientation, orientation};

    fn points(corners: &[[i32; 2]]) -> Vec<DVec2> {
        corners.iter().map(|&[x, y]| DVec2::new(f64::from(x), f64::from(y))).collect()
    }

    fn double_area(corners: &[DVec2]) -> f64 {
        corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| a.perp_dot(*b)).sum()
    }

    /// Twice the area of the triangles, all of which must be positive.
    fn covered(points: &[DVec2], triangles: &[[u32; 3]]) -> f64 {
        let corners = triangles.iter().map(|t| t.map(|c| points[c as usize]));
        corners
            .map(|[a, b, c]| {
                assert_eq!(orientation(a, b, c), Some(Orientation::CounterClockwise));
                double_area(&[a, b, c])
            })
            .sum()
    }

    #[test]
    fn a_convex_polygon_has_no_pockets() {
        assert_eq!(outside_triangles(&points(&[[0, 0], [4, 0], [5, 3], [1, 4]]), &[]), Some(Vec::new()));
    }

    #[test]
    fn corners_in_the_middle_of_a_hull_side_make_no_pocket() {
        let square = points(&[[0, 0], [2, 0], [4, 0], [4, 4], [0, 4], [0, 1]]);
        assert_eq!(outside_triangles(&square, &[]), Some(Vec::new()));
    }

    #[test]
    fn pockets_fill_the_hull() {
        let comb = points(&[[0, 0], [9, 0], [9, 5], [7, 1], [5, 5], [3, 1], [1, 4], [0, 5]]);
        let triangles = outside_triangles(&comb, &[]).unwrap();
        let hull = points(&[[0, 0], [9, 0], [9, 5], [5, 5], [0, 5]]);
        assert_eq!(double_area(&comb) + covered(&comb, &triangles), double_area(&hull));
    }

    #[test]
    fn a_pocket_within_a_spiral_is_found() {
        let spiral = points(&[
            [0, 0],
            [9, 0],
            [9, 9],
            [1, 9],
            [1, 3],
            [6, 3],
            [6, 6],
            [4, 6],
            [4, 5],
            [5, 5],
            [5, 4],
            [2, 4],
            [2, 8],
            [8, 8],
            [8, 1],
            [0, 1],
        ]);
        let triangles = outside_triangles(&spiral, &[]).unwrap();
        let hull = points(&[[0, 0], [9, 0], [9, 9], [1, 9], [0, 1]]);
        assert_eq!(double_area(&spiral) + covered(&spiral, &triangles), double_area(&hull));
    }

    #[test]
    fn a_frame_is_filled_up_to_the_polygon() {
        let ell = points(&[[0, 0], [4, 0], [4, 1], [1, 1], [1, 4], [0, 4]]);
        let frame = points(&[[-9, -9], [9, -9], [9, 9], [-9, 9]]);
        let triangles = outside_triangles(&ell, &frame).unwrap();
        let all: Vec<DVec2> = ell.iter().chain(&frame).copied().collect();
        assert_eq!(double_area(&ell) + covered(&all, &triangles), double_area(&frame));
    }

    #[test]
    fn a_polygon_that_is_not_simple_is_refused() {
        assert_eq!(outside_triangles(&points(&[[0, 0], [2, 2], [2, 0], [0, 2]]), &[]), None);
        assert_eq!(outside_triangles(&points(&[[0, 0], [4, 0], [4, 4], [4, 0], [0, 4]]), &[]), None);
        assert_eq!(outside_triangles(&[DVec2::ZERO, DVec2::X, DVec2::NAN], &[]), None);
    }
}
