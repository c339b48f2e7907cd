//! The brush tool in the embedding pane: its bar, its circle, and its strokes.

use eframe::egui::{self, PointerButton, Rect, Response, Role, Stroke, WidgetInfo};
use glam::DVec2;

use super::{pane, plane_pane};
use crate::session::{Action, BrushDab, PageDab};
use crate::ui::editor::scene::PlaneScene;
use crate::ui::state::{BrushChoice, Viewport, brush_words};
use crate::ui::{Control, Editor, Request, Tool, theme_of};
use crate::view::PlaneCamera;
use freebound_core::bijective::BrushKind;

/// Kinds in the order of the bar.
const KINDS: [BrushKind; 5] =
    [BrushKind::Relax, BrushKind::Grab, BrushKind::Pinch, BrushKind::Smooth, BrushKind::Texels];

/// Distance of the bar from the sides of the pane, points.
const GAP: f32 = 8.0;

/// Width of the pane in points below which the sliders stand one below the other.
const NARROW: f32 = 440.0;

/// True if the brush tool takes drags of the left button in the embedding pane.
pub(super) fn takes_drags(editor: &Editor) -> bool {
    editor.tools.tool() == Tool::Brush
}

/// Bar with the kinds of brushes, size and strength, at the top of the pane.
pub(super) fn bar(ui: &egui::Ui, rect: Rect, editor: &Editor, requests: &mut Vec<Request>) {
    if !takes_drags(editor) {
        return;
    }
    let theme = theme_of(ui);
    // An area takes drags, too: a press on a button of the bar must not begin a stroke below it.
    let area = egui::Area::new(egui::Id::unique("brush bar")).movable(false).order(egui::Order::Middle);
    let area = area.fixed_pos(rect.min + egui::Vec2::splat(GAP)).constrain_to(rect);
    let frame = egui::Frame::new().fill(theme.panel.gamma_multiply(0.95)).corner_radius(4).inner_margin(8);
    let choice = editor.tools.brush;
    area.show(ui.ctx(), |ui| {
        frame.show(ui, |ui| {
            ui.set_max_width(rect.width() - 2.0 * GAP - 16.0);
            ui.spacing_mut().item_spacing = egui::vec2(8.0, 4.0);
            ui.horizontal_wrapped(|ui| {
                for kind in KINDS {
                    let [name, about] = brush_words(kind);
                    let is_on = choice.kind == kind;
                    let label = ui.selectable_label(is_on, name).on_hover_text(about);
                    // The name tells the brush from the button that relaxes the whole map.
                    label.widget_info(|| WidgetInfo::selected(Role::Button, true, is_on, format!("{name} brush")));
                    label.asks(Request::SetBrush(BrushChoice { kind, ..choice }), requests);
                }
            });
            // A row does not wrap between a slider and its number.
            let row = egui::Layout::left_to_right(egui::Align::Center);
            let layout = if rect.width() < NARROW { egui::Layout::top_down(egui::Align::Min) } else { row };
            ui.with_layout(layout, |ui| sliders(ui, choice, requests));
            if !can_brush_here(editor) && !editor.session.is_brushing() {
                let words = if editor.shows_page() && !editor.session.can_move_charts() {
                    "The charts are being laid out."
                } else {
                    "Brushes shape a planar map without new vertices that meets its pins."
                };
                ui.label(egui::RichText::new(words).small().color(theme.weak_text));
            }
        })
    });
}

/// True if brushes can shape the map on the screen, or the chart of the page under the pointer.
fn can_brush_here(editor: &Editor) -> bool {
    if editor.shows_page() {
        editor.plane.page.hovered().is_none_or(|chart| editor.session.can_brush_chart(chart))
    } else {
        editor.session.can_brush()
    }
}

fn sliders(ui: &mut egui::Ui, choice: BrushChoice, requests: &mut Vec<Request>) {
    let mut next = choice;
    // Room for the number and the name beside the slider.
    ui.spacing_mut().slider_width = (ui.available_width() - 130.0).clamp(24.0, 80.0);
    let size = egui::Slider::new(&mut next.radius, BrushChoice::RADII).logarithmic(true).text("Size").suffix(" pt");
    ui.add(size.max_decimals(0)).on_hover_text("Radius of the brush in points of the screen ([ and ], Alt + wheel)");
    if choice.kind != BrushKind::Grab {
        let mut percent = 100.0 * next.strength;
        let strength = egui::Slider::new(&mut percent, 1.0..=100.0).text("Strength").suffix(" %").max_decimals(0);
        if ui.add(strength).on_hover_text("Effect of the brush at each moment").changed() {
            next.strength = percent / 100.0;
        }
    }
    if next != choice {
        requests.push(Request::SetBrush(next));
    }
}

/// Carries out strokes on the map on the screen, and draws the circle of the brush.
pub(super) fn over_plane(
    ui: &egui::Ui,
    response: &Response,
    view: Viewport<PlaneCamera>,
    editor: &Editor,
    requests: &mut Vec<Request>,
) {
    if !takes_drags(editor) {
        return;
    }
    end_with_button(ui, response, editor, requests);
    let can_brush = editor.session.can_brush();
    if let Some(dab) = dab(ui, response, view, editor, can_brush) {
        requests.push(Request::Do(Action::Brush(dab)));
    }
    circle(ui, response, view, editor, can_brush);
}

/// Carries out strokes on the charts of the page, and draws the circle of the brush.
pub(super) fn over_page(
    ui: &egui::Ui,
    response: &Response,
    view: Viewport<PlaneCamera>,
    editor: &Editor,
    requests: &mut Vec<Request>,
) {
    let chart = editor.plane.page.hovered();
    let can_brush = chart.is_some_and(|chart| editor.session.can_brush_chart(chart));
    end_with_button(ui, response, editor, requests);
    let dab = dab(ui, response, view, editor, can_brush);
    if let Some((dab, chart)) = dab.zip(chart) {
        let insists = ui.input(|input| input.modifiers.alt);
        requests.push(Request::Do(Action::BrushOnPage(PageDab { chart, dab, insists })));
    }
    circle(ui, response, view, editor, can_brush);
}

/// Circle of the brush at the pointer, and the cursor that says if the brush works there.
fn circle(ui: &egui::Ui, response: &Response, view: Viewport<PlaneCamera>, editor: &Editor, can_brush: bool) {
    let choice = editor.tools.brush;
    let pointer = ui.input(|input| input.pointer.latest_pos());
    let Some(at) = pointer.filter(|at| view.rect.contains(*at) && response.contains_pointer()) else { return };
    if can_brush || editor.session.is_brushing() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::None);
    } else {
        ui.ctx().set_cursor_icon(egui::CursorIcon::NotAllowed);
    }
    let theme = theme_of(ui);
    let point = point_size(view);
    // A brush over too many vertices is smaller than chosen.
    #[expect(clippy::cast_possible_truncation, reason = "points of the screen are f32")]
    let used = editor.session.brush_radius().map(|radius| (radius / point) as f32);
    let over = ui.painter_at(view.rect);
    let is_narrowed = used.is_some_and(|used| used < 0.99 * choice.radius);
    if is_narrowed {
        over.circle_stroke(at, choice.radius, Stroke::new(1.0, theme.weak_text));
    }
    let radius = used.map_or(choice.radius, |used| used.min(choice.radius));
    over.circle_stroke(at, radius, Stroke::new(3.0, theme.background));
    over.circle_stroke(at, radius, Stroke::new(1.5, theme.selection));
    over.circle_filled(at, 1.5, theme.selection);
}

/// Size of a point of the screen in the plane.
fn point_size(view: Viewport<PlaneCamera>) -> f64 {
    let [a, b] = [view.rect.min, view.rect.min + egui::vec2(100.0, 0.0)].map(|at| view.point_at(at));
    a.distance(b) / 100.0
}

/// Radius of the chosen brush in the plane.
pub(super) fn radius_in_plane(editor: &Editor, view: Viewport<PlaneCamera>) -> f64 {
    editor.tools.brush.in_plane(point_size(view), false).radius
}

/// True while the left button is down on the pane.
fn is_down(ui: &egui::Ui, response: &Response) -> bool {
    response.is_pointer_button_down_on() && ui.input(|input| input.pointer.primary_down())
}

/// Ends the stroke once the left button is up.
fn end_with_button(ui: &egui::Ui, response: &Response, editor: &Editor, requests: &mut Vec<Request>) {
    if editor.session.is_brushing() && !is_down(ui, response) {
        requests.push(Request::Do(Action::EndBrush));
    }
}

/// Brush at the pointer while the left button is down.
fn dab(
    ui: &egui::Ui,
    response: &Response,
    view: Viewport<PlaneCamera>,
    editor: &Editor,
    can_brush: bool,
) -> Option<BrushDab> {
    let is_brushing = editor.session.is_brushing();
    let begins = ui.input(|input| input.pointer.button_pressed(PointerButton::Primary));
    if !is_down(ui, response) || !(is_brushing || begins) {
        return None;
    }
    let at = response.interact_pointer_pos().filter(|_| is_brushing || can_brush)?;
    let inverts = ui.input(|input| input.modifiers.command);
    let brush = editor.tools.brush.in_plane(point_size(view), inverts);
    // The brush works on while the button is held.
    ui.ctx().request_repaint();
    Some(BrushDab { brush, at: view.point_at(at), begins })
}

/// Camera moves. Beside a brush the other buttons pan, and the wheel with Alt resizes the brush.
pub(super) fn navigate(
    ui: &egui::Ui,
    response: &Response,
    camera: &mut PlaneCamera,
    editor: &Editor,
    requests: &mut Vec<Request>,
) {
    if !takes_drags(editor) {
        return plane_pane::navigate(ui, response, camera);
    }
    if response.dragged() && !response.dragged_by(PointerButton::Primary) {
        camera.pan(DVec2::new(response.drag_delta().x.into(), response.drag_delta().y.into()));
    }
    if !ui.input(|input| input.modifiers.alt) {
        return plane_pane::zoom(ui, response, camera);
    }
    let turned = pane::wheel(ui).zoom;
    if response.contains_pointer() && (turned - 1.0).abs() > f64::EPSILON {
        requests.push(Request::ResizeBrush { grows: turned > 1.0 });
    }
}

/// True if the pins under the brush tool are not dragged.
pub(super) fn hides_pins(editor: &Editor, plane: &PlaneScene) -> bool {
    takes_drags(editor) || plane.is_stage()
}
