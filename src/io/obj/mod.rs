//! OBJ files: what is kept of one, and the ways in and out.
//!
//! | file           | what it holds                                                           |
//! |----------------|-------------------------------------------------------------------------|
//! | `mod`          | what is kept of a file                                                  |
//! | `read`         | reads a file, with progress                                             |
//! | `lines`        | the lines of a text as pieces of its bytes                              |
//! | `parse`        | lines put together to a mesh                                            |
//! | `line`         | words of a line: numbers and corners                                    |
//! | `format`       | formats that are not read, told by name or by beginning                 |
//! | `error`        | what can be wrong with a file, with line, fault and remedy              |
//! | `texture`      | the mesh of the texture coordinates: the surface cut in the plane       |
//! | `material`     | the files that the materials name                                       |
//! | `refined`      | a file's mesh with new vertices                                         |
//! | `libraries`    | material libraries of a mesh that is written into another folder        |
//! | `beside`       | files that belong to a mesh and lie beside it                           |
//! | `write`        | writes a file that reads back bit for bit                               |
//! | `carried`      | a mesh written as the text that it was read from                        |
//! | `with_picture` | writes a file, its material and its picture side by side                |
//!
//! A file is kept as its text, which is written back with other texture coordinates and not another byte changed; and as
//! what it says: positions, polygons, texture coordinates and the statements among the faces.

mod beside;
mod carried;
mod error;
mod format;
mod libraries;
mod line;
mod lines;
mod material;
mod parse;
mod read;
mod refined;
mod texture;
mod with_picture;
mod write;

use std::borrow::Cow;

use glam::DVec2;

use crate::mesh::{PolygonMesh, Repaired, TriMesh, VertexId};
use crate::solver::Embedding;

pub(in crate::io) use carried::Edits;
pub use carried::SourceText;
pub use error::{MAX_PARSE_FAULTS, ParseFault, ParseFaultKind, ReadError, TextureError};
pub use libraries::{Materials, copies_of_materials};
pub(in crate::io) use libraries::{copy_materials, relocated};
pub use material::{material_files, material_picture};
pub use read::{Progress, read_mesh, read_mesh_with, read_obj, read_obj_with};
pub use refined::refined_obj;
pub use texture::TextureMesh;
pub use write::write_obj;
pub(in crate::io) use write::write_obj_with;

/// Stands in [`Texture::corners`] where a corner has no texture coordinate.
pub const NO_TEXTURE: u32 = u32::MAX;

/// A mesh with what else is kept of an OBJ file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjMesh {
    /// Positions and faces.
    pub polygons: PolygonMesh,
    /// Texture coordinates, where at least one corner has one.
    pub texture: Option<Texture>,
    /// Names, groups, smoothing and materials, in file order.
    pub statements: Vec<Statement>,
    /// The text that it was read from. Where there is one it is what is written, and no other statements than its own.
    pub text: Option<SourceText>,
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
        Self { coordinates: coordinates.to_vec(), corners }
    }
}

/// An `o`, `g`, `s`, `usemtl` or `mtllib` line.
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

impl ObjMesh {
    /// The same mesh with every polygon run around the other way, from the same first corner.
    #[must_use = "the mesh itself stays as it is"]
    pub fn turned(&self) -> Self {
        let mut turned = self.clone();
        for face in 0..self.polygons.face_count() {
            let mut range = self.polygons.corner_range(face);
            range.start += 1;
            turned.polygons.corners[range.clone()].reverse();
            if let Some(texture) = &mut turned.texture {
                texture.corners[range].reverse();
            }
        }
        turned
    }
}

impl From<&TriMesh> for ObjMesh {
    fn from(mesh: &TriMesh) -> Self {
        Self { polygons: mesh.into(), ..Self::default() }
    }
}
