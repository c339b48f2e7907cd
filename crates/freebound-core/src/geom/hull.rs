//! Convex hull of points by Andrew's monotone chain with the exact predicate; test if a point lies inside a hull.
//!
//! Source: A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979.

use std::cmp::Ordering;

use glam::DVec2;

use super::polygon::is_down;
use super::{Orientation, orientation};

/// Corners of the convex hull as indices into `points`, counter-clockwise from the leftmost, none inside a side.
/// Points that are not finite are skipped. Fewer than three corners are returned if the points span no area.
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

/// True if a point lies strictly inside the convex hull of the others: not on its boundary, and never if the hull
/// has no area. Exact. False if a coordinate is not finite.
///
/// The point is inside exactly if the directions to the others leave no gap of half a turn or more: each direction,
/// followed by the next one counter-clockwise, turns left. Points given in the order of their directions need no
/// sorting; other points are sorted first.
pub fn is_inside_hull(point: DVec2, others: &[DVec2]) -> bool {
    if !point.is_finite() || !others.iter().all(|other| other.is_finite()) {
        return false;
    }
    let turns_left = |a: DVec2, b: DVec2| orientation(point, a, b) == Some(Orientation::CounterClockwise);
    if others.len() > 2 && in_turn(others).all(|[a, b]| turns_left(a, b)) {
        return true;
    }
    // Each point carries the half-turn of its direction: points collinear with `point` share a direction if they
    // share the half-turn.
    let halved = |&other: &DVec2| Some((is_down(point, other)?, other));
    let mut sorted: Vec<(bool, DVec2)> = others.iter().filter_map(halved).collect();
    sorted.sort_by(|a, b| a.0.cmp(&b.0).then_with(|| turn_order(orientation(point, a.1, b.1))));
    let is_same = |a: &(bool, DVec2), b: &(bool, DVec2)| {
        a.0 == b.0 && orientation(point, a.1, b.1) == Some(Orientation::Collinear)
    };
    sorted.dedup_by(|b, a| is_same(a, b));
    sorted.len() > 2 && in_turn(&sorted).all(|[a, b]| turns_left(a.1, b.1))
}

/// Pairs of consecutive items; the last item is paired with the first.
fn in_turn<T: Copy>(all: &[T]) -> impl Iterator<Item = [T; 2]> + '_ {
    all.iter().zip(all.iter().cycle().skip(1)).map(|(&a, &b)| [a, b])
}

/// Counter-clockwise order of two directions of one half-turn, from the orientation of their points.
fn turn_order(turn: Option<Orientation>) -> Ordering {
    match turn {
        Some(Orientation::CounterClockwise) => Ordering::Less,
        Some(Orientation::Clockwise) => Ordering::Greater,
        Some(Orientation::Collinear) | None => Ordering::Equal,
    }
}
