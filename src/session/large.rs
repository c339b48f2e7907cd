//! What is to be opened; and a mesh file whose reading may take more than half of the machine's memory, which waits for a
//! person's word.

use std::path::PathBuf;

use super::Session;
use super::files::Files;
use super::opened::{OpenError, Opened};
use crate::examples::Example;
use crate::io::MemoryShortage;

/// What is to be opened.
#[derive(Clone, Debug)]
pub(super) enum Wanted {
    /// A mesh file or a project.
    File(PathBuf),
    /// A built-in mesh.
    Example(Example),
    /// What a session before has left.
    Recovery(PathBuf),
}

impl Wanted {
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
    pub(super) wanted: Wanted,
    /// The mesh file.
    pub path: PathBuf,
    /// What reading it may take.
    pub shortage: MemoryShortage,
}

impl Files {
    /// Opens what waits for a word.
    pub(super) fn open_large(&mut self) {
        if let Some(large) = self.large.take() {
            self.load(large.wanted, None);
        }
    }

    /// Leaves it.
    pub(super) fn leave_large(&mut self) {
        if self.large.take().is_some() {
            self.end_opening();
        }
    }
}

impl Session {
    /// Asks before it opens what may take more than half of this memory, bytes.
    pub fn heed_memory(&mut self, bytes: u64) {
        self.files.memory = Some(bytes);
    }

    /// The file that waits for [`Action::OpenLarge`](super::Action::OpenLarge) or
    /// [`Action::LeaveLarge`](super::Action::LeaveLarge).
    pub fn large_file(&self) -> Option<&LargeFile> {
        self.files.large.as_ref()
    }
}
