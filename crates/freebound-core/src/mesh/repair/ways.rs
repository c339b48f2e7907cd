//! Shortest paths along the edges of a mesh (Dijkstra 1959), and the cost of cutting an edge.
//!
//! A cut interrupts the texture visibly. Its cost is its length, reduced along creases of the surface, and increased
//! on parts that face the front, +z, where figures have their faces:
//!
//! ```text
//! cost = length · (CREASED + (1 − CREASED) · (1 + n₁·n₂)/2) · (1 + FRONT · max(0, n_z))
//! ```
//!
//! with n₁ and n₂ the normals of the edge's faces and n their mean.
//!
//! Seams that the user draws have a different measure, defined in `paths.rs`.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::sides::Sides;
use crate::mesh::{PolygonMesh, VertexId};

/// Factor of the cost of an edge whose faces lie back to back.
const CREASED: f64 = 0.1;

/// Factor of the cost of a sharp edge for drawn seams with full crease weight.
const CREASED_SEAM: f64 = 0.05;

/// Smallest angle between two faces' normals, in radians, at which an edge counts as fully sharp: 90°.
const SHARP: f64 = std::f64::consts::FRAC_PI_2;

/// Relative increase of the cost of an edge that faces straight to the front.
const FRONT: f64 = 4.0;

/// Graph of a mesh's edges, in the order of the edge table.
#[derive(Debug)]
pub(super) struct Ways {
    /// Ends, length, cost and sharpness of each edge.
    edges: Vec<Edge>,
    /// Edges at each vertex, vertex by vertex.
    at: Vec<u32>,
    /// Start of each vertex's edges in `at`, and the end of the last.
    starts: Vec<u32>,
}

/// Edge of the graph.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) ends: [VertexId; 2],
    length: f64,
    pub(super) cost: f64,
    /// Sharpness of the crease, from 0 to 1.
    sharpness: f64,
}

/// Measure that shortest paths minimise.
#[derive(Clone, Copy)]
pub(super) enum Measure {
    Length,
    Cost,
    /// Length, reduced along creases by a weight from 0 to 1.
    Blend(f64),
}

impl Edge {
    fn measured(&self, by: Measure) -> f64 {
        match by {
            Measure::Length => self.length,
            Measure::Cost => self.cost,
            Measure::Blend(creases) => self.length * (1.0 - creases * (1.0 - CREASED_SEAM) * self.sharpness),
        }
    }
}

/// Distance of each vertex, and the edge from it towards the start. The edge is `None` at the start and at unreachable
/// vertices.
#[derive(Debug)]
pub(super) struct Reach {
    pub(super) far: Vec<f64>,
    pub(super) back: Vec<Option<u32>>,
}

impl Ways {
    pub(super) fn new(polygons: &PolygonMesh, sides: &Sides<'_>) -> Self {
        let normals: Vec<DVec3> = (0..polygons.face_count()).map(|face| polygons.face_normal(face)).collect();
        let edge = |on: &[u32]| {
            let ends = sides.ends(on[0]);
            let [a, b] = ends.map(|v| polygons.positions[v.index()]);
            let length = a.distance(b);
            let of = |side: u32| normals[sides.face[side as usize] as usize];
            let [first, last] = [of(on[0]), of(on[on.len() - 1])];
            let crease = CREASED + (1.0 - CREASED) * f64::midpoint(1.0, first.dot(last));
            let front = (first + last).normalize_or_zero().z.max(0.0);
            let cost = length * crease * (1.0 + FRONT * front);
            Edge { ends, length, cost, sharpness: sharpness(first, last) }
        };
        let edges: Vec<Edge> = sides.table.edges().map(edge).collect();
        let mut starts = vec![0_u32; polygons.positions.len() + 1];
        for end in edges.iter().flat_map(|edge| edge.ends) {
            starts[end.index() + 1] += 1;
        }
        for v in 1..starts.len() {
            starts[v] += starts[v - 1];
        }
        let mut cursor = starts.clone();
        let mut at = vec![0; 2 * edges.len()];
        for (number, edge) in (0..).zip(&edges) {
            for end in edge.ends {
                let place = &mut cursor[end.index()];
                at[*place as usize] = number;
                *place += 1;
            }
        }
        Self { edges, at, starts }
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.starts.len() - 1
    }

    pub(super) fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Edges at a vertex.
    pub(super) fn at(&self, vertex: VertexId) -> &[u32] {
        &self.at[self.starts[vertex.index()] as usize..self.starts[vertex.index() + 1] as usize]
    }

    /// End of an edge other than `vertex`.
    pub(super) fn other_end(&self, edge: u32, vertex: VertexId) -> VertexId {
        let [a, b] = self.edges[edge as usize].ends;
        if a == vertex { b } else { a }
    }

    /// Finds the shortest paths from the given vertices to all others.
    pub(super) fn reach(&self, from: impl Iterator<Item = VertexId>, by: Measure) -> Reach {
        let mut far = vec![f64::INFINITY; self.starts.len() - 1];
        let mut back = vec![None; far.len()];
        let mut queue = BinaryHeap::new();
        // Non-negative floats sort like their bit patterns.
        for vertex in from {
            far[vertex.index()] = 0.0;
            queue.push(Reverse((0_u64, vertex)));
        }
        while let Some(Reverse((bits, vertex))) = queue.pop() {
            if bits != far[vertex.index()].to_bits() {
                continue;
            }
            for &edge in self.at(vertex) {
                let step = self.edges[edge as usize].measured(by);
                let (to, there) = (self.other_end(edge, vertex), far[vertex.index()] + step);
                if there < far[to.index()] {
                    far[to.index()] = there;
                    back[to.index()] = Some(edge);
                    queue.push(Reverse((there.to_bits(), to)));
                }
            }
        }
        Reach { far, back }
    }
}

impl Reach {
    /// Edges of the shortest path to a vertex, listed backwards from it.
    pub(super) fn way_to<'a>(&'a self, vertex: VertexId, ways: &'a Ways) -> impl Iterator<Item = u32> + 'a {
        let mut at = vertex;
        std::iter::from_fn(move || {
            let edge = self.back[at.index()]?;
            at = ways.other_end(edge, at);
            Some(edge)
        })
    }

    /// Returns the farthest vertex by length, the first of several. A vertex whose path costs more than its length,
    /// because it crosses the front, counts as nearer by the ratio of the two. `cost` holds the distances by cost.
    pub(super) fn farthest(&self, cost: &Self) -> VertexId {
        let score = |v: usize| {
            let (far, cost) = (self.far[v], cost.far[v]);
            let share = if cost > far { far / cost } else { 1.0 };
            if far.is_finite() { far * share } else { -1.0 }
        };
        let farther = |best: usize, v: usize| if score(v) > score(best) { v } else { best };
        VertexId::from_index((0..self.far.len()).fold(0, farther))
    }
}

/// Sharpness of the crease between two faces, proportional to the angle between their normals, at most 1. A face
/// without area has no crease.
fn sharpness(first: DVec3, last: DVec3) -> f64 {
    if first == DVec3::ZERO || last == DVec3::ZERO {
        return 0.0;
    }
    (first.cross(last).length().atan2(first.dot(last)) / SHARP).min(1.0)
}
