//! Bytes that a mesh was read from, and the changes of the mesh since then.

use std::sync::Arc;

use crate::gltf::Scene;
use crate::ply::Header;
use freebound_core::mesh::NewVertex;

/// Origin of a mesh, and the changes of the mesh since it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    pub(crate) format: SourceFormat,
    pub(crate) bytes: Arc<Vec<u8>>,
    /// Number of vertices in the file.
    pub(crate) vertex_count: usize,
    /// Face of the file for each face of the mesh, which equals it or is a part of it; ascending. `None` if all faces
    /// are unchanged.
    face_of: Option<Vec<u32>>,
    /// Vertices that the file does not have, numbered after those of the file.
    pub(crate) new_vertices: Vec<NewVertex>,
}

/// Format that files can be written back in.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SourceFormat {
    Obj,
    Ply(Arc<Header>),
    /// The bytes are the concatenated buffers of the file.
    Gltf(Arc<Scene>),
}

impl Source {
    /// Source with the bytes of a file, for a mesh with `vertex_count` vertices.
    pub(crate) fn of(format: SourceFormat, bytes: impl Into<Arc<Vec<u8>>>, vertex_count: usize) -> Self {
        Self { format, bytes: bytes.into(), vertex_count, face_of: None, new_vertices: Vec::new() }
    }

    /// Face of the file that a face of the mesh equals or is a part of.
    pub(crate) fn face_of(&self, face: usize) -> u32 {
        self.face_of.as_ref().map_or_else(|| u32::try_from(face).expect("faces fit"), |faces| faces[face])
    }

    /// Number of faces of the mesh that equal, or are parts of, the first `count` faces of the file.
    pub(crate) fn faces_before(&self, count: u32) -> usize {
        self.face_of.as_ref().map_or(count as usize, |faces| faces.partition_point(|&face| face < count))
    }

    /// Source of a mesh with further vertices.
    pub(crate) fn with_vertices(&self, new_vertices: &[NewVertex]) -> Self {
        Self { new_vertices: [&self.new_vertices, new_vertices].concat(), ..self.clone() }
    }

    /// Source of a changed mesh. New vertices follow the present ones. Each new face equals, or is a part of, the
    /// present face given by `face_of`, in ascending order.
    pub(super) fn changed(&self, face_of: &[u32], new_vertices: &[NewVertex]) -> Self {
        Self {
            face_of: Some(face_of.iter().map(|&face| self.face_of(face as usize)).collect()),
            ..self.with_vertices(new_vertices)
        }
    }
}
