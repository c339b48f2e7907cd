//! Reads OBJ files: the whole text first, which is kept to be written again, then its lines.
//!
//! Understood: `v` (words behind the third number are ignored), `vt`, `f` in all its forms with positive and negative
//! indices, `o`, `g`, `s`, `usemtl`, `mtllib`, comments, lines that go on behind a `\`. Anything else is skipped. A
//! positive index may name an element that comes later in the file. A line ends with LF, with CR LF, or with CR alone.

use std::fs::File;
use std::io::Read;
use std::ops::ControlFlow;
use std::path::Path;

use memchr::{memchr, memrchr2};

use super::format::{format_of_extension, not_text};
use super::lines::Lines;
use super::parse::parse;
use super::{ObjMesh, ReadError, SourceText};

/// Bytes read at once.
const CHUNK: u64 = 256 << 10;

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
    let text = read_text(&mut reader, watch)?;
    let size = text.len() as u64;
    let mut mesh = parse(&text, &mut || watch(size))?;
    mesh.text = Some(SourceText::of(text, mesh.polygons.positions.len()));
    Ok(mesh)
}

/// Reads all of a text. What is no text, or has lines that no reader should hold, is refused as soon as it is seen.
fn read_text(reader: &mut impl Read, watch: &mut dyn FnMut(u64) -> ControlFlow<()>) -> Result<Vec<u8>, ReadError> {
    let mut text = Vec::new();
    let mut line_begin = 0;
    loop {
        let fresh = text.len();
        match reader.by_ref().take(CHUNK).read_to_end(&mut text)? {
            0 => return Ok(text),
            _ if memchr(0, &text[fresh..]).is_some() => return Err(not_text(&text, fresh)),
            _ => {}
        }
        line_begin = memrchr2(b'\n', b'\r', &text[fresh..]).map_or(line_begin, |at| fresh + at + 1);
        if text.len() - line_begin > MAX_LINE {
            let line = 1 + Lines::of(&text[..line_begin]).map(|line| line.count).sum::<u64>();
            return Err(ReadError::LineTooLong { line, limit: MAX_LINE });
        }
        if watch(text.len() as u64).is_break() {
            return Err(ReadError::Cancelled);
        }
    }
}
