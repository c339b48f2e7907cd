//! Files that are asked for, or about to be written.

use std::path::PathBuf;
use std::sync::mpsc::Receiver;

use crate::ui::dialogs::Dialogs;
use crate::ui::state::PendingClose;
use freebound_core::geom::Picture;
use freebound_core::pipeline::Fit;

/// Files that are asked for, or about to be written.
#[derive(Debug, Default)]
pub struct Files {
    pub dialogs: Dialogs,
    pub unsaved: Unsaved,
    /// Size of coordinates in files.
    pub fit: Fit,
    /// A picture of a pane that was asked for, and where to write it.
    pub(in crate::ui) shot: Option<(PathBuf, Receiver<Picture>)>,
}

/// The question as the window has it.
#[derive(Debug, Default)]
pub struct Unsaved {
    /// Action that is asked about.
    pub(super) asked: Option<PendingClose>,
    /// Action that follows once the project is saved.
    pub(super) after_saving: Option<PendingClose>,
}

impl Unsaved {
    /// The action that waits for the answer.
    pub(in crate::ui) fn asked(&self) -> Option<&PendingClose> {
        self.asked.as_ref()
    }

    pub fn is_asked(&self) -> bool {
        self.asked.is_some()
    }
}
