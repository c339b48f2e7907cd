//! Requests to open files. A mesh file that may take more than half of the machine's memory waits for a confirmation.

use std::path::PathBuf;

use super::opened::{OpenError, Opened};
use crate::examples::Example;
use freebound_io::MemoryShortage;

/// Request to open a file.
#[derive(Clone, Debug)]
pub(super) enum OpenRequest {
    /// A mesh file or a project.
    File(PathBuf),
    /// A built-in mesh.
    Example(Example),
    /// A recovery copy of an earlier session.
    Recovery(PathBuf),
}

impl OpenRequest {
    /// Opens the file, unless its mesh may take more than half of `memory`, bytes. `None` means no limit.
    pub(super) fn open(&self, memory: Option<u64>) -> Result<Opened, OpenError> {
        match self {
            Self::File(path) => Opened::read(path, memory),
            Self::Example(example) => Ok(Opened::example(*example)),
            Self::Recovery(path) => Opened::recovered(path, memory),
        }
    }
}

/// File that needs a confirmation before it is read.
#[derive(Clone, Debug)]
pub struct LargeFile {
    /// Original request: the mesh file, or a project with it.
    pub(super) wanted: OpenRequest,
    /// Path of the mesh file.
    pub path: PathBuf,
    /// Memory that reading the file may take.
    pub shortage: MemoryShortage,
}
