//! Mesh files of any format: what is kept of one, and the way in.
//!
//! | file      | what it holds                                                                        |
//! |-----------|--------------------------------------------------------------------------------------|
//! | `mod`     | what is kept of a file                                                               |
//! | `read`    | reads a file of any format, with progress                                            |
//! | `format`  | the formats, told by a file's beginning and by its name                              |
//! | `memory`  | the memory that it takes to read a file, before it is read                            |
//! | `source`  | the bytes that a mesh was read from, and how the mesh has changed since              |
//! | `error`   | what can be wrong with a file, with line or byte, fault and remedy                   |
//! | `labels` | what tells faces apart: materials and groups                                      |
//! | `texture` | the mesh of the texture coordinates: the surface cut in the plane                    |
//! | `layout`  | the texture coordinates as an embedding of the mesh, to go on from                     |
//! | `refined` | a file's mesh with new vertices                                                      |
//! | `words`   | the words of a text, with their lines                                                |
//! | `off`     | OFF files                                                                            |
//! | `stl`     | STL files, their triangles joined where they meet                                    |
//!
//! A file is kept as its bytes, which OBJ and PLY files are written back from with other texture coordinates and not
//! another byte changed; and as what they say: positions, polygons, texture coordinates and the statements among the faces.

mod error;
mod format;
mod labels;
mod layout;
mod memory;
mod off;
mod read;
mod refined;
mod source;
mod stl;
mod texture;
mod words;

use std::borrow::Cow;

use glam::DVec2;

use freebound_core::mesh::{PolygonMesh, Repaired, TriMesh, VertexId};
use freebound_core::problem::Embedding;

pub(crate) use error::{FaultPlace, fault_at, fault_in};
pub use error::{MAX_PARSE_FAULTS, ParseFault, ParseFaultKind, ReadError, TextureError};
pub use labels::LabelError;
pub use layout::LayoutError;
pub use memory::{MemoryShortage, check_memory, memory_to_read};
pub use read::{ReadProgress, read_mesh, read_mesh_with, read_stream, read_stream_with};
pub use refined::{Refined, RefinedChart};
pub use source::Source;
pub(crate) use source::SourceFormat;
pub use texture::TextureMesh;
pub(crate) use words::TokenWords;

/// Stands in [`Texture::corners`] where a corner has no texture coordinate.
pub const NO_TEXTURE: u32 = u32::MAX;

/// A mesh with what else is kept of its file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshFile {
    /// Positions and faces.
    pub polygons: PolygonMesh,
    /// Texture coordinates, where at least one corner has one.
    pub texture: Option<Texture>,
    /// Names, groups, smoothing and materials of an OBJ file, in file order.
    pub statements: Vec<Statement>,
    /// What it was read from. Where it is written in the same format, this is written, with no other statements than its
    /// own.
    pub source: Option<Source>,
}

/// Texture coordinates, and which of them each corner has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Texture {
    /// As the file lists them.
    pub coordinates: Vec<DVec2>,
    /// One index into `coordinates` for each corner of `polygons.corners`, or [`NO_TEXTURE`].
    pub corners: Vec<u32>,
}

impl Texture {
    /// One coordinate per vertex, at all corners there; none where there are no coordinates.
    pub fn per_vertex(polygons: &PolygonMesh, coordinates: &Embedding) -> Self {
        if coordinates.is_empty() {
            return Self::default();
        }
        let corners = polygons.corners.iter().map(|vertex| vertex.number()).collect();
        Self { coordinates: coordinates.to_vec(), corners }
    }

    /// One coordinate per vertex of a repaired mesh, at the corners of the mesh as given. Faces that were left out have
    /// none.
    pub fn of_repaired(repaired: &Repaired, source: &PolygonMesh, coordinates: &Embedding) -> Self {
        let number = |vertex: Option<VertexId>| vertex.map_or(NO_TEXTURE, VertexId::number);
        let corners = repaired.vertices_at_corners(source).into_iter().map(number).collect();
        // What fills holes stands behind.
        Self { coordinates: coordinates[..repaired.polygons().positions.len()].to_vec(), corners }
    }
}

/// An `o`, `g`, `s`, `usemtl` or `mtllib` line of an OBJ file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Statement {
    /// It stands before this face.
    pub before_face: u32,
    /// The line without blanks around it; any encoding.
    pub text: Vec<u8>,
}

impl Statement {
    /// The first word.
    pub fn keyword(&self) -> &[u8] {
        self.split().0
    }

    /// What follows the first word, as far as it is UTF-8.
    pub fn argument(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(self.split().1.trim_ascii())
    }

    fn split(&self) -> (&[u8], &[u8]) {
        self.text.split_at(self.text.iter().position(u8::is_ascii_whitespace).unwrap_or(self.text.len()))
    }
}

impl MeshFile {
    /// Whether the numbers in its file have 32 bits, of 1 − v in place of v.
    pub fn is_turned_over(&self) -> bool {
        self.source.as_ref().is_some_and(|source| matches!(source.format, SourceFormat::Gltf(_)))
    }

    /// The same mesh with every polygon run around the other way, from the same first corner.
    #[must_use = "the mesh itself stays as it is"]
    pub fn turned(&self) -> Self {
        let mut turned = Self { polygons: self.polygons.turned(), ..self.clone() };
        if let Some(texture) = &mut turned.texture {
            texture.corners = self.polygons.turned_at_corners(&texture.corners);
        }
        turned
    }
}

impl From<&TriMesh> for MeshFile {
    fn from(mesh: &TriMesh) -> Self {
        Self { polygons: mesh.into(), ..Self::default() }
    }
}
