//! Text read as a mesh file.

use freebound_io::{MeshFile, read_stream};

/// Reads a valid mesh file from text.
pub fn read(text: &str) -> MeshFile {
    read_stream(text.as_bytes()).unwrap_or_else(|error| panic!("{text}: {error}"))
}
