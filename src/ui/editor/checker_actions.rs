//! Actions of the checker over the plane.

use std::path::PathBuf;

use super::Editor;
use super::checker::{ACROSS_CHART, ALONG_PAGE};
use crate::session::{Busy, MessagePlace};
use crate::ui::state::{CheckerRequest, CheckerStyle, FileDialogKind};

impl Editor {
    /// Number of squares on the screen: along the page, or across one chart.
    pub fn squares_shown(&self) -> u32 {
        let usual = if self.shows_page() { ALONG_PAGE } else { ACROSS_CHART };
        self.pane_shading.checker.wanted_squares().unwrap_or(usual)
    }

    /// Handles a request to the checker. Asks for the user's picture in a dialog.
    pub(super) fn handle_checker(&mut self, request: CheckerRequest) {
        if request == CheckerRequest::SetStyle(CheckerStyle::Picture) {
            return self.ask(FileDialogKind::OpenChecker);
        }
        let shown = self.squares_shown();
        self.pane_shading.checker.change(request, shown);
    }

    /// Repeats a picture over the plane.
    pub(super) fn open_checker(&mut self, path: PathBuf) {
        self.pane_shading.checker.open(path);
    }

    /// Makes the tile of the checker, and reports faults. Call once per frame.
    pub(super) fn refresh_checker(&mut self) {
        if matches!(self.session.busy(), Some(Busy::Loading)) {
            // An opened mesh would dismiss the message.
            return;
        }
        if let Some(failure) = self.pane_shading.checker.take_failure() {
            self.session.tell_failure(MessagePlace::Embedding, "drawing", &failure);
        }
        if let Some(fault) = self.pane_shading.checker.refresh_tile() {
            let remedy = "Choose a PNG or JPEG file in View › Checker and pixels › Own picture";
            self.session.tell_fault(MessagePlace::Embedding, fault.to_string(), remedy);
        }
    }
}
