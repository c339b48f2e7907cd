//! Text read as a mesh file.

use freebound_io::{MeshFile, read_stream};

/// Reads text that is right.
pub fn read(text: &str) -> MeshFile {
    read_stream(text.as_bytes()).unwrap_or_else(|error| panic!("{text}: {error}"))
}
