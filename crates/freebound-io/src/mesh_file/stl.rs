//! STL files, as text and binary. Their triangles share no vertices, so equal corners are joined to one vertex.
//!
//! Two corners are equal if the bits of their coordinates are, except that −0 equals 0. Vertices are numbered by
//! first use. Normals and attributes are ignored.
//!
//! A binary file has a header of 80 arbitrary bytes and the number of triangles. Each triangle is a normal, three
//! corners, and two bytes. Numbers have 32 bits, in little-endian order.

use std::collections::HashMap;

use glam::DVec3;

use super::{FaultPlace, MeshFile, ParseFaultKind, ReadError, TokenWords, fault_at};
use crate::obj::quoted;
use freebound_core::mesh::{PolygonMesh, VertexId};

/// Offset of the first triangle, bytes.
const HEAD: usize = 84;

/// Size of a triangle, and offset of its corners, bytes.
const TRIANGLE: usize = 50;
const CORNERS: usize = 12;

/// True if a file that begins with `head` is a binary STL file: all its triangles (or at least 1000) are there, with
/// finite corners.
pub(super) fn is_binary_stl(head: &[u8]) -> bool {
    let Some(count) = triangle_count(head) else { return false };
    let triangles = head[HEAD..].chunks_exact(TRIANGLE).take(count);
    let are_there = triangles.len() == count || head.len() > HEAD + TRIANGLE * 1000;
    count > 0 && are_there && triangles.into_iter().all(|triangle| corners_of(triangle).iter().all(|p| p.is_finite()))
}

/// Parses a mesh from a binary STL file.
pub(super) fn parse_stl_binary(bytes: &[u8]) -> Result<MeshFile, ReadError> {
    let end = FaultPlace::Byte(bytes.len() as u64);
    let count = triangle_count(bytes).ok_or_else(|| fault_at(end, ParseFaultKind::EndsEarly))?;
    let triangles = bytes[HEAD..].chunks_exact(TRIANGLE).take(count);
    if triangles.len() < count {
        let kind = ParseFaultKind::TooMany { element: "triangle".to_owned(), count: count as u64 };
        return Err(fault_at(FaultPlace::Byte(HEAD as u64 - 4), kind));
    }
    let mut welded = Welded::default();
    for (number, triangle) in triangles.enumerate() {
        for corner in corners_of(triangle) {
            welded.push(corner, || FaultPlace::Byte((HEAD + TRIANGLE * number + CORNERS) as u64))?;
        }
    }
    welded.finish()
}

/// Parses a mesh from an STL text.
pub(super) fn parse_stl_text(text: &[u8]) -> Result<MeshFile, ReadError> {
    let mut words = TokenWords::of(text, 1);
    let mut welded = Welded::default();
    let (mut begin, mut is_open) = (0, true);
    while let Some(word) = words.next() {
        match word.to_ascii_lowercase().as_slice() {
            b"vertex" => {
                let position = [words.number()?, words.number()?, words.number()?];
                welded.push(DVec3::from(position), || words.place())?;
            }
            b"endloop" | b"endfacet" => {
                let corners = welded.mesh.corners.len() - begin;
                if !matches!(corners, 0 | 3) {
                    let found = format!("{} ({corners} corners)", quoted(word));
                    let expected = "a triangle's third corner";
                    return Err(fault_at(words.place(), ParseFaultKind::Unexpected { found, expected }));
                }
                begin = welded.mesh.corners.len();
            }
            b"solid" => is_open = true,
            b"endsolid" => is_open = false,
            _ => {}
        }
    }
    if is_open || begin != welded.mesh.corners.len() {
        return Err(fault_at(words.place(), ParseFaultKind::EndsEarly));
    }
    welded.finish()
}

fn triangle_count(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEAD - 4..HEAD)?;
    usize::try_from(u32::from_le_bytes(count.try_into().ok()?)).ok()
}

fn corners_of(triangle: &[u8]) -> [DVec3; 3] {
    let number = |at: usize| {
        let at = CORNERS + 4 * at;
        f64::from(f32::from_le_bytes(triangle[at..at + 4].try_into().expect("four bytes")))
    };
    [0, 3, 6].map(|at| DVec3::new(number(at), number(at + 1), number(at + 2)))
}

/// Triangles whose equal corners are joined to one vertex.
#[derive(Default)]
struct Welded {
    mesh: PolygonMesh,
    vertex_at: HashMap<[u64; 3], VertexId>,
}

impl Welded {
    /// Adds the next corner; `place` is its position in the file, for an error.
    fn push(&mut self, position: DVec3, place: impl Fn() -> FaultPlace) -> Result<(), ReadError> {
        if !position.is_finite() {
            return Err(fault_at(place(), ParseFaultKind::NotFinite));
        }
        if self.mesh.corners.len() >= u32::MAX as usize - 1 {
            return Err(ReadError::TooLarge);
        }
        let positions = &mut self.mesh.positions;
        let bits = (position + DVec3::ZERO).to_array().map(f64::to_bits);
        let vertex = *self.vertex_at.entry(bits).or_insert_with(|| {
            positions.push(position);
            VertexId::from_index(positions.len() - 1)
        });
        self.mesh.corners.push(vertex);
        Ok(())
    }

    fn finish(self) -> Result<MeshFile, ReadError> {
        if self.mesh.corners.is_empty() {
            return Err(ReadError::NoFaces { vertices: 0 });
        }
        Ok(MeshFile { polygons: self.mesh, ..MeshFile::default() })
    }
}
