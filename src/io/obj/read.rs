//! Reads OBJ files in chunks: beside the mesh only a few lines are in memory.
//!
//! Understood: `v` (words behind the third number are ignored), `vt`, `f` in all its forms with positive and negative
//! indices, `o`, `g`, `s`, `usemtl`, `mtllib`, comments, lines that go on behind a `\`. Anything else is skipped. A
//! positive index may name an element that comes later in the file. A line ends with LF, with CR LF, or with CR alone.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::ops::ControlFlow;
use std::path::Path;

use super::format::{format_of_extension, not_text};
use super::parse::Parser;
use super::{ObjMesh, ReadError};

/// Bytes read at once.
const CHUNK: usize = 256 << 10;

/// Longest line, bytes: a polygon with a million corners fits.
const MAX_LINE: usize = 16 << 20;

/// How far the reading of a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Bytes read so far.
    pub bytes: u64,
    /// Bytes in all, where that is known.
    pub total: Option<u64>,
}

/// Reads a mesh from a file.
///
/// # Errors
///
/// [`ReadError`] says what is wrong with the file.
pub fn read_mesh(path: &Path) -> Result<ObjMesh, ReadError> {
    read_mesh_with(path, &mut |_| ControlFlow::Continue(()))
}

/// Reads a mesh from a file, reporting progress; `watch` stops the reading by breaking.
///
/// # Errors
///
/// [`ReadError`] says what is wrong with the file.
pub fn read_mesh_with(path: &Path, watch: &mut dyn FnMut(Progress) -> ControlFlow<()>) -> Result<ObjMesh, ReadError> {
    let file = File::open(path)?;
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    if let Some(format) = format_of_extension(&extension) {
        return Err(ReadError::NotReadYet(format));
    }
    let total = file.metadata().ok().filter(std::fs::Metadata::is_file).map(|data| data.len());
    read_obj_with(file, &mut |bytes| watch(Progress { bytes, total }))
}

/// Reads OBJ text.
///
/// # Errors
///
/// [`ReadError`] says what is wrong with the text.
pub fn read_obj(reader: impl Read) -> Result<ObjMesh, ReadError> {
    read_obj_with(reader, &mut |_| ControlFlow::Continue(()))
}

/// Reads OBJ text, reporting the bytes read so far; `watch` stops the reading by breaking.
///
/// # Errors
///
/// [`ReadError`] says what is wrong with the text.
pub fn read_obj_with(
    mut reader: impl Read,
    watch: &mut dyn FnMut(u64) -> ControlFlow<()>,
) -> Result<ObjMesh, ReadError> {
    let mut parser = Parser::default();
    let mut buffer = vec![0; CHUNK];
    let mut filled = 0;
    let mut total = 0;
    loop {
        if filled == buffer.len() {
            if filled >= MAX_LINE {
                return Err(ReadError::LineTooLong { line: parser.lines_taken() + 1, limit: MAX_LINE });
            }
            buffer.resize(2 * filled, 0);
        }
        let count = match reader.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(count) => count,
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(error) => return Err(error.into()),
        };
        end_lines(&mut buffer[..filled + count], filled);
        let fresh = &buffer[filled..filled + count];
        let (has_zero, has_line) = (fresh.contains(&0), fresh.contains(&b'\n'));
        filled += count;
        total += count as u64;
        if has_zero {
            return Err(not_text(&buffer[..filled], parser.lines_taken()));
        }
        if has_line {
            let taken = parser.take_lines(&buffer[..filled])?;
            buffer.copy_within(taken..filled, 0);
            filled -= taken;
        }
        if watch(total).is_break() {
            return Err(ReadError::Cancelled);
        }
    }
    buffer.truncate(filled);
    // The last line may lack its end, and may end with a `\` that nothing follows.
    buffer.push(b'\n');
    let taken = parser.take_lines(&buffer)?;
    parser.finish(&buffer[taken..])
}

/// Makes a line feed of every carriage return that stands alone, as other programs read it. The last byte waits for the
/// next chunk. `fresh` is where the bytes begin that are new.
fn end_lines(bytes: &mut [u8], fresh: usize) {
    let mut at = fresh.saturating_sub(1);
    // Most files have none, and to look for one byte alone is fast.
    if !bytes[at..].contains(&b'\r') {
        return;
    }
    while let Some(found) = bytes[at..].iter().position(|&byte| byte == b'\r') {
        at += found + 1;
        if bytes.get(at).is_some_and(|&next| next != b'\n') {
            bytes[at - 1] = b'\n';
        }
    }
}
