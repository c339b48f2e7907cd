//! File dialogs and files about to be written.

use std::path::PathBuf;
use std::sync::mpsc::Receiver;

use super::colour_table::ColourTable;
use crate::ui::dialogs::Dialogs;
use crate::ui::state::{ExportOptions, PendingClose};
use freebound_core::geom::Picture;
use freebound_core::pipeline::Fit;
use freebound_io::{BakeOptions, PatternOptions, Registration};

/// File dialogs and files about to be written.
#[derive(Debug, Default)]
pub struct Files {
    pub dialogs: Dialogs,
    pub unsaved: Unsaved,
    /// Size of coordinates in files.
    pub fit: Fit,
    /// Table of numbers that colours the faces.
    pub table: ColourTable,
    /// Export whose options are shown.
    pub options_shown: Option<ExportOptions>,
    /// Options of the next cutting pattern.
    pub pattern: PatternOptions,
    /// Options of the next picture drawn for the layout.
    pub baked: BakeChoice,
    /// Requested picture of a pane, and its path.
    pub(in crate::ui) shot: Option<(PathBuf, Receiver<Picture>)>,
}

/// Options of the next picture drawn for the layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BakeChoice {
    /// Side of a square picture, pixels. Default: the size of the picture.
    pub side: Option<u32>,
    /// Margin around the charts, pixels.
    pub margin: u32,
}

impl Default for BakeChoice {
    fn default() -> Self {
        Self { side: None, margin: BakeOptions::DEFAULT_MARGIN }
    }
}

impl BakeChoice {
    /// Options for a picture.
    pub fn options(self, picture: &Picture) -> BakeOptions {
        let pixels = self.side.map_or_else(|| BakeOptions::size_for(picture), |side| [side; 2]);
        BakeOptions { pixels, margin: self.margin, registration: Registration::AsTheyAre }
    }
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
