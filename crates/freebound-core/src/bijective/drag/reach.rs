//! Neighbourhood of dragged pins: the nearest vertices of the embedding.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::mesh::{DiskMesh, VertexId};
use crate::problem::Embedding;

/// Cost of an edge beside its length, in mean edges. In crushed regions a path of many edges is therefore long.
const HOP: f64 = 0.25;

/// Vertices by distance from some sources along edges, found on demand (Dijkstra).
#[derive(Debug)]
pub(super) struct Reach {
    hop: f64,
    ahead: BinaryHeap<Reverse<Ahead>>,
    is_reached: Vec<bool>,
    reached: Vec<VertexId>,
}

/// Vertex with an upper bound of its distance. The bits of non-negative numbers are ordered like the numbers.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Ahead {
    distance: u64,
    vertex: VertexId,
}

impl Reach {
    /// Starts from the sources `from`, in an embedding with this mean edge length.
    pub(super) fn new(mesh: &DiskMesh, from: &[VertexId], mean_edge: f64) -> Self {
        let begin = |&vertex: &VertexId| Reverse(Ahead { distance: 0, vertex });
        Self {
            hop: HOP * mean_edge,
            ahead: from.iter().map(begin).collect(),
            is_reached: vec![false; mesh.vertex_count()],
            reached: Vec::new(),
        }
    }

    /// Nearest `count` vertices, or all.
    pub(super) fn nearest(&mut self, mesh: &DiskMesh, sheet: &Embedding, count: usize) -> &[VertexId] {
        while self.reached.len() < count
            && let Some(Reverse(Ahead { distance, vertex })) = self.ahead.pop()
        {
            if std::mem::replace(&mut self.is_reached[vertex.index()], true) {
                continue;
            }
            self.reached.push(vertex);
            for head in mesh.outgoing(vertex).map(|halfedge| mesh.head(halfedge)) {
                if !self.is_reached[head.index()] {
                    let along = f64::from_bits(distance) + sheet[vertex].distance(sheet[head]) + self.hop;
                    self.ahead.push(Reverse(Ahead { distance: along.to_bits(), vertex: head }));
                }
            }
        }
        &self.reached[..count.min(self.reached.len())]
    }
}
