//! The rectangle of the least area around points.
//!
//! One of its sides lies on a side of the convex hull. Source: H. Freeman, R. Shapira, "Determining the minimum-area encasing
//! rectangle for an arbitrary closed curve", 1975.

use glam::DVec2;

use super::{Bounds, convex_hull};

/// The turn, a complex number of length 1, after which the box around the points has the least area of all turns; 1 where
/// they span none. Of sides as good as each other, the first counts.
pub fn least_box_turn(points: &[DVec2]) -> DVec2 {
    let hull: Vec<DVec2> = convex_hull(points).into_iter().map(|place| points[place]).collect();
    let area_after = |turn: DVec2| {
        let size = Bounds::of(hull.iter().map(|z| turn.rotate(*z))).size();
        size.x * size.y
    };
    // A direction's conjugate turns it onto the x axis.
    let sides = (0..hull.len()).filter_map(|k| (hull[(k + 1) % hull.len()] - hull[k]).try_normalize());
    let turns = std::iter::once(DVec2::X).chain(sides.map(|along| DVec2::new(along.x, -along.y)));
    let areas = turns.map(|turn| (turn, area_after(turn)));
    areas.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(DVec2::X, |(turn, _)| turn)
}
