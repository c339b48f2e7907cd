//! Data of a mesh file that a written mesh file does not hold.

use memchr::memmem::find_iter;

use crate::mesh_file::{MeshFile, ReadWarning, ReadWarningKind, SourceFormat, Texture};
use crate::obj::{Lines, split_mark, words};
use crate::output::OutputKind;

/// Number of words of an OBJ vertex with a colour: keyword, position, colour.
const COLOURED: usize = 7;

/// Data of a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FileData {
    /// Materials and their pictures.
    Materials,
    /// Names of objects, groups, meshes or nodes.
    Names,
    /// Normals of vertices or corners.
    Normals,
    /// Colours of vertices.
    Colours,
    /// Tangents, which follow from texture coordinates.
    Tangents,
    /// Further copies of meshes that nodes of a glTF file share.
    Copies,
}

impl FileData {
    /// Word for messages.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Materials => "materials",
            Self::Names => "names",
            Self::Normals => "normals",
            Self::Colours => "colours",
            Self::Tangents => "tangents",
            Self::Copies => "copies of shared meshes",
        }
    }
}

impl MeshFile {
    /// Data of this file that a mesh of the given kind with these texture coordinates does not hold, in the order of
    /// [`FileData`].
    pub(crate) fn not_kept_in(&self, kind: OutputKind, texture: &Texture) -> Vec<FileData> {
        let Some(source) = &self.source else { return Vec::new() };
        let mut found = match &source.format {
            SourceFormat::Obj if kind == OutputKind::Obj => Vec::new(),
            SourceFormat::Obj => self.data_of_obj(&source.bytes, kind),
            SourceFormat::Ply(_) if kind == OutputKind::Ply => Vec::new(),
            SourceFormat::Ply(header) => header.data(),
            SourceFormat::Gltf(_) if kind == OutputKind::Glb && self.has_texture(texture) => Vec::new(),
            SourceFormat::Gltf(scene) if kind == OutputKind::Glb => scene.texture_data(),
            SourceFormat::Gltf(scene) => scene.data(),
        };
        let shares = |warning: &ReadWarning| warning.kind == ReadWarningKind::SharedInstances;
        if kind != OutputKind::Glb && self.warnings.iter().any(shares) {
            found.push(FileData::Copies);
        }
        found.sort_unstable();
        found
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
    fn data_of_obj(&self, bytes: &[u8], kind: OutputKind) -> Vec<FileData> {
        let has = |keywords: &[&[u8]]| self.statements.iter().any(|line| keywords.contains(&line.keyword()));
        let (_, text) = split_mark(bytes);
        let first_vertex =
            Lines::of(text).map(|line| words(line.whole)).find(|words| words.clone().next() == Some(b"v"));
        [
            (FileData::Materials, kind != OutputKind::Glb && has(&[b"usemtl", b"mtllib"])),
            (FileData::Names, has(&[b"o", b"g"])),
            (FileData::Normals, find_iter(text, b"vn ").any(|at| at == 0 || matches!(text[at - 1], b'\n' | b'\r'))),
            (FileData::Colours, first_vertex.is_some_and(|words| words.count() >= COLOURED)),
        ]
        .into_iter()
        .filter_map(|(data, is_there)| is_there.then_some(data))
        .collect()
    }
}
