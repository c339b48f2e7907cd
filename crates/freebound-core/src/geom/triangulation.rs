//! Triangulations of points in the plane and of the outside of a simple polygon (spade, exact predicates).

use glam::DVec2;
use spade::{ConstrainedDelaunayTriangulation, DelaunayTriangulation, Point2, Triangulation};

/// Magnitude below which coordinates, scaled to a size near 1, become zero: they are beyond the range of `spade`.
const LEAST_COORDINATE: f64 = 1e-40;

/// Triangulates the convex hull of points. Triangles are counter-clockwise; corners are indices into `points`.
///
/// `None` if a coordinate is not finite or too large, or if two points coincide.
///
/// # Panics
///
/// If there are 2³² points or more.
pub fn delaunay_triangles(points: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    let triangulation = DelaunayTriangulation::<Point2<f64>>::bulk_load_stable(spade_points(points.iter())).ok()?;
    (triangulation.num_vertices() == points.len()).then(|| triangles_where(&triangulation, |_| true))
}

/// Constrained Delaunay triangulation of points: the given sides, two indices each, become edges of the
/// triangulation. Otherwise like [`delaunay_triangles`].
///
/// Also `None` if sides cross or pass through points.
///
/// # Panics
///
/// If there are 2³² points or more, or if the index of a corner is out of range.
pub fn constrained_triangles(points: &[DVec2], sides: &[[u32; 2]]) -> Option<Vec<[u32; 3]>> {
    let sides = sides.iter().map(|side| side.map(|corner| corner as usize)).collect();
    triangles_with(spade_points(points.iter()), sides, |_| true)
}

/// Triangulates the region between a simple counter-clockwise polygon and the convex hull of polygon and frame,
/// without new points. The triangulation is constrained Delaunay: each triangle lies either inside or outside the
/// polygon.
///
/// Corners of the frame must lie outside the hull of the polygon and are numbered after the corners of the polygon.
/// Triangles are counter-clockwise. `None` if a coordinate is not finite or too large for the triangulation, and if
/// the polygon is not simple.
///
/// # Panics
///
/// If there are 2³² points or more.
pub fn outside_triangles(polygon: &[DVec2], frame: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    let count = polygon.len();
    let points = spade_points(polygon.iter().chain(frame));
    let sides = (0..count).map(|k| [k, (k + 1) % count]).collect();
    triangles_with(points, sides, |corners| !is_inside(corners, count))
}

/// Wanted triangles of the constrained triangulation with the given sides.
fn triangles_with(
    points: Vec<Point2<f64>>,
    sides: Vec<[usize; 2]>,
    is_wanted: impl Fn([usize; 3]) -> bool,
) -> Option<Vec<[u32; 3]>> {
    let (mut conflicts, total) = (0, points.len());
    let triangulation =
        ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(points, sides, |_| conflicts += 1).ok()?;
    let is_sound = conflicts == 0 && triangulation.num_vertices() == total;
    is_sound.then(|| triangles_where(&triangulation, is_wanted))
}

/// Wanted triangles of a triangulation, sorted, each rotated to start at its lowest corner. The order does not
/// depend on the construction of the triangulation.
fn triangles_where(
    triangulation: &impl Triangulation<Vertex = Point2<f64>>,
    is_wanted: impl Fn([usize; 3]) -> bool,
) -> Vec<[u32; 3]> {
    let corners = triangulation.inner_faces().map(|face| face.vertices().map(|vertex| vertex.fix().index()));
    let mut triangles: Vec<[u32; 3]> = corners
        .filter(|&corners| is_wanted(corners))
        .map(|mut corners| {
            let least = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
            corners.rotate_left(least);
            corners.map(|corner| u32::try_from(corner).expect("spade counts in 32 bits"))
        })
        .collect();
    triangles.sort_unstable();
    triangles
}

/// True if a counter-clockwise triangle that crosses no side of the polygon lies inside. Its corners then have the
/// cyclic order of the polygon; outside they have the opposite order.
fn is_inside([a, b, c]: [usize; 3], count: usize) -> bool {
    let descents = usize::from(a > b) + usize::from(b > c) + usize::from(c > a);
    a.max(b).max(c) < count && descents == 1
}

/// Points for the triangulation: scaled by a power of two to a size near 1, which changes no orientation.
fn spade_points<'a>(points: impl Iterator<Item = &'a DVec2> + Clone) -> Vec<Point2<f64>> {
    let extent = points.clone().fold(0.0_f64, |most, z| most.max(z.abs().max_element()));
    let is_usable = extent.is_finite() && extent > 0.0;
    // Two factors, each a normal number.
    let half = if is_usable { (-0.5 * extent.log2()).floor().exp2() } else { 1.0 };
    let seen = |x: f64| {
        let x = x * half * half;
        if x.abs() < LEAST_COORDINATE { 0.0 } else { x }
    };
    points.map(|z| Point2::new(seen(z.x), seen(z.y))).collect()
}
