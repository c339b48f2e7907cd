//! Files that are asked for, or about to be written.

use crate::session::OutputFit;
use crate::ui::panels::exports::PaneShot;
use crate::ui::{Dialogs, Unsaved};

/// Files that are asked for, or about to be written.
#[derive(Debug, Default)]
pub struct Files {
    /// File dialogs.
    pub dialogs: Dialogs,
    /// The question about unsaved work.
    pub unsaved: Unsaved,
    /// Size of coordinates in files.
    pub fit: OutputFit,
    pub(in crate::ui) shot: Option<PaneShot>,
}
