//! File dialogs and files about to be written.

use std::path::PathBuf;
use std::sync::mpsc::Receiver;

use super::colour_table::ColourTable;
use crate::ui::dialogs::Dialogs;
use crate::ui::state::PendingClose;
use freebound_core::geom::Picture;
use freebound_core::pipeline::Fit;
use freebound_io::PatternOptions;

/// File dialogs and files about to be written.
#[derive(Debug, Default)]
pub struct Files {
    pub dialogs: Dialogs,
    pub unsaved: Unsaved,
    /// Size of coordinates in files.
    pub fit: Fit,
    /// Table of numbers that colours the faces.
    pub table: ColourTable,
    pub pattern: PatternChoice,
    /// Requested picture of a pane, and its path.
    pub(in crate::ui) shot: Option<(PathBuf, Receiver<Picture>)>,
}

/// Options of the next cutting pattern.
#[derive(Debug, Default)]
pub struct PatternChoice {
    /// True while their window is open.
    pub is_shown: bool,
    pub options: PatternOptions,
}

/// State of the question about unsaved work.
#[derive(Debug, Default)]
pub struct Unsaved {
    /// Action that waits for the user's answer.
    pub(super) asked: Option<PendingClose>,
    /// Action that follows once the project is saved.
    pub(super) after_saving: Option<PendingClose>,
}

impl Unsaved {
    /// Action that waits for the user's answer.
    pub(in crate::ui) fn asked(&self) -> Option<&PendingClose> {
        self.asked.as_ref()
    }

    pub fn is_asked(&self) -> bool {
        self.asked.is_some()
    }
}
