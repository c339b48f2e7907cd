//! Unsaved work: the question before it is lost, and the action after the answer.

use super::Editor;
use crate::session::Action;
use crate::ui::state::{FileDialogKind, PendingClose, UnsavedAnswer};

impl Editor {
    /// Name of the open document.
    pub(in crate::ui) fn document_name(&self) -> String {
        self.session.project_name().unwrap_or_else(|| "Freebound".to_owned())
    }

    /// Name of the open document, with a mark if there is unsaved work.
    pub(in crate::ui) fn marked_name(&self) -> String {
        format!("{}{}", if self.session.has_unsaved_work() { "• " } else { "" }, self.document_name())
    }

    /// Carries out an action that closes the open document: at once if nothing is lost, else after the user's answer.
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

    /// Saves the project to its file, or asks for one.
    pub(in crate::ui) fn save_project(&mut self) {
        match self.session.project_path().cloned() {
            Some(path) => {
                self.keep_view();
                self.session.handle(Action::SaveProject(path));
            }
            None => self.ask(FileDialogKind::SaveProject),
        }
    }

    /// Carries out the action that waits for the project to be saved. Drops the action if the project was not saved.
    /// Call once per frame.
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

    /// Withdraws the question. Returns true if it was asked.
    pub(in crate::ui) fn close_question(&mut self) -> bool {
        self.files.unsaved.asked.take().is_some()
    }
}
