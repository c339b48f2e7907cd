//! How often a closed polygon turns, and how often it winds around a point: exact integers, no angle is summed.
//!
//! # Method
//!
//! Directions are sorted into two half-turns: *up* holds the angles [0, π), *down* holds [π, 2π). A direction's half
//! follows from comparing coordinates, which is exact. A walk that turns by less than π at a time passes the angle 0
//! exactly where it goes from down to up while turning left (+1) or from up to down while turning right (−1).

use glam::DVec2;

use super::{Orientation, orientation};

/// Whether the direction from one point to another is down: an angle in [π, 2π), where up is [0, π). `None` where they coincide
/// or are not finite.
pub fn is_down(from: DVec2, to: DVec2) -> Option<bool> {
    let has_direction = from.is_finite() && to.is_finite() && from != to;
    has_direction.then_some(to.y < from.y || (to.y <= from.y && to.x <= from.x))
}

/// How often the direction passes the angle 0 counter-clockwise, `[before, after]` being whether it is down; `None` where
/// it turns exactly back.
fn passes(are_down: [bool; 2], turn: Orientation) -> Option<i64> {
    match (are_down, turn) {
        ([true, false], Orientation::CounterClockwise) => Some(1),
        ([false, true], Orientation::Clockwise) => Some(-1),
        ([true, false] | [false, true], Orientation::Collinear) => None,
        _ => Some(0),
    }
}

/// The turning number of a closed polygon: full turns to the left of its edge directions, once around.
///
/// A simple polygon turns once: 1 counter-clockwise, −1 clockwise. `None` where an edge has length zero or turns
/// exactly back at its end, where a coordinate is not finite, and for fewer than three corners.
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

/// The winding number of a closed polygon around a point: full turns to the left of the direction from the point.
///
/// `None` where the polygon passes through the point, or a coordinate is not finite.
pub fn winding_number(polygon: &[DVec2], around: DVec2) -> Option<i64> {
    let mut turns = 0;
    let mut before = *polygon.last()?;
    for &after in polygon {
        let [first, second] = [is_down(around, before)?, is_down(around, after)?];
        // Within one half nothing passes 0, and the point cannot lie between: no need for the exact turn.
        if first != second {
            turns += passes([first, second], orientation(around, before, after)?)?;
        }
        before = after;
    }
    Some(turns)
}
