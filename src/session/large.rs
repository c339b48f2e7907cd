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
    /// A project or a recovery copy with a file that the user located.
    Located { project: PathBuf, is_recovery: bool, file: LocatedFile },
}

impl OpenRequest {
    /// Opens the file, unless its mesh may take more than half of `memory`, bytes. `None` means no limit.
    pub(super) fn open(&self, memory: Option<u64>) -> Result<Opened, OpenError> {
        match self {
            Self::File(path) => Opened::read(path, memory),
            Self::Example(example) => Ok(Opened::example(*example)),
            Self::Recovery(path) => Opened::recovered(path, None, memory),
            Self::Located { project, is_recovery: true, file } => Opened::recovered(project, Some(file), memory),
            Self::Located { project, file, .. } => Opened::project_with(project, file, memory),
        }
    }
}

/// File that the user located in place of a missing one.
#[derive(Clone, Debug)]
pub(super) enum LocatedFile {
    Mesh(PathBuf),
    Picture(PathBuf),
}

/// Request that failed because the mesh of a project does not exist.
#[derive(Clone, Debug)]
pub(super) struct MissingMesh {
    /// Message about it.
    pub(super) message: u64,
    /// Project or recovery copy.
    pub(super) project: PathBuf,
    pub(super) is_recovery: bool,
}

impl OpenRequest {
    /// Project or recovery copy of a request, and true for a copy.
    pub(super) fn project(&self) -> Option<(PathBuf, bool)> {
        match self {
            Self::File(path) => Some((path.clone(), false)),
            Self::Recovery(path) => Some((path.clone(), true)),
            Self::Located { project, is_recovery, .. } => Some((project.clone(), *is_recovery)),
            Self::Example(_) => None,
        }
    }
}

/// Missing file of a project that the user can locate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MissingFile {
    /// Mesh. The project is not open.
    Mesh,
    /// Picture of the open project.
    Picture,
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
