//! Turning number of a closed polygon and its winding number around a point, as exact integers. No angle is summed.
//!
//! # Method
//!
//! Directions are sorted into two half-turns: *up* holds the angles [0, π), *down* holds [π, 2π). Comparing
//! coordinates gives the half of a direction exactly. A walk that turns by less than π per step passes the angle 0
//! in exactly two cases: from down to up in a left turn (+1), and from up to down in a right turn (−1).

use glam::DVec2;

use super::{Orientation, orientation};

/// True if the direction from one point to another is down, an angle in [π, 2π); up is [0, π). `None` if the points
/// coincide or are not finite.
pub fn is_down(from: DVec2, to: DVec2) -> Option<bool> {
    let has_direction = from.is_finite() && to.is_finite() && from != to;
    has_direction.then_some(to.y < from.y || (to.y <= from.y && to.x <= from.x))
}

/// Number of counter-clockwise passes of the angle 0 between two directions, 1, 0 or −1. `are_down` tells for the
/// direction before and the direction after if it is down. `None` if the second direction is opposite to the first.
fn passes(are_down: [bool; 2], turn: Orientation) -> Option<i64> {
    match (are_down, turn) {
        ([true, false], Orientation::CounterClockwise) => Some(1),
        ([false, true], Orientation::Clockwise) => Some(-1),
        ([true, false] | [false, true], Orientation::Collinear) => None,
        _ => Some(0),
    }
}

/// Turning number of a closed polygon: full left turns of its edge directions, once around.
///
/// A simple polygon has turning number 1 if counter-clockwise, −1 if clockwise. `None` if an edge has length zero or
/// the next edge folds exactly back, if a coordinate is not finite, and for fewer than three corners.
pub fn turning_number(polygon: &[DVec2]) -> Option<i64> {
    let count = polygon.len();
    if count < 3 {
        return None;
    }
    let mut turns = 0;
    for i in 0..count {
        let [a, b, c] = [polygon[i], polygon[(i + 1) % count], polygon[(i + 2) % count]];
        turns += passes([is_down(a, b)?, is_down(b, c)?], orientation(a, b, c)?)?;
    }
    Some(turns)
}

/// Winding number of a closed polygon around a point: full left turns of the direction from the point to the
/// polygon.
///
/// `None` if the polygon passes through the point or a coordinate is not finite.
pub fn winding_number(polygon: &[DVec2], around: DVec2) -> Option<i64> {
    let mut turns = 0;
    let mut before = *polygon.last()?;
    for &after in polygon {
        let [first, second] = [is_down(around, before)?, is_down(around, after)?];
        // Within one half, the direction passes no angle 0 and the point cannot lie on the edge: the exact turn is
        // not needed.
        if first != second {
            turns += passes([first, second], orientation(around, before, after)?)?;
        }
        before = after;
    }
    Some(turns)
}
