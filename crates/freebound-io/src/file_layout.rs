//! Verdict on the texture coordinates of a mesh file.

use super::{MeshFile, TextureError, TextureMesh};
use freebound_core::mesh::{FaceId, TriMesh};
use freebound_core::problem::Control;
use freebound_core::verify::{LayoutOptions, LayoutVerdict, PlaneLayout, layout_verdict_with};

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

/// Reason why texture coordinates are not judged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum JudgeError {
    /// The file has no usable texture coordinates.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// The caller cancelled.
    #[error("the check was cancelled")]
    Cancelled,
}

impl MeshFile {
    /// Judges the texture coordinates of the file. Faces of different materials may overlap, unless `across_materials`
    /// is true.
    ///
    /// # Errors
    ///
    /// [`JudgeError`] if the file has no usable texture coordinates, or if the caller cancels.
    pub fn judged_layout(
        &self,
        options: LayoutOptions,
        across_materials: bool,
        control: Control<'_>,
    ) -> Result<JudgedLayout, JudgeError> {
        let (texture, bare_faces) = self.partial_texture_mesh()?;
        let labels = self.material_labels().ok().filter(|_| !across_materials);
        let groups = labels.as_ref().map(|labels| groups_of(labels, &texture.mesh)).unwrap_or_default();
        let coordinates = &texture.embedding;
        let layout = PlaneLayout { mesh: &texture.mesh, coordinates, groups: &groups, bare_faces: &bare_faces };
        let mut verdict = layout_verdict_with(layout, options, control).map_err(|_| JudgeError::Cancelled)?;
        // A file that stores 32-bit numbers with v down holds them, whatever 1 − v rounds.
        verdict.planar_in_f32 |= verdict.planar && self.is_turned_over();
        Ok(JudgedLayout { texture, labels, verdict })
    }
}

/// Material of each triangle. `labels` has the material of each face of the file.
pub fn groups_of(labels: &[u32], mesh: &TriMesh) -> Vec<u32> {
    (0..mesh.face_count()).map(|face| labels[mesh.polygon(FaceId::from_index(face)) as usize]).collect()
}
