//! Edges of a mesh that seams usually follow.

use super::Model;
use freebound_core::mesh::{VertexId, borders, creases, splits};
use freebound_io::LabelError;

/// Edges for seams, by the file's vertices. Each edge appears once, in ascending order.
impl Model {
    /// Default angle from which an edge is sharp, degrees. Corners exceed it; facets of curved surfaces do not.
    pub const SHARP_DEGREES: f64 = 60.0;

    /// Edges whose face normals differ by at least `degrees`. The angle is 0 in a plane.
    pub fn crease_edges(&self, degrees: f64) -> Vec<[VertexId; 2]> {
        creases(&self.source.polygons, self.prepared.form.repair, degrees)
    }

    /// Edges at which repairs have joined vertices: where a program has split the mesh.
    pub fn split_edges(&self) -> Vec<[VertexId; 2]> {
        splits(&self.source.polygons, self.prepared.form.repair)
    }

    /// Edges between faces of different materials.
    ///
    /// # Errors
    ///
    /// [`LabelError`] if the file has no materials.
    pub fn material_borders(&self) -> Result<Vec<[VertexId; 2]>, LabelError> {
        self.source.material_labels().map(|labels| borders(&self.source.polygons, self.prepared.form.repair, &labels))
    }

    /// Edges between faces of different groups or objects.
    ///
    /// # Errors
    ///
    /// [`LabelError`] if the file has no groups and no objects.
    pub fn group_borders(&self) -> Result<Vec<[VertexId; 2]>, LabelError> {
        self.source.group_labels().map(|labels| borders(&self.source.polygons, self.prepared.form.repair, &labels))
    }
}
