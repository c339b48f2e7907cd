//! Writer of a mesh as the text that it was read from, with other texture coordinates.
//!
//! | file     | contents                                                                          |
//! |----------|-----------------------------------------------------------------------------------|
//! | `mod`    | the text, the lines of it that change, and the pass over it                       |
//! | `face`   | line of a face: texture coordinates of its corners, or its triangles              |
//! | `corner` | word of a corner with other indices                                               |
//! | `pieces` | pieces of the text, processed in parallel                                         |
//! | `added`  | vertices and normals that the text does not have                                  |
//!
//! Every line is copied byte for byte, except for these:
//!
//! * `vt` lines: the new ones replace the old, at the first old one or the first face, whichever comes first.
//! * `f` lines: each corner gets the index of its new texture coordinate. `l` lines with such indices get those of
//!   corners at their vertices.
//! * Faces that were split: the triangles replace the face. New vertices follow the last vertex and new normals the
//!   last normal, so that all positive indices keep their meaning. Negative indices after them count further back.
//! * Statements that name materials, according to [`Edits`].

mod added;
mod corner;
mod face;
mod pieces;

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::ops::Range;
use std::sync::OnceLock;

use rayon::prelude::*;

use self::added::Added;
use self::corner::{CornerWord, Indices};
use self::pieces::PIECE;
use super::digits::write_numbers;
use super::line::{keyword, word_ranges, words};
use super::lines::{Line, Lines, pieces, split_mark};
use super::parse::resolve;
use crate::mesh_file::{MeshFile, NO_TEXTURE, Source, Texture};

/// Changes to the statements of a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Edits {
    /// Lines that replace a statement, by its position among the statements.
    pub(super) statements: BTreeMap<usize, Vec<Vec<u8>>>,
    /// Line to insert before all others.
    pub(super) first: Option<Vec<u8>>,
    /// Line to insert before the first face.
    pub(super) before_faces: Option<Vec<u8>>,
}

/// Writes a mesh as its text, with these texture coordinates. Pieces of the text are processed in parallel.
pub(super) fn write_carried(
    out: &mut impl Write,
    mesh: &MeshFile,
    text: &Source,
    written: Written<'_>,
) -> io::Result<()> {
    let (mark, lines) = split_mark(&text.bytes);
    out.write_all(mark)?;
    let line_end = match Lines::of(lines).next() {
        Some(first) if !first.end().is_empty() => first.end().to_vec(),
        _ => b"\n".to_vec(),
    };
    let all = All { mesh, text, written, added: Added::find(mesh, text, lines), line_end, at_vertex: OnceLock::new() };
    let (before, behind) = lines.split_at(place_of_texture(lines));
    let mut seen = Seen::default();
    all.write_pieces(out, before, &mut seen)?;
    if !seen.has_begun {
        seen.has_begun = true;
        out.write_all(&all.added_line(written.edits.first.as_ref()))?;
    }
    all.write_texture(out)?;
    seen.has_texture = true;
    all.write_pieces(out, behind, &mut seen)
}

/// Byte offset of the first line that the texture coordinates must precede: an old coordinate, or a face.
fn place_of_texture(lines: &[u8]) -> usize {
    let pieces = pieces(lines, PIECE);
    let place_in = |(number, piece): (usize, &&[u8])| {
        let (mut at, mut joined) = (0, Vec::new());
        for line in Lines::of(piece) {
            if matches!(words(line.as_one(&mut joined)).next(), Some(b"vt" | b"f")) {
                return Some((number, at));
            }
            at += line.whole.len();
        }
        None
    };
    let found = pieces.par_iter().enumerate().find_map_first(place_in);
    let before = |(number, at): (usize, usize)| pieces[..number].iter().map(|piece| piece.len()).sum::<usize>() + at;
    found.map_or(lines.len(), before)
}

/// Changes to the text.
#[derive(Clone, Copy)]
pub(super) struct Written<'a> {
    pub(super) edits: &'a Edits,
    pub(super) texture: &'a Texture,
}

/// Data shared by all pieces of a text.
struct All<'a> {
    mesh: &'a MeshFile,
    text: &'a Source,
    written: Written<'a>,
    added: Added,
    /// Line end of added lines.
    line_end: Vec<u8>,
    /// Texture coordinate of each vertex, or [`NO_TEXTURE`].
    at_vertex: OnceLock<Vec<u32>>,
}

/// Writer of a piece of the text.
struct Writer<'a> {
    all: &'a All<'a>,
    out: Vec<u8>,
    seen: Seen,
    buffers: Buffers,
}

/// Counts of the elements passed so far.
#[derive(Clone, Copy, Default)]
struct Seen {
    vertices: usize,
    normals: usize,
    statements: usize,
    /// Number of faces of the text.
    faces: u32,
    /// Number of faces of the mesh.
    own_faces: usize,
    /// True after the first line with words.
    has_begun: bool,
    /// True once the texture coordinates are written.
    has_texture: bool,
}

/// Buffers that are reused for every line.
#[derive(Default)]
struct Buffers {
    line: Vec<u8>,
    /// Byte ranges of the corners in a line.
    words: Vec<Range<usize>>,
    vertices: Vec<u32>,
    /// Vertices with their corners, ascending. Filled only on demand, like `order`.
    by_vertex: Vec<(u32, usize)>,
    /// Corner of the line for each corner of a face.
    order: Vec<usize>,
}

impl Writer<'_> {
    fn line(&mut self, line: &Line<'_>, joined: &mut Vec<u8>) -> io::Result<()> {
        let one = line.as_one(joined);
        let Some(keyword) = keyword(one) else { return self.out.write_all(line.whole) };
        if !std::mem::replace(&mut self.seen.has_begun, true) {
            self.add_line(self.all.written.edits.first.as_ref())?;
        }
        match keyword {
            b"v" => self.vertex(line),
            b"vn" => self.normal(line),
            // The new coordinates are written at the first old one.
            b"vt" => Ok(()),
            b"f" => {
                if self.seen.faces == 0 {
                    self.add_line(self.all.written.edits.before_faces.as_ref())?;
                }
                self.face(line, one)
            }
            b"l" | b"p" => self.element(line, one),
            b"o" | b"g" | b"s" | b"usemtl" | b"mtllib" => self.statement(line),
            _ => self.out.write_all(line.whole),
        }
    }

    fn add_line(&mut self, line: Option<&Vec<u8>>) -> io::Result<()> {
        let Some(line) = line else { return Ok(()) };
        self.out.write_all(line)?;
        self.out.write_all(&self.all.line_end)
    }

    /// Copies a line and ensures that it has a line end, so that other lines can follow.
    fn copy_with_end(&mut self, line: &Line<'_>) -> io::Result<()> {
        self.out.write_all(line.whole)?;
        if line.end().is_empty() { self.out.write_all(&self.all.line_end) } else { Ok(()) }
    }

    fn vertex(&mut self, line: &Line<'_>) -> io::Result<()> {
        self.seen.vertices += 1;
        let new = &self.all.mesh.polygons.positions[self.all.text.vertex_count..];
        if self.seen.vertices < self.all.text.vertex_count || new.is_empty() {
            return self.out.write_all(line.whole);
        }
        self.copy_with_end(line)?;
        for (position, further) in new.iter().zip(&self.all.added.further_numbers) {
            write_numbers(&mut self.out, b"v", position.to_array().iter().chain(further))?;
            self.out.write_all(&self.all.line_end)?;
        }
        Ok(())
    }

    fn normal(&mut self, line: &Line<'_>) -> io::Result<()> {
        self.seen.normals += 1;
        if self.seen.normals < self.all.added.normal_count || self.all.added.normals.is_empty() {
            return self.out.write_all(line.whole);
        }
        self.copy_with_end(line)?;
        for normal in &self.all.added.normals {
            write_numbers(&mut self.out, b"vn", &normal.to_array())?;
            self.out.write_all(&self.all.line_end)?;
        }
        Ok(())
    }

    fn statement(&mut self, line: &Line<'_>) -> io::Result<()> {
        let place = self.seen.statements;
        self.seen.statements += 1;
        let Some(lines) = self.all.written.edits.statements.get(&place) else {
            return self.out.write_all(line.whole);
        };
        lines.iter().try_for_each(|line| self.add_line(Some(line)))
    }

    /// Writes a line element or point element.
    fn element(&mut self, line: &Line<'_>, one: &[u8]) -> io::Result<()> {
        let (indices, mut at) = (self.indices(), 0);
        let has_texture = one.contains(&b'/');
        if !has_texture && !indices.are_shifted() {
            return self.out.write_all(line.whole);
        }
        let mut changed = std::mem::take(&mut self.buffers.line);
        changed.clear();
        for range in word_ranges(one).skip(1) {
            let word = CornerWord::of(&one[range.clone()]);
            let Some(vertex) = word.vertex_index().and_then(|index| resolve("", index, self.seen.vertices).ok()) else {
                continue;
            };
            changed.extend_from_slice(&line.whole[at..range.start]);
            let texture = if word.has_texture { self.texture_at(vertex) } else { None };
            indices.push(&mut changed, &word, texture);
            at = range.end;
        }
        changed.extend_from_slice(&line.whole[at..]);
        self.out.write_all(&changed)?;
        self.buffers.line = changed;
        Ok(())
    }

    /// Texture coordinate of some corner at a vertex.
    fn texture_at(&self, vertex: u32) -> Option<u32> {
        let at_vertex = self.all.at_vertex.get_or_init(|| {
            let mut found = vec![NO_TEXTURE; self.all.mesh.polygons.positions.len()];
            let corners = self.all.mesh.polygons.corners.iter().zip(&self.all.written.texture.corners);
            let corners = corners.filter(|(_, texture)| **texture != NO_TEXTURE);
            corners.rev().for_each(|(corner, &texture)| found[corner.index()] = texture);
            found
        });
        at_vertex.get(vertex as usize).copied().filter(|&texture| texture != NO_TEXTURE)
    }

    /// Index offsets at the current position.
    fn indices(&self) -> Indices {
        let new_vertices = self.all.mesh.polygons.positions.len() - self.all.text.vertex_count;
        let have_vertices = self.seen.vertices == self.all.text.vertex_count;
        let have_normals = self.seen.normals == self.all.added.normal_count;
        Indices {
            vertices: self.seen.vertices,
            new_vertices: if have_vertices { new_vertices } else { 0 },
            normals: self.seen.normals,
            new_normals: if have_normals { self.all.added.normals.len() } else { 0 },
            coordinates: if self.seen.has_texture { self.all.written.texture.coordinates.len() } else { 0 },
        }
    }
}
