//! Relaxation sweeps: vertices move one after another to where their own triangles are least distorted.
//!
//! Vertices that are put back find room between others that were placed without them. The resulting distortion is
//! local, and local moves remove it at a small fraction of the cost of a Newton step of all vertices.
//!
//! A vertex of the boundary moves if it has a very distorted face, within its faces and its triangles of the outside,
//! which are found anew for each sweep: the tip of a face on the boundary is often put back between two sides of a
//! seam that the coarse disk had closed. A move leaves half of the room to what lies opposite.

use crate::parallel::prelude::*;
use glam::DVec2;

use super::place::{Room, SHARE_BEFORE_FOLD, Steps, resistance};
use super::surface::{Ring, Surface};
use crate::mesh::{DiskMesh, VertexId};
use crate::nonlinear::foldover_energy::Element;
use crate::problem::Embedding;

/// Steps of a vertex of the interior in one sweep.
const INTERIOR: Steps = Steps { most: 1, share: SHARE_BEFORE_FOLD };

/// Steps of a vertex of the boundary in one sweep.
const BOUNDARY: Steps = Steps { most: 1, share: 0.5 };

/// Energy from which a face is very distorted. The energy without distortion is 2.
const MUCH_ENERGY: f64 = 10.0;

/// Data of the sweeps over one disk.
pub(super) struct Sweeps<'a> {
    disk: &'a DiskMesh,
    /// Length in the plane per length in space.
    scale: f64,
    /// Movable vertices of the interior by colour; no two vertices of one list are neighbours.
    colours: Vec<Vec<VertexId>>,
    /// Movable vertices of the boundary.
    boundary: Vec<VertexId>,
}

impl<'a> Sweeps<'a> {
    /// Sweeps over all vertices that are not held and belong to no virtual face.
    pub(super) fn new(disk: &'a DiskMesh, is_held: impl Fn(VertexId) -> bool, scale: f64) -> Self {
        let mut colours: Vec<Vec<VertexId>> = Vec::new();
        let mut colour_of = vec![usize::MAX; disk.vertex_count()];
        let mut stays: Vec<bool> = disk.vertices().map(|vertex| !disk.is_used(vertex) || is_held(vertex)).collect();
        for vertex in disk.vertices_at_holes() {
            stays[vertex.index()] = true;
        }
        let boundary = disk.boundary_loop().iter().copied().filter(|vertex| !stays[vertex.index()]).collect();
        let moves = |vertex: &VertexId| !stays[vertex.index()] && disk.boundary_place(*vertex).is_none();
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
        Self { disk, scale, colours, boundary }
    }

    /// Moves each vertex of the interior once, and those of the boundary that have a very distorted face. The faces of
    /// `embedding` must be positive, and stay positive.
    pub(super) fn sweep(&self, embedding: &mut Embedding) {
        self.sweep_interior(embedding, false);
        self.sweep_boundary(embedding);
    }

    /// Moves each vertex that has a very distorted face once. Returns true if any moved. Otherwise like
    /// [`sweep`](Self::sweep).
    pub(super) fn sweep_distorted(&self, embedding: &mut Embedding) -> bool {
        let before = embedding.clone();
        self.sweep_interior(embedding, true);
        self.sweep_boundary(embedding);
        *embedding != before
    }

    fn sweep_interior(&self, embedding: &mut Embedding, only_distorted: bool) {
        for vertices in &self.colours {
            let move_one = |&vertex: &VertexId| {
                let around = Neighbourhood::new(self, vertex, embedding);
                let room = around.room();
                let stays = only_distorted && room.worst(embedding[vertex]) < MUCH_ENERGY;
                if stays { embedding[vertex] } else { room.improved(embedding[vertex], INTERIOR) }
            };
            let moved: Vec<DVec2> = vertices.par_iter().with_min_len(64).map(move_one).collect();
            for (&vertex, z) in vertices.iter().zip(moved) {
                embedding[vertex] = z;
            }
        }
    }

    /// Moves vertices of the boundary within their faces and their triangles of the outside.
    fn sweep_boundary(&self, embedding: &mut Embedding) {
        let is_distorted = |vertex: &VertexId| {
            Neighbourhood::new(self, *vertex, embedding).room().worst(embedding[*vertex]) >= MUCH_ENERGY
        };
        let distorted: Vec<VertexId> = self.boundary.iter().copied().filter(is_distorted).collect();
        if distorted.is_empty() {
            return;
        }
        let mut surface = Surface::new(self.disk, embedding);
        surface.look_around();
        let mut ring = Ring::default();
        for vertex in distorted {
            if !surface.find_ring(vertex.number(), &mut ring) || !ring.is_of_boundary() {
                continue;
            }
            let polygon: Vec<DVec2> = ring.vertices.iter().map(|&v| surface.points[v as usize]).collect();
            let neighbours: Vec<VertexId> = ring.vertices[..=ring.inner].iter().map(|&v| VertexId::new(v)).collect();
            let elements = (0..ring.inner).map(|k| self.element(vertex, &neighbours, k)).collect();
            let z = Neighbourhood { polygon, elements }.room().improved(embedding[vertex], BOUNDARY);
            embedding[vertex] = z;
            surface.points[vertex.index()] = z;
        }
    }

    /// Face of a vertex between two of its neighbours, the one at place `k` and the next.
    fn element(&self, vertex: VertexId, neighbours: &[VertexId], k: usize) -> Element {
        let next = (k + 1) % neighbours.len();
        resistance(self.disk.shape([vertex, neighbours[k], neighbours[next]]), [k, next], self.scale)
    }
}

/// Neighbours of a vertex and its faces.
struct Neighbourhood {
    polygon: Vec<DVec2>,
    elements: Vec<Element>,
}

impl Neighbourhood {
    /// Neighbours and faces on the surface. At the boundary the neighbours do not surround the vertex.
    fn new(sweeps: &Sweeps<'_>, vertex: VertexId, embedding: &Embedding) -> Self {
        let disk = sweeps.disk;
        let faces = disk.outgoing(vertex).filter(|&side| disk.face_of(side).is_some()).count();
        let neighbours: Vec<VertexId> = disk.outgoing(vertex).map(|side| disk.head(side)).collect();
        let polygon = neighbours.iter().map(|&v| embedding[v]).collect();
        Self { polygon, elements: (0..faces).map(|k| sweeps.element(vertex, &neighbours, k)).collect() }
    }

    fn room(&self) -> Room<'_> {
        Room { polygon: &self.polygon, elements: &self.elements }
    }
}
