//! The pins as a table: go to, move by typing, free.

use eframe::egui;
use egui::{DragValue, Role, WidgetInfo};
use glam::DVec2;

use super::theme::theme_of;
use super::{Editor, Request, Tool, keys_of};
use crate::mesh::VertexId;
use crate::session::Action;

/// Shows the panel.
pub(super) fn pins_panel(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let document = editor.session.document();
    if !document.settings.method.uses_pins() {
        ui.label(
            "A convex boundary needs no pins: every boundary vertex has its place. Pins come back with another method.",
        );
        return;
    }
    if document.pins.is_empty() {
        let keys = keys_of(ui.ctx(), &Request::SetTool(Tool::Fix));
        ui.label(format!(
            "No pins of yours. The hollow squares are gauge pins: they only fix position, turn and size.\n\nTake up the Fix \
             tool ({keys}) and click vertices to pin them where they lie, then drag them. Dragging a hollow square \
             makes it yours."
        ));
        return;
    }
    let speed = editor.plane_scene().map_or(0.01, |plane| plane.arrays.bounds().extent() / 500.0);
    let height = (ui.available_height() - 40.0).max(80.0);
    egui::ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
        egui::Grid::new("pins").num_columns(4).spacing([8.0, 4.0]).striped(true).show(ui, |ui| {
            for words in ["Vertex", "u", "v", ""] {
                ui.weak(words);
            }
            ui.end_row();
            for (&vertex, pin) in &document.pins {
                pin_row(ui, editor, (vertex, pin.target), speed, requests);
                ui.end_row();
            }
        });
    });
    ui.separator();
    if ui.button("Free all").on_hover_text("Free all pins; undo brings them back").clicked() {
        requests.push(Request::Do(Action::UnpinAll));
    }
    if document.pins.len() == 1 {
        let words = "One pin only moves the embedding. Fix a second one to turn and scale it, more to bend it.";
        ui.label(egui::RichText::new(words).small().color(theme_of(ui).weak_text));
    }
}

fn pin_row(
    ui: &mut egui::Ui,
    editor: &Editor,
    (vertex, target): (VertexId, DVec2),
    speed: f64,
    requests: &mut Vec<Request>,
) {
    let selected = editor.selection.contains(&vertex);
    if ui.selectable_label(selected, vertex.to_string()).on_hover_text("Select and show it").clicked() {
        requests.push(Request::GoTo(vec![vertex]));
    }
    let mut moved = target;
    let mut ended = false;
    for (axis, name) in [(0, "u"), (1, "v")] {
        let field = ui.add_sized([76.0, 20.0], coordinate(&mut moved[axis], speed));
        field.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, format!("{name} of pin {vertex}")));
        ended |= field.drag_stopped() || field.lost_focus();
    }
    if moved != target && moved.is_finite() {
        requests.push(Request::Do(Action::MovePin { vertex, target: moved }));
    }
    if ended {
        requests.push(Request::Do(Action::EndGesture));
    }
    let free = ui.small_button("Free").on_hover_text("Free this pin");
    free.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Free pin {vertex}")));
    if free.clicked() {
        requests.push(Request::Do(Action::Unpin(vec![vertex])));
    }
}

/// A field for a coordinate. It shows a few digits; a value that is not typed over keeps all of its own.
fn coordinate(value: &mut f64, speed: f64) -> DragValue<'_> {
    let exact = *value;
    let shown = digits(exact);
    DragValue::new(value).speed(speed).custom_formatter(|value, _| digits(value)).custom_parser(move |text| {
        let text = text.trim().replace('−', "-");
        if text == shown { Some(exact) } else { text.parse().ok() }
    })
}

/// Six digits behind the point, or as many that mean something.
fn digits(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) { format!("{value:.6}") } else { format!("{value:.5e}") }
}
