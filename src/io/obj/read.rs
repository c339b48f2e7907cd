//! Reads OBJ files in chunks: beside the mesh only a few lines are in memory.
//!
//! Understood: `v` (words behind the third number are ignored), `vt`, `f` in all its forms with positive and negative
//! indices, `o`, `g`, `s`, `usemtl`, `mtllib`, comments, lines that go on behind a `\`. Anything else is skipped. A
//! positive index may name an element that comes later in the file.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::ops::ControlFlow;
use std::path::Path;

use super::line::words;
use super::parse::{Parser, format_of_word};
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
    let unreadable = |source| ReadError::File { path: path.to_owned(), source };
    let file = File::open(path).map_err(unreadable)?;
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    if let Some(format) = format_of_extension(&extension) {
        return Err(ReadError::NotReadYet(format));
    }
    let total = file.metadata().ok().filter(std::fs::Metadata::is_file).map(|data| data.len());
    let read = read_obj_with(file, &mut |bytes| watch(Progress { bytes, total }));
    read.map_err(|error| match error {
        ReadError::Stream(source) => unreadable(source),
        other => other,
    })
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

fn format_of_extension(extension: &str) -> Option<&'static str> {
    Some(match extension {
        "off" => "OFF",
        "ply" => "PLY",
        "stl" => "STL",
        "gltf" | "glb" => "glTF",
        _ => return None,
    })
}

/// What a file with a zero byte is, going by its beginning.
fn not_text(head: &[u8], lines_before: u64) -> ReadError {
    let first_line = head.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let format = match words(first_line).next() {
        _ if lines_before > 0 => None,
        _ if head.starts_with(b"glTF") => Some("glTF"),
        word => word.and_then(format_of_word),
    };
    format.map_or(ReadError::NotText, ReadError::NotReadYet)
}
