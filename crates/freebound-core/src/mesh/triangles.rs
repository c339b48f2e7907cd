//! Triangles that share vertices: the input of the diagnosis, not yet known to be a disk.

use glam::DVec3;

use super::{FaceId, VertexId};

/// A list of triangles over shared vertices, without any guarantee about connectivity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriMesh {
    /// Position of each vertex, mesh units.
    pub positions: Vec<DVec3>,
    /// Three corners per triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[VertexId; 3]>,
    /// Polygon number of each triangle; `None` if every polygon is a triangle.
    pub polygon_of: Option<Vec<u32>>,
}

impl TriMesh {
    /// Builds a mesh from positions and plain corner numbers.
    pub fn new(positions: Vec<DVec3>, triangles: &[[u32; 3]]) -> Self {
        let triangles = triangles.iter().map(|t| t.map(VertexId::new)).collect();
        Self { positions, triangles, polygon_of: None }
    }

    /// Builds a mesh from arrays: one position per vertex and three vertex numbers per triangle, counter-clockwise
    /// seen from outside.
    pub fn from_arrays(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Self {
        Self::new(positions.iter().copied().map(DVec3::from).collect(), triangles)
    }

    /// Number of vertices, referenced or not.
    pub fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Number of triangles.
    pub fn face_count(&self) -> usize {
        self.triangles.len()
    }

    /// Number in the file of the face that contains a triangle.
    pub fn polygon(&self, face: FaceId) -> u32 {
        self.polygon_of.as_ref().map_or(face.number(), |of| of[face.index()])
    }

    /// Positions of a triangle's corners.
    pub fn corners(&self, face: FaceId) -> [DVec3; 3] {
        self.triangles[face.index()].map(|v| self.positions[v.index()])
    }

    /// Twice the vector area of a triangle; its length is twice the area.
    pub fn double_area_vector(&self, face: FaceId) -> DVec3 {
        let [a, b, c] = self.corners(face);
        (b - a).cross(c - a)
    }

    /// Total area of the surface, square mesh units.
    pub fn area(&self) -> f64 {
        (0..self.face_count()).map(|f| self.double_area_vector(FaceId::from_index(f)).length() / 2.0).sum()
    }
}
