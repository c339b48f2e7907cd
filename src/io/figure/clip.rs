//! Lines and polygons cut to a rectangle, so that what reads the drawing need not know how to cut.

use glam::DVec2;

use crate::geom::Bounds;

/// The part of a segment inside a rectangle, if there is any (Liang and Barsky 1984).
pub(super) fn clip_segment([a, b]: [DVec2; 2], area: Bounds) -> Option<[DVec2; 2]> {
    let along = b - a;
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let (low, high) = (area.low[axis] - a[axis], area.high[axis] - a[axis]);
        if along[axis] == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (enter, leave) = (low / along[axis], high / along[axis]);
        from = from.max(enter.min(leave));
        to = to.min(enter.max(leave));
    }
    (from <= to).then(|| [from, to].map(|share| a + share * along))
}

/// The part of a polygon inside a rectangle (Sutherland and Hodgman 1974). Where the polygon leaves and comes back, its
/// parts hang together along the rectangle's side.
pub(super) fn clip_polygon(polygon: &[DVec2], area: Bounds) -> Vec<DVec2> {
    let sides =
        [(DVec2::X, area.low.x), (DVec2::NEG_X, -area.high.x), (DVec2::Y, area.low.y), (DVec2::NEG_Y, -area.high.y)];
    let mut kept = polygon.to_vec();
    for (inwards, limit) in sides {
        let mut cut = Vec::with_capacity(kept.len() + 4);
        for (k, &b) in kept.iter().enumerate() {
            let a = kept[(k + kept.len() - 1) % kept.len()];
            let (depth_a, depth_b) = (a.dot(inwards) - limit, b.dot(inwards) - limit);
            if (depth_a < 0.0) != (depth_b < 0.0) {
                cut.push(a.lerp(b, depth_a / (depth_a - depth_b)));
            }
            if depth_b >= 0.0 {
                cut.push(b);
            }
        }
        kept = cut;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Bounds = Bounds { low: DVec2::ZERO, high: DVec2::ONE };

    #[test]
    fn a_segment_is_cut_on_both_sides_or_left_out() {
        let segment = |a: [f64; 2], b: [f64; 2]| clip_segment([a, b].map(DVec2::from), UNIT);
        assert_eq!(segment([-1.0, 0.5], [3.0, 0.5]), Some([DVec2::new(0.0, 0.5), DVec2::new(1.0, 0.5)]));
        assert_eq!(segment([0.25, 0.25], [0.5, 0.5]), Some([DVec2::splat(0.25), DVec2::splat(0.5)]));
        assert_eq!(segment([-1.0, 0.5], [0.5, 3.0]), None);
        assert_eq!(segment([2.0, 0.0], [2.0, 1.0]), None);
    }

    #[test]
    fn a_polygon_is_cut_to_its_part_inside() {
        let area = |p: &[DVec2]| p.iter().zip(p.iter().cycle().skip(1)).map(|(a, b)| a.perp_dot(*b)).sum::<f64>() / 2.0;
        let around = [[-1.0, -1.0], [2.0, -1.0], [2.0, 2.0], [-1.0, 2.0]].map(DVec2::from);
        assert!((area(&clip_polygon(&around, UNIT)) - 1.0).abs() < 1e-12);
        let half = [[-1.0, 0.0], [0.5, 0.0], [0.5, 1.0], [-1.0, 1.0]].map(DVec2::from);
        assert!((area(&clip_polygon(&half, UNIT)) - 0.5).abs() < 1e-12);
        let beside = [[2.0, 0.0], [3.0, 0.0], [3.0, 1.0]].map(DVec2::from);
        assert!(clip_polygon(&beside, UNIT).is_empty());
    }
}
