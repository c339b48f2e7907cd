//! Edges of a mesh that seams follow as a rule.

use super::Model;
use freebound_core::mesh::{VertexId, borders, creases};
use freebound_io::LabelError;

/// Edges for seams, by the file's vertices, each edge once, in their order.
impl Model {
    /// From which angle on an edge is sharp where nobody says so, degrees: corners are, and the facets of round things are not.
    pub const SHARP_DEGREES: f64 = 60.0;

    /// The edges whose faces meet at an angle of so many degrees or more between their normals: 0 where they lie in one plane.
    pub fn crease_edges(&self, degrees: f64) -> Vec<[VertexId; 2]> {
        creases(&self.source.polygons, self.prepared.form.repair, degrees)
    }

    /// The edges between faces of different materials.
    ///
    /// # Errors
    ///
    /// Where the file gives its faces no materials.
    pub fn material_borders(&self) -> Result<Vec<[VertexId; 2]>, LabelError> {
        self.source.material_labels().map(|labels| borders(&self.source.polygons, self.prepared.form.repair, &labels))
    }

    /// The edges between faces of different groups, or of different objects.
    ///
    /// # Errors
    ///
    /// Where the file has none.
    pub fn group_borders(&self) -> Result<Vec<[VertexId; 2]>, LabelError> {
        self.source.group_labels().map(|labels| borders(&self.source.polygons, self.prepared.form.repair, &labels))
    }
}
