//! Row of a PLY file that is being written.

use std::io::{self, Write};

use super::header::{Encoding, Scalar};
use freebound_core::mesh::VertexId;

/// Properties of an item, so far.
pub(super) struct Row {
    encoding: Encoding,
    pub(super) bytes: Vec<u8>,
}

impl Row {
    pub(super) fn of(encoding: Encoding) -> Self {
        Self { encoding, bytes: Vec::new() }
    }

    /// Appends a property in the form of another file with this encoding.
    pub(super) fn raw(&mut self, property: &[u8]) {
        self.bytes.extend_from_slice(property);
        if self.encoding == Encoding::Text {
            self.bytes.push(b' ');
        }
    }

    /// Appends a number that the type can hold; 32-bit floats are rounded.
    pub(super) fn number(&mut self, kind: Scalar, x: f64) {
        if self.encoding == Encoding::Text {
            let text = if kind.is_integer() { format!("{x:.0}") } else { format!("{x:?}") };
            return self.raw(text.as_bytes());
        }
        let begin = self.bytes.len();
        #[expect(clippy::cast_possible_truncation, reason = "the kind can hold it, or is to round it")]
        match kind {
            Scalar::F64 => self.bytes.extend(x.to_le_bytes()),
            Scalar::F32 => self.bytes.extend((x as f32).to_le_bytes()),
            _ => self.bytes.extend(&(x as i64).to_le_bytes()[..kind.size()]),
        }
        if self.encoding == Encoding::BigEndian {
            self.bytes[begin..].reverse();
        }
    }

    /// Appends a list of vertices; `kinds` are the types of its length and its indices.
    pub(super) fn indices(&mut self, kinds: [Scalar; 2], vertices: &[VertexId]) {
        self.number(kinds[0], vertices.len() as f64);
        for vertex in vertices {
            self.number(kinds[1], f64::from(vertex.number()));
        }
    }

    /// Writes the row and begins the next.
    pub(super) fn end(&mut self, out: &mut impl Write) -> io::Result<()> {
        if self.encoding == Encoding::Text {
            self.bytes.pop();
            self.bytes.push(b'\n');
        }
        out.write_all(&self.bytes)?;
        self.bytes.clear();
        Ok(())
    }
}
