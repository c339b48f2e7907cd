//! Flat mesh: the layout as geometry in the plane z = 0.

use std::path::Path;

use glam::DVec2;

use super::finite::check_finite;
use super::{
    MeshFile, NO_TEXTURE, Output, OutputKind, Precision, Texture, TexturedMesh, WriteError, write_atomically,
    write_glb, write_obj, write_ply,
};
use freebound_core::flatten::true_area_factor;
use freebound_core::mesh::{PolygonMesh, VertexId};
use freebound_core::problem::Embedding;

impl Output<'_> {
    /// The layout as polygons in the plane z = 0, with its texture coordinates. There is one vertex per texture
    /// coordinate, and the polygons are those of the file that are flattened. All charts together have the area of their
    /// surfaces.
    fn flat_polygons(&self) -> (PolygonMesh, Texture) {
        // Faces that are left out keep the coordinates of the file. Without these, they have none.
        let bare = MeshFile { texture: None, ..self.source.clone() };
        let TexturedMesh { mesh, texture, .. } = super::charts::textured(&self.charts, &bare, self.repaired);
        let factor = self.flat_scale();
        let place = |uv: &DVec2| (factor * *uv * DVec2::new(self.aspect, 1.0)).extend(0.0);
        let mut flat = PolygonMesh {
            positions: texture.coordinates.iter().map(place).collect(),
            corners: Vec::new(),
            starts: mesh.polygons.starts.as_ref().map(|_| vec![0]),
        };
        for face in 0..mesh.polygons.face_count() {
            let corners = &texture.corners[mesh.polygons.corner_range(face)];
            if corners.contains(&NO_TEXTURE) {
                continue;
            }
            flat.corners.extend(corners.iter().map(|&corner| VertexId::new(corner)));
            if let Some(starts) = &mut flat.starts {
                // There are no more corners than in the file.
                starts.push(u32::try_from(flat.corners.len()).unwrap_or(u32::MAX));
            }
        }
        let corners = flat.corners.iter().map(|vertex| vertex.number()).collect();
        (flat, Texture { coordinates: texture.coordinates, corners })
    }

    /// Factor by which all charts together get the area of their surfaces.
    fn flat_scale(&self) -> f64 {
        let (mut surface, mut plane) = (0.0, 0.0);
        for chart in &self.charts {
            let flat: Embedding = chart.coordinates.iter().map(|uv| uv * DVec2::new(self.aspect, 1.0)).collect();
            let factor = true_area_factor(chart.mesh, &flat);
            let area = chart.mesh.area();
            if factor.is_finite() && factor > 0.0 {
                (surface, plane) = (surface + area, plane + area / (factor * factor));
            }
        }
        let factor = (surface / plane).sqrt();
        if factor.is_finite() && factor > 0.0 { factor } else { 1.0 }
    }

    /// Writes the flat mesh atomically: PLY or GLB if the name ends so, else OBJ.
    ///
    /// # Errors
    ///
    /// If the file cannot be written, or coordinates are not finite; the error names the file.
    pub fn write_flat_mesh(&self, path: &Path) -> Result<(), WriteError> {
        let (polygons, texture) = self.flat_polygons();
        let (mesh, texture) = (MeshFile::from(polygons), &texture);
        check_finite(&texture.coordinates).map_err(|source| WriteError::writing(path, source))?;
        write_atomically(path, |out| match OutputKind::of_mesh(path) {
            OutputKind::Ply => write_ply(out, &mesh, texture, Precision::F64),
            OutputKind::Glb => write_glb(out, &mesh, texture),
            _ => write_obj(out, &mesh, texture),
        })
    }
}
