//! Pieces of a text, processed in parallel and written in order.

use std::io::{self, Write};

use glam::DVec2;
use rayon::prelude::*;

use super::super::digits::write_numbers;
use super::super::line::keyword;
use super::super::lines::{Lines, pieces};
use super::{All, Buffers, Seen, Writer};
use crate::mesh_file::Source;

/// Size of a piece of the text, bytes: large enough to outweigh the cost of scheduling it.
pub(super) const PIECE: usize = 256 << 10;

/// Number of texture coordinates in a piece.
const COORDINATES: usize = 8192;

/// Number of pieces that are processed before they are written.
const PIECES_AT_ONCE: usize = 32;

impl Seen {
    /// Counts of the elements in a piece of the text.
    fn of(piece: &[u8]) -> Self {
        let (mut this, mut joined) = (Self::default(), Vec::new());
        for line in Lines::of(piece) {
            let Some(keyword) = keyword(line.as_one(&mut joined)) else { continue };
            this.has_begun = true;
            match keyword {
                b"v" => this.vertices += 1,
                b"vn" => this.normals += 1,
                b"f" => this.faces += 1,
                b"o" | b"g" | b"s" | b"usemtl" | b"mtllib" => this.statements += 1,
                _ => {}
            }
        }
        this
    }

    /// Counts after another piece of the text.
    fn and(self, more: &Self, text: &Source) -> Self {
        let faces = self.faces + more.faces;
        Self {
            vertices: self.vertices + more.vertices,
            normals: self.normals + more.normals,
            statements: self.statements + more.statements,
            faces,
            own_faces: text.faces_before(faces),
            has_begun: self.has_begun || more.has_begun,
            has_texture: self.has_texture || more.has_texture,
        }
    }
}

impl All<'_> {
    /// Writes lines that follow those in `seen`.
    pub(super) fn write_pieces(&self, out: &mut impl Write, lines: &[u8], seen: &mut Seen) -> io::Result<()> {
        for batch in pieces(lines, PIECE).chunks(PIECES_AT_ONCE) {
            let counts: Vec<Seen> = batch.par_iter().map(|piece| Seen::of(piece)).collect();
            let mut begins = Vec::with_capacity(batch.len());
            for count in &counts {
                begins.push(*seen);
                *seen = seen.and(count, self.text);
            }
            let ready: Vec<io::Result<Vec<u8>>> =
                batch.par_iter().zip(begins).map(|(piece, seen)| self.piece(piece, seen)).collect();
            ready.into_iter().try_for_each(|piece| out.write_all(&piece?))?;
        }
        Ok(())
    }

    /// Piece of the text as it is written.
    fn piece(&self, piece: &[u8], seen: Seen) -> io::Result<Vec<u8>> {
        let out = Vec::with_capacity(2 * piece.len());
        let mut writer = Writer { all: self, out, seen, buffers: Buffers::default() };
        let mut joined = Vec::new();
        Lines::of(piece).try_for_each(|line| writer.line(&line, &mut joined))?;
        Ok(writer.out)
    }

    pub(super) fn write_texture(&self, out: &mut impl Write) -> io::Result<()> {
        for batch in self.written.texture.coordinates.chunks(PIECES_AT_ONCE * COORDINATES) {
            let ready: Vec<io::Result<Vec<u8>>> =
                batch.par_chunks(COORDINATES).map(|piece| self.coordinates(piece)).collect();
            ready.into_iter().try_for_each(|piece| out.write_all(&piece?))?;
        }
        Ok(())
    }

    fn coordinates(&self, coordinates: &[DVec2]) -> io::Result<Vec<u8>> {
        let mut lines = Vec::new();
        for coordinate in coordinates {
            write_numbers(&mut lines, b"vt", &coordinate.to_array())?;
            lines.extend_from_slice(&self.line_end);
        }
        Ok(lines)
    }

    /// Line to insert, with its line end; empty if there is none.
    pub(super) fn added_line(&self, line: Option<&Vec<u8>>) -> Vec<u8> {
        line.map_or_else(Vec::new, |line| [&line[..], &self.line_end].concat())
    }
}
