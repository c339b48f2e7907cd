//! Parser of OBJ text.
//!
//! Parsing continues after a fault, so that all faults are known at the end. Pieces of the text are parsed in
//! parallel and joined in order, unless an index counts backwards or there is a fault.
//!
//! Supported: `v` (words after the third number are ignored), `vt`, `f` in all its forms with positive and negative
//! indices, `o`, `g`, `s`, `usemtl`, `mtllib`, comments, lines continued by `\`. Anything else is skipped. A positive
//! index may name an element that comes later in the file. Faces of fewer than three corners, and texture indices of
//! coordinates that do not exist, are left out with a warning. A line ends with LF, with CR LF, or with CR alone.

use std::ops::ControlFlow;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::line::{corner, has_few_corners, numbers, statement, words};
use super::lines::{Line, Lines, pieces, split_mark};
use crate::mesh_file::{
    MAX_PARSE_FAULTS, MeshFile, NO_TEXTURE, ParseFault, ParseFaultKind, ReadError, ReadWarning, ReadWarningKind,
    Statement, Texture,
};
use freebound_core::mesh::VertexId;

/// Size of a piece of the text, bytes: large enough to outweigh the cost of scheduling it.
const PIECE: usize = 256 << 10;

/// Number of pieces parsed between two checks for cancellation: some hundredths of a second.
const PIECES_AT_ONCE: usize = 16;

/// Parses a mesh. `watch` is called now and then and may cancel; the text itself is not kept.
pub(crate) fn parse(text: &[u8], watch: &mut dyn FnMut() -> ControlFlow<()>) -> Result<MeshFile, ReadError> {
    let pieces = pieces(split_mark(text).1, PIECE);
    let whole = match side_by_side(&pieces, watch)? {
        Some(parser) => parser,
        None => one_after_another(&pieces, watch)?,
    };
    whole.finish()
}

/// Parses pieces on all threads. `None` if an index counts backwards or there is a fault, because either depends on
/// all the text before it.
fn side_by_side(pieces: &[&[u8]], watch: &mut dyn FnMut() -> ControlFlow<()>) -> Result<Option<Parser>, ReadError> {
    let mut whole = Parser::default();
    for batch in pieces.chunks(PIECES_AT_ONCE) {
        let parsed: Vec<Result<Parser, ReadError>> = batch.par_iter().map(|piece| Parser::of(piece)).collect();
        for piece in parsed {
            let piece = piece?;
            if piece.counts_backwards || piece.fault_count > 0 {
                return Ok(None);
            }
            whole.append(piece)?;
        }
        if watch().is_break() {
            return Err(ReadError::Cancelled);
        }
    }
    Ok(Some(whole))
}

fn one_after_another(pieces: &[&[u8]], watch: &mut dyn FnMut() -> ControlFlow<()>) -> Result<Parser, ReadError> {
    let mut whole = Parser::default();
    for piece in pieces {
        whole.take_all(piece)?;
        if watch().is_break() {
            return Err(ReadError::Cancelled);
        }
    }
    Ok(whole)
}

/// Mesh as far as it is parsed.
#[derive(Debug, Default)]
struct Parser {
    mesh: MeshFile,
    coordinates: Vec<DVec2>,
    /// Empty until the first corner with a texture coordinate.
    texture_corners: Vec<u32>,
    face_count: u32,
    /// Runs of faces on consecutive lines: number of the first face and its line.
    line_runs: Vec<(u32, u64)>,
    /// Number of complete lines before the current one.
    line: u64,
    faults: Vec<ParseFault>,
    fault_count: usize,
    /// Faces of fewer than three corners.
    small_faces: LeftOut,
    /// Corners that name a texture coordinate that does not exist. Positive indices are checked at the end.
    missing_texture: LeftOut,
    /// True if an index counts backwards.
    counts_backwards: bool,
    /// Buffer for a line joined from continued ones.
    joined: Vec<u8>,
}

/// Number of elements that were left out, with the line of the first one.
#[derive(Clone, Copy, Debug, Default)]
struct LeftOut {
    count: usize,
    line: u64,
}

impl LeftOut {
    fn add(&mut self, line: u64) {
        self.append(Self { count: 1, line });
    }

    fn append(&mut self, later: Self) {
        if self.count == 0 || (later.count > 0 && later.line < self.line) {
            self.line = later.line;
        }
        self.count += later.count;
    }

    fn warning(self, kind: ReadWarningKind) -> Option<ReadWarning> {
        (self.count > 0).then_some(ReadWarning { kind, count: self.count, line: Some(self.line) })
    }
}

impl Parser {
    /// Parses a piece of a text on its own.
    fn of(piece: &[u8]) -> Result<Self, ReadError> {
        let mut parser = Self::default();
        parser.take_all(piece)?;
        Ok(parser)
    }

    fn take_all(&mut self, piece: &[u8]) -> Result<(), ReadError> {
        Lines::of(piece).try_for_each(|line| self.take(&line))
    }

    /// Appends the next piece, which was parsed on its own and has no faults.
    fn append(&mut self, piece: Self) -> Result<(), ReadError> {
        let (faces, corners) = (self.face_count, self.mesh.polygons.corners.len());
        let polygons = &mut self.mesh.polygons;
        polygons.positions.extend(piece.mesh.polygons.positions);
        polygons.corners.extend(piece.mesh.polygons.corners);
        self.check_size()?;
        let place = |corner: usize| u32::try_from(corner).expect("checked above");
        let polygons = &mut self.mesh.polygons;
        if polygons.starts.is_none() && piece.mesh.polygons.starts.is_some() {
            polygons.starts = Some(starts_of_triangles(faces));
        }
        if let Some(starts) = &mut polygons.starts {
            let own = piece.mesh.polygons.starts.unwrap_or_else(|| starts_of_triangles(piece.face_count));
            starts.extend(own.into_iter().skip(1).map(|start| start + place(corners)));
        }
        if !piece.texture_corners.is_empty() {
            self.texture_corners.resize(corners, NO_TEXTURE);
            self.texture_corners.extend(piece.texture_corners);
        }
        self.coordinates.extend(piece.coordinates);
        let moved = |statement: Statement| Statement { before_face: statement.before_face + faces, ..statement };
        self.mesh.statements.extend(piece.mesh.statements.into_iter().map(moved));
        for (first, line) in piece.line_runs {
            self.note_line(first + faces, line + self.line);
        }
        let in_file = |of_piece: LeftOut| LeftOut { line: of_piece.line + self.line, ..of_piece };
        let [small_faces, missing_texture] = [piece.small_faces, piece.missing_texture].map(in_file);
        self.small_faces.append(small_faces);
        self.missing_texture.append(missing_texture);
        self.face_count += piece.face_count;
        self.line += piece.line;
        Ok(())
    }

    /// Parses a line.
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
                    // A placeholder keeps the numbers of the vertices after it.
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

    /// Parses a texture coordinate. A missing second number is 0, as the format defines.
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

    fn take_face<'a>(&mut self, words: impl Iterator<Item = &'a [u8]> + Clone) -> Result<(), ReadError> {
        let begin = self.mesh.polygons.corners.len();
        if has_few_corners(words.clone()) {
            self.small_faces.add(self.line + 1);
            return Ok(());
        }
        if let Err(kind) = self.take_corners(words) {
            self.mesh.polygons.corners.truncate(begin);
            self.texture_corners.truncate(begin);
            self.fault(kind);
            return Ok(());
        }
        self.check_size()?;
        let polygons = &mut self.mesh.polygons;
        let end = polygons.corners.len();
        let place = |corner: usize| u32::try_from(corner).expect("checked above");
        if polygons.starts.is_none() && end - begin != 3 {
            polygons.starts = Some(starts_of_triangles(self.face_count));
        }
        if let Some(starts) = &mut polygons.starts {
            starts.push(place(end));
        }
        self.note_line(self.face_count, self.line + 1);
        self.face_count += 1;
        Ok(())
    }

    /// Fails if 32 bits cannot number the corners or vertices.
    fn check_size(&self) -> Result<(), ReadError> {
        let polygons = &self.mesh.polygons;
        let is_too_large = polygons.corners.len().max(polygons.positions.len()) >= u32::MAX as usize;
        if is_too_large { Err(ReadError::TooLarge) } else { Ok(()) }
    }

    /// Records the line of a face. Consecutive faces on consecutive lines share one entry.
    fn note_line(&mut self, face: u32, line: u64) {
        if self.line_of_face(face) != Some(line) {
            self.line_runs.push((face, line));
        }
    }

    fn take_corners<'a>(&mut self, words: impl Iterator<Item = &'a [u8]>) -> Result<(), ParseFaultKind> {
        let vertex_count = self.mesh.polygons.positions.len();
        for word in words {
            let (vertex, texture) = corner(word)?;
            self.counts_backwards |= vertex < 0 || texture.is_some_and(|texture| texture < 0);
            let vertex = resolve("vertex", vertex, vertex_count)?;
            if let Some(texture) = texture {
                match resolve("texture coordinate", texture, self.coordinates.len()) {
                    Ok(texture) => {
                        self.texture_corners.resize(self.mesh.polygons.corners.len(), NO_TEXTURE);
                        self.texture_corners.push(texture);
                    }
                    Err(_) => self.missing_texture.add(self.line + 1),
                }
            }
            self.mesh.polygons.corners.push(VertexId::new(vertex));
        }
        Ok(())
    }

    /// Line of a face.
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

    /// Runs the checks that need the whole file.
    fn finish(mut self) -> Result<MeshFile, ReadError> {
        if !self.texture_corners.is_empty() {
            self.texture_corners.resize(self.mesh.polygons.corners.len(), NO_TEXTURE);
        }
        self.check_vertices();
        self.drop_missing_texture();
        if self.fault_count > 0 {
            self.faults.sort_by_key(|fault| fault.line);
            self.faults.truncate(MAX_PARSE_FAULTS);
            return Err(ReadError::Parse { faults: self.faults, total: self.fault_count });
        }
        if self.face_count == 0 {
            return Err(ReadError::NoFaces { vertices: self.mesh.polygons.positions.len() });
        }
        let small_faces = self.small_faces.warning(ReadWarningKind::FacesOfFewCorners);
        let missing = self.missing_texture.warning(ReadWarningKind::MissingTextureCoordinates);
        self.mesh.warnings = small_faces.into_iter().chain(missing).collect();
        if self.texture_corners.iter().any(|&texture| texture != NO_TEXTURE) {
            self.mesh.texture = Some(Texture { coordinates: self.coordinates, corners: self.texture_corners });
        }
        Ok(self.mesh)
    }

    /// Reports corners that name missing vertices.
    fn check_vertices(&mut self) {
        let vertex_count = self.mesh.polygons.positions.len();
        if self.mesh.polygons.corners.iter().all(|v| v.index() < vertex_count) {
            return;
        }
        // Faults of single lines may have filled the list; the faults found here may be on earlier lines.
        let mut earlier = std::mem::take(&mut self.faults);
        for face in 0..self.face_count {
            let line = self.line_of_face(face).expect("every face has a line");
            for place in self.mesh.polygons.corner_range(face as usize) {
                let vertex = self.mesh.polygons.corners[place].number();
                if vertex as usize >= vertex_count {
                    let (index, count) = (i64::from(vertex) + 1, vertex_count);
                    self.fault_at(line, ParseFaultKind::IndexOutOfRange { element: "vertex", index, count });
                }
            }
        }
        self.faults.append(&mut earlier);
    }

    /// Takes texture coordinates that do not exist from the corners that name them.
    fn drop_missing_texture(&mut self) {
        let count = self.coordinates.len();
        let is_missing = |&texture: &u32| texture != NO_TEXTURE && texture as usize >= count;
        if !self.texture_corners.iter().any(is_missing) {
            return;
        }
        for face in 0..self.face_count {
            for place in self.mesh.polygons.corner_range(face as usize) {
                if is_missing(&self.texture_corners[place]) {
                    self.texture_corners[place] = NO_TEXTURE;
                    self.missing_texture.add(self.line_of_face(face).expect("every face has a line"));
                }
            }
        }
    }
}

/// Offsets of the corners of `count` triangles, and the end of the last.
fn starts_of_triangles(count: u32) -> Vec<u32> {
    (0..=count).map(|face| 3 * face).collect()
}

/// Converts an index as written to one from 0. Positive indices are checked at the end of the file.
pub(super) fn resolve(element: &'static str, index: i64, count: usize) -> Result<u32, ParseFaultKind> {
    let from_zero = match index {
        1.. => Some(index - 1),
        0 => return Err(ParseFaultKind::IndexZero),
        _ => i64::try_from(count).ok().map(|count| count + index),
    };
    // The largest number is reserved for [`NO_TEXTURE`].
    from_zero
        .and_then(|value| u32::try_from(value).ok())
        .filter(|&value| value != NO_TEXTURE)
        .ok_or(ParseFaultKind::IndexOutOfRange { element, index, count })
}
