//! A bounding-volume hierarchy over triangles in space: finds the nearest triangle, and the triangles that may lie in a
//! region.
//!
//! Nodes are split at the median of the centroids along the longest side. Queries cost at most twice those of the
//! best tree, and construction takes a few tens of milliseconds for 100,000 faces. Boxes are in f64, like the mesh.

use glam::DVec3;

/// Largest number of triangles in a leaf.
const LEAF_SIZE: usize = 4;

/// Bounding box of a run of triangles. The first child of an inner node follows it; `skip` is the index after its
/// subtree.
#[derive(Clone, Copy, Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// Index in `order` of the first triangle; `count` triangles follow, none in an inner node.
    first: u32,
    count: u32,
    skip: u32,
}

/// Hierarchy over the triangles of one mesh. Triangles are numbered in the order in which they were given.
#[derive(Clone, Debug)]
pub struct TriangleTree {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

/// Point of a triangle that is nearest to another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPoint {
    /// Number of the triangle.
    pub triangle: u32,
    /// Barycentric weights of the triangle's corners; they sum to 1.
    pub weights: [f64; 3],
    /// Squared distance between the points.
    pub distance_squared: f64,
}

impl TriangleTree {
    /// Builds the hierarchy of triangles given by their corners. Triangles with a corner that is not finite are left
    /// out.
    ///
    /// # Panics
    ///
    /// If there are 2^32 triangles or more.
    pub fn new(triangles: &[[DVec3; 3]]) -> Self {
        let mut entries: Vec<(DVec3, u32)> = triangles
            .iter()
            .zip(0..)
            .filter(|(t, _)| t.iter().all(|p| p.is_finite()))
            .map(|(t, number)| ((t[0] + t[1] + t[2]) / 3.0, number))
            .collect();
        let mut tree = Self { nodes: Vec::with_capacity(entries.len()), order: Vec::new() };
        if !entries.is_empty() {
            tree.split(&mut entries, 0, triangles);
        }
        tree.order = entries.iter().map(|e| e.1).collect();
        tree
    }

    fn split(&mut self, entries: &mut [(DVec3, u32)], first: u32, triangles: &[[DVec3; 3]]) {
        let place = self.nodes.len();
        let corners = || entries.iter().flat_map(|e| triangles[e.1 as usize]);
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let length = u32::try_from(entries.len()).expect("a mesh has fewer than 2^32 faces");
        self.nodes.push(Node { low, high, first, count: length, skip: 0 });
        if entries.len() > LEAF_SIZE {
            self.nodes[place].count = 0;
            let axis = widest_axis(entries);
            let middle = entries.len() / 2;
            entries.select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1)));
            let (left, right) = entries.split_at_mut(middle);
            self.split(left, first, triangles);
            self.split(right, first + u32::try_from(middle).expect("half of a u32"), triangles);
        }
        self.nodes[place].skip = u32::try_from(self.nodes.len()).expect("fewer nodes than faces");
    }

    /// Calls `leaf` for every triangle in a leaf whose box and all ancestor boxes pass `enter`.
    pub fn visit(&self, mut enter: impl FnMut(DVec3, DVec3) -> bool, mut leaf: impl FnMut(u32)) {
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            if !enter(node.low, node.high) {
                at = node.skip as usize;
                continue;
            }
            self.triangles(node).iter().for_each(|&triangle| leaf(triangle));
            at += 1;
        }
    }

    fn triangles(&self, node: &Node) -> &[u32] {
        &self.order[node.first as usize..(node.first + node.count) as usize]
    }

    /// Point of the triangles nearest to `point`. Among equally near triangles the one with the lowest number is found.
    ///
    /// Only triangles that pass `accept` and are no farther than the square root of `limit_squared` are found.
    /// `triangle` returns the corners of a triangle.
    pub fn nearest(
        &self,
        point: DVec3,
        limit_squared: f64,
        triangle: impl Fn(u32) -> [DVec3; 3],
        accept: impl Fn(u32) -> bool,
    ) -> Option<NearestPoint> {
        let (mut best, mut limit) = (None::<NearestPoint>, limit_squared);
        let mut pending = Vec::with_capacity(64);
        pending.extend(self.nodes.first().map(|root| (distance_to_box(root, point), 0)));
        while let Some((distance, at)) = pending.pop() {
            let node = &self.nodes[at];
            if distance > limit {
                continue;
            }
            for &number in self.triangles(node).iter().filter(|&&number| accept(number)) {
                let found = nearest_point(point, triangle(number), number);
                let is_nearer = |best: NearestPoint| {
                    found.distance_squared.total_cmp(&best.distance_squared).then(number.cmp(&best.triangle)).is_lt()
                };
                if found.distance_squared <= limit && best.is_none_or(is_nearer) {
                    (best, limit) = (Some(found), found.distance_squared);
                }
            }
            if node.count == 0 {
                let children = [at + 1, self.nodes[at + 1].skip as usize];
                let mut children = children.map(|child| (distance_to_box(&self.nodes[child], point), child));
                if children[0].0 <= children[1].0 {
                    children.reverse();
                }
                pending.extend(children);
            }
        }
        best
    }
}

fn widest_axis(entries: &[(DVec3, u32)]) -> usize {
    let low = entries.iter().fold(DVec3::INFINITY, |low, e| low.min(e.0));
    let high = entries.iter().fold(DVec3::NEG_INFINITY, |high, e| high.max(e.0));
    (high - low).max_position()
}

/// Squared distance between a point and the box of a node.
fn distance_to_box(node: &Node, point: DVec3) -> f64 {
    point.distance_squared(point.clamp(node.low, node.high))
}

/// Point of a triangle nearest to `point`. Corners are met exactly: a corner has the weight 1.
///
/// The foot of the perpendicular if it lies in the triangle, otherwise the nearest point of the three sides.
pub fn nearest_point(point: DVec3, corners: [DVec3; 3], triangle: u32) -> NearestPoint {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    let from_a = point - a;
    let [of_b, of_c] =
        [from_a.cross(c - a), (b - a).cross(from_a)].map(|area| area.dot(normal) / normal.length_squared());
    let foot = [1.0 - of_b - of_c, of_b, of_c];
    let at = |weights: [f64; 3]| NearestPoint {
        triangle,
        weights,
        distance_squared: point.distance_squared(point_at(corners, weights)),
    };
    // A triangle without area gives NaN, which fails the test.
    if foot.iter().all(|&weight| weight >= 0.0) {
        return at(foot);
    }
    let side = |k: usize| {
        let (tail, head) = (corners[k], corners[(k + 1) % 3]);
        let share = (point - tail).dot(head - tail) / (head - tail).length_squared();
        // A side without length gives NaN.
        let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
        let mut weights = [0.0; 3];
        (weights[k], weights[(k + 1) % 3]) = (1.0 - share, share);
        at(weights)
    };
    let [first, second, third] = [0, 1, 2].map(side);
    let nearer = |a: NearestPoint, b: NearestPoint| if b.distance_squared < a.distance_squared { b } else { a };
    nearer(nearer(first, second), third)
}

/// Point with barycentric weights in a triangle.
pub fn point_at(corners: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]
}
