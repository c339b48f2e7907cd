//! Estimate of the memory for reading a mesh file, from its extension and its length.
//!
//! ```text
//! memory = length × bytes of memory per byte of the file, by format
//! ```
//!
//! Measured as peak memory of `freebound check` per byte of the file, on one sheet of 217,800 triangles without
//! normals and texture coordinates, and rounded up: STL 4.4 (binary), OFF 6.4, OBJ 7.1, PLY 12.4 (binary), GLB 12.9.
//! The memory of a solve comes on top. Buffers beside a glTF file are not counted.

use std::ffi::OsStr;
use std::path::Path;
use std::{fs, io};

use crate::machine::bytes_in_words;

/// Bytes of memory per byte of the file, by extension.
const BYTES_PER_BYTE: [(&str, u64); 5] = [("stl", 5), ("off", 7), ("obj", 8), ("ply", 13), ("glb", 13)];

/// Bytes of memory per byte of a file with an unknown extension: the largest of all formats.
const MOST_BYTES_PER_BYTE: u64 = 13;

/// Inverse of the share of the machine's memory that a mesh may take without confirmation.
const SHARE: u64 = 2;

/// File that may take more than half of the machine's memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("reading it may need {}, more than half of the machine's memory of {}", bytes_in_words(*needed), bytes_in_words(*memory))]
pub struct MemoryShortage {
    /// Memory for reading the file, bytes.
    pub needed: u64,
    /// Memory of the machine, bytes.
    pub memory: u64,
}

/// Memory for reading a mesh file, bytes; 0 for anything but a regular file, such as a pipe.
///
/// # Errors
///
/// If the system does not tell the length of the file.
pub fn memory_to_read(path: &Path) -> io::Result<u64> {
    let data = fs::metadata(path)?;
    let length = if data.is_file() { data.len() } else { 0 };
    Ok(length.saturating_mul(bytes_per_byte(path.extension().unwrap_or_default())))
}

fn bytes_per_byte(extension: &OsStr) -> u64 {
    let known = BYTES_PER_BYTE.iter().find(|(name, _)| extension.eq_ignore_ascii_case(name));
    known.map_or(MOST_BYTES_PER_BYTE, |&(_, bytes)| bytes)
}

/// Checks that reading a mesh file takes at most half of this memory (bytes). Without a number every file passes. A
/// missing file passes, too: reading it reports the error.
///
/// # Errors
///
/// [`MemoryShortage`] with the memory that reading may take.
pub fn check_memory(path: &Path, memory: Option<u64>) -> Result<(), MemoryShortage> {
    let Some(memory) = memory else { return Ok(()) };
    match memory_to_read(path) {
        Ok(needed) if needed > memory / SHARE => Err(MemoryShortage { needed, memory }),
        _ => Ok(()),
    }
}
