//! Reader of glTF files.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::accessor::Elements;
use super::container::{Buffers, Chunks};
use super::document::Document;
use super::scene::{Scene, Shown, VertexSet, triangles};
use super::{POSITION, TEXTURE};
use crate::mesh_file::{
    Instances, MeshFile, NO_TEXTURE, ParseFaultKind, ReadError, Source, SourceFormat, Texture, fault_in,
};
use freebound_core::mesh::{PolygonMesh, VertexId};

/// Value in `vertex_of` for a vertex of the file that no triangle has.
pub(super) const UNUSED: u32 = u32::MAX;

/// Parses a file, as text or binary; files that belong to it are in `folder`.
pub(crate) fn parse_gltf(bytes: Vec<u8>, folder: Option<&Path>, instances: Instances) -> Result<MeshFile, ReadError> {
    let (json, binary) = Chunks::split(bytes)?;
    let document = Document::of(&json)?;
    let buffers = Buffers::of(&document, binary, folder)?;
    let shown = Shown::of(&document, &buffers, instances)?;
    let warnings = shown.warnings();
    let mut builder = Builder::of(&document, &buffers, shown);
    builder.faces()?;
    if builder.corners.is_empty() {
        return Err(ReadError::NoFaces { vertices: builder.vertex_of.len() });
    }
    builder.vertices()?;
    let texture = builder.texture()?;
    let Builder { shown, corners, vertex_of, positions, .. } = builder;
    let polygons = PolygonMesh {
        positions,
        corners: corners.iter().map(|&corner| VertexId::new(vertex_of[corner as usize])).collect(),
        starts: None,
    };
    let Buffers { bytes, starts } = buffers;
    let scene = Scene { json, starts, folder: folder.map(Path::to_owned), shown, vertex_of, corners };
    let source = Source::of(SourceFormat::Gltf(Arc::new(scene)), bytes, polygons.positions.len());
    Ok(MeshFile { polygons, texture, source: Some(source), warnings, ..MeshFile::default() })
}

/// Mesh under construction.
struct Builder<'a> {
    document: &'a Document,
    buffers: &'a Buffers,
    shown: Shown,
    /// Vertex of the file at each corner.
    corners: Vec<u32>,
    /// Vertex of the mesh for each vertex of the file.
    vertex_of: Vec<u32>,
    positions: Vec<DVec3>,
}

impl<'a> Builder<'a> {
    fn of(document: &'a Document, buffers: &'a Buffers, shown: Shown) -> Self {
        let count = shown.sets.last().map_or(0, |set| set.range.end);
        let vertex_of = vec![UNUSED; count];
        Self { document, buffers, shown, corners: Vec::new(), vertex_of, positions: Vec::new() }
    }

    /// Collects all triangles, and marks their vertices.
    fn faces(&mut self) -> Result<(), ReadError> {
        for number in 0..self.shown.parts.len() {
            self.shown.parts[number].first_face = self.corners.len() / 3;
            let part = &self.shown.parts[number];
            let begin = self.shown.sets[part.set].range.start;
            for vertex in triangles(self.document, self.buffers, &self.shown, part)?.into_flattened() {
                self.corners.push(u32::try_from(begin + vertex).map_err(|_| ReadError::TooLarge)?);
                self.vertex_of[begin + vertex] = 0;
            }
        }
        Ok(())
    }

    /// Joins the vertices of an instance that have equal positions: equal bits, except that −0 equals 0. They are
    /// numbered in the order of the file.
    fn vertices(&mut self) -> Result<(), ReadError> {
        let mut vertex_at: HashMap<[u64; 3], u32> = HashMap::new();
        for (number, set) in self.shown.sets.iter().enumerate() {
            if number > 0 && self.shown.sets[number - 1].instance != set.instance {
                vertex_at.clear();
            }
            let accessor = set.attributes[POSITION];
            let elements = elements(self.document, self.buffers, set, POSITION, 3)?;
            let transform = self.shown.instances[set.instance].transform;
            let used = set.range.clone().enumerate().filter(|&(_, vertex)| self.vertex_of[vertex] != UNUSED);
            let used: Vec<(usize, usize)> = used.collect();
            vertex_at.reserve(used.len());
            for (place, vertex) in used {
                let own = DVec3::from([0, 1, 2].map(|axis| elements.number(place, axis)));
                let bits = (own + DVec3::ZERO).to_array().map(f64::to_bits);
                let position = transform.map_or(own, |transform| transform.transform_point3(own));
                if !position.is_finite() {
                    return Err(fault_in("accessor", accessor, ParseFaultKind::NotFinite));
                }
                let next = u32::try_from(self.positions.len()).map_err(|_| ReadError::TooLarge)?;
                let found = *vertex_at.entry(bits).or_insert(next);
                if found == next {
                    self.positions.push(position);
                }
                self.vertex_of[vertex] = found;
            }
        }
        Ok(())
    }

    /// Texture coordinates of all vertices of the file, v up; `None` if there are none.
    fn texture(&self) -> Result<Option<Texture>, ReadError> {
        if !self.shown.sets.iter().any(|set| set.attributes.contains_key(TEXTURE)) {
            return Ok(None);
        }
        let (mut coordinates, mut corners) = (vec![DVec2::ZERO; self.vertex_of.len()], self.corners.clone());
        for set in &self.shown.sets {
            if set.attributes.contains_key(TEXTURE) {
                let elements = elements(self.document, self.buffers, set, TEXTURE, 2)?;
                for (place, vertex) in set.range.clone().enumerate() {
                    coordinates[vertex] = upright([0, 1].map(|at| elements.number(place, at)));
                }
            }
        }
        for (number, part) in self.shown.parts.iter().enumerate() {
            if !self.shown.sets[part.set].attributes.contains_key(TEXTURE) {
                let end = self.shown.parts.get(number + 1).map_or(corners.len(), |next| 3 * next.first_face);
                corners[3 * part.first_face..end].fill(NO_TEXTURE);
            }
        }
        Ok(Some(Texture { coordinates, corners }))
    }
}

/// Converts a texture coordinate with v down to v up.
pub(super) fn upright(uv: [f64; 2]) -> DVec2 {
    DVec2::new(uv[0], 1.0 - uv[1])
}

/// Converts a texture coordinate with v up to 32 bits and v down.
#[expect(clippy::cast_possible_truncation, reason = "that is what the format holds")]
pub(super) fn turned_over(uv: DVec2) -> [f32; 2] {
    [uv.x as f32, (1.0 - uv.y) as f32]
}

/// Attribute of a set, with `width` numbers for each vertex.
pub(super) fn elements<'a>(
    document: &Document,
    buffers: &'a Buffers,
    set: &VertexSet,
    name: &str,
    width: usize,
) -> Result<Elements<'a>, ReadError> {
    let accessor = set.attributes[name];
    let elements = Elements::of(document, buffers, accessor)?;
    if elements.width == width && elements.count >= set.range.len() {
        return Ok(elements);
    }
    let found = format!("{} elements of {} numbers", elements.count, elements.width);
    let expected = "one element per position, with 3 numbers, or 2 for texture coordinates";
    Err(fault_in("accessor", accessor, ParseFaultKind::Unexpected { found, expected }))
}
