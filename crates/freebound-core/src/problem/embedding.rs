//! An embedding: the paper's word for planar positions of all vertices.

use std::ops::{Deref, DerefMut, Index, IndexMut};
use std::slice::SliceIndex;

use glam::DVec2;

use super::SolveError;
use crate::geom::Bounds;
use crate::mesh::{DiskMesh, FaceId, TriMesh, VertexId};

/// Planar positions of all vertices of a mesh, in the order of its vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Embedding(Vec<DVec2>);

impl Embedding {
    /// Positions of a face's corners.
    pub fn corners(&self, mesh: &DiskMesh, face: FaceId) -> [DVec2; 3] {
        mesh.face(face).map(|v| self[v])
    }

    /// Positions of the boundary loop's vertices.
    pub fn boundary(&self, mesh: &DiskMesh) -> Vec<DVec2> {
        mesh.boundary_loop().iter().map(|&v| self[v]).collect()
    }

    /// Checks that all positions are finite.
    ///
    /// # Errors
    ///
    /// [`SolveError::OutOfRange`] with the first vertex whose position is not finite.
    pub fn check_finite(&self) -> Result<(), SolveError> {
        match self.iter().position(|z| !z.is_finite()) {
            Some(vertex) => Err(SolveError::OutOfRange { vertex: VertexId::from_index(vertex) }),
            None => Ok(()),
        }
    }

    /// Bounding box of the positions.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.iter().copied())
    }

    /// Embedding of the first points, which are the vertices of a mesh. All later points are virtual vertices.
    pub fn of_mesh(mesh: &DiskMesh, points: &[DVec2]) -> Self {
        Self(points[..mesh.vertex_count()].to_vec())
    }

    /// Embedding from the positions of all vertices but those in holes, which come last: they get the middle of their
    /// hole's rim.
    pub(crate) fn with_holes(mesh: &TriMesh, positions: impl Iterator<Item = DVec2>) -> Self {
        let mut positions: Vec<DVec2> = positions.collect();
        let outside_holes = positions.len();
        positions.resize(mesh.vertex_count(), DVec2::ZERO);
        for hole in mesh.holes() {
            let rim = hole.rim.iter().map(|vertex| positions[vertex.index()]);
            let middle = rim.sum::<DVec2>() / hole.rim.len().max(1) as f64;
            for vertex in mesh.triangles[hole.faces].iter().flatten().filter(|v| v.index() >= outside_holes) {
                positions[vertex.index()] = middle;
            }
        }
        Self(positions)
    }

    /// Moves unreferenced vertices to the first boundary vertex, so that they do not stretch the bounds.
    pub(crate) fn gather_unused(&mut self, mesh: &DiskMesh) {
        if mesh.used_vertex_count() < mesh.vertex_count() {
            let begin = self[mesh.boundary_loop()[0]];
            mesh.vertices().filter(|&vertex| !mesh.is_used(vertex)).for_each(|vertex| self[vertex] = begin);
        }
    }

    /// The list of positions.
    pub fn into_inner(self) -> Vec<DVec2> {
        self.0
    }
}

impl From<Vec<DVec2>> for Embedding {
    fn from(positions: Vec<DVec2>) -> Self {
        Self(positions)
    }
}

impl FromIterator<DVec2> for Embedding {
    fn from_iter<I: IntoIterator<Item = DVec2>>(positions: I) -> Self {
        Self(positions.into_iter().collect())
    }
}

impl Deref for Embedding {
    type Target = [DVec2];

    fn deref(&self) -> &[DVec2] {
        &self.0
    }
}

impl DerefMut for Embedding {
    fn deref_mut(&mut self) -> &mut [DVec2] {
        &mut self.0
    }
}

impl Index<VertexId> for Embedding {
    type Output = DVec2;

    fn index(&self, vertex: VertexId) -> &DVec2 {
        &self.0[vertex.index()]
    }
}

/// Index by reference, for vertices in maps and lists.
impl Index<&VertexId> for Embedding {
    type Output = DVec2;

    fn index(&self, vertex: &VertexId) -> &DVec2 {
        &self.0[vertex.index()]
    }
}

impl IndexMut<VertexId> for Embedding {
    fn index_mut(&mut self, vertex: VertexId) -> &mut DVec2 {
        &mut self.0[vertex.index()]
    }
}

impl<I: SliceIndex<[DVec2]>> Index<I> for Embedding {
    type Output = I::Output;

    fn index(&self, index: I) -> &I::Output {
        &self.0[index]
    }
}

impl<I: SliceIndex<[DVec2]>> IndexMut<I> for Embedding {
    fn index_mut(&mut self, index: I) -> &mut I::Output {
        &mut self.0[index]
    }
}

impl<'a> IntoIterator for &'a Embedding {
    type Item = &'a DVec2;
    type IntoIter = std::slice::Iter<'a, DVec2>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}
