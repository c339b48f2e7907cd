//! The bytes that a mesh was read from, and how the mesh has changed since.

use std::sync::Arc;

use crate::gltf::Scene;
use crate::ply::Header;
use freebound_core::mesh::NewVertex;

/// What a mesh was read from, and how the mesh has changed since.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    pub(crate) format: SourceFormat,
    pub(crate) bytes: Arc<Vec<u8>>,
    /// How many vertices the file has.
    pub(crate) vertex_count: usize,
    /// For each face of the mesh the file's face that it is or is a part of, ascending; `None` where all are as they were.
    face_of: Option<Vec<u32>>,
    /// Vertices that the file does not have, numbered after its own.
    pub(crate) new_vertices: Vec<NewVertex>,
}

/// A format that files can be written back in.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SourceFormat {
    Obj,
    Ply(Arc<Header>),
    /// The bytes are those of its buffers, one behind another.
    Gltf(Arc<Scene>),
}

impl Source {
    /// A file's bytes, of a mesh with so many vertices.
    pub(crate) fn of(format: SourceFormat, bytes: impl Into<Arc<Vec<u8>>>, vertex_count: usize) -> Self {
        Self { format, bytes: bytes.into(), vertex_count, face_of: None, new_vertices: Vec::new() }
    }

    /// The file's face that a face of the mesh is or is a part of.
    pub(crate) fn face_of(&self, face: usize) -> u32 {
        self.face_of.as_ref().map_or_else(|| u32::try_from(face).expect("faces fit"), |faces| faces[face])
    }

    /// How many faces of the mesh are, or are parts of, so many first faces of the file.
    pub(crate) fn faces_before(&self, count: u32) -> usize {
        self.face_of.as_ref().map_or(count as usize, |faces| faces.partition_point(|&face| face < count))
    }

    /// The same file for another mesh: new vertices follow the present ones, and each of its faces is, or is a part of, a
    /// face of the present mesh, `face_of` it, in their order.
    pub(super) fn changed(&self, face_of: &[u32], new_vertices: &[NewVertex]) -> Self {
        Self {
            face_of: Some(face_of.iter().map(|&face| self.face_of(face as usize)).collect()),
            new_vertices: [&self.new_vertices, new_vertices].concat(),
            ..self.clone()
        }
    }
}
