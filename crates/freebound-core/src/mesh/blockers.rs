//! Search tree over polygon corners: does any corner lie in a given triangle?

use std::ops::Range;

use glam::DVec2;

use super::triangulate::turn;

/// Largest number of corners in a leaf.
const LEAF: usize = 8;

/// Binary tree of bounding boxes over corners. Node 1 is the root; node k has the children 2k and 2k + 1. Each node
/// halves the range of its parent.
pub(super) struct Blockers<'a> {
    points: &'a [DVec2],
    /// The corners in the tree, ordered so that every node covers a contiguous range.
    corners: Vec<usize>,
    /// Position of each polygon corner in `corners`; `None` for corners that are absent or removed.
    place: Vec<Option<usize>>,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy)]
struct Node {
    low: DVec2,
    high: DVec2,
    /// Number of corners below the node that were not removed.
    live: usize,
}

impl<'a> Blockers<'a> {
    pub(super) fn new(points: &'a [DVec2], corners: Vec<usize>) -> Self {
        let empty = Node { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY, live: 0 };
        let leaves = corners.len().div_ceil(LEAF).next_power_of_two();
        let mut tree = Self { points, nodes: vec![empty; 2 * leaves], place: vec![None; points.len()], corners };
        tree.build(1, 0..tree.corners.len());
        for (place, &corner) in tree.corners.iter().enumerate() {
            tree.place[corner] = Some(place);
        }
        tree
    }

    fn build(&mut self, node: usize, range: Range<usize>) {
        let (points, is_leaf) = (self.points, self.is_leaf(node));
        let corners = &mut self.corners[range.clone()];
        let low = corners.iter().fold(DVec2::INFINITY, |low, &c| low.min(points[c]));
        let high = corners.iter().fold(DVec2::NEG_INFINITY, |high, &c| high.max(points[c]));
        self.nodes[node] = Node { low, high, live: corners.len() };
        if is_leaf {
            return;
        }
        let axis = usize::from(high.y - low.y > high.x - low.x);
        let middle = corners.len() / 2;
        if middle > 0 {
            corners.select_nth_unstable_by(middle, |&a, &b| points[a][axis].total_cmp(&points[b][axis]));
        }
        let [first, second] = halves(range);
        self.build(2 * node, first);
        self.build(2 * node + 1, second);
    }

    fn is_leaf(&self, node: usize) -> bool {
        2 * node >= self.nodes.len()
    }

    /// Removes a corner. Does nothing if the corner is not in the tree.
    pub(super) fn remove(&mut self, corner: usize) {
        let Some(place) = self.place[corner].take() else { return };
        let (mut node, mut range) = (1, 0..self.corners.len());
        self.nodes[node].live -= 1;
        while !self.is_leaf(node) {
            let [first, second] = halves(range);
            (node, range) = if first.contains(&place) { (2 * node, first) } else { (2 * node + 1, second) };
            self.nodes[node].live -= 1;
        }
    }

    /// True if a corner lies inside a counter-clockwise triangle or on its rim, other than at the triangle's corners.
    pub(super) fn any_in(&self, triangle: [DVec2; 3]) -> bool {
        self.any_below(1, 0..self.corners.len(), triangle)
    }

    fn any_below(&self, node: usize, range: Range<usize>, triangle: [DVec2; 3]) -> bool {
        let Node { low, high, live } = self.nodes[node];
        if live == 0 || misses(low, high, triangle) {
            return false;
        }
        if !self.is_leaf(node) {
            let [first, second] = halves(range);
            return self.any_below(2 * node, first, triangle) || self.any_below(2 * node + 1, second, triangle);
        }
        let [a, b, c] = triangle;
        let holds = |p: DVec2| turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
        let live = self.corners[range].iter().filter(|&&corner| self.place[corner].is_some());
        // Corners that coincide with a corner of the triangle (a bridge to a hole) do not count.
        live.map(|&corner| self.points[corner]).any(|p| !triangle.contains(&p) && holds(p))
    }
}

fn halves(range: Range<usize>) -> [Range<usize>; 2] {
    let middle = range.start + range.len() / 2;
    [range.start..middle, middle..range.end]
}

/// True if a box lies beyond one side of a counter-clockwise triangle. Tests the box corner nearest to the inside.
fn misses(low: DVec2, high: DVec2, [a, b, c]: [DVec2; 3]) -> bool {
    let beyond = |[from, to]: [DVec2; 2]| {
        let side = if to.y > from.y { low.x } else { high.x };
        let edge = if to.x > from.x { high.y } else { low.y };
        turn(from, to, DVec2::new(side, edge)) < 0.0
    };
    [[a, b], [b, c], [c, a]].into_iter().any(beyond)
}
