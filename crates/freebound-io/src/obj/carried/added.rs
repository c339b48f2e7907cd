//! Vertices and normals that a text does not have.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::super::line::{number, numbers, words};
use super::super::lines::Lines;
use super::Buffers;
use super::corner::CornerWord;
use crate::mesh_file::{MeshFile, Source};
use freebound_core::mesh::{NewVertex, VertexId};

/// What is added to a text, found in a first look at it. Nothing where there are no new vertices.
#[derive(Default)]
pub(super) struct Added {
    /// For each new vertex the numbers behind its position, such as a colour: those of the ends of its edge, between.
    pub(super) further_numbers: Vec<Vec<f64>>,
    /// Of length 1.
    pub(super) normals: Vec<DVec3>,
    /// How many normals the text has.
    pub(super) normal_count: usize,
    /// By the text's face and the new vertex, indices of normals from 0, behind those of the text.
    normal_of: BTreeMap<[u32; 2], usize>,
}

/// What is looked for in a text.
#[derive(Default)]
struct Found {
    normals: Vec<Option<DVec3>>,
    /// For the ends of split edges.
    further_numbers: BTreeMap<VertexId, Vec<f64>>,
    wanted: Vec<Wanted>,
}

/// A face of the text, its corners found and sorted.
struct FaceLine<'a> {
    face: u32,
    line: &'a [u8],
    buffers: &'a Buffers,
}

/// The normal at a new vertex of a face.
struct Wanted {
    face: u32,
    vertex: u32,
    /// Of the ends of its edge, from 0.
    ends: [usize; 2],
    /// Place on the edge.
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
            match words.next() {
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

    /// Notes the normals that a face of the text needs at new vertices.
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

    /// The numbers behind the position of a new vertex: as many as both ends have.
    fn numbers_between(&self, new: &NewVertex) -> Vec<f64> {
        let [Some(a), Some(b)] = new.edge.map(|end| self.further_numbers.get(&end)) else { return Vec::new() };
        a.iter().zip(b).map(|(a, b)| a + new.at * (b - a)).collect()
    }

    fn normals_at(&self, ends: [usize; 2]) -> Option<[DVec3; 2]> {
        let [a, b] = ends.map(|end| self.normals.get(end).copied().flatten());
        Some([a?, b?])
    }
}

/// The new vertices at corners of each face of the text that has some.
fn new_vertices_by_face(mesh: &MeshFile, text: &Source) -> BTreeMap<u32, BTreeSet<u32>> {
    let mut found: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for face in 0..mesh.polygons.face_count() {
        for corner in mesh.polygons.face(face).iter().filter(|corner| corner.index() >= text.vertex_count) {
            found.entry(text.face_of(face)).or_default().insert(corner.number());
        }
    }
    found
}
