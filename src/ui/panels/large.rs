//! Question before opening a file that may need more than half of the machine's memory.

use eframe::egui;

use crate::session::Action;
use crate::ui::{Control, Editor, Request, accented, dialog_buttons, theme_of};

impl Editor {
    /// True if a modal question is open.
    pub(in crate::ui) fn is_asking(&self) -> bool {
        self.files.unsaved.is_asked() || self.session.large_file().is_some()
    }

    /// Cancels the opening of the large file. Returns true if the question was open.
    pub(in crate::ui) fn leave_large(&mut self) -> bool {
        let was_asked = self.session.large_file().is_some();
        self.session.handle(Action::LeaveLarge);
        was_asked
    }
}

pub(in crate::ui) fn question(context: &egui::Context, editor: &Editor, requests: &mut Vec<Request>) {
    let Some(file) = editor.session.large_file() else { return };
    let name = file.path.file_name().unwrap_or_default().to_string_lossy();
    egui::Modal::new(egui::Id::unique("large file")).show(context, |ui| {
        ui.set_width(380.0);
        ui.strong(format!("Open the large file {name}?"));
        ui.add_space(4.0);
        ui.label(format!(
            "Estimated from its size: {}. If memory runs out, the system may end Freebound.",
            file.shortage
        ));
        ui.add_space(12.0);
        dialog_buttons(ui, |ui| {
            // The button that risks nothing is the primary one.
            ui.add(accented("Cancel", theme_of(ui))).asks(Request::Do(Action::LeaveLarge), requests);
            ui.button("Open").asks(Request::Do(Action::OpenLarge), requests);
        });
    });
}
