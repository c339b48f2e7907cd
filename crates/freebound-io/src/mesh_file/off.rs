//! OFF files: a line per vertex and a line per face. Further contents of a line (colours, normals, texture
//! coordinates) are ignored.
//!
//! Source: Geomview's manual, "OFF". Binary files, and files with four or any number of coordinates, are not
//! supported.

use glam::DVec3;

use super::{FaultPlace, MeshFile, ParseFaultKind, ReadError, fault_at};
use crate::obj::{Lines, number, quoted, split_mark, words};
use freebound_core::mesh::{PolygonMesh, VertexId};

/// Least number of bytes of a line.
const LEAST_LINE: u64 = 2;

/// Parses a mesh from OFF text.
pub(super) fn parse_off(text: &[u8]) -> Result<MeshFile, ReadError> {
    let mut rows = Rows::of(split_mark(text).1);
    let [vertices, faces] = rows.counts(text.len())?;
    let mut mesh = PolygonMesh { starts: Some(vec![0]), ..PolygonMesh::default() };
    for _ in 0..vertices {
        mesh.positions.push(rows.position()?);
    }
    let mut are_triangles = true;
    for _ in 0..faces {
        let corners = rows.corners(vertices)?;
        are_triangles &= corners.len() == 3;
        mesh.corners.extend(corners);
        let end = u32::try_from(mesh.corners.len()).map_err(|_| ReadError::TooLarge)?;
        mesh.starts.as_mut().expect("made above").push(end);
    }
    if faces == 0 {
        return Err(ReadError::NoFaces { vertices: mesh.positions.len() });
    }
    if are_triangles {
        mesh.starts = None;
    }
    Ok(MeshFile { polygons: mesh, ..MeshFile::default() })
}

/// Iterator over the lines with words.
struct Rows<'a> {
    lines: Lines<'a>,
    /// Number of the current line.
    line: u64,
    next_line: u64,
}

impl<'a> Rows<'a> {
    fn of(text: &'a [u8]) -> Self {
        Self { lines: Lines::of(text), line: 0, next_line: 1 }
    }

    /// Next line with words.
    fn row(&mut self) -> Result<&'a [u8], ReadError> {
        loop {
            self.line = self.next_line;
            let line = self.lines.next().ok_or_else(|| self.fault(ParseFaultKind::EndsEarly))?;
            self.next_line += line.count;
            let row = &line.whole[..line.length];
            if words(row).next().is_some() {
                return Ok(row);
            }
        }
    }

    /// Numbers of vertices and faces. Fails if a text of `size` bytes is too short for them.
    fn counts(&mut self, size: usize) -> Result<[u64; 2], ReadError> {
        let mut row = self.row()?;
        if let Some(at) = row.windows(3).position(|three| three == b"OFF") {
            if row[..at].iter().any(|byte| b"4n".contains(byte)) {
                return Err(ReadError::NotReadYet("OFF without exactly three coordinates"));
            }
            row = &row[at + 3..];
            if words(row).next() == Some(b"BINARY") {
                return Err(ReadError::NotReadYet("binary OFF"));
            }
            if words(row).next().is_none() {
                row = self.row()?;
            }
        }
        let mut words = words(row);
        let mut count = |element: &str| {
            let word = words.next().ok_or_else(|| self.fault(ParseFaultKind::EndsEarly))?;
            let count = self.integer(word)?;
            let count = u64::try_from(count).map_err(|_| self.fault(ParseFaultKind::BadNumber(quoted(word))))?;
            let has_room = count.checked_mul(LEAST_LINE).is_some_and(|least| least <= size as u64);
            let too_many = || self.fault(ParseFaultKind::TooMany { element: element.to_owned(), count });
            if has_room { Ok(count) } else { Err(too_many()) }
        };
        Ok([count("vertex")?, count("face")?])
    }

    fn position(&mut self) -> Result<DVec3, ReadError> {
        let row = self.row()?;
        let mut position = [0.0; 3];
        let mut words = words(row);
        for (found, coordinate) in position.iter_mut().enumerate() {
            let word = words.next().ok_or_else(|| self.fault(ParseFaultKind::TooFewNumbers { found, needed: 3 }))?;
            *coordinate = number(word).ok_or_else(|| self.fault(ParseFaultKind::BadNumber(quoted(word))))?;
        }
        let position = DVec3::from(position);
        if position.is_finite() { Ok(position) } else { Err(self.fault(ParseFaultKind::NotFinite)) }
    }

    fn corners(&mut self, vertices: u64) -> Result<Vec<VertexId>, ReadError> {
        let row = self.row()?;
        let mut words = words(row);
        let count = self.integer(words.next().expect("a row has words"))?;
        let mut corners = Vec::new();
        for word in words.take(usize::try_from(count).unwrap_or(0)) {
            let index = self.integer(word)?;
            let vertex = u32::try_from(index).ok().filter(|&vertex| u64::from(vertex) < vertices);
            let count = usize::try_from(vertices).unwrap_or(usize::MAX);
            let out = || self.fault(ParseFaultKind::IndexOutOfRange { element: "vertex", index, count });
            corners.push(VertexId::new(vertex.ok_or_else(out)?));
        }
        if i64::try_from(corners.len()).is_ok_and(|found| found == count) && count >= 3 {
            return Ok(corners);
        }
        Err(self.fault(if count >= 3 {
            ParseFaultKind::TooFewNumbers { found: corners.len(), needed: usize::try_from(count).unwrap_or(usize::MAX) }
        } else {
            ParseFaultKind::TooFewCorners(usize::try_from(count).unwrap_or(0))
        }))
    }

    fn integer(&self, word: &[u8]) -> Result<i64, ReadError> {
        let parsed = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
        parsed.ok_or_else(|| self.fault(ParseFaultKind::BadNumber(quoted(word))))
    }

    fn fault(&self, kind: ParseFaultKind) -> ReadError {
        fault_at(FaultPlace::Line(self.line), kind)
    }
}
