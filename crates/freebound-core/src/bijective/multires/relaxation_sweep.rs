//! Relaxation sweeps: vertices move one after another to where their own triangles are least distorted.
//!
//! Vertices that are put back find room between others that were placed without them. The resulting distortion is
//! local, and local moves remove it at a small fraction of the cost of a Newton step of all vertices.
//!
//! After the first sweep, a vertex of the interior moves only if it or a neighbour moved far in the sweep before.
//!
//! A vertex of the boundary moves if it has a very distorted face, within its faces and its triangles of the outside,
//! which are found anew for each sweep: the tip of a face on the boundary is often put back between two sides of a
//! seam that the coarse disk had closed. A move leaves half of the room to what lies opposite, and never narrows a gap
//! to less than a small share of the vertex's edges: sweep after sweep would close it to the last digit.

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

/// Height of a triangle of the outside below which no move narrows it, relative to the shorter edge of the boundary
/// at the vertex.
const GAP: f64 = 1e-2;

/// Move from which a vertex and its neighbours are active, relative to its shortest edge.
const ACTIVE: f64 = 0.02;

/// Most lengths that are tried for a move, each half of the one before, until it narrows no gap too much.
const TRIALS: usize = 4;

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
    /// True for each vertex that may still have far to move: it or a neighbour moved far in the sweep before.
    is_active: Vec<bool>,
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
        Self { disk, scale, colours, boundary, is_active: vec![true; disk.vertex_count()] }
    }

    /// Moves each active vertex of the interior once, and those of the boundary that have a very distorted face. The
    /// faces of `embedding` must be positive, and stay positive.
    pub(super) fn sweep(&mut self, embedding: &mut Embedding) {
        let before = embedding.clone();
        self.sweep_interior(embedding, false);
        self.sweep_boundary(embedding);
        self.find_active(&before, embedding);
    }

    /// Finds the vertices that a sweep moved far, and their neighbours.
    fn find_active(&mut self, before: &Embedding, after: &Embedding) {
        self.is_active.fill(false);
        for vertex in self.disk.vertices().filter(|&vertex| before[vertex] != after[vertex]) {
            let span = |side| after[self.disk.head(side)].distance(after[vertex]);
            let nearest = self.disk.outgoing(vertex).map(span).fold(f64::INFINITY, f64::min);
            if before[vertex].distance(after[vertex]) >= ACTIVE * nearest {
                self.is_active[vertex.index()] = true;
                self.disk.outgoing(vertex).for_each(|side| self.is_active[self.disk.head(side).index()] = true);
            }
        }
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
                if !only_distorted && !self.is_active[vertex.index()] {
                    return embedding[vertex];
                }
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
            let (from, around) = (embedding[vertex], Neighbourhood { polygon, elements });
            let gaps = Gaps { outer: &around.polygon[ring.inner..], first: around.polygon[0], from };
            let z = gaps.kept_open(around.room().improved(from, BOUNDARY));
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

/// Gaps between a vertex of the boundary and what lies opposite: its triangles of the outside.
struct Gaps<'a> {
    /// Neighbours around the outside, from one boundary edge of the vertex on.
    outer: &'a [DVec2],
    /// Neighbour at the other boundary edge.
    first: DVec2,
    /// Position of the vertex before a move.
    from: DVec2,
}

impl Gaps<'_> {
    /// End of a move that narrows no gap too much: the given one, or one nearer to the start, or the start.
    fn kept_open(&self, to: DVec2) -> DVec2 {
        let edge = f64::min(self.from.distance(self.outer[0]), self.from.distance(self.first));
        let least: Vec<f64> = self.heights(self.from).map(|height| height.min(GAP * edge)).collect();
        let trials = (0..TRIALS).scan(1.0, |share, _| Some(std::mem::replace(share, 0.5 * *share)));
        let mut ends = trials.map(|share| self.from.lerp(to, share));
        ends.find(|end| self.heights(*end).zip(&least).all(|(height, least)| height >= *least)).unwrap_or(self.from)
    }

    /// Least height of each triangle of the outside, with the vertex at a position.
    fn heights(&self, z: DVec2) -> impl Iterator<Item = f64> + '_ {
        let next = self.outer[1..].iter().chain([&self.first]);
        self.outer.iter().zip(next).map(move |(a, b)| {
            let longest = z.distance_squared(*a).max(z.distance_squared(*b)).max(a.distance_squared(*b));
            (*a - z).perp_dot(*b - z) / longest.sqrt()
        })
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Least distance from a vertex at `z` to the line opposite, at a height of 1, after sweeps that pull it there.
    fn distance_left(sweeps: usize) -> f64 {
        let outer = [DVec2::new(1.0, 0.0), DVec2::new(2.0, 1.0), DVec2::new(-2.0, 1.0)];
        let mut z = DVec2::ZERO;
        for _ in 0..sweeps {
            let gaps = Gaps { outer: &outer, first: DVec2::new(-1.0, 0.0), from: z };
            // Half of the room to the line opposite, like a sweep.
            z = gaps.kept_open(z + 0.5 * DVec2::new(0.0, 1.0 - z.y));
        }
        1.0 - z.y
    }

    #[test]
    fn sweeps_leave_a_gap_open_however_many_follow() {
        let [few, many] = [3, 60].map(distance_left);
        assert!((few - 0.125).abs() < 1e-12, "{few}");
        // The shorter edge of the boundary is 1 to 1.5 long.
        assert!((GAP..4.0 * GAP).contains(&many), "{many}");
    }

    #[test]
    fn a_sliver_of_the_outside_does_not_let_other_gaps_close() {
        let outer = [(1.0, 0.0), (2.0, 1e-9), (2.0, 2.0), (-0.5, 2.0), (-0.5, -0.4)].map(|(x, y)| DVec2::new(x, y));
        let mut z = DVec2::ZERO;
        for _ in 0..60 {
            let gaps = Gaps { outer: &outer, first: DVec2::new(-1.0, -1.0), from: z };
            z = gaps.kept_open(z + 0.5 * DVec2::new(-0.5 - z.x, 0.0));
        }
        assert!(z.x + 0.5 >= GAP, "{z}");
    }

    #[test]
    fn a_move_that_widens_the_narrowest_gap_is_never_held_back() {
        let outer = [DVec2::new(1.0, 0.0), DVec2::new(2.0, 1.0), DVec2::new(-2.0, 1.0)];
        let from = DVec2::new(0.0, 1.0 - 1e-7);
        let gaps = Gaps { outer: &outer, first: DVec2::new(-1.0, 0.0), from };
        assert_eq!(gaps.kept_open(DVec2::ZERO), DVec2::ZERO);
        assert_eq!(gaps.kept_open(DVec2::new(0.0, 1.0 - 1e-8)), from, "a narrow gap gets no narrower");
    }
}
