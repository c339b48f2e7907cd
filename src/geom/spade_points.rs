//! Points as the triangulation takes them: scaled to a size near 1, which changes no orientation.

use glam::DVec2;
use spade::Point2;

/// Coordinates nearer to zero than this, at a size near 1, are beyond what the triangulation can represent, and are taken
/// as zero.
const LEAST_COORDINATE: f64 = 1e-40;

/// Scales by a power of two.
pub(super) fn spade_points<'a>(points: impl Iterator<Item = &'a DVec2> + Clone) -> Vec<Point2<f64>> {
    let extent = points.clone().fold(0.0_f64, |most, z| most.max(z.abs().max_element()));
    let is_usable = extent.is_finite() && extent > 0.0;
    // In two factors, each of which is a normal number.
    let half = if is_usable { (-0.5 * extent.log2()).floor().exp2() } else { 1.0 };
    let seen = |x: f64| {
        let x = x * half * half;
        if x.abs() < LEAST_COORDINATE { 0.0 } else { x }
    };
    points.map(|z| Point2::new(seen(z.x), seen(z.y))).collect()
}
