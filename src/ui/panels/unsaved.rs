//! Modal question about unsaved work before another document opens or the window closes.

use eframe::egui;

use crate::ui::state::{PendingClose, UnsavedAnswer};
use crate::ui::{Control, Editor, Request, accented, dialog_buttons, theme_of};

/// Keeps the window open if the user closes it with unsaved work, and asks.
pub(in crate::ui) fn hold_window(context: &egui::Context, editor: &mut Editor) {
    let is_closing = context.input(|input| input.viewport().close_requested());
    if is_closing && !editor.gpu.is_quitting() && editor.session.has_unsaved_work() {
        context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
        editor.close_or_ask(PendingClose::Quit);
    }
}

pub(in crate::ui) fn question(context: &egui::Context, editor: &Editor, requests: &mut Vec<Request>) {
    let Some(pending) = editor.files.unsaved.asked() else { return };
    let name = editor.document_name();
    egui::Modal::new(egui::Id::unique("unsaved work")).show(context, |ui| {
        ui.set_width(340.0);
        ui.strong(format!("Save the project {name}?"));
        ui.add_space(4.0);
        ui.label(match pending {
            PendingClose::Quit => "Its changes are lost when the window closes.",
            PendingClose::Do(_) => "Its changes are lost when something else opens.",
        });
        ui.add_space(12.0);
        dialog_buttons(ui, |ui| {
            ui.add(accented("Save", theme_of(ui))).asks(Request::Answer(UnsavedAnswer::Save), requests);
            for (answer, words) in [(UnsavedAnswer::DontSave, "Don't save"), (UnsavedAnswer::Cancel, "Cancel")] {
                ui.button(words).asks(Request::Answer(answer), requests);
            }
        });
    });
}

/// Sets the title of the window: the document's name, with a mark if there is unsaved work.
pub(in crate::ui) fn title_of_window(editor: &mut Editor) {
    let title = match editor.session.model() {
        Some(_) => format!("{} – Freebound", editor.marked_name()),
        None => "Freebound".to_owned(),
    };
    editor.gpu.set_title(title);
}
