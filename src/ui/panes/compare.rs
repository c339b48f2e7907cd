//! Words in the panes about two steps that are compared.

use eframe::egui;
use egui::{Rect, RichText, Stroke, Vec2};

use crate::ui::theme::theme_of;
use crate::ui::{Editor, Shading};

impl Editor {
    /// The name of the shading with what it is measured from.
    pub(super) fn shading_title(&self) -> String {
        match (self.look.shading, self.plane.moved_from(&self.session)) {
            (Shading::Move, Some(base)) => format!("Move from step {}, plane units", base.step.index),
            (shading, _) => shading.title().to_owned(),
        }
    }
}

/// Says in the pane's lower left corner which step the outline is of.
pub(super) fn ghost_note(ui: &mut egui::Ui, rect: Rect, editor: &Editor) {
    let Some(step) = editor.plane.ghost_step() else { return };
    let theme = theme_of(ui);
    let has_legend = editor.layout.mesh_hidden() && editor.look.paint().is_some_and(|paint| paint.legend.is_some());
    let height = if has_legend { 124.0 } else { 32.0 };
    let place = Rect::from_min_size(rect.left_bottom() + Vec2::new(12.0, -height), Vec2::new(150.0, 20.0));
    if rect.width() < 180.0 {
        return;
    }
    ui.painter_at(rect).rect_filled(place, 4.0, theme.panel.gamma_multiply(0.92));
    let ink = crate::ui::theme::on_screen(theme.ghost);
    let middle = place.left_center() + Vec2::new(8.0, 0.0);
    ui.painter_at(rect).line_segment([middle, middle + Vec2::new(18.0, 0.0)], Stroke::new(2.0, ink));
    let words = RichText::new(format!("Outline of step {step}")).small().color(theme.weak_text);
    let text = Rect::from_min_max(place.min + Vec2::new(32.0, 0.0), place.max);
    let mut part = ui.new_child(egui::UiBuilder::new().max_rect(text));
    part.horizontal_centered(|ui| ui.add(egui::Label::new(words).selectable(false)));
}

/// Says why nothing is coloured where moves are asked for and there are none.
pub(super) fn no_move_note(ui: &egui::Ui, rect: Rect, editor: &Editor) {
    let has_legend = editor.look.paint().is_some_and(|paint| paint.legend.is_some());
    if editor.look.shading != Shading::Move || has_legend || editor.plane.scene().is_none() {
        return;
    }
    let at = rect.left_bottom() + Vec2::new(12.0, -12.0);
    let words = "No step before this one is kept: nothing has moved";
    let font = egui::FontId::proportional(11.0);
    ui.painter_at(rect).text(at, egui::Align2::LEFT_BOTTOM, words, font, theme_of(ui).weak_text);
}
