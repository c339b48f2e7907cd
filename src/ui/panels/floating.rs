//! What floats over the panes: the list of keys, "go to", the file dialog inside the window.

use eframe::egui::{self, Align2, Key};

use crate::ui::keys::{BINDINGS, Binding, MOUSE};
use crate::ui::{Editor, Element, Request, pairs};

pub(in crate::ui) fn floating_windows(context: &egui::Context, editor: &mut Editor, requests: &mut Vec<Request>) {
    if editor.layout.keys_shown {
        keys_window(context, editor);
    }
    if editor.layout.go_to.is_some() {
        go_to_window(context, editor, requests);
    }
    if editor.layout.exports_shown {
        super::exports::exports_window(context, editor, requests);
    }
    super::unsaved::question(context, editor, requests);
    if let Some(choice) = editor.files.dialogs.show(context) {
        editor.take_choice(choice);
    }
}

fn keys_window(context: &egui::Context, editor: &mut Editor) {
    // Plain keys first, then those with modifiers: the table itself has them the other way round.
    let mut bindings: Vec<&Binding> = BINDINGS.iter().collect();
    bindings.sort_by_key(|binding| (binding.shortcut.modifiers.any(), binding.about));
    let height = (context.content_rect().height() - 120.0).max(160.0);
    egui::Window::new("Keys and mouse")
        .open(&mut editor.layout.keys_shown)
        .collapsible(false)
        .default_size([520.0, height.min(620.0)])
        .pivot(Align2::CENTER_CENTER)
        .default_pos(context.content_rect().center())
        .show(context, |ui| {
            egui::ScrollArea::vertical().auto_shrink(false).max_height(height).show(ui, |ui| {
                let keys = bindings.iter().map(|key| (context.format_shortcut(&key.shortcut), key.about));
                let gestures = MOUSE.iter().map(|&(gesture, about)| (gesture.to_owned(), about));
                pairs(ui, "keys", [24.0, 4.0], |ui| {
                    for (input, about) in keys.chain(gestures) {
                        ui.monospace(input);
                        ui.label(about);
                        ui.end_row();
                    }
                });
            });
        });
}

fn go_to_window(context: &egui::Context, editor: &mut Editor, requests: &mut Vec<Request>) {
    let mut text = editor.layout.go_to.clone().unwrap_or_default();
    let mut open = true;
    let mut gone = false;
    let window = egui::Window::new("Go to").open(&mut open).collapsible(false).resizable(false);
    window.anchor(Align2::CENTER_TOP, [0.0, 80.0]).show(context, |ui| {
        let label = ui.label("Number of a vertex (12 or v12), an edge (e7) or a face (f3), from 0");
        let field = ui.add(egui::TextEdit::singleline(&mut text).desired_width(160.0)).labelled_by(label.id);
        let found = Element::parse(&text).zip(editor.mesh_scene()).map(|(element, scene)| scene.vertices_of(element));
        let found = found.filter(|vertices| !vertices.is_empty());
        if !text.trim().is_empty() && found.is_none() {
            ui.colored_label(crate::ui::theme::theme_of(ui).flipped, "This mesh has no such element");
        }
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let clicked = ui.add_enabled(found.is_some(), egui::Button::new("Go")).clicked();
        if let (true, Some(vertices)) = (entered || clicked, found) {
            requests.push(Request::GoTo(vertices));
            gone = true;
        } else if !field.has_focus() && !clicked {
            field.request_focus();
        }
    });
    editor.layout.go_to = (open && !gone).then_some(text);
}
