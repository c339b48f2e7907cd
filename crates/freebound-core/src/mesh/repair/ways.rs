//! Shortest ways along the edges of a mesh (Dijkstra 1959), and what an edge costs a cut.
//!
//! A cut shows where the picture breaks off. It costs its length, less where the surface has a crease, and more where it looks to
//! the front, along +z, where figures have their faces:
//!
//! ```text
//! cost = length · (CREASED + (1 − CREASED) · (1 + n₁·n₂)/2) · (1 + FRONT · max(0, n_z))
//! ```
//!
//! with n₁ and n₂ the normals of the edge's faces and n their mean.
//!
//! A seam that a person draws has a measure of its own, which `paths.rs` gives.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::sides::Sides;
use crate::mesh::{PolygonMesh, VertexId};

/// What is left of the cost of an edge whose faces lie back to back.
const CREASED: f64 = 0.1;

/// The same for a seam that a person draws along creases alone.
const CREASED_SEAM: f64 = 0.05;

/// Angle between two faces' normals, in radians, from which on the edge between them is as sharp as can be: 90°.
const SHARP: f64 = std::f64::consts::FRAC_PI_2;

/// By how much the cost of an edge grows that looks straight to the front.
const FRONT: f64 = 4.0;

/// Edges as ways between vertices, in the order of the edges of the sides.
#[derive(Debug)]
pub(super) struct Ways {
    /// Length and cost of each edge.
    edges: Vec<Edge>,
    /// Edges at each vertex, one after the other.
    at: Vec<u32>,
    /// Where the edges of each vertex begin, and the end of the last.
    starts: Vec<u32>,
}

/// An edge as a way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) ends: [VertexId; 2],
    length: f64,
    pub(super) cost: f64,
    /// How sharp its crease is, from 0 to 1.
    sharpness: f64,
}

/// What is sought to be short.
#[derive(Clone, Copy)]
pub(super) enum Measure {
    Length,
    Cost,
    /// Length, less along creases by a share from 0 to 1.
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

/// How far vertices are, and the edge towards where the way began; none there, or where no way leads.
#[derive(Debug)]
pub(super) struct Reach {
    pub(super) far: Vec<f64>,
    pub(super) back: Vec<Option<u32>>,
}

impl Ways {
    pub(super) fn new(polygons: &PolygonMesh, sides: &Sides<'_>) -> Self {
        let normals: Vec<DVec3> = (0..polygons.face_count()).map(|face| normal(polygons, face)).collect();
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

    /// The edges at a vertex.
    pub(super) fn at(&self, vertex: VertexId) -> &[u32] {
        &self.at[self.starts[vertex.index()] as usize..self.starts[vertex.index() + 1] as usize]
    }

    /// The end of an edge that is not this one.
    pub(super) fn other_end(&self, edge: u32, vertex: VertexId) -> VertexId {
        let [a, b] = self.edges[edge as usize].ends;
        if a == vertex { b } else { a }
    }

    /// The shortest ways from some vertices to all others.
    pub(super) fn reach(&self, from: impl Iterator<Item = VertexId>, by: Measure) -> Reach {
        let mut far = vec![f64::INFINITY; self.starts.len() - 1];
        let mut back = vec![None; far.len()];
        let mut queue = BinaryHeap::new();
        // Numbers that are not negative are ordered as their bits are.
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
    /// The edges of the way to a vertex, from there back.
    pub(super) fn way_to<'a>(&'a self, vertex: VertexId, ways: &'a Ways) -> impl Iterator<Item = u32> + 'a {
        let mut at = vertex;
        std::iter::from_fn(move || {
            let edge = self.back[at.index()]?;
            at = ways.other_end(edge, at);
            Some(edge)
        })
    }

    /// The vertex that is farthest by length, the first of several. One whose ways cost more than they are long, because they
    /// go across the front, counts as nearer by as much. `cost` is how far vertices are by cost.
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

/// How sharp the crease between two faces is by their normals: in proportion to the angle, up to 1. A face without area has none.
fn sharpness(first: DVec3, last: DVec3) -> f64 {
    if first == DVec3::ZERO || last == DVec3::ZERO {
        return 0.0;
    }
    (first.cross(last).length().atan2(first.dot(last)) / SHARP).min(1.0)
}

/// The normal of a face, of length 1 or 0.
pub(super) fn normal(polygons: &PolygonMesh, face: usize) -> DVec3 {
    let corners = polygons.face(face);
    let origin = polygons.positions[corners[0].index()];
    let from_origin = |v: VertexId| polygons.positions[v.index()] - origin;
    corners.windows(2).map(|pair| from_origin(pair[0]).cross(from_origin(pair[1]))).sum::<DVec3>().normalize_or_zero()
}
