//! All pairs of edges of a closed polygon that meet other than at a shared end. Exact.
//!
//! # What counts
//!
//! Edge i runs from corner i to corner i + 1. Edges that are not next to each other cross where they have any point
//! in common: crossing, touching, overlapping. Edges next to each other cross where they have more than their shared
//! end in common: one folds back onto the other. An edge of length zero has one point; the edges before and behind it
//! then meet there and are not neighbours, so that they cross. Edges with an end that is not finite are left out.
//!
//! # Method
//!
//! A binary tree of bounding boxes over the edges in polygon order: neighbours lie together, so that the boxes are
//! small and nothing needs sorting. Every edge asks the tree for the later edges whose boxes its own box meets.
//! On a boundary of n short edges that is n log n; on edges most of whose boxes overlap (n long parallel edges
//! aslant) it is quadratic, as any method over boxes is. The search ends with the first [`CROSSINGS_LISTED`] pairs: of n
//! random edges nearly a quarter of all pairs cross, and nobody looks at them.

use crate::parallel::prelude::*;
use glam::DVec2;

use super::{Bounds, BoxTree, Orientation, orientation};

/// The most pairs that are looked for, listed in less than a megabyte.
pub const CROSSINGS_LISTED: usize = 100_000;

/// Edges that share the work of one task.
const EDGES_PER_TASK: usize = 256;

/// The most tasks that run side by side before the pairs are counted. Not the number of threads, on which no result may
/// depend.
const TASKS_PER_ROUND: usize = 64;

/// Pairs of crossing edges.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Crossings {
    /// Numbers of edges, the lower first, in ascending order: the first [`CROSSINGS_LISTED`] of all.
    pub pairs: Vec<[u32; 2]>,
    /// Whether there are more than these.
    pub has_more: bool,
}

/// Finds the pairs of edges of a closed polygon that meet other than at a shared end, up to [`CROSSINGS_LISTED`] of them.
///
/// # Panics
///
/// If the polygon has 2³² edges or more.
pub fn crossings(polygon: &[DVec2]) -> Crossings {
    // One more than are listed tells that there are more.
    let mut pairs = first_crossings(polygon, CROSSINGS_LISTED + 1);
    let has_more = pairs.len() > CROSSINGS_LISTED;
    pairs.truncate(CROSSINGS_LISTED);
    Crossings { pairs, has_more }
}

/// Whether no two edges of a closed polygon meet other than at a shared end.
///
/// # Panics
///
/// If the polygon has 2³² edges or more.
pub fn is_simple(polygon: &[DVec2]) -> bool {
    first_crossings(polygon, 1).is_empty()
}

/// The first `most` pairs of all.
fn first_crossings(polygon: &[DVec2], most: usize) -> Vec<[u32; 2]> {
    let edges = Polygon::new(polygon);
    let task_count = polygon.len().div_ceil(EDGES_PER_TASK);
    let mut pairs = Vec::new();
    let (mut round, mut done) = (1, 0);
    while done < task_count && pairs.len() < most {
        let missing = most - pairs.len();
        let of_task = |task: usize| {
            let begin = task * EDGES_PER_TASK;
            let range = begin..(begin + EDGES_PER_TASK).min(polygon.len());
            range.flat_map(|edge| edges.later_crossings(edge)).take(missing).collect()
        };
        let tasks = done..(done + round).min(task_count);
        done = tasks.end;
        // Where nearly all edges cross, the first task alone finds enough.
        round = (2 * round).min(TASKS_PER_ROUND);
        let found: Vec<Vec<[u32; 2]>> = tasks.into_par_iter().map(of_task).collect();
        pairs.extend(found.into_iter().flatten().take(missing));
    }
    pairs
}

/// Whether two closed segments meet: points where their length is zero; none where an end is not finite.
pub fn segments_meet(first: [DVec2; 2], second: [DVec2; 2]) -> bool {
    box_around(first).meets(box_around(second)) && straddles(first, second) && straddles(second, first)
}

/// Whether the ends of a segment do not lie strictly on the same side of a line.
fn straddles(line: [DVec2; 2], segment: [DVec2; 2]) -> bool {
    let side = |point| orientation(line[0], line[1], point);
    let Some(first) = side(segment[0]) else { return false };
    first == Orientation::Collinear || side(segment[1]).is_some_and(|second| second != first)
}

/// Whether the segments from `shared` to `a` and to `b` have more than `shared` in common.
pub fn folds_back(a: DVec2, shared: DVec2, b: DVec2) -> bool {
    // On one line they overlap where both go the same way. Comparing coordinates is exact, subtracting them is not.
    let same_way = |a: f64, shared: f64, b: f64| (a > shared && b > shared) || (a < shared && b < shared);
    orientation(a, shared, b) == Some(Orientation::Collinear)
        && (same_way(a.x, shared.x, b.x) || same_way(a.y, shared.y, b.y))
}

/// The box around a segment, empty where an end is not finite.
fn box_around([a, b]: [DVec2; 2]) -> Bounds {
    if a.is_finite() && b.is_finite() { Bounds::of([a, b]) } else { Bounds::EMPTY }
}

/// A closed polygon, with a tree over its edges.
struct Polygon<'a> {
    corners: &'a [DVec2],
    tree: BoxTree,
}

impl<'a> Polygon<'a> {
    fn new(corners: &'a [DVec2]) -> Self {
        assert!(u32::try_from(corners.len()).is_ok(), "a polygon has fewer than 2^32 edges");
        let boxes = (0..corners.len()).map(|edge| box_around(segment(corners, edge)));
        Self { corners, tree: BoxTree::new(boxes) }
    }

    /// The crossings of an edge with later edges, in ascending order.
    fn later_crossings(&self, edge: usize) -> impl Iterator<Item = [u32; 2]> + '_ {
        let crossing = self.tree.later(edge).filter(move |&later| self.edges_cross(edge, later));
        crossing.map(move |later| [edge, later].map(|e| u32::try_from(e).expect("checked in new")))
    }

    /// Whether two edges, the lower first, whose boxes meet, meet other than at a shared end.
    fn edges_cross(&self, lower: usize, higher: usize) -> bool {
        let [[a, b], [c, d]] = [lower, higher].map(|edge| segment(self.corners, edge));
        // In a triangle the first and the last edge share a corner, as all pairs do.
        if lower + 1 == higher {
            folds_back(a, b, d)
        } else if lower == 0 && higher + 1 == self.corners.len() {
            folds_back(c, a, b)
        } else {
            straddles([a, b], [c, d]) && straddles([c, d], [a, b])
        }
    }
}

fn segment(corners: &[DVec2], edge: usize) -> [DVec2; 2] {
    [corners[edge], corners[(edge + 1) % corners.len()]]
}
