//! What the paths are to match: a triangulation of the targets and of the frame's corners around them.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::geom::{Orientation, delaunay_triangles, orientation};

/// A Delaunay triangulation whose vertices are the targets, followed by the corners of the frame.
#[derive(Debug)]
pub(super) struct TargetGraph {
    pub(super) points: Vec<DVec2>,
    /// Ends of each edge, the lower number first.
    pub(super) edges: Vec<[u32; 2]>,
    number_of_edge: BTreeMap<[u32; 2], u32>,
    /// Neighbours of each vertex, counter-clockwise; of a frame corner from the side that leaves to the one that comes.
    neighbours: Vec<Vec<u32>>,
}

impl TargetGraph {
    /// Triangulates targets and frame. `None` where targets coincide, or lie too near for the triangulation.
    pub(super) fn new(targets: &[DVec2], frame: &[DVec2]) -> Option<Self> {
        let points: Vec<DVec2> = targets.iter().chain(frame).copied().collect();
        let triangles = delaunay_triangles(&points)?;
        let is_positive = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|corner| points[corner as usize]);
            orientation(a, b, c) == Some(Orientation::CounterClockwise)
        };
        if !triangles.iter().all(is_positive) {
            return None;
        }
        let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let mut edges: Vec<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        let number_of_edge = edges.iter().copied().zip(0..).collect();
        let neighbours = neighbours(points.len(), &triangles);
        Some(Self { points, edges, number_of_edge, neighbours })
    }

    pub(super) fn edge_between(&self, a: u32, b: u32) -> Option<u32> {
        self.number_of_edge.get(&[a.min(b), a.max(b)]).copied()
    }

    /// Neighbours of a vertex in their order around it, from the one after `first` until `first` again.
    pub(super) fn neighbours_after(&self, vertex: u32, first: u32) -> impl DoubleEndedIterator<Item = u32> + '_ {
        let all = &self.neighbours[vertex as usize];
        let at = all.iter().position(|&other| other == first).unwrap_or(0);
        (1..=all.len()).map(move |step| all[(at + step) % all.len()])
    }
}

/// Neighbours of each vertex in their order around it.
fn neighbours(count: usize, triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let mut after: Vec<BTreeMap<u32, u32>> = vec![BTreeMap::new(); count];
    for &[a, b, c] in triangles {
        for [at, from, to] in [[a, b, c], [b, c, a], [c, a, b]] {
            after[at as usize].insert(from, to);
        }
    }
    let around = |after: &BTreeMap<u32, u32>| {
        let begins = |from: &&u32| !after.values().any(|to| to == *from);
        let first = after.keys().find(begins).or_else(|| after.keys().next()).copied();
        let mut order: Vec<u32> = first.into_iter().collect();
        while let Some(&next) = order.last().and_then(|last| after.get(last)) {
            if Some(next) == first {
                break;
            }
            order.push(next);
        }
        order
    };
    after.iter().map(around).collect()
}
