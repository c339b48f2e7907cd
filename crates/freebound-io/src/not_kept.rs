//! Data of a mesh file that a written mesh file does not hold.

use glam::DVec3;

use crate::corner_data::{CornerData, normals_of_vertices};
use crate::file_data::FileData;
use crate::mesh_file::{MeshFile, ReadWarning, ReadWarningKind, SourceFormat, Texture};
use crate::output::OutputKind;

impl MeshFile {
    /// Data of this file that a mesh of the given kind with these texture coordinates does not hold, in the order of
    /// [`FileData`].
    pub(crate) fn not_kept_in(&self, kind: OutputKind, texture: &Texture) -> Vec<FileData> {
        let Some(source) = &self.source else { return Vec::new() };
        let mut found = match &source.format {
            SourceFormat::Obj if kind != OutputKind::Obj => self.data_of_obj(kind),
            SourceFormat::Gltf(_) if kind == OutputKind::Glb && self.has_texture(texture) => Vec::new(),
            SourceFormat::Gltf(scene) if kind == OutputKind::Glb => scene.texture_data(),
            SourceFormat::Gltf(scene) => scene.data(),
            SourceFormat::Obj | SourceFormat::Ply(_) => Vec::new(),
        };
        if kind == OutputKind::Ply && !self.has_normals_of_vertices() {
            found.push(FileData::Normals);
        }
        let shares = |warning: &ReadWarning| warning.kind == ReadWarningKind::SharedInstances;
        if kind != OutputKind::Glb && self.warnings.iter().any(shares) {
            found.push(FileData::Copies);
        }
        found.sort_unstable();
        found
    }

    /// True if no vertex has several normals, so that a PLY file holds them.
    fn has_normals_of_vertices(&self) -> bool {
        let is_of_ply = self.source.as_ref().is_some_and(|source| matches!(source.format, SourceFormat::Ply(_)));
        let has = |normals: Vec<DVec3>| normals_of_vertices(&self.polygons, &normals).is_some();
        is_of_ply || CornerData::of(self).normals.is_none_or(has)
    }

    /// True if all corners have the texture coordinates of the file.
    fn has_texture(&self, texture: &Texture) -> bool {
        let at = |of: &Texture, corner: usize| of.coordinates.get(of.corners[corner] as usize).copied();
        let is_as_read = |own: &Texture| {
            let corners = 0..own.corners.len();
            own.corners.len() == texture.corners.len() && corners.into_iter().all(|k| at(own, k) == at(texture, k))
        };
        self.texture.as_ref().is_some_and(is_as_read)
    }

    /// Data of an OBJ file that files of another kind do not hold. GLB files hold the materials.
    fn data_of_obj(&self, kind: OutputKind) -> Vec<FileData> {
        let has = |keywords: &[&[u8]]| self.statements.iter().any(|line| keywords.contains(&line.keyword()));
        let materials = (kind != OutputKind::Glb && has(&[b"usemtl", b"mtllib"])).then_some(FileData::Materials);
        materials.into_iter().chain(has(&[b"o", b"g"]).then_some(FileData::Names)).collect()
    }
}
