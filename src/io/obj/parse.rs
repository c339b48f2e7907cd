//! Takes OBJ lines one by one and puts a mesh together.
//!
//! Every fault is noted and the reading goes on, so that all of them are known at the end.
//!
//! Understood: `v` (words behind the third number are ignored), `vt`, `f` in all its forms with positive and negative
//! indices, `o`, `g`, `s`, `usemtl`, `mtllib`, comments, lines that go on behind a `\`. Anything else is skipped. A
//! positive index may name an element that comes later in the file. A line ends with LF, with CR LF, or with CR alone.

use std::ops::ControlFlow;

use glam::{DVec2, DVec3};

use super::line::{corner, numbers, statement, words};
use super::lines::{Line, Lines, split_mark};
use crate::io::mesh_file::{
    MAX_PARSE_FAULTS, MeshFile, NO_TEXTURE, ParseFault, ParseFaultKind, ReadError, Statement, Texture,
};
use crate::mesh::VertexId;

/// Lines between two looks whether to go on.
const LINES_AT_ONCE: usize = 1 << 14;

/// Puts a mesh together from text, looking now and then whether to go on; the text itself is not kept.
pub(in crate::io) fn parse(text: &[u8], watch: &mut dyn FnMut() -> ControlFlow<()>) -> Result<MeshFile, ReadError> {
    let mut parser = Parser::default();
    for (count, line) in Lines::of(split_mark(text).1).enumerate() {
        parser.take(&line)?;
        if count % LINES_AT_ONCE == 0 && watch().is_break() {
            return Err(ReadError::Cancelled);
        }
    }
    parser.finish()
}

/// The mesh as far as it is read.
#[derive(Debug, Default)]
struct Parser {
    mesh: MeshFile,
    coordinates: Vec<DVec2>,
    /// Empty until a corner has a texture coordinate.
    texture_corners: Vec<u32>,
    face_count: u32,
    /// Runs of faces on consecutive lines: number of the first face and its line.
    line_runs: Vec<(u32, u64)>,
    /// Complete lines before the present one.
    line: u64,
    faults: Vec<ParseFault>,
    fault_count: usize,
    /// A line put together from continued ones.
    joined: Vec<u8>,
}

impl Parser {
    /// Takes one line.
    fn take(&mut self, line: &Line<'_>) -> Result<(), ReadError> {
        let mut joined = std::mem::take(&mut self.joined);
        let taken = self.take_line(line.as_one(&mut joined));
        self.joined = joined;
        self.line += line.count;
        taken
    }

    fn take_line(&mut self, line: &[u8]) -> Result<(), ReadError> {
        let mut words = words(line);
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword {
            b"v" => match numbers::<3>(words) {
                Ok(position) => self.mesh.polygons.positions.push(DVec3::from(position)),
                Err(kind) => {
                    self.fault(kind);
                    // Keeps the numbers of the vertices behind it.
                    self.mesh.polygons.positions.push(DVec3::NAN);
                }
            },
            b"vt" => {
                let coordinate = self.texture_coordinate(words);
                self.coordinates.push(coordinate);
            }
            b"f" => self.take_face(words)?,
            b"o" | b"g" | b"s" | b"usemtl" | b"mtllib" => {
                self.mesh.statements.push(Statement { before_face: self.face_count, text: statement(line) });
            }
            _ => {}
        }
        Ok(())
    }

    /// A second number that is missing is 0, as the format says.
    fn texture_coordinate<'a>(&mut self, words: impl Iterator<Item = &'a [u8]> + Clone) -> DVec2 {
        let parsed = match words.clone().count() {
            1 => numbers(words).map(|[u]| DVec2::new(u, 0.0)),
            _ => numbers::<2>(words).map(DVec2::from),
        };
        parsed.unwrap_or_else(|kind| {
            self.fault(kind);
            DVec2::NAN
        })
    }

    fn take_face<'a>(&mut self, words: impl Iterator<Item = &'a [u8]>) -> Result<(), ReadError> {
        let begin = self.mesh.polygons.corners.len();
        if let Err(kind) = self.take_corners(words) {
            self.mesh.polygons.corners.truncate(begin);
            self.texture_corners.truncate(begin);
            self.fault(kind);
            return Ok(());
        }
        let polygons = &mut self.mesh.polygons;
        let end = polygons.corners.len();
        if end >= u32::MAX as usize || polygons.positions.len() >= u32::MAX as usize {
            return Err(ReadError::TooLarge);
        }
        let place = |corner: usize| u32::try_from(corner).expect("checked above");
        if polygons.starts.is_none() && end - begin != 3 {
            polygons.starts = Some((0..=self.face_count).map(|face| 3 * face).collect());
        }
        if let Some(starts) = &mut polygons.starts {
            starts.push(place(end));
        }
        let line = self.line + 1;
        if self.line_of_face(self.face_count) != Some(line) {
            self.line_runs.push((self.face_count, line));
        }
        self.face_count += 1;
        Ok(())
    }

    fn take_corners<'a>(&mut self, words: impl Iterator<Item = &'a [u8]>) -> Result<(), ParseFaultKind> {
        let mut found = 0;
        let vertex_count = self.mesh.polygons.positions.len();
        for word in words {
            let (vertex, texture) = corner(word)?;
            let vertex = resolve("vertex", vertex, vertex_count)?;
            if let Some(texture) = texture {
                let texture = resolve("texture coordinate", texture, self.coordinates.len())?;
                self.texture_corners.resize(self.mesh.polygons.corners.len(), NO_TEXTURE);
                self.texture_corners.push(texture);
            }
            self.mesh.polygons.corners.push(VertexId::new(vertex));
            found += 1;
        }
        if found < 3 { Err(ParseFaultKind::TooFewCorners(found)) } else { Ok(()) }
    }

    /// The line that a face stands on.
    fn line_of_face(&self, face: u32) -> Option<u64> {
        let after = self.line_runs.partition_point(|&(first, _)| first <= face);
        let &(first, line) = self.line_runs.get(after.checked_sub(1)?)?;
        Some(line + u64::from(face - first))
    }

    fn fault(&mut self, kind: ParseFaultKind) {
        self.fault_at(self.line + 1, kind);
    }

    fn fault_at(&mut self, line: u64, kind: ParseFaultKind) {
        self.fault_count += 1;
        if self.faults.len() < MAX_PARSE_FAULTS {
            self.faults.push(ParseFault { line, kind });
        }
    }

    /// Checks what can be checked only at the end.
    fn finish(mut self) -> Result<MeshFile, ReadError> {
        if !self.texture_corners.is_empty() {
            self.texture_corners.resize(self.mesh.polygons.corners.len(), NO_TEXTURE);
        }
        self.check_ranges();
        if self.fault_count > 0 {
            self.faults.sort_by_key(|fault| fault.line);
            self.faults.truncate(MAX_PARSE_FAULTS);
            return Err(ReadError::Parse { faults: self.faults, total: self.fault_count });
        }
        if self.face_count == 0 {
            return Err(ReadError::NoFaces { vertices: self.mesh.polygons.positions.len() });
        }
        if !self.texture_corners.is_empty() {
            self.mesh.texture = Some(Texture { coordinates: self.coordinates, corners: self.texture_corners });
        }
        Ok(self.mesh)
    }

    /// Looks for corners that name elements which never came.
    fn check_ranges(&mut self) {
        let vertex_count = self.mesh.polygons.positions.len();
        let coordinate_count = self.coordinates.len();
        let corners = &self.mesh.polygons.corners;
        let vertex_misses = corners.iter().any(|v| v.index() >= vertex_count);
        let texture_misses = self.texture_corners.iter().any(|&t| t != NO_TEXTURE && t as usize >= coordinate_count);
        if !vertex_misses && !texture_misses {
            return;
        }
        // Faults of single lines may have filled the list; those found here can stand on earlier lines.
        let mut earlier = std::mem::take(&mut self.faults);
        for face in 0..self.face_count {
            let line = self.line_of_face(face).expect("every face has a line");
            for place in self.mesh.polygons.corner_range(face as usize) {
                let vertex = self.mesh.polygons.corners[place].number();
                if vertex as usize >= vertex_count {
                    self.fault_at(line, out_of_range("vertex", vertex, vertex_count));
                }
                let texture = self.texture_corners.get(place).copied().unwrap_or(NO_TEXTURE);
                if texture != NO_TEXTURE && texture as usize >= coordinate_count {
                    self.fault_at(line, out_of_range("texture coordinate", texture, coordinate_count));
                }
            }
        }
        self.faults.append(&mut earlier);
    }
}

fn out_of_range(element: &'static str, resolved: u32, count: usize) -> ParseFaultKind {
    ParseFaultKind::IndexOutOfRange { element, index: i64::from(resolved) + 1, count }
}

/// From an index as written to one from 0. Positive ones are checked when the file is read.
pub(super) fn resolve(element: &'static str, index: i64, count: usize) -> Result<u32, ParseFaultKind> {
    let from_zero = match index {
        1.. => Some(index - 1),
        0 => return Err(ParseFaultKind::IndexZero),
        _ => i64::try_from(count).ok().map(|count| count + index),
    };
    // The highest number is kept free to say "none".
    from_zero
        .and_then(|value| u32::try_from(value).ok())
        .filter(|&value| value != NO_TEXTURE)
        .ok_or(ParseFaultKind::IndexOutOfRange { element, index, count })
}
