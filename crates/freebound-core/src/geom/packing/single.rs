//! Turn and scale of a single chart: the page edge alone limits it.

use glam::DVec2;

use super::turns::{QUARTERS, size_of};

/// Number of turns that are compared between 0° and 90°.
const TURNS: usize = 1024;

/// Number of narrowing steps around the best turn.
const NARROWINGS: usize = 40;

/// Turn between 0° and 90° at which a hull fits into a page at the largest scale.
pub(crate) fn best_turn(hull: &[DVec2], room: DVec2) -> DVec2 {
    let scale = |parameter: f64| largest_scale(size_of(hull, turn_at(parameter)), room);
    let parameters = (0..=TURNS).map(|k| k as f64 / TURNS as f64);
    let best = parameters.reduce(|best, other| if scale(other) > scale(best) { other } else { best }).unwrap_or(0.0);
    let width = 1.0 / TURNS as f64;
    let (mut low, mut high) = ((best - width).max(0.0), (best + width).min(1.0));
    for _ in 0..NARROWINGS {
        let (first, second) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if scale(first) < scale(second) { low = first } else { high = second }
    }
    let narrowed = f64::midpoint(low, high);
    turn_at(if scale(narrowed) > scale(best) { narrowed } else { best })
}

/// Exact quarter turn, of at most two, at which a hull fits into a page at the largest scale.
pub(crate) fn best_quarter(hull: &[DVec2], room: DVec2) -> DVec2 {
    let scale = |turn: DVec2| largest_scale(size_of(hull, turn), room);
    if scale(QUARTERS[1]) > scale(QUARTERS[0]) { QUARTERS[1] } else { QUARTERS[0] }
}

/// Largest scale at which a box fits into a room. Infinite for a point.
pub(crate) fn largest_scale(size: DVec2, room: DVec2) -> f64 {
    let ratio = |room: f64, side: f64| if side > 0.0 { room / side } else { f64::INFINITY };
    ratio(room.x, size.x).min(ratio(room.y, size.y))
}

/// Turn with the tangent of half of its angle equal to a parameter; 0 to 1 gives 0° to 90°. Needs no library
/// function, so it is the same on every machine.
fn turn_at(parameter: f64) -> DVec2 {
    let square = parameter * parameter;
    DVec2::new(1.0 - square, 2.0 * parameter) / (1.0 + square)
}
