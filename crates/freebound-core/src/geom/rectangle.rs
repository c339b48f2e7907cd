//! Rectangle of least area around points.
//!
//! At least one side of the rectangle lies on a side of the convex hull. Source: H. Freeman, R. Shapira,
//! "Determining the minimum-area encasing rectangle for an arbitrary closed curve", 1975.

use glam::DVec2;

use super::{Bounds, convex_hull};

/// Rotation, a complex number of length 1, after which the bounding box of the points has the least area. Returns 1
/// if the points span no area. Ties go to the first side.
pub fn least_box_turn(points: &[DVec2]) -> DVec2 {
    let hull: Vec<DVec2> = convex_hull(points).into_iter().map(|place| points[place]).collect();
    let area_after = |turn: DVec2| {
        let size = Bounds::of(hull.iter().map(|z| turn.rotate(*z))).size();
        size.x * size.y
    };
    // The conjugate of a direction rotates it onto the x axis.
    let sides = (0..hull.len()).filter_map(|k| (hull[(k + 1) % hull.len()] - hull[k]).try_normalize());
    let turns = std::iter::once(DVec2::X).chain(sides.map(|along| DVec2::new(along.x, -along.y)));
    let areas = turns.map(|turn| (turn, area_after(turn)));
    areas.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(DVec2::X, |(turn, _)| turn)
}
