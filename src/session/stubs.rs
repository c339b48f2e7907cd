//! What the window asks of the session beside actions: unsaved work and recovery.

use std::path::PathBuf;

use super::{Model, Session};

/// Work that a session left which ended without saving.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recoverable {
    /// What the document was called.
    pub name: String,
    /// Where its autosave lies.
    pub path: PathBuf,
}

impl Session {
    /// Whether something would be lost if the document were closed.
    pub fn has_unsaved_work(&self) -> bool {
        self.history().can_undo()
    }

    /// Where the project was saved or opened.
    pub fn project_path(&self) -> Option<PathBuf> {
        None
    }

    /// What sessions left that ended without saving.
    pub fn recoverable(&self) -> &[Recoverable] {
        &[]
    }

    /// Whether a file is being written.
    pub fn is_saving(&self) -> bool {
        !self.saving.is_empty()
    }
}

impl Model {
    /// Whether the surface shows its inside.
    pub fn faces_point_inward(&self) -> bool {
        false
    }
}
