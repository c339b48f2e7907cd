//! The document as a command line, on the clipboard.

use super::Editor;
use crate::session::{CommandLine, RunStop};

impl Editor {
    /// Copies the command line that makes the map of the document.
    pub(super) fn copy_command_line(&mut self) {
        let session = &self.session;
        let Some(model) = session.model() else { return };
        let mut line = CommandLine::of(session.document(), model, self.files.fit);
        let timeline = session.timeline();
        let is_ended = matches!(session.stopped(), Some(RunStop::Ended(_))) && timeline.shown() == timeline.newest();
        if let Some(step) = timeline.shown().filter(|_| !is_ended) {
            line = line.with_remark(format!("The window shows step {step}; the command runs the method to its end"));
        }
        self.gpu.context().copy_text(line.text());
        self.session.tell_note("copied the command line");
    }
}
