//! Selecting with a box: Ctrl and a drag.

use eframe::egui;
use egui::{Rect, Response, Stroke};

use crate::ui::theme::theme_of;
use crate::ui::{Editor, Pane};

/// Follows a box being drawn. Gives it, in window points, when the drag ends.
pub(super) fn drag_box(ui: &egui::Ui, response: &Response, editor: &mut Editor, pane: Pane) -> Option<Rect> {
    if response.drag_started_by(egui::PointerButton::Primary) && ui.input(|input| input.modifiers.command) {
        // From where the button went down, not from where egui was sure of a drag.
        let origin = ui.input(|input| input.pointer.press_origin()).or(response.interact_pointer_pos());
        editor.pointer.begin_box(pane, origin);
    }
    let from = editor.pointer.box_in(pane)?;
    let to = ui.input(|input| input.pointer.latest_pos())?;
    let chosen = Rect::from_two_pos(from, to);
    if response.drag_stopped() {
        editor.pointer.end_box();
        return Some(chosen);
    }
    let theme = theme_of(ui);
    let painter =
        ui.ctx().layer_painter(egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("selection box")));
    let painter = painter.with_clip_rect(response.rect);
    painter.rect_filled(chosen, 0.0, theme.selection.gamma_multiply(0.12));
    painter.rect_stroke(chosen, 0.0, Stroke::new(1.0, theme.selection), egui::StrokeKind::Inside);
    None
}
