//! Data of a mesh file that a written mesh file does not hold.

use glam::{DVec3, DVec4};

use crate::corner_data::{CornerData, at_vertices, normals_of_vertices};
use crate::file_data::FileData;
use crate::mesh_file::{MeshFile, ReadWarning, ReadWarningKind, SourceFormat, Texture};
use crate::output::OutputKind;
use freebound_core::mesh::VertexId;

impl MeshFile {
    /// Data of this file that a mesh of the given kind with these texture coordinates does not hold, in the order of
    /// [`FileData`]. The coordinates are computed only if they matter.
    pub(crate) fn not_kept_in(&self, kind: OutputKind, texture: impl FnOnce() -> Texture) -> Vec<FileData> {
        let Some(source) = &self.source else { return Vec::new() };
        let mut found = match &source.format {
            SourceFormat::Obj if kind != OutputKind::Obj => self.data_of_obj(kind),
            SourceFormat::Gltf(_) if kind == OutputKind::Glb && self.has_texture(&texture()) => Vec::new(),
            SourceFormat::Gltf(scene) if kind == OutputKind::Glb => scene.texture_data(),
            SourceFormat::Gltf(scene) => scene.data(),
            SourceFormat::Obj | SourceFormat::Ply(_) => Vec::new(),
        };
        found.extend(self.values_not_kept_in(kind));
        let shares = |warning: &ReadWarning| {
            matches!(warning.kind, ReadWarningKind::SharedInstances | ReadWarningKind::RepeatedNodes)
        };
        if kind != OutputKind::Glb && self.warnings.iter().any(shares) {
            found.push(FileData::Copies);
        }
        found.sort_unstable();
        found
    }

    /// Normals and colours that a file of this kind does not hold, as it has one for each vertex, or no alpha.
    fn values_not_kept_in(&self, kind: OutputKind) -> Vec<FileData> {
        let format = self.source.as_ref().map(|source| &source.format);
        let is_carried = match kind {
            OutputKind::Ply => matches!(format, Some(SourceFormat::Ply(_))),
            OutputKind::Obj => matches!(format, Some(SourceFormat::Obj)),
            _ => true,
        };
        if is_carried {
            return Vec::new();
        }
        let data = CornerData::of(self);
        let has_several = |normals: &Vec<DVec3>| normals_of_vertices(&self.polygons, normals).is_none();
        let is_opaque = |colour: &DVec4| colour.w >= 1.0;
        let loses_colours = |colours: &Vec<DVec4>| {
            let first = at_vertices(&self.polygons, colours, DVec4::ONE);
            let is_first = |(vertex, colour): (&VertexId, &DVec4)| first[vertex.index()] == *colour;
            let has_alpha = kind == OutputKind::Obj && !colours.iter().all(is_opaque);
            has_alpha || !self.polygons.corners.iter().zip(colours).all(is_first)
        };
        let normals = kind == OutputKind::Ply && data.normals.as_ref().is_some_and(has_several);
        let colours = data.colours.as_ref().is_some_and(loses_colours);
        let found = [(FileData::Normals, normals), (FileData::Colours, colours)];
        found.into_iter().filter_map(|(data, is_lost)| is_lost.then_some(data)).collect()
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
