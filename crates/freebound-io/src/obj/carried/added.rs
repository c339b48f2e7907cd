//! Vertices and normals that a text does not have.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::super::line::{keyword, number, numbers, words};
use super::super::lines::Lines;
use super::Buffers;
use super::corner::CornerWord;
use crate::mesh_file::{MeshFile, Source};
use freebound_core::mesh::{NewVertex, VertexId};

/// Additions to a text, found in a first pass over it. Empty without new vertices.
#[derive(Default)]
pub(super) struct Added {
    /// Numbers after the position of each new vertex, such as a colour: interpolated between the ends of its edge.
    pub(super) further_numbers: Vec<Vec<f64>>,
    /// New normals, of length 1.
    pub(super) normals: Vec<DVec3>,
    /// Number of normals in the text.
    pub(super) normal_count: usize,
    /// Index of the normal, by face of the text and new vertex. Counts from 0; new normals come after those of the
    /// text.
    normal_of: BTreeMap<[u32; 2], usize>,
}

/// Data collected from a text.
#[derive(Default)]
struct Found {
    normals: Vec<Option<DVec3>>,
    /// Numbers after the positions of the ends of split edges.
    further_numbers: BTreeMap<VertexId, Vec<f64>>,
    wanted: Vec<Wanted>,
}

/// Face of the text, with its corners parsed and sorted.
struct FaceLine<'a> {
    face: u32,
    line: &'a [u8],
    buffers: &'a Buffers,
}

/// Request for the normal at a new vertex of a face.
struct Wanted {
    face: u32,
    vertex: u32,
    /// Normals at the ends of its edge, by index from 0.
    ends: [usize; 2],
    /// Position on the edge, as a fraction.
    at: f64,
}

impl Added {
    pub(super) fn find(mesh: &MeshFile, text: &Source, lines: &[u8]) -> Self {
        if text.new_vertices.is_empty() {
            return Self::default();
        }
        let found = Found::in_text(mesh, text, lines);
        let mut added = Self { normal_count: found.normals.len(), ..Self::default() };
        added.further_numbers = text.new_vertices.iter().map(|new| found.numbers_between(new)).collect();
        let mut known: BTreeMap<(u32, [usize; 2]), usize> = BTreeMap::new();
        for wanted in &found.wanted {
            let Some([a, b]) = found.normals_at(wanted.ends) else { continue };
            let normal = a.lerp(b, wanted.at).try_normalize().unwrap_or(a);
            let index = *known.entry((wanted.vertex, wanted.ends)).or_insert_with(|| {
                added.normals.push(normal);
                found.normals.len() + added.normals.len() - 1
            });
            added.normal_of.insert([wanted.face, wanted.vertex], index);
        }
        added
    }

    /// Index from 0 of the normal at a new vertex of a face of the text.
    pub(super) fn normal_at(&self, face: u32, vertex: u32) -> Option<usize> {
        self.normal_of.get(&[face, vertex]).copied()
    }
}

impl Found {
    fn in_text(mesh: &MeshFile, text: &Source, lines: &[u8]) -> Self {
        let ends: BTreeSet<VertexId> = text.new_vertices.iter().flat_map(|new| new.edge).collect();
        let vertices_in = new_vertices_by_face(mesh, text);
        let mut found = Self::default();
        let (mut joined, mut buffers) = (Vec::new(), Buffers::default());
        let (mut vertices, mut faces) = (0, 0);
        for line in Lines::of(lines) {
            let one = line.as_one(&mut joined);
            let mut words = words(one);
            words.next();
            match keyword(one) {
                Some(b"v") => {
                    let vertex = VertexId::from_index(vertices);
                    vertices += 1;
                    if ends.contains(&vertex) {
                        found.further_numbers.insert(vertex, words.skip(3).map_while(number).collect());
                    }
                }
                Some(b"vn") => found.normals.push(numbers::<3>(words).ok().map(DVec3::from)),
                Some(b"f") => {
                    if let Some(new) = vertices_in.get(&faces) {
                        buffers.take_corners(one, vertices);
                        buffers.sort_corners();
                        found.want(&FaceLine { face: faces, line: one, buffers: &buffers }, new, text);
                    }
                    faces += 1;
                }
                _ => {}
            }
        }
        found
    }

    /// Collects the normals that a face of the text needs at new vertices.
    fn want(&mut self, of: &FaceLine<'_>, new: &BTreeSet<u32>, text: &Source) {
        let &FaceLine { face, line, buffers } = of;
        let normal_at = |vertex: VertexId| {
            let place = buffers.place_of(vertex.number())?;
            match CornerWord::of(&line[buffers.words[place].clone()]).normal_index()? {
                index @ 1.. => usize::try_from(index - 1).ok(),
                index => self.normals.len().checked_sub(usize::try_from(index.unsigned_abs()).ok()?),
            }
        };
        let mut wanted = Vec::new();
        for &vertex in new {
            let NewVertex { edge: [a, b], at } = text.new_vertices[vertex as usize - text.vertex_count];
            if let (Some(a), Some(b)) = (normal_at(a), normal_at(b)) {
                wanted.push(Wanted { face, vertex, ends: [a, b], at });
            }
        }
        self.wanted.extend(wanted);
    }

    /// Numbers after the position of a new vertex, as many as both ends of its edge have.
    fn numbers_between(&self, new: &NewVertex) -> Vec<f64> {
        let [Some(a), Some(b)] = new.edge.map(|end| self.further_numbers.get(&end)) else { return Vec::new() };
        a.iter().zip(b).map(|(a, b)| a + new.at * (b - a)).collect()
    }

    fn normals_at(&self, ends: [usize; 2]) -> Option<[DVec3; 2]> {
        let [a, b] = ends.map(|end| self.normals.get(end).copied().flatten());
        Some([a?, b?])
    }
}

/// New vertices at the corners of each face of the text, for faces that have some.
fn new_vertices_by_face(mesh: &MeshFile, text: &Source) -> BTreeMap<u32, BTreeSet<u32>> {
    let mut found: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for face in 0..mesh.polygons.face_count() {
        for corner in mesh.polygons.face(face).iter().filter(|corner| corner.index() >= text.vertex_count) {
            found.entry(text.face_of(face)).or_default().insert(corner.number());
        }
    }
    found
}
