//! The convex hull of points, by Andrew's monotone chain with the exact predicate.
//!
//! Source: A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979.

use glam::DVec2;

use super::{Orientation, orientation};

/// The corners of the convex hull as places among the points, counter-clockwise from the leftmost, none within a side.
/// Points that are not finite are left out; there are fewer than three corners where no area is spanned.
pub fn convex_hull(points: &[DVec2]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|&i| points[i].is_finite()).collect();
    order.sort_by(|&i, &j| points[i].x.total_cmp(&points[j].x).then(points[i].y.total_cmp(&points[j].y)));
    order.dedup_by(|i, j| points[*i] == points[*j]);
    let chain = |places: &mut dyn Iterator<Item = usize>| {
        let mut corners: Vec<usize> = Vec::new();
        for place in places {
            while let [.., a, b] = corners[..]
                && orientation(points[a], points[b], points[place]) != Some(Orientation::CounterClockwise)
            {
                corners.pop();
            }
            corners.push(place);
        }
        corners
    };
    let mut lower = chain(&mut order.iter().copied());
    let mut upper = chain(&mut order.iter().rev().copied());
    // Each chain ends where the other begins.
    lower.pop();
    upper.pop();
    lower.append(&mut upper);
    lower
}
