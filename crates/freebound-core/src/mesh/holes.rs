//! Holes of a surface, filled with *virtual* faces, which are of no face of the file.
//!
//! Virtual faces stand behind all real ones. Those of one hole follow each other and have one number, from
//! [`FIRST_HOLE`] on, where real faces have the number of their polygon. A refinement cuts faces in their place and keeps
//! their numbers: so virtual faces are told from real ones there, too.

use std::collections::BTreeMap;

use super::polygons::outer_sides;
use super::{DiskMesh, EdgeId, FaceId, TriMesh, VertexId};

/// The number of the first hole in the place of a polygon's: beyond all faces of a file, whose corners are fewer than 2^32.
pub const FIRST_HOLE: u32 = 1 << 31;

/// A hole that virtual faces fill.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hole {
    /// The virtual faces.
    pub faces: std::ops::Range<usize>,
    /// The vertices around it, the lowest first, in the direction in which its faces run around.
    pub rim: Vec<VertexId>,
}

impl TriMesh {
    /// How many triangles are parts of the file's faces: all but the virtual ones, which follow.
    pub fn real_face_count(&self) -> usize {
        self.polygon_of.as_ref().map_or(self.face_count(), |of| of.partition_point(|&number| number < FIRST_HOLE))
    }

    /// The triangles that are parts of the file's faces.
    pub fn real_triangles(&self) -> &[[VertexId; 3]] {
        &self.triangles[..self.real_face_count()]
    }

    /// The holes that are filled, in their order.
    pub fn holes(&self) -> Vec<Hole> {
        let mut begin = self.real_face_count();
        let numbers = self.polygon_of.as_ref().map_or(&[][..], |of| &of[begin..]);
        let hole = |run: &[u32]| {
            let faces = begin..begin + run.len();
            begin = faces.end;
            Hole { rim: rim(&self.triangles[faces.clone()]), faces }
        };
        numbers.chunk_by(|a, b| a == b).map(hole).collect()
    }
}

/// The vertices around triangles that make a disk.
fn rim(triangles: &[[VertexId; 3]]) -> Vec<VertexId> {
    let next: BTreeMap<VertexId, VertexId> =
        outer_sides(triangles).into_iter().map(|[tail, head]| (tail, head)).collect();
    let first = next.keys().next().copied();
    let after = |vertex: &VertexId| next.get(vertex).copied().filter(|&head| Some(head) != first);
    std::iter::successors(first, after).collect()
}

impl DiskMesh {
    /// The faces that are parts of the file's.
    pub fn real_faces(&self) -> impl ExactSizeIterator<Item = FaceId> + Clone + use<> {
        (0..self.mesh().real_face_count()).map(FaceId::from_index)
    }

    /// Whether a face only fills a hole.
    pub fn is_virtual(&self, face: FaceId) -> bool {
        self.mesh().polygon(face) >= FIRST_HOLE
    }

    /// Whether all faces of a vertex only fill a hole.
    pub fn is_virtual_vertex(&self, vertex: VertexId) -> bool {
        self.is_used(vertex) && self.outgoing(vertex).filter_map(|h| self.face_of(h)).all(|face| self.is_virtual(face))
    }

    /// Whether an edge lies within a hole.
    pub fn is_virtual_edge(&self, edge: EdgeId) -> bool {
        let first = self.halfedge(edge);
        [first, self.twin(first)].into_iter().filter_map(|h| self.face_of(h)).all(|face| self.is_virtual(face))
    }

    /// The vertices of virtual faces alone, ascending.
    pub fn virtual_vertices(&self) -> Vec<VertexId> {
        let mut found = self.mesh().triangles[self.mesh().real_face_count()..].concat();
        found.sort_unstable();
        found.dedup();
        found.retain(|&vertex| self.is_virtual_vertex(vertex));
        found
    }

    /// How many vertices there are but for those of virtual faces alone.
    pub fn real_vertex_count(&self) -> usize {
        self.vertex_count() - self.virtual_vertices().len()
    }
}
