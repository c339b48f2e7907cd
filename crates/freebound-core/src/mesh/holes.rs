//! Holes of a surface, filled with *virtual* faces, which belong to no face of the file.
//!
//! Virtual faces follow all real faces. The faces of one hole are consecutive and share one number, [`FIRST_HOLE`] or
//! higher; real faces have the number of their polygon. A refinement that splits a face keeps its number, so virtual
//! faces remain recognisable there.

use std::collections::BTreeMap;

use super::polygons::outer_sides;
use super::{DiskMesh, EdgeId, FaceId, TriMesh, VertexId};

/// Polygon number of the first hole, beyond all faces of a file, whose corners are fewer than 2^32.
pub const FIRST_HOLE: u32 = 1 << 31;

/// Hole filled with virtual faces.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hole {
    /// Indices of the virtual faces.
    pub faces: std::ops::Range<usize>,
    /// Vertices around the hole, the lowest first, in the direction of its faces.
    pub rim: Vec<VertexId>,
}

impl TriMesh {
    /// Number of triangles that belong to faces of the file. The virtual triangles follow them.
    pub fn real_face_count(&self) -> usize {
        self.polygon_of.as_ref().map_or(self.face_count(), |of| of.partition_point(|&number| number < FIRST_HOLE))
    }

    /// Triangles that belong to faces of the file.
    pub fn real_triangles(&self) -> &[[VertexId; 3]] {
        &self.triangles[..self.real_face_count()]
    }

    /// Filled holes, in the order of their numbers.
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

/// Vertices around triangles that form a disk.
fn rim(triangles: &[[VertexId; 3]]) -> Vec<VertexId> {
    let next: BTreeMap<VertexId, VertexId> =
        outer_sides(triangles).into_iter().map(|[tail, head]| (tail, head)).collect();
    let first = next.keys().next().copied();
    let after = |vertex: &VertexId| next.get(vertex).copied().filter(|&head| Some(head) != first);
    std::iter::successors(first, after).collect()
}

impl DiskMesh {
    /// Faces that belong to faces of the file.
    pub fn real_faces(&self) -> impl ExactSizeIterator<Item = FaceId> + Clone + use<> {
        (0..self.mesh().real_face_count()).map(FaceId::from_index)
    }

    /// True if a face fills a hole.
    pub fn is_virtual(&self, face: FaceId) -> bool {
        self.mesh().polygon(face) >= FIRST_HOLE
    }

    /// True if all faces of a vertex fill holes.
    pub fn is_virtual_vertex(&self, vertex: VertexId) -> bool {
        self.is_used(vertex) && self.outgoing(vertex).filter_map(|h| self.face_of(h)).all(|face| self.is_virtual(face))
    }

    /// True if all faces of an edge fill holes.
    pub fn is_virtual_edge(&self, edge: EdgeId) -> bool {
        let first = self.halfedge(edge);
        [first, self.twin(first)].into_iter().filter_map(|h| self.face_of(h)).all(|face| self.is_virtual(face))
    }

    /// Vertices of virtual faces, ascending.
    pub fn vertices_at_holes(&self) -> Vec<VertexId> {
        let mut found = self.mesh().triangles[self.mesh().real_face_count()..].concat();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Vertices that belong to virtual faces only, ascending.
    pub fn virtual_vertices(&self) -> Vec<VertexId> {
        let mut found = self.vertices_at_holes();
        found.retain(|&vertex| self.is_virtual_vertex(vertex));
        found
    }

    /// Number of vertices without those that belong to virtual faces only.
    pub fn real_vertex_count(&self) -> usize {
        self.vertex_count() - self.virtual_vertices().len()
    }
}
