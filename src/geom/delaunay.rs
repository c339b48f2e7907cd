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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_with_a_point_in_it_has_four_triangles_around_that_point() {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.4, 1e-300]].map(DVec2::from);
        assert_eq!(delaunay_triangles(&points[..4]).map(|triangles| triangles.len()), Some(2));
        let inside = [points[0], points[1], points[2], points[3], DVec2::new(0.4, 0.5)];
        assert_eq!(delaunay_triangles(&inside), Some(vec![[0, 1, 4], [0, 4, 3], [1, 2, 4], [2, 3, 4]]));
        // A coordinate that is all but zero counts as zero: the point then lies on the lower side.
        assert_eq!(delaunay_triangles(&points).map(|triangles| triangles.len()), Some(3));
    }

    #[test]
    fn points_that_coincide_are_refused() {
        assert_eq!(delaunay_triangles(&[DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::X]), None);
        assert_eq!(delaunay_triangles(&[DVec2::ZERO, DVec2::X, DVec2::NAN]), None);
    }
}
