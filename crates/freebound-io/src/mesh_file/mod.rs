//! Mesh files of any format: reading, and the contents kept of a file.
//!
//! | file      | contents                                                                             |
//! |-----------|--------------------------------------------------------------------------------------|
//! | `mod`     | contents kept of a file                                                              |
//! | `read`    | reader of files of any format, with progress                                         |
//! | `format`  | formats, recognised by a file's beginning and by its name                            |
//! | `memory`  | estimate of the memory for reading a file                                            |
//! | `source`  | the bytes that a mesh was read from, and changes of the mesh since then              |
//! | `error`   | errors of reading, with line or byte, fault and remedy                               |
//! | `labels`  | labels of faces: materials and groups                                                |
//! | `texture` | mesh over the texture coordinates: the surface as it is cut in the plane             |
//! | `layout`  | texture coordinates as an embedding of the mesh, to continue from                    |
//! | `refined` | mesh of a file with new vertices                                                     |
//! | `words`   | words of a text, with their lines                                                    |
//! | `off`     | OFF files                                                                            |
//! | `stl`     | STL files, with equal corners joined to vertices                                     |
//!
//! A file is kept in two forms. Its bytes are the basis for writing OBJ, PLY and glTF files with other texture
//! coordinates and nothing else changed. Its contents are positions, polygons, texture coordinates, and the
//! statements between the faces.

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
use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use freebound_core::mesh::{PolygonMesh, Repaired, TriMesh, VertexId};
use freebound_core::problem::Embedding;

pub(crate) use error::{FaultPlace, fault_at, fault_in};
pub use error::{MAX_PARSE_FAULTS, ParseFault, ParseFaultKind, ReadError, ReadWarning, ReadWarningKind, TextureError};
pub(crate) use format::is_gltf;
pub use labels::{LabelError, NamedGroups};
pub use layout::LayoutError;
pub use memory::{MemoryShortage, check_memory, memory_to_read};
pub use read::{Instances, ReadOptions, ReadProgress, read_mesh, read_mesh_with, read_stream, read_stream_with};
pub use refined::{Refined, RefinedChart};
pub use source::Source;
pub(crate) use source::SourceFormat;
pub use texture::TextureMesh;
pub(crate) use texture::coordinate_key;
pub(crate) use words::TokenWords;

/// Value in [`Texture::corners`] for a corner without a texture coordinate.
pub const NO_TEXTURE: u32 = u32::MAX;

/// Mesh with the other contents kept of its file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshFile {
    /// Positions and faces.
    pub polygons: PolygonMesh,
    /// Texture coordinates, if at least one corner has one.
    pub texture: Option<Texture>,
    /// Names, groups, smoothing and materials of an OBJ file, in file order.
    pub statements: Vec<Statement>,
    /// Origin of the mesh. A writer of its format starts from it, and writes its own statements instead of
    /// `statements`.
    pub source: Option<Source>,
    /// Elements of the file that were left out, or that were read once for several places.
    pub warnings: Vec<ReadWarning>,
}

/// Texture coordinates, and their assignment to corners.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Texture {
    /// Coordinates in the order of the file.
    pub coordinates: Vec<DVec2>,
    /// Index into `coordinates` for each corner of `polygons.corners`, or [`NO_TEXTURE`].
    pub corners: Vec<u32>,
}

impl Texture {
    /// Texture with one coordinate per vertex, at all its corners. Empty if there are no coordinates.
    pub fn per_vertex(polygons: &PolygonMesh, coordinates: &Embedding) -> Self {
        if coordinates.is_empty() {
            return Self::default();
        }
        let corners = polygons.corners.iter().map(|vertex| vertex.number()).collect();
        Self { coordinates: coordinates.to_vec(), corners }
    }

    /// Edges of polygons along which the texture is cut: their two sides have different coordinates. Each edge is listed
    /// once, its lower vertex first.
    ///
    /// # Panics
    ///
    /// If the texture has fewer corners than the polygons.
    pub fn seams(&self, polygons: &PolygonMesh) -> Vec<[VertexId; 2]> {
        let key = |place: usize| self.coordinates.get(self.corners[place] as usize).copied().map(coordinate_key);
        let mut ends = BTreeMap::new();
        let mut seams = BTreeSet::new();
        for face in 0..polygons.face_count() {
            let range = polygons.corner_range(face);
            for place in range.clone() {
                let next = if place + 1 == range.end { range.start } else { place + 1 };
                let [tail, head] = [place, next].map(|place| (polygons.corners[place], key(place)));
                let [low, high] = if tail.0 <= head.0 { [tail, head] } else { [head, tail] };
                let edge = [low.0, high.0];
                if *ends.entry(edge).or_insert([low.1, high.1]) != [low.1, high.1] {
                    seams.insert(edge);
                }
            }
        }
        seams.into_iter().collect()
    }

    /// Texture with one coordinate per vertex of a repaired mesh, at the corners of the mesh before the repair. Faces
    /// that were left out have none.
    pub fn of_repaired(repaired: &Repaired, source: &PolygonMesh, coordinates: &Embedding) -> Self {
        let number = |vertex: Option<VertexId>| vertex.map_or(NO_TEXTURE, VertexId::number);
        let corners = repaired.vertices_at_corners(source).into_iter().map(number).collect();
        // Coordinates of hole fillings come after those of the vertices.
        Self { coordinates: coordinates[..repaired.polygons().positions.len()].to_vec(), corners }
    }
}

/// An `o`, `g`, `s`, `usemtl` or `mtllib` line of an OBJ file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Statement {
    /// Face that the statement precedes.
    pub before_face: u32,
    /// Line without surrounding blanks; any encoding.
    pub text: Vec<u8>,
}

impl Statement {
    /// First word of the line.
    pub fn keyword(&self) -> &[u8] {
        self.split().0
    }

    /// Rest of the line after the first word. Invalid UTF-8 is replaced.
    pub fn argument(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(self.split().1.trim_ascii())
    }

    fn split(&self) -> (&[u8], &[u8]) {
        self.text.split_at(self.text.iter().position(u8::is_ascii_whitespace).unwrap_or(self.text.len()))
    }
}

impl MeshFile {
    /// True if the mesh was read from glTF, which stores 32-bit numbers, and 1 − v instead of v.
    pub fn is_turned_over(&self) -> bool {
        self.source.as_ref().is_some_and(|source| matches!(source.format, SourceFormat::Gltf(_)))
    }

    /// Mesh with every polygon reversed, starting from its first corner.
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
        PolygonMesh::from(mesh).into()
    }
}

impl From<PolygonMesh> for MeshFile {
    fn from(polygons: PolygonMesh) -> Self {
        Self { polygons, ..Self::default() }
    }
}
