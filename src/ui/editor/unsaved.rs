//! Work that is not saved: the question before it is lost, and what goes on once it is answered.

use super::Editor;
use crate::session::Action;
use crate::ui::state::{FileDialogKind, PendingClose, UnsavedAnswer};

impl Editor {
    /// Name of the open document.
    pub(in crate::ui) fn document_name(&self) -> String {
        self.session.project_name().unwrap_or_else(|| "Freebound".to_owned())
    }

    /// Name of the open document, with a mark if work is not saved.
    pub(in crate::ui) fn marked_name(&self) -> String {
        format!("{}{}", if self.session.has_unsaved_work() { "• " } else { "" }, self.document_name())
    }

    /// Does what would lose the open document: at once where nothing is lost, else once the person has answered.
    pub(in crate::ui) fn close_or_ask(&mut self, pending: PendingClose) {
        if self.session.has_unsaved_work() {
            self.files.unsaved.asked = Some(pending);
        } else {
            self.close(pending);
        }
    }

    fn close(&mut self, pending: PendingClose) {
        match pending {
            PendingClose::Quit => self.gpu.quit(),
            PendingClose::Do(action) => self.session.handle(action),
        }
    }

    pub(in crate::ui) fn answer(&mut self, answer: UnsavedAnswer) {
        let Some(pending) = self.files.unsaved.asked.take() else { return };
        match answer {
            UnsavedAnswer::Cancel => {}
            UnsavedAnswer::DontSave => self.close(pending),
            UnsavedAnswer::Save => {
                self.files.unsaved.after_saving = Some(pending);
                self.save_project();
            }
        }
    }

    /// Saves where the project was saved before, or asks where.
    pub(in crate::ui) fn save_project(&mut self) {
        match self.session.project_path().cloned() {
            Some(path) => {
                self.keep_view();
                self.session.handle(Action::SaveProject(path));
            }
            None => self.ask(FileDialogKind::SaveProject),
        }
    }

    /// Goes on with what waited for the project to be saved. Where it was not saved, that is given up. Call once per
    /// frame.
    pub(in crate::ui) fn go_on_after_saving(&mut self) {
        if self.files.unsaved.after_saving.is_none() || self.files.dialogs.is_open() || self.session.is_saving_project()
        {
            return;
        }
        let pending = self.files.unsaved.after_saving.take();
        if let Some(pending) = pending.filter(|_| !self.session.has_unsaved_work()) {
            self.close(pending);
        }
    }

    /// Takes the question away. Returns whether it was asked.
    pub(in crate::ui) fn close_question(&mut self) -> bool {
        self.files.unsaved.asked.take().is_some()
    }
}
