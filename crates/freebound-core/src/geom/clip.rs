//! Clipping of segments and polygons to a box.

use glam::DVec2;

use super::Bounds;

/// Part of a segment inside a box, if any (Liang and Barsky 1984).
pub fn clip_segment([a, b]: [DVec2; 2], bounds: Bounds) -> Option<[DVec2; 2]> {
    let along = b - a;
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let (low, high) = (bounds.low[axis] - a[axis], bounds.high[axis] - a[axis]);
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

/// Part of a polygon inside a box (Sutherland and Hodgman 1974). If the polygon leaves the box and returns, its
/// parts stay connected along the side of the box.
pub fn clip_polygon(polygon: &[DVec2], bounds: Bounds) -> Vec<DVec2> {
    let sides = [
        (DVec2::X, bounds.low.x),
        (DVec2::NEG_X, -bounds.high.x),
        (DVec2::Y, bounds.low.y),
        (DVec2::NEG_Y, -bounds.high.y),
    ];
    let mut kept = polygon.to_vec();
    for (inwards, limit) in sides {
        let mut cut = Vec::with_capacity(kept.len() + 4);
        cut_by_line(&kept, |z| z.dot(inwards) - limit, &mut cut);
        kept = cut;
    }
    kept
}

/// Appends to `cut` the part of a polygon on the side of a line on which `depth`, a linear function, is not
/// negative.
pub(super) fn cut_by_line(polygon: &[DVec2], depth: impl Fn(DVec2) -> f64, cut: &mut Vec<DVec2>) {
    for (k, &b) in polygon.iter().enumerate() {
        let a = polygon[(k + polygon.len() - 1) % polygon.len()];
        let (depth_a, depth_b) = (depth(a), depth(b));
        if (depth_a < 0.0) != (depth_b < 0.0) {
            cut.push(a.lerp(b, depth_a / (depth_a - depth_b)));
        }
        if depth_b >= 0.0 {
            cut.push(b);
        }
    }
}
