//! Vertices of the file for the corners of a mesh. A corner keeps its vertex or gets a new one on an edge. Vertices
//! with several texture coordinates are copied.

use std::collections::HashMap;
use std::io;

use super::TEXTURE;
use super::container::Buffers;
use super::document::Document;
use super::grown::Origin;
use super::read::{elements, turned_over, upright};
use super::scene::Scene;
use crate::mesh_file::{MeshFile, NO_TEXTURE, Source, Texture};
use freebound_core::mesh::VertexId;

/// Vertices of all corners.
pub(super) struct Placed {
    pub(super) sets: Vec<PlacedSet>,
    /// Triangles of each part, as vertices of its set.
    pub(super) triangles: Vec<Vec<[u32; 3]>>,
    /// True for a part whose triangles differ from the file.
    pub(super) has_changed: Vec<bool>,
}

/// Vertices of a set.
#[derive(Default)]
pub(super) struct PlacedSet {
    /// Texture coordinates of all vertices, v down.
    pub(super) texture: Vec<[f32; 2]>,
    /// True for a vertex of the file that a corner of the mesh has.
    is_taken: Vec<bool>,
    /// True if texture coordinates differ from the file: tangents, which follow from them, are wrong then.
    pub(super) has_new_texture: bool,
    /// Origins of the added vertices, which follow those of the file.
    pub(super) added: Vec<Origin>,
    /// Numbers of the added vertices.
    number_of: HashMap<Key, u32>,
}

/// Key of an added vertex: the bits of its origin and of its texture coordinates.
type Key = ([usize; 2], u64, [u32; 2]);

impl PlacedSet {
    /// Vertex of a corner, added if necessary.
    fn number(&mut self, origin: Origin, uv: [f32; 2]) -> u32 {
        let bits = uv.map(f32::to_bits);
        let key = match origin {
            Origin::Copy(vertex) => {
                let own = &mut self.texture[vertex];
                if !std::mem::replace(&mut self.is_taken[vertex], true) {
                    *own = uv;
                }
                if own.map(f32::to_bits) == bits {
                    return VertexId::from_index(vertex).number();
                }
                ([vertex; 2], 0, bits)
            }
            Origin::Between(ends, share) => (ends, share.to_bits(), bits),
        };
        *self.number_of.entry(key).or_insert_with(|| {
            self.added.push(origin);
            self.texture.push(uv);
            VertexId::from_index(self.texture.len() - 1).number()
        })
    }
}

impl Placed {
    /// Assigns vertices to the corners of a mesh that was read from the scene.
    pub(super) fn of(
        mesh: &MeshFile,
        source: &Source,
        scene: &Scene,
        texture: &Texture,
        before: Vec<PlacedSet>,
    ) -> io::Result<Self> {
        let parts = scene.shown.parts.len();
        let (sets, triangles) = (before, vec![Vec::new(); parts]);
        let mut own = Self { sets, triangles, has_changed: vec![false; parts] };
        let originals: Vec<Vec<[f32; 2]>> = own.sets.iter().map(|set| set.texture.clone()).collect();
        let corners = Corners { mesh, source, scene };
        for face in 0..mesh.polygons.face_count() {
            let of_file = source.face_of(face) as usize;
            let part = scene.shown.part_of(of_file);
            let set = scene.shown.parts[part].set;
            let begin = scene.shown.sets[set].range.start;
            let mut triangle = [0; 3];
            for (at, corner) in mesh.polygons.corner_range(face).enumerate() {
                let origin = corners.origin(of_file, at, mesh.polygons.corners[corner], begin)?;
                let wanted = texture.corners.get(corner).filter(|&&index| index != NO_TEXTURE);
                let wanted = wanted.map(|&index| texture.coordinates[index as usize]);
                let old = match origin {
                    Origin::Copy(vertex) => originals[set][vertex],
                    Origin::Between(..) => [0.0; 2],
                };
                let uv = match wanted {
                    // Unchanged coordinates keep their bits.
                    Some(uv) if uv != upright(old.map(f64::from)) => turned_over(uv),
                    _ => old,
                };
                triangle[at] = own.sets[set].number(origin, uv);
            }
            if scene.shown.instances[scene.shown.parts[part].instance].is_mirrored() {
                triangle.swap(1, 2);
            }
            own.triangles[part].push(triangle);
        }
        for (set, original) in own.sets.iter_mut().zip(&originals) {
            set.has_new_texture = set.texture != *original;
        }
        own.compare(scene);
        Ok(own)
    }

    /// Finds the parts whose triangles differ from the file.
    fn compare(&mut self, scene: &Scene) {
        for (number, part) in scene.shown.parts.iter().enumerate() {
            let end = scene.shown.parts.get(number + 1).map_or(scene.corners.len(), |next| 3 * next.first_face);
            let begin = scene.shown.sets[part.set].range.start;
            let is_mirrored = scene.shown.instances[part.instance].is_mirrored();
            let before = scene.corners[3 * part.first_face..end].chunks_exact(3).map(|triangle| {
                let [a, b, c] = [0, 1, 2].map(|k| triangle[k] as usize - begin);
                if is_mirrored { [a, c, b] } else { [a, b, c] }
            });
            let own = self.triangles[number].iter().map(|triangle| triangle.map(|index| index as usize));
            self.has_changed[number] = !own.eq(before);
        }
    }
}

impl PlacedSet {
    /// Vertices of all sets, as the file has them.
    pub(super) fn all(document: &Document, buffers: &Buffers, scene: &Scene) -> io::Result<Vec<Self>> {
        let mut sets = Vec::with_capacity(scene.shown.sets.len());
        for set in &scene.shown.sets {
            let count = set.range.len();
            let mut texture = vec![[0.0; 2]; count];
            if set.attributes.contains_key(TEXTURE) {
                let elements = elements(document, buffers, set, TEXTURE, 2).map_err(io::Error::other)?;
                for (place, uv) in texture.iter_mut().enumerate() {
                    #[expect(clippy::cast_possible_truncation, reason = "they are numbers of 32 bits")]
                    {
                        *uv = [0, 1].map(|at| elements.number(place, at) as f32);
                    }
                }
            }
            sets.push(Self { texture, is_taken: vec![false; count], ..Self::default() });
        }
        Ok(sets)
    }
}

/// Corners of a mesh and of its file.
struct Corners<'a> {
    mesh: &'a MeshFile,
    source: &'a Source,
    scene: &'a Scene,
}

impl Corners<'_> {
    /// Origin of the vertex at a corner of a face. The face equals, or is a part of, `face` of the file.
    fn origin(&self, face: usize, at: usize, vertex: VertexId, begin: usize) -> io::Result<Origin> {
        let of_face = &self.scene.corners[3 * face..3 * face + 3];
        let is_at = |k: usize, vertex: VertexId| self.scene.vertex_of[of_face[k] as usize] == vertex.number();
        // Degenerate faces have one vertex at several corners.
        let corner_at = |vertex| [at, 0, 1, 2].into_iter().find(|&k| is_at(k, vertex));
        let local = |k: usize| of_face[k] as usize - begin;
        if let Some(corner) = corner_at(vertex) {
            return Ok(Origin::Copy(local(corner)));
        }
        let new = vertex.index().checked_sub(self.source.vertex_count);
        let new = new.and_then(|number| self.source.new_vertices.get(number));
        let ends = new.and_then(|new| Some(([corner_at(new.edge[0])?, corner_at(new.edge[1])?], new.at)));
        let (ends, share) = ends.ok_or_else(|| {
            let count = self.mesh.polygons.positions.len();
            io::Error::other(format!("vertex {vertex} of {count} is not on an edge of face {face}: write PLY or OBJ"))
        })?;
        Ok(Origin::Between(ends.map(local), share))
    }
}
