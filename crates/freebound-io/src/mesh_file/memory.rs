//! The memory that it takes to read a mesh file, estimated from its name and its length before anything of it is read.
//!
//! ```text
//! memory = length × bytes of memory per byte of the file, by format
//! ```
//!
//! Measured as the most memory that `freebound check` held on one sheet of 217,800 triangles, without normals and texture
//! coordinates, per byte of the file, and rounded up: STL 4.4 (binary), OFF 6.4, OBJ 7.1, PLY 12.4 (binary), GLB 12.9. What a
//! solve takes comes on top; the buffers beside a glTF file are not counted.

use std::ffi::OsStr;
use std::path::Path;
use std::{fs, io};

use crate::machine::bytes_in_words;

/// Bytes of memory per byte of the file, by the ending of its name.
const BYTES_PER_BYTE: [(&str, u64); 5] = [("stl", 5), ("off", 7), ("obj", 8), ("ply", 13), ("glb", 13)];

/// The same of names that tell no format: as much as any.
const MOST_BYTES_PER_BYTE: u64 = 13;

/// The share of the machine's memory that a mesh may take without a question: one half.
const SHARE: u64 = 2;

/// A file that may take more than half of the machine's memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("reading it may take {}, more than half of the machine's memory of {}", bytes_in_words(*needed), bytes_in_words(*memory))]
pub struct MemoryShortage {
    /// What reading it may take, bytes.
    pub needed: u64,
    /// What the machine has, bytes.
    pub memory: u64,
}

/// What reading a mesh file may take, bytes; 0 of what is no file, such as a pipe.
///
/// # Errors
///
/// Where the system does not tell the file's length.
pub fn memory_to_read(path: &Path) -> io::Result<u64> {
    let data = fs::metadata(path)?;
    let length = if data.is_file() { data.len() } else { 0 };
    Ok(length.saturating_mul(bytes_per_byte(path.extension().unwrap_or_default())))
}

fn bytes_per_byte(extension: &OsStr) -> u64 {
    let known = BYTES_PER_BYTE.iter().find(|(name, _)| extension.eq_ignore_ascii_case(name));
    known.map_or(MOST_BYTES_PER_BYTE, |&(_, bytes)| bytes)
}

/// Whether a mesh file can be read within half of this memory, bytes; without a number any can. A file that is not there
/// passes: reading it says so.
///
/// # Errors
///
/// [`MemoryShortage`] says what it may take.
pub fn check_memory(path: &Path, memory: Option<u64>) -> Result<(), MemoryShortage> {
    let Some(memory) = memory else { return Ok(()) };
    match memory_to_read(path) {
        Ok(needed) if needed > memory / SHARE => Err(MemoryShortage { needed, memory }),
        _ => Ok(()),
    }
}
