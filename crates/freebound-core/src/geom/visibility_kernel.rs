//! Kernel of a polygon: the points that see all of it.

use glam::DVec2;

use super::Bounds;
use super::clip::cut_by_line;

/// Kernel of a counter-clockwise polygon as a convex polygon: the points to the left of all its sides. Empty, up to
/// rounding, if no point sees all of the polygon.
pub fn kernel(polygon: &[DVec2]) -> Vec<DVec2> {
    let Bounds { low, high } = Bounds::of(polygon.iter().copied());
    let mut kept = vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    let mut cut = Vec::with_capacity(kept.len() + polygon.len());
    for (k, &from) in polygon.iter().enumerate() {
        let along = polygon[(k + 1) % polygon.len()] - from;
        cut_by_line(&kept, |z| along.perp_dot(z - from), &mut cut);
        std::mem::swap(&mut kept, &mut cut);
        cut.clear();
    }
    kept
}

/// Centroid of a convex polygon, or of its corners if it has no area. `None` if it has no corners.
pub fn centre_of_gravity(polygon: &[DVec2]) -> Option<DVec2> {
    let &first = polygon.first()?;
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    for pair in polygon.windows(2) {
        let (a, b) = (pair[0] - first, pair[1] - first);
        area += a.perp_dot(b);
        moment += a.perp_dot(b) * (a + b);
    }
    let of_corners = || polygon.iter().sum::<DVec2>() / polygon.len() as f64;
    let centre = first + moment / (3.0 * area);
    Some(if area > 0.0 && centre.is_finite() { centre } else { of_corners() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
        list.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    #[test]
    fn the_kernel_of_an_arrow_lies_between_its_wings() {
        // Square with a notch from below up to its middle.
        let arrow = points(&[(0.0, 0.0), (2.0, 2.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
        let kernel = kernel(&arrow);
        // Left of both sides of the notch: above y = x and above y = 4 − x.
        assert!(kernel.iter().all(|z| z.y >= z.x - 1e-12 && z.y >= 4.0 - z.x - 1e-12 && z.y <= 4.0));
        let centre = centre_of_gravity(&kernel).unwrap();
        assert!(centre.distance(DVec2::new(2.0, 2.0 + 4.0 / 3.0)) < 1e-12, "the centre of the triangle: {centre}");
    }

    #[test]
    fn a_polygon_that_no_point_sees_all_of_has_no_kernel() {
        let spiral = points(&[
            (0.0, 0.0),
            (5.0, 0.0),
            (5.0, 5.0),
            (2.0, 5.0),
            (2.0, 4.0),
            (4.0, 4.0),
            (4.0, 1.0),
            (1.0, 1.0),
            (1.0, 5.0),
            (0.0, 5.0),
        ]);
        let area =
            |z: &[DVec2]| (1..z.len().saturating_sub(1)).map(|k| (z[k] - z[0]).perp_dot(z[k + 1] - z[0])).sum::<f64>();
        assert!(area(&kernel(&spiral)).abs() < 1e-12);
        assert_eq!(centre_of_gravity(&[]), None);
    }
}
