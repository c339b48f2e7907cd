//! Polygons over shared vertices: a mesh as a file gives it.

use glam::DVec3;

use super::{TriMesh, VertexId};

/// A list of polygons over shared vertices, kept whole so that it can be written back as it was read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolygonMesh {
    /// One position per vertex, mesh units.
    pub positions: Vec<DVec3>,
    /// Corners of all polygons, one after the other.
    pub corners: Vec<VertexId>,
    /// `None` where every polygon is a triangle; otherwise where each polygon's corners begin, and the end of the last.
    pub starts: Option<Vec<u32>>,
}

impl PolygonMesh {
    /// Number of polygons.
    pub fn face_count(&self) -> usize {
        self.starts.as_ref().map_or(self.corners.len() / 3, |starts| starts.len().saturating_sub(1))
    }

    /// Places of a polygon's corners in `corners`.
    pub fn corner_range(&self, polygon: usize) -> std::ops::Range<usize> {
        match &self.starts {
            None => 3 * polygon..3 * polygon + 3,
            Some(starts) => starts[polygon] as usize..starts[polygon + 1] as usize,
        }
    }

    /// Corners of one polygon, in file order.
    pub fn face(&self, polygon: usize) -> &[VertexId] {
        &self.corners[self.corner_range(polygon)]
    }
}

impl From<&TriMesh> for PolygonMesh {
    fn from(mesh: &TriMesh) -> Self {
        Self { positions: mesh.positions.clone(), corners: mesh.triangles.concat(), starts: None }
    }
}
