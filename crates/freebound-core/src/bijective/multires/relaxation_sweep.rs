//! Relaxation sweeps: vertices move one after another to where their own triangles are least distorted.
//!
//! Vertices that are put back find room between others that were placed without them. The resulting distortion is
//! local, and local moves remove it at a small fraction of the cost of a Newton step of all vertices.

use crate::parallel::prelude::*;
use glam::DVec2;

use super::place::{Room, resistance};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::Embedding;

/// Newton steps per vertex in one sweep.
const STEPS: usize = 1;

/// Data of the sweeps over one disk.
pub(super) struct Sweeps<'a> {
    disk: &'a DiskMesh,
    /// Length in the plane per length in space.
    scale: f64,
    /// Movable vertices by colour; no two vertices of one list are neighbours.
    colours: Vec<Vec<VertexId>>,
}

impl<'a> Sweeps<'a> {
    /// Colours all interior vertices that are not held.
    pub(super) fn new(disk: &'a DiskMesh, is_held: impl Fn(VertexId) -> bool, scale: f64) -> Self {
        let mut colours: Vec<Vec<VertexId>> = Vec::new();
        let mut colour_of = vec![usize::MAX; disk.vertex_count()];
        let moves =
            |vertex: &VertexId| disk.is_used(*vertex) && disk.boundary_place(*vertex).is_none() && !is_held(*vertex);
        for vertex in disk.vertices().filter(moves) {
            let is_taken =
                |colour: &usize| disk.outgoing(vertex).any(|side| colour_of[disk.head(side).index()] == *colour);
            let colour = (0..colours.len()).find(|colour| !is_taken(colour)).unwrap_or(colours.len());
            colour_of[vertex.index()] = colour;
            if colour == colours.len() {
                colours.push(Vec::new());
            }
            colours[colour].push(vertex);
        }
        Self { disk, scale, colours }
    }

    /// Moves each vertex once. The faces of `embedding` must be positive, and stay positive.
    pub(super) fn sweep(&self, embedding: &mut Embedding) {
        for vertices in &self.colours {
            let moved: Vec<DVec2> =
                vertices.par_iter().with_min_len(64).map(|&vertex| self.moved(vertex, embedding)).collect();
            for (&vertex, z) in vertices.iter().zip(moved) {
                embedding[vertex] = z;
            }
        }
    }

    fn moved(&self, vertex: VertexId, embedding: &Embedding) -> DVec2 {
        let neighbours: Vec<VertexId> = self.disk.outgoing(vertex).map(|side| self.disk.head(side)).collect();
        let polygon: Vec<DVec2> = neighbours.iter().map(|&v| embedding[v]).collect();
        let count = neighbours.len();
        let element = |k: usize| {
            let corners = [vertex, neighbours[k], neighbours[(k + 1) % count]];
            resistance(self.disk.shape(corners), [k, (k + 1) % count], self.scale)
        };
        let elements: Vec<_> = (0..count).map(element).collect();
        Room { polygon: &polygon, elements: &elements }.improved(embedding[vertex], STEPS)
    }
}
