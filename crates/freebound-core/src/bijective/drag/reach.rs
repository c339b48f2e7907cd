//! Which vertices move with a dragged pin: the nearest ones on the sheet.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::mesh::{DiskMesh, VertexId};
use crate::problem::Embedding;

/// What an edge counts beside its length, in mean edges: where a sheet is crushed, many edges make a way.
const HOP: f64 = 0.25;

/// The vertices of a sheet by their distance from some of them, along edges; found as far as they are asked for.
#[derive(Debug)]
pub(super) struct Reach {
    hop: f64,
    ahead: BinaryHeap<Reverse<Ahead>>,
    is_reached: Vec<bool>,
    reached: Vec<VertexId>,
}

/// A vertex with a distance that it has at most. Bits of numbers that are not negative have the numbers' order.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Ahead {
    distance: u64,
    vertex: VertexId,
}

impl Reach {
    /// Around these vertices, on a sheet with edges of such a mean length.
    pub(super) fn new(mesh: &DiskMesh, from: &[VertexId], mean_edge: f64) -> Self {
        let begin = |&vertex: &VertexId| Reverse(Ahead { distance: 0, vertex });
        Self {
            hop: HOP * mean_edge,
            ahead: from.iter().map(begin).collect(),
            is_reached: vec![false; mesh.vertex_count()],
            reached: Vec::new(),
        }
    }

    /// The nearest vertices, so many or all.
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
