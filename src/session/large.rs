//! What is to be opened; and a mesh file whose reading may take more than half of the machine's memory, which waits for a
//! person's word.

use std::path::PathBuf;

use super::opened::{OpenError, Opened};
use crate::examples::Example;
use freebound_io::MemoryShortage;

/// What is to be opened.
#[derive(Clone, Debug)]
pub(super) enum OpenRequest {
    /// A mesh file or a project.
    File(PathBuf),
    /// A built-in mesh.
    Example(Example),
    /// What a session before has left.
    Recovery(PathBuf),
}

impl OpenRequest {
    /// Opens it, unless its mesh may take more than half of this memory, bytes; without a number, whatever it takes.
    pub(super) fn open(&self, memory: Option<u64>) -> Result<Opened, OpenError> {
        match self {
            Self::File(path) => Opened::read(path, memory),
            Self::Example(example) => Ok(Opened::example(*example)),
            Self::Recovery(path) => Opened::recovered(path, memory),
        }
    }
}

/// A file that is not read without a person's word.
#[derive(Clone, Debug)]
pub struct LargeFile {
    /// What was to be opened: the file itself, or a project with it.
    pub(super) wanted: OpenRequest,
    /// The mesh file.
    pub path: PathBuf,
    /// What reading it may take.
    pub shortage: MemoryShortage,
}
