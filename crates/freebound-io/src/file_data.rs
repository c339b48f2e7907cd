//! Kinds of data that a mesh file can hold besides the mesh and its texture coordinates.

/// Data of a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FileData {
    /// Materials and their pictures.
    Materials,
    /// Names of objects, groups, meshes or nodes.
    Names,
    /// Normals, if the format has one for each vertex and a vertex has several.
    Normals,
    /// Colours, if the format has one for each vertex and a vertex has several, or if it has no alpha.
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
