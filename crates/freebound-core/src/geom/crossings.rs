//! Pairs of edges of a closed polygon that meet other than at a shared end. Exact.
//!
//! # Definition
//!
//! Edge i runs from corner i to corner i + 1. Two edges that are not adjacent cross if they have any point in
//! common: crossing, touching, overlapping. Adjacent edges cross if they have more than their shared end in common:
//! one folds back onto the other. An edge of length zero is a single point; the edges before and after it meet there
//! without being adjacent, so they cross. Edges with an end that is not finite are skipped.
//!
//! # Method
//!
//! A binary tree holds the bounding boxes of the edges in polygon order: neighbours lie together, so the boxes are
//! small and nothing needs sorting. Each edge queries the tree for the later edges whose boxes meet its own. A
//! boundary of n short edges takes O(n log n). Edges most of whose boxes overlap (n long parallel slanted edges)
//! take quadratic time, like any method based on boxes. The search ends with the first [`CROSSINGS_LISTED`] pairs:
//! of n random edges nearly a quarter of all pairs cross, more than anybody needs.

use crate::parallel::prelude::*;
use glam::DVec2;

use super::{Bounds, BoxTree, Orientation, orientation};

/// Largest number of pairs listed: less than a megabyte.
pub const CROSSINGS_LISTED: usize = 100_000;

/// Number of edges per task.
const EDGES_PER_TASK: usize = 256;

/// Largest number of parallel tasks between two counts of the pairs. A constant instead of the number of threads, so
/// that no result depends on the number of threads.
const TASKS_PER_ROUND: usize = 64;

/// Pairs of crossing edges.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Crossings {
    /// Edge numbers, the lower first, in ascending order: the first [`CROSSINGS_LISTED`] of all.
    pub pairs: Vec<[u32; 2]>,
    /// True if there are more crossings than [`pairs`](Self::pairs) lists.
    pub has_more: bool,
}

/// Finds the pairs of edges of a closed polygon that meet other than at a shared end, at most [`CROSSINGS_LISTED`].
///
/// # Panics
///
/// If the polygon has 2³² edges or more.
pub fn crossings(polygon: &[DVec2]) -> Crossings {
    // An extra pair shows that there are more than are listed.
    let mut pairs = first_crossings(polygon, CROSSINGS_LISTED + 1);
    let has_more = pairs.len() > CROSSINGS_LISTED;
    pairs.truncate(CROSSINGS_LISTED);
    Crossings { pairs, has_more }
}

/// True if no two edges of a closed polygon meet other than at a shared end.
///
/// # Panics
///
/// If the polygon has 2³² edges or more.
pub fn is_simple(polygon: &[DVec2]) -> bool {
    first_crossings(polygon, 1).is_empty()
}

/// First `most` pairs of crossing edges.
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
        // If nearly all edges cross, the first task alone finds enough.
        round = (2 * round).min(TASKS_PER_ROUND);
        let found: Vec<Vec<[u32; 2]>> = tasks.into_par_iter().map(of_task).collect();
        pairs.extend(found.into_iter().flatten().take(missing));
    }
    pairs
}

/// True if two closed segments meet. A segment of length zero is a point. False if an end is not finite.
pub fn segments_meet(first: [DVec2; 2], second: [DVec2; 2]) -> bool {
    box_around(first).meets(box_around(second)) && straddles(first, second) && straddles(second, first)
}

/// True unless both ends of a segment lie strictly on one side of a line. False if a coordinate is not finite.
fn straddles(line: [DVec2; 2], segment: [DVec2; 2]) -> bool {
    let side = |point| orientation(line[0], line[1], point);
    let Some(first) = side(segment[0]) else { return false };
    first == Orientation::Collinear || side(segment[1]).is_some_and(|second| second != first)
}

/// True if the segments from `shared` to `a` and to `b` have more than `shared` in common.
pub fn folds_back(a: DVec2, shared: DVec2, b: DVec2) -> bool {
    // Collinear segments overlap if both have one direction. Comparing coordinates is exact, subtracting them is
    // not.
    let same_way = |a: f64, shared: f64, b: f64| (a > shared && b > shared) || (a < shared && b < shared);
    orientation(a, shared, b) == Some(Orientation::Collinear)
        && (same_way(a.x, shared.x, b.x) || same_way(a.y, shared.y, b.y))
}

/// Bounding box of a segment; empty if an end is not finite.
fn box_around([a, b]: [DVec2; 2]) -> Bounds {
    if a.is_finite() && b.is_finite() { Bounds::of([a, b]) } else { Bounds::EMPTY }
}

/// Closed polygon with a tree over its edges.
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

    /// Crossings of an edge with later edges, in ascending order.
    fn later_crossings(&self, edge: usize) -> impl Iterator<Item = [u32; 2]> + '_ {
        let crossing = self.tree.later(edge).filter(move |&later| self.edges_cross(edge, later));
        crossing.map(move |later| [edge, later].map(|e| u32::try_from(e).expect("checked in new")))
    }

    /// True if two edges, the lower first, whose boxes meet, meet other than at a shared end.
    fn edges_cross(&self, lower: usize, higher: usize) -> bool {
        let [[a, b], [c, d]] = [lower, higher].map(|edge| segment(self.corners, edge));
        // In a triangle, the first and the last edge share a corner, like all pairs.
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
