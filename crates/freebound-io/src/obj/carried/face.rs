//! Line of a face: texture coordinates of its corners, or its triangles.

use std::io::{self, Write};
use std::ops::Range;

use super::super::line::word_ranges;
use super::super::lines::Line;
use super::super::parse::resolve;
use super::corner::{CornerWord, NewCorner};
use super::{Buffers, Writer};
use crate::mesh_file::{NO_TEXTURE, Texture};
use freebound_core::mesh::VertexId;

impl Writer<'_> {
    /// Writes the mesh's faces that replace a face of the text: in its line if it is whole, otherwise in their own
    /// lines.
    pub(super) fn face(&mut self, line: &Line<'_>, one: &[u8]) -> io::Result<()> {
        let mut buffers = std::mem::take(&mut self.buffers);
        buffers.take_corners(one, self.seen.vertices);
        let faces = self.faces_of_line();
        let is_whole = faces.len() == 1 && buffers.find_order(self.all.mesh.polygons.face(faces.start));
        buffers.line.clear();
        if is_whole {
            self.whole_face(line, faces.start, &mut buffers);
        } else {
            buffers.sort_corners();
            for face in faces.clone() {
                self.part(line, face, faces.end, &mut buffers);
            }
        }
        self.seen.faces += 1;
        self.out.write_all(&buffers.line)?;
        self.buffers = buffers;
        Ok(())
    }

    /// Faces of the mesh that replace the current face of the text.
    fn faces_of_line(&mut self) -> Range<usize> {
        let begin = self.seen.own_faces;
        let count = self.all.mesh.polygons.face_count();
        while self.seen.own_faces < count && self.all.text.face_of(self.seen.own_faces) == self.seen.faces {
            self.seen.own_faces += 1;
        }
        begin..self.seen.own_faces
    }

    /// Copies the line, with the corners in the mesh's order.
    fn whole_face(&self, line: &Line<'_>, face: usize, buffers: &mut Buffers) {
        let coordinates = coordinates_of(self.all.written.texture, self.all.mesh.polygons.corner_range(face));
        let (indices, mut at) = (self.indices(), 0);
        for (place, &from) in buffers.order.iter().enumerate() {
            let range = &buffers.words[place];
            buffers.line.extend_from_slice(&line.whole[at..range.start]);
            let word = CornerWord::of(&line.whole[buffers.words[from].clone()]);
            indices.push(&mut buffers.line, &word, coordinates.map(|of| of[place]));
            at = range.end;
        }
        buffers.line.extend_from_slice(&line.whole[at..]);
    }

    /// Writes a part of a face that was split. The last part keeps the end of the face's line, including anything
    /// after its corners.
    fn part(&self, line: &Line<'_>, face: usize, faces_end: usize, buffers: &mut Buffers) {
        let polygons = &self.all.mesh.polygons;
        let coordinates = coordinates_of(self.all.written.texture, polygons.corner_range(face));
        let indices = self.indices();
        let is_negative = CornerWord::of(&line.whole[buffers.words[0].clone()]).is_negative();
        let before = if line.is_continued { b"f " } else { &line.whole[..buffers.words[0].start] };
        buffers.line.extend_from_slice(before);
        for (place, corner) in polygons.face(face).iter().enumerate() {
            if place > 0 {
                buffers.line.push(b' ');
            }
            let texture = coordinates.map(|of| of[place]);
            let vertex = corner.number();
            if let Some(own) = buffers.place_of(vertex) {
                let word = CornerWord::of(&line.whole[buffers.words[own].clone()]);
                indices.push(&mut buffers.line, &word, texture);
            } else {
                let normal = self.all.added.normal_at(self.seen.faces, vertex);
                indices.push_new(&mut buffers.line, &NewCorner { vertex, texture, normal, is_negative });
            }
        }
        let is_last = face + 1 == faces_end;
        let rest = &line.whole[buffers.words.last().map_or(0, |word| word.end)..];
        buffers.line.extend_from_slice(match (is_last, line.is_continued) {
            (true, false) => rest,
            (true, true) => line.end(),
            (false, _) => &self.all.line_end,
        });
    }
}

impl Buffers {
    /// Parses the corners of a face's line, with `vertices_before` vertices before it.
    pub(super) fn take_corners(&mut self, one: &[u8], vertices_before: usize) {
        self.words.clear();
        self.words.extend(word_ranges(one).skip(1));
        self.vertices.clear();
        self.vertices.extend(self.words.iter().map(|range| {
            let index = CornerWord::of(&one[range.clone()]).vertex_index();
            index.and_then(|index| resolve("", index, vertices_before).ok()).unwrap_or(u32::MAX)
        }));
    }

    /// Finds the line's corner for each corner of a face; returns true if the face has exactly these corners.
    fn find_order(&mut self, face: &[VertexId]) -> bool {
        self.order.clear();
        if face.iter().map(|corner| corner.number()).eq(self.vertices.iter().copied()) {
            self.order.extend(0..face.len());
            return true;
        }
        self.sort_corners();
        let mut corners: Vec<(u32, usize)> = face.iter().map(|corner| corner.number()).zip(0..).collect();
        corners.sort_unstable();
        if !corners.iter().map(|corner| corner.0).eq(self.by_vertex.iter().map(|own| own.0)) {
            return false;
        }
        self.order.resize(face.len(), 0);
        for (corner, own) in corners.iter().zip(&self.by_vertex) {
            self.order[corner.1] = own.1;
        }
        true
    }

    /// Prepares the line's corners for [`place_of`](Self::place_of).
    pub(super) fn sort_corners(&mut self) {
        self.by_vertex.clear();
        self.by_vertex.extend(self.vertices.iter().copied().zip(0..));
        self.by_vertex.sort_unstable();
    }

    /// First corner of the line at a vertex.
    pub(super) fn place_of(&self, vertex: u32) -> Option<usize> {
        let first = self.by_vertex.partition_point(|own| own.0 < vertex);
        self.by_vertex.get(first).filter(|own| own.0 == vertex).map(|own| own.1)
    }
}

/// Texture coordinates of corners; `None` if one has none: the face is then written without.
fn coordinates_of(texture: &Texture, corners: Range<usize>) -> Option<&[u32]> {
    texture.corners.get(corners).filter(|found| !found.contains(&NO_TEXTURE))
}
