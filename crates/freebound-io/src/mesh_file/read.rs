//! Reader of mesh files. All bytes are read first, and are kept if the file can be written again; then they are
//! parsed.

use std::fs::File;
use std::io::Read;
use std::ops::ControlFlow;
use std::path::Path;

use memchr::{memchr, memrchr2};

use super::format::Format;
use super::off::parse_off;
use super::stl::{parse_stl_binary, parse_stl_text};
use super::{MeshFile, ReadError, Source, SourceFormat};
use crate::gltf::parse_gltf;
use crate::obj::{Lines, parse as parse_obj};
use crate::ply::parse_ply;

/// Number of bytes read at once.
const CHUNK: u64 = 256 << 10;

/// Maximum length of a line, bytes: a polygon with a million corners fits.
const MAX_LINE: usize = 16 << 20;

/// Options of reading a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// Use of meshes that several nodes of a glTF file show.
    pub instances: Instances,
}

/// Use of a mesh that several nodes of a glTF file show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Instances {
    /// Read each mesh once, at its first node; all its nodes share its map.
    #[default]
    Shared,
    /// Read a mesh of its own for each node; each gets a map of its own.
    Unique,
}

/// Progress of reading a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReadProgress {
    /// Bytes read so far.
    pub bytes: u64,
    /// Size of the file in bytes, if known.
    pub total: Option<u64>,
}

/// Reads a mesh from a file.
///
/// # Errors
///
/// [`ReadError`] for the fault of the file.
pub fn read_mesh(path: &Path) -> Result<MeshFile, ReadError> {
    read_mesh_with(path, ReadOptions::default(), &mut |_| ControlFlow::Continue(()))
}

/// Reads a mesh from a file and reports progress; `watch` cancels the reading by breaking.
///
/// # Errors
///
/// [`ReadError`] for the fault of the file.
pub fn read_mesh_with(
    path: &Path,
    options: ReadOptions,
    watch: &mut dyn FnMut(ReadProgress) -> ControlFlow<()>,
) -> Result<MeshFile, ReadError> {
    let file = File::open(path)?;
    let total = file.metadata().ok().filter(std::fs::Metadata::is_file).map(|data| data.len());
    read(file, Some(path), options, &mut |bytes| watch(ReadProgress { bytes, total }))
}

/// Reads a mesh from a stream; its first bytes determine the format.
///
/// # Errors
///
/// [`ReadError`] for the fault of the stream.
pub fn read_stream(reader: impl Read) -> Result<MeshFile, ReadError> {
    read_stream_with(reader, ReadOptions::default(), &mut |_| ControlFlow::Continue(()))
}

/// Reads a mesh from a stream and reports the bytes read so far; `watch` cancels the reading by breaking.
///
/// # Errors
///
/// [`ReadError`] for the fault of the stream.
pub fn read_stream_with(
    reader: impl Read,
    options: ReadOptions,
    watch: &mut dyn FnMut(u64) -> ControlFlow<()>,
) -> Result<MeshFile, ReadError> {
    read(reader, None, options, watch)
}

fn read(
    mut reader: impl Read,
    path: Option<&Path>,
    options: ReadOptions,
    watch: &mut dyn FnMut(u64) -> ControlFlow<()>,
) -> Result<MeshFile, ReadError> {
    let mut bytes = Vec::new();
    reader.by_ref().take(CHUNK).read_to_end(&mut bytes)?;
    let extension = path.map(|path| path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase());
    let format = Format::of(&bytes, extension.as_deref())?;
    read_rest(&mut reader, &mut bytes, format, watch)?;
    let size = bytes.len() as u64;
    let mut mesh = match format {
        Format::Obj => parse_obj(&bytes, &mut || watch(size))?,
        Format::Off => parse_off(&bytes)?,
        Format::StlText => parse_stl_text(&bytes)?,
        Format::StlBinary => parse_stl_binary(&bytes)?,
        Format::Ply => return parse_ply(bytes),
        Format::Gltf => {
            let folder = path.map(|path| path.parent().unwrap_or(Path::new("")));
            return parse_gltf(bytes, folder, options.instances);
        }
    };
    if format == Format::Obj {
        mesh.source = Some(Source::of(SourceFormat::Obj, bytes, mesh.polygons.positions.len()));
    }
    Ok(mesh)
}

/// Reads everything after the first chunk. Binary data in a text format and overlong lines fail as soon as they are
/// seen.
fn read_rest(
    reader: &mut impl Read,
    bytes: &mut Vec<u8>,
    format: Format,
    watch: &mut dyn FnMut(u64) -> ControlFlow<()>,
) -> Result<(), ReadError> {
    let is_text = matches!(format, Format::Obj | Format::Off | Format::StlText);
    let (mut fresh, mut line_begin) = (0, 0);
    while fresh < bytes.len() {
        if is_text {
            check_text(bytes, fresh, &mut line_begin)?;
        }
        if watch(bytes.len() as u64).is_break() {
            return Err(ReadError::Cancelled);
        }
        fresh = bytes.len();
        reader.by_ref().take(CHUNK).read_to_end(bytes)?;
    }
    Ok(())
}

/// Fails for new bytes that contain a zero, and for overlong lines.
fn check_text(bytes: &[u8], fresh: usize, line_begin: &mut usize) -> Result<(), ReadError> {
    if memchr(0, &bytes[fresh..]).is_some() {
        return Err(ReadError::NotText);
    }
    *line_begin = memrchr2(b'\n', b'\r', &bytes[fresh..]).map_or(*line_begin, |at| fresh + at + 1);
    if bytes.len() - *line_begin > MAX_LINE {
        let line = 1 + Lines::of(&bytes[..*line_begin]).map(|line| line.count).sum::<u64>();
        return Err(ReadError::LineTooLong { line, limit: MAX_LINE });
    }
    Ok(())
}
