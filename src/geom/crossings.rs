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
//! aslant) it is quadratic, as any method over boxes is.

use glam::DVec2;
use rayon::prelude::*;

use super::{Orientation, orientation};

/// The greatest number of pairs that [`Crossings::pairs`] lists: what a person or a program can still use, in less
/// than a megabyte. All are counted.
pub const CROSSINGS_LISTED: usize = 100_000;

/// Edges that share the work of one task.
const EDGES_PER_TASK: usize = 512;

/// Pairs of crossing edges.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Crossings {
    /// Numbers of edges, the lower first, in ascending order: the first [`CROSSINGS_LISTED`] of all.
    pub pairs: Vec<[u32; 2]>,
    /// How many there are in all.
    pub count: usize,
}

/// Finds all pairs of edges of a closed polygon that meet other than at a shared end.
///
/// # Panics
///
/// If the polygon has 2³² edges or more.
pub fn crossings(polygon: &[DVec2]) -> Crossings {
    let tree = BoxTree::new(polygon);
    let tasks: Vec<usize> = (0..polygon.len()).step_by(EDGES_PER_TASK).collect();
    let found: Vec<Crossings> = tasks
        .into_par_iter()
        .map(|begin| {
            let mut found = Crossings::default();
            let mut pending = Vec::new();
            for edge in begin..(begin + EDGES_PER_TASK).min(polygon.len()) {
                tree.add_later_crossings(edge, &mut pending, &mut found);
            }
            found
        })
        .collect();
    let count = found.iter().map(|part| part.count).sum();
    let pairs = found.into_iter().flat_map(|part| part.pairs).take(CROSSINGS_LISTED).collect();
    Crossings { pairs, count }
}

/// Whether two closed segments have a point in common. Segments of length zero are points; a segment with an end
/// that is not finite meets nothing.
pub fn segments_meet(first: [DVec2; 2], second: [DVec2; 2]) -> bool {
    Bounds::around(first).meets(Bounds::around(second)) && straddles(first, second) && straddles(second, first)
}

/// Whether the ends of a segment do not lie strictly on the same side of a line.
fn straddles(line: [DVec2; 2], segment: [DVec2; 2]) -> bool {
    let side = |point| orientation(line[0], line[1], point);
    let Some(first) = side(segment[0]) else { return false };
    first == Orientation::Collinear || side(segment[1]).is_some_and(|second| second != first)
}

/// Whether the segments from `shared` to `a` and to `b` have more than `shared` in common.
fn folds_back(a: DVec2, shared: DVec2, b: DVec2) -> bool {
    if orientation(a, shared, b) != Some(Orientation::Collinear) {
        return false;
    }
    // On one line: they overlap where both go the same way. Comparing coordinates is exact, subtracting them is not.
    let same_way = |a: f64, shared: f64, b: f64| (a > shared && b > shared) || (a < shared && b < shared);
    same_way(a.x, shared.x, b.x) || same_way(a.y, shared.y, b.y)
}

/// A closed box with sides along the axes; nothing meets an empty one.
#[derive(Clone, Copy)]
struct Bounds {
    low: DVec2,
    high: DVec2,
}

impl Bounds {
    const EMPTY: Self = Self { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY };

    /// The box around a segment, empty where an end is not finite.
    fn around([a, b]: [DVec2; 2]) -> Self {
        if a.is_finite() && b.is_finite() { Self { low: a.min(b), high: a.max(b) } } else { Self::EMPTY }
    }

    fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn meets(self, other: Self) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
    }
}

/// Boxes over ranges of edges. Node 1 is the root, node k has the children 2k and 2k + 1; the leaves, one an edge,
/// are the last half of the nodes.
struct BoxTree<'a> {
    polygon: &'a [DVec2],
    boxes: Vec<Bounds>,
    leaf_count: usize,
}

impl<'a> BoxTree<'a> {
    fn new(polygon: &'a [DVec2]) -> Self {
        assert!(u32::try_from(polygon.len()).is_ok(), "a polygon has fewer than 2^32 edges");
        let leaf_count = polygon.len().next_power_of_two();
        let mut tree = Self { polygon, boxes: vec![Bounds::EMPTY; 2 * leaf_count], leaf_count };
        for edge in 0..polygon.len() {
            tree.boxes[leaf_count + edge] = Bounds::around(tree.segment(edge));
        }
        for node in (1..leaf_count).rev() {
            tree.boxes[node] = tree.boxes[2 * node].union(tree.boxes[2 * node + 1]);
        }
        tree
    }

    fn segment(&self, edge: usize) -> [DVec2; 2] {
        [self.polygon[edge], self.polygon[(edge + 1) % self.polygon.len()]]
    }

    /// Adds the crossings of an edge with later edges, in ascending order. `pending` is room to work in.
    fn add_later_crossings(&self, edge: usize, pending: &mut Vec<(usize, usize)>, found: &mut Crossings) {
        let bounds = self.boxes[self.leaf_count + edge];
        // Nodes to look at with the end of the range of edges below them; the left child is taken first.
        pending.clear();
        pending.push((1, self.leaf_count));
        while let Some((node, end)) = pending.pop() {
            if end <= edge + 1 || !bounds.meets(self.boxes[node]) {
                continue;
            }
            if node < self.leaf_count {
                let half = self.leaf_count >> (node.ilog2() + 1);
                pending.push((2 * node + 1, end));
                pending.push((2 * node, end - half));
            } else if self.edges_cross(edge, end - 1) {
                found.count += 1;
                if found.pairs.len() < CROSSINGS_LISTED {
                    found.pairs.push([edge, end - 1].map(|e| u32::try_from(e).expect("checked in new")));
                }
            }
        }
    }

    /// Whether two edges, the lower first, whose boxes meet, meet other than at a shared end.
    fn edges_cross(&self, lower: usize, higher: usize) -> bool {
        let ([a, b], [c, d]) = (self.segment(lower), self.segment(higher));
        // In a triangle the first and the last edge share a corner, as all pairs do.
        if lower + 1 == higher {
            folds_back(a, b, d)
        } else if lower == 0 && higher + 1 == self.polygon.len() {
            folds_back(c, a, b)
        } else {
            straddles([a, b], [c, d]) && straddles([c, d], [a, b])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(corners: &[[i32; 2]]) -> Vec<DVec2> {
        corners.iter().map(|&[x, y]| DVec2::new(f64::from(x), f64::from(y))).collect()
    }

    #[test]
    fn a_convex_polygon_has_none() {
        assert_eq!(crossings(&points(&[[0, 0], [4, 0], [4, 3], [2, 5], [0, 3]])), Crossings::default());
    }

    #[test]
    fn corners_in_the_middle_of_a_side_are_no_crossings() {
        assert_eq!(crossings(&points(&[[0, 0], [1, 0], [2, 0], [2, 2], [0, 2], [0, 1]])), Crossings::default());
    }

    #[test]
    fn a_bow_tie_has_one() {
        assert_eq!(crossings(&points(&[[0, 0], [2, 2], [2, 0], [0, 2]])).pairs, [[0, 2]]);
    }

    #[test]
    fn a_corner_that_touches_an_edge_crosses_it_with_both_its_edges() {
        let touching = points(&[[0, 0], [6, 0], [6, 4], [3, 0], [0, 4]]);
        assert_eq!(crossings(&touching).pairs, [[0, 2], [0, 3]]);
    }

    #[test]
    fn two_corners_in_one_place_cross_with_all_their_edges() {
        let pinched = points(&[[0, 0], [2, 2], [4, 0], [4, 4], [2, 2], [0, 4]]);
        assert_eq!(crossings(&pinched).pairs, [[0, 3], [0, 4], [1, 3], [1, 4]]);
    }

    #[test]
    fn edges_that_overlap_cross() {
        let overlapping = points(&[[0, 0], [4, 0], [4, 2], [6, 2], [6, 0], [3, 0], [3, -2], [0, -2]]);
        assert!(crossings(&overlapping).pairs.contains(&[0, 4]));
    }

    #[test]
    fn an_edge_that_folds_back_crosses_its_neighbour() {
        assert_eq!(crossings(&points(&[[0, 0], [4, 0], [2, 0], [2, 3]])).pairs, [[0, 1], [0, 2]]);
        // The same with the spike at the first corner.
        assert_eq!(crossings(&points(&[[4, 0], [2, 0], [2, 3], [0, 0]])).pairs, [[0, 3], [1, 3]]);
    }

    #[test]
    fn an_edge_of_length_zero_lets_its_neighbours_meet() {
        assert_eq!(crossings(&points(&[[0, 0], [4, 0], [4, 0], [0, 4]])).pairs, [[0, 2]]);
        assert_eq!(crossings(&points(&[[0, 0], [4, 0], [4, 0]])).pairs, [[0, 2]]);
    }

    #[test]
    fn corners_that_are_not_finite_take_no_part() {
        let mut bow_tie = points(&[[0, 0], [2, 2], [2, 0], [0, 2]]);
        bow_tie[3].x = f64::NAN;
        assert_eq!(crossings(&bow_tie), Crossings::default());
    }

    #[test]
    fn beyond_the_limit_crossings_are_counted_but_not_listed() {
        // A comb laid over another: 400 teeth across 400 teeth, 4 · 400² pairs at least.
        let teeth = 400;
        let mut corners = Vec::new();
        for tooth in 0..teeth {
            corners.extend([[2 * tooth, -1], [2 * tooth, 2 * teeth], [2 * tooth + 1, 2 * teeth], [2 * tooth + 1, -1]]);
        }
        corners.push([2 * teeth, -1]);
        for tooth in 0..teeth {
            corners.extend([[2 * teeth, 2 * tooth], [-1, 2 * tooth], [-1, 2 * tooth + 1], [2 * teeth, 2 * tooth + 1]]);
        }
        let found = crossings(&points(&corners));
        assert!(found.count >= 4 * 400 * 400, "{}", found.count);
        assert_eq!(found.pairs.len(), CROSSINGS_LISTED);
        assert!(found.pairs.is_sorted());
    }

    #[test]
    fn fewer_than_three_corners_are_no_trouble() {
        assert_eq!(crossings(&[]), Crossings::default());
        assert_eq!(crossings(&points(&[[1, 1]])), Crossings::default());
        assert_eq!(crossings(&points(&[[0, 0], [1, 1]])).pairs, [[0, 1]]);
    }
}
