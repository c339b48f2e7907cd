//! The panels at the right: a row of tabs and what the open one shows.

use eframe::egui;

use super::{defects_panel, method_panel, pins_panel, vertex_panel};
use crate::ui::{Editor, Request, Tab};

pub(in crate::ui) fn side_panel(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for tab in Tab::ALL {
            let count = match tab {
                Tab::Pins => editor.session.document().targets.len(),
                Tab::Defects => editor.defect_count(),
                Tab::Method | Tab::Vertex => 0,
            };
            let words = if count > 0 { format!("{} {count}", tab.title()) } else { tab.title().to_owned() };
            if ui.selectable_label(editor.layout.tab() == tab, words).clicked() {
                requests.push(Request::ShowTab(tab));
            }
        }
    });
    ui.separator();
    match editor.layout.tab() {
        Tab::Method => scrolled(ui, |ui| method_panel::method_panel(ui, editor, requests)),
        Tab::Pins => pins_panel::pins_panel(ui, editor, requests),
        Tab::Defects => defects_panel::defects_panel(ui, editor, requests),
        Tab::Vertex => scrolled(ui, |ui| vertex_panel::vertex_panel(ui, editor, requests)),
    }
}

/// A panel that may be higher than the window.
fn scrolled(ui: &mut egui::Ui, add: impl FnOnce(&mut egui::Ui)) {
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, add);
}
