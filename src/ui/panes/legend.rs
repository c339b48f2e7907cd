//! Legend of a shading, and notes in the panes about two compared steps.

use eframe::egui::{self, Align2, FontId, Pos2, Rect, RichText, Role, Sense, Stroke, Vec2};

use crate::session::Action;
use crate::ui::editor::paint::Legend;
use crate::ui::theme::{on_screen, rgb, theme_of};
use crate::ui::{Control, Editor, Pane, Request, ShadingMode, Theme, close_button};

/// Distance that labels may reach beyond their bar, points.
const MARGIN: f32 = 6.0;

/// True if the embedding pane has its own legend: the mesh pane is hidden or has another shading.
pub(super) fn plane_has_own(editor: &Editor) -> bool {
    editor.layout.mesh_hidden() || editor.shading(Pane::Plane) != editor.shading(Pane::Mesh)
}

/// Legend of a shading by numbers: bar, histogram and labels.
pub(super) fn legend(ui: &egui::Ui, rect: Rect, editor: &Editor, pane: Pane) {
    let Some(legend) = editor.legend(pane) else { return };
    let title = match (editor.shading(pane), editor.plane.moved_from(&editor.session)) {
        (ShadingMode::Move, Some(base)) => format!("Move from step {}, plane units", base.step.index),
        (shading, _) => editor.title_of_shading(shading),
    };
    let theme = theme_of(ui);
    let painter = ui.painter_at(rect);
    let size = Vec2::new(184.0, 78.0);
    if rect.width() < size.x + 24.0 || rect.height() < 2.0 * size.y {
        return;
    }
    let frame = Rect::from_min_size(rect.left_bottom() + Vec2::new(12.0, -12.0 - size.y), size);
    painter.rect_filled(frame, 4.0, theme.panel.gamma_multiply(0.92));
    let at = frame.min + Vec2::new(10.0, 6.0);
    let words = painter.with_clip_rect(frame.shrink2(Vec2::new(8.0, 0.0)));
    words.text(at, Align2::LEFT_TOP, title, FontId::proportional(11.0), theme.text);
    let bar = Rect::from_min_size(frame.min + Vec2::new(10.0, 44.0), Vec2::new(size.x - 20.0, 9.0));
    columns(&painter, bar, legend, theme);
    scale(&painter, bar, legend, theme);
}

/// Legend in a low line: title, bar and labels.
pub(super) fn strip(ui: &egui::Ui, rect: Rect, title: &str, legend: &Legend) {
    let theme = theme_of(ui);
    let painter = ui.painter_at(rect);
    let left = rect.left_center() + Vec2::new(12.0, 0.0);
    let words = painter.text(left, Align2::LEFT_CENTER, title, FontId::proportional(11.0), theme.text);
    let width = (rect.right() - words.right() - 40.0).min(220.0);
    if width >= 60.0 {
        let bar = Rect::from_min_size(Pos2::new(words.right() + 16.0, rect.top() + 5.0), Vec2::new(width, 8.0));
        scale(&painter, bar, legend, theme);
    }
}

/// Histogram of the faces, above a bar.
fn columns(painter: &egui::Painter, bar: Rect, legend: &Legend, theme: &Theme) {
    let most = legend.histogram.iter().copied().max().unwrap_or(0).max(1);
    let width = bar.width() / legend.histogram.len() as f32;
    for (i, &count) in legend.histogram.iter().enumerate() {
        let left = bar.left() + width * i as f32;
        #[expect(clippy::cast_possible_truncation, reason = "a height in points")]
        let height = (20.0 * f64::from(count) / f64::from(most)) as f32;
        let column =
            Rect::from_min_max(Pos2::new(left, bar.top() - 1.0 - height), Pos2::new(left + width, bar.top() - 1.0));
        painter.rect_filled(column, 0.0, theme.weak_text.gamma_multiply(0.6));
    }
}

/// Colour bar, and the labels below it.
fn scale(painter: &egui::Painter, bar: Rect, legend: &Legend, theme: &Theme) {
    let count = legend.histogram.len();
    let width = bar.width() / count as f32;
    for i in 0..count {
        let cell =
            Rect::from_min_size(bar.min + Vec2::new(width * i as f32, 0.0), Vec2::new(width + 0.5, bar.height()));
        painter.rect_filled(cell, 0.0, rgb(legend.scale.colour_at((i as f64 + 0.5) / count as f64)));
    }
    for tick in legend.scale.ticks(legend.range) {
        #[expect(clippy::cast_possible_truncation, reason = "points of the screen are f32")]
        let x = bar.left() + bar.width() * tick.at as f32;
        painter.vline(x, bar.bottom()..=bar.bottom() + 3.0, Stroke::new(1.0, theme.weak_text));
        let label = painter.layout_no_wrap(tick.label.clone(), FontId::proportional(10.0), theme.weak_text);
        // Labels at the ends stay within the frame.
        let [least, most] = [bar.left() - MARGIN, bar.right() + MARGIN - label.size().x];
        let left = (x - label.size().x / 2.0).clamp(least.min(most), most.max(least));
        painter.galley(Pos2::new(left, bar.bottom() + 4.0), label, theme.weak_text);
    }
}

/// Note at the lower left of the pane that names the step of the outline. Its close button ends the comparison.
pub(super) fn ghost_note(ui: &mut egui::Ui, rect: Rect, editor: &Editor, requests: &mut Vec<Request>) {
    let Some(step) = editor.plane.ghost_step().filter(|_| rect.width() >= 180.0) else { return };
    let theme = theme_of(ui);
    let height = if plane_has_own(editor) && editor.pane_shading.legend(Pane::Plane).is_some() { 124.0 } else { 32.0 };
    let place = Rect::from_min_size(rect.left_bottom() + Vec2::new(12.0, -height), Vec2::new(172.0, 20.0));
    // Clicks on the note must not reach the pane.
    ui.interact(place, ui.scope_id().with("outline"), Sense::click_and_drag())
        .named(Role::Group, "Legend of the outline");
    ui.painter_at(rect).rect_filled(place, 4.0, theme.panel.gamma_multiply(0.92));
    let middle = place.left_center() + Vec2::new(8.0, 0.0);
    let sample = [middle, middle + Vec2::new(18.0, 0.0)];
    ui.painter_at(rect).line_segment(sample, Stroke::new(2.0, on_screen(theme.ghost)));
    let words = RichText::new(format!("Outline of step {step}")).small().color(theme.weak_text);
    let text = Rect::from_min_max(place.min + Vec2::new(32.0, 0.0), place.max);
    let mut part = ui.new_child(egui::UiBuilder::new().max_rect(text));
    part.horizontal_centered(|ui| ui.add(egui::Label::new(words).selectable(false)));
    let id = ui.scope_id().with("close the outline");
    let cross = Rect::from_center_size(place.right_center() - Vec2::new(11.0, 0.0), Vec2::splat(16.0));
    let close = close_button(ui, id, cross, ["Stop comparing", "Stop comparing and hide the outline"]);
    close.asks(Action::Compare(None), requests);
}

/// Note for the shading by moves if no earlier step is kept, so that nothing is coloured.
pub(super) fn no_move_note(ui: &egui::Ui, rect: Rect, editor: &Editor, pane: Pane) {
    if editor.shading(pane) == ShadingMode::Move
        && editor.pane_shading.legend(pane).is_none()
        && editor.plane.scene().is_some()
    {
        let at = rect.left_bottom() + Vec2::new(12.0, -12.0);
        let words = "No previous step is kept: there is no movement to show";
        let ink = theme_of(ui).weak_text;
        ui.painter_at(rect).text(at, Align2::LEFT_BOTTOM, words, FontId::proportional(11.0), ink);
    }
}
