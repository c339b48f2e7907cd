//! Verdict on the texture coordinates of a mesh file.

use super::{MeshFile, TextureError, TextureMesh};
use freebound_core::mesh::{FaceId, TriMesh};
use freebound_core::verify::{LayoutOptions, LayoutVerdict, PlaneLayout, layout_verdict};

/// Texture coordinates of a file with their verdict.
#[derive(Clone, Debug)]
pub struct JudgedLayout {
    /// Mesh with one vertex for each texture coordinate.
    pub texture: TextureMesh,
    /// Material of each face of the file. Absent if the file has no materials or they do not count.
    pub labels: Option<Vec<u32>>,
    /// Verdict with findings. Faces have their numbers in the file.
    pub verdict: LayoutVerdict,
}

impl MeshFile {
    /// Judges the texture coordinates of the file. Faces of different materials may overlap, unless `across_materials`
    /// is true.
    ///
    /// # Errors
    ///
    /// [`TextureError`] if the file has no texture coordinates.
    pub fn judged_layout(&self, options: LayoutOptions, across_materials: bool) -> Result<JudgedLayout, TextureError> {
        let (texture, bare_faces) = self.partial_texture_mesh()?;
        let labels = self.material_labels().ok().filter(|_| !across_materials);
        let groups = labels.as_ref().map(|labels| groups_of(labels, &texture.mesh)).unwrap_or_default();
        let coordinates = &texture.embedding;
        let layout = PlaneLayout { mesh: &texture.mesh, coordinates, groups: &groups, bare_faces: &bare_faces };
        let verdict = layout_verdict(layout, options);
        Ok(JudgedLayout { texture, labels, verdict })
    }
}

/// Material of each triangle. `labels` has the material of each face of the file.
pub fn groups_of(labels: &[u32], mesh: &TriMesh) -> Vec<u32> {
    (0..mesh.face_count()).map(|face| labels[mesh.polygon(FaceId::from_index(face)) as usize]).collect()
}
