//! Triangle sides grouped by edge, for any mesh, manifold or not.
//!
//! Sides are sorted into buckets by their lower vertex (a counting sort), then within each short bucket by the higher
//! vertex. Time: linear on ordinary meshes.

use crate::parallel::prelude::*;

use super::VertexId;

/// Number of vertices whose buckets one task sorts.
const VERTICES_PER_TASK: usize = 16_384;

/// Sides of triangles by undirected edge. Side `3 f + k` runs from corner `k` of triangle `f` to the next corner.
#[derive(Clone, Debug, Default)]
pub struct EdgeTable {
    /// All sides, grouped by edge; ascending within an edge.
    sides: Vec<u32>,
    /// Start of each edge's sides, and the end of the last edge.
    starts: Vec<u32>,
}

pub(super) fn side_ends(triangles: &[[VertexId; 3]], side: u32) -> (VertexId, VertexId) {
    let (face, corner) = (side as usize / 3, side as usize % 3);
    (triangles[face][corner], triangles[face][(corner + 1) % 3])
}

impl EdgeTable {
    /// Groups the sides of triangles over `vertex_count` vertices. Sides with equal ends form edges too.
    ///
    /// # Panics
    ///
    /// If a triangle names a vertex beyond the last.
    pub fn new(vertex_count: usize, triangles: &[[VertexId; 3]]) -> Self {
        let side_count = u32::try_from(3 * triangles.len()).expect("a mesh has fewer than 2^32 sides");
        Self::of_sides(vertex_count, side_count, |side| side_ends(triangles, side))
    }

    /// Groups the sides of arbitrary polygons by their ends.
    pub(super) fn of_sides(
        vertex_count: usize,
        side_count: u32,
        ends: impl Fn(u32) -> (VertexId, VertexId) + Sync,
    ) -> Self {
        let low = |side: u32| ends(side).0.min(ends(side).1).index();
        let high = |side: u32| ends(side).0.max(ends(side).1);
        let mut bucket_end = vec![0_u32; vertex_count + 1];
        for side in 0..side_count {
            bucket_end[low(side) + 1] += 1;
        }
        for v in 0..vertex_count {
            bucket_end[v + 1] += bucket_end[v];
        }
        let mut sides = vec![0_u32; side_count as usize];
        let mut cursor = bucket_end.clone();
        for side in 0..side_count {
            let place = &mut cursor[low(side)];
            sides[*place as usize] = side;
            *place += 1;
        }
        let starts = sort_buckets(&mut sides, &bucket_end, high);
        Self { sides, starts }
    }

    /// Number of undirected edges.
    pub fn edge_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// Sides of each edge.
    pub fn edges(&self) -> impl Iterator<Item = &[u32]> {
        self.starts.windows(2).map(|w| &self.sides[w[0] as usize..w[1] as usize])
    }
}

/// Sorts the sides of each bucket by their higher vertex. Returns the start of each edge's sides, and the end of the
/// last.
fn sort_buckets(sides: &mut [u32], bucket_end: &[u32], high: impl Fn(u32) -> VertexId + Sync) -> Vec<u32> {
    let (mut rest, mut tasks) = (sides, Vec::new());
    for first in (0..bucket_end.len() - 1).step_by(VERTICES_PER_TASK) {
        let ends = &bucket_end[first..=(first + VERTICES_PER_TASK).min(bucket_end.len() - 1)];
        let own = rest.split_off_mut(..(ends[ends.len() - 1] - ends[0]) as usize);
        tasks.push((ends, own.expect("buckets follow each other")));
    }
    let of_task = |(ends, own): (&[u32], &mut [u32])| {
        let mut starts = Vec::new();
        for pair in ends.windows(2) {
            let bucket = &mut own[(pair[0] - ends[0]) as usize..(pair[1] - ends[0]) as usize];
            bucket.sort_unstable_by_key(|&side| (high(side), side));
            for (offset, pair) in (pair[0] + 1..).zip(bucket.windows(2)) {
                if high(pair[0]) != high(pair[1]) {
                    starts.push(offset);
                }
            }
            if !bucket.is_empty() {
                starts.push(pair[1]);
            }
        }
        starts
    };
    let mut starts = vec![vec![0]];
    starts.extend(tasks.into_par_iter().map(of_task).collect::<Vec<_>>());
    starts.concat()
}

/// Numbers edges by their lower halfedge. Returns the edge of each halfedge, and the lower halfedge of each edge.
pub(super) fn number_edges(twin: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let mut edge = vec![0_u32; twin.len()];
    let mut halfedge_of_edge = Vec::with_capacity(twin.len() / 2);
    for (h, &other) in (0_u32..).zip(twin) {
        if h < other {
            edge[h as usize] = u32::try_from(halfedge_of_edge.len()).expect("an edge fits");
            edge[other as usize] = edge[h as usize];
            halfedge_of_edge.push(h);
        }
    }
    (edge, halfedge_of_edge)
}

/// Returns an outgoing halfedge per vertex. At a boundary vertex, this is its given side along the boundary, which
/// begins its fan.
pub(super) fn first_of_fans(triangles: &[[VertexId; 3]], side_along_boundary: &[u32]) -> Vec<u32> {
    let mut first = vec![u32::MAX; side_along_boundary.len()];
    for side in (0..u32::try_from(3 * triangles.len()).expect("a side fits")).rev() {
        let (tail, _) = side_ends(triangles, side);
        let along = side_along_boundary[tail.index()];
        if along == u32::MAX || along == side {
            first[tail.index()] = side;
        }
    }
    first
}
