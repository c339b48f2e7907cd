//! Curve in its own window, with axes, units, and the value under the pointer.

use eframe::egui::{self, Align2, Color32, FontId, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, Vec2};

use super::curves::{MOST_POINTS, export_entries, nearest, scale_entries};
use crate::session::Action;
use crate::ui::editor::step_curve::{CURVES, ShownCurve};
use crate::ui::state::CurveRequest;
use crate::ui::{Control, Editor, Request, list, theme_of};
use freebound_io::figure::AxisSpan;

/// Font size of the axes, points.
const WORDS: f32 = 12.0;

/// Space between the sides of the plot and its axes: left, top, right, bottom.
const AROUND: [f32; 4] = [64.0, 24.0, 16.0, 38.0];

/// Height of the strip for numbers without a place on the scale, points.
const STRIP: f32 = 20.0;

/// Largest size of the window, and its distance from the sides, points.
const SIZE: Vec2 = Vec2::new(860.0, 520.0);
const DISTANCE: Vec2 = Vec2::new(60.0, 140.0);

/// Shows the enlarged curve, if one is chosen.
pub(in crate::ui) fn enlarged_curve(context: &egui::Context, editor: &Editor, requests: &mut Vec<Request>) {
    let Some(place) = editor.timeline.curve_enlarged else { return };
    if !editor.has_disk() {
        return requests.push(Request::Curve(CurveRequest::Close));
    }
    let shown = ShownCurve::new(place, editor.session.timeline(), &editor.timeline);
    let mut open = true;
    egui::Window::new("Curve of the steps")
        .open(&mut open)
        .collapsible(false)
        .default_size(SIZE.min(context.content_rect().size() - DISTANCE).max(Vec2::new(300.0, 200.0)))
        .pivot(Align2::CENTER_CENTER)
        .default_pos(context.content_rect().center())
        .show(context, |ui| {
            controls(ui, &shown, requests);
            plot(ui, editor, &shown, requests);
        });
    if !open {
        requests.push(Request::Curve(CurveRequest::Close));
    }
}

fn controls(ui: &mut egui::Ui, shown: &ShownCurve, requests: &mut Vec<Request>) {
    ui.horizontal(|ui| {
        let menu = list(ui, "Enlarged curve", 150.0, shown.curve.title, |ui| {
            for (place, curve) in CURVES.iter().enumerate() {
                let entry = ui.selectable_label(place == shown.place, curve.title);
                entry.asks(Request::Curve(CurveRequest::Enlarge(place)), requests);
            }
        });
        menu.on_hover_text("Choose the curve");
        scale_entries(ui, shown, requests);
        let menu = ui.menu_button("Export", |ui| export_entries(ui, requests)).response;
        menu.named(Role::Button, "Export curves").on_hover_text("Write the curves to a file");
    });
}

/// Area of the plot: values with a place on the scale, and the strip below for others.
struct Area {
    /// Values with a place on the scale.
    placed: Rect,
    /// All values.
    whole: Rect,
    span: AxisSpan,
    last: usize,
}

impl Area {
    fn x(&self, step: usize) -> f32 {
        let share = step as f32 / self.last.max(1) as f32;
        self.placed.left() + 8.0 + (self.placed.width() - 16.0) * share
    }

    /// Step under a place.
    fn step_at(&self, x: f32) -> usize {
        let share = (x - self.placed.left() - 8.0) / (self.placed.width() - 16.0).max(1.0);
        nearest(f64::from(share) * self.last.max(1) as f64, self.last + 1)
    }

    #[expect(clippy::cast_possible_truncation, reason = "points of the screen are f32")]
    fn y(&self, share: f64) -> f32 {
        self.placed.bottom() - self.placed.height() * share as f32
    }

    /// Position of a value, and true if the value has a place on the scale.
    fn at(&self, step: usize, value: f64) -> (Pos2, bool) {
        let share = self.span.share(value);
        let below = self.whole.bottom() - STRIP / 2.0;
        (egui::pos2(self.x(step), share.map_or(below, |share| self.y(share))), share.is_some())
    }
}

fn plot(ui: &mut egui::Ui, editor: &Editor, shown: &ShownCurve, requests: &mut Vec<Request>) {
    let size = ui.available_size().max(Vec2::new(200.0, 120.0));
    let (room, response) = ui.allocate_exact_size(size, Sense::click());
    let theme = theme_of(ui);
    let [left, top, right, bottom] = AROUND;
    let whole = Rect::from_min_max(room.min + egui::vec2(left, top), room.max - egui::vec2(right, bottom));
    let span = shown.span();
    let strip = if span.has_unplaced { STRIP } else { 0.0 };
    let placed = whole.with_max_y(whole.bottom() - strip);
    let area = Area { placed, whole, span, last: shown.values.len().saturating_sub(1) };
    let painter = ui.painter_at(room);
    axes(&painter, &area, shown, [theme.text, theme.weak_text, theme.separator]);
    let timeline = editor.session.timeline();
    if let Some(step) = timeline.shown() {
        painter.vline(area.x(step), whole.y_range(), Stroke::new(1.0, theme.accent.gamma_multiply(0.5)));
    }
    values(&painter, &area, shown, shown.colour(theme));
    let name = format!("Enlarged curve: {} {}", shown.curve.title, shown.about());
    let now = timeline.shown().map(|step| format!(". Step {step}: {}", shown.words_at(step))).unwrap_or_default();
    let response = response.named(Role::Image, &format!("{name}{now}"));
    if let Some(pointer) = response.hover_pos().filter(|_| !shown.values.is_empty()) {
        let step = area.step_at(pointer.x);
        painter.vline(area.x(step), whole.y_range(), Stroke::new(1.0, theme.weak_text.gamma_multiply(0.6)));
        if let Some(value) = shown.values[step] {
            painter.circle_stroke(area.at(step, value).0, 5.0, Stroke::new(1.5, theme.text));
        }
        response.asks(Action::ShowStep(step), requests);
        let stage = timeline.records()[step].stage.short_words();
        response.on_hover_text_at_pointer(format!("Step {step}, {stage}: {}", shown.words_at(step)));
    }
}

/// Paints lines at round numbers, and the names of the axes. `inks` colour words, marks and lines.
fn axes(painter: &Painter, area: &Area, shown: &ShownCurve, [text, weak, line]: [Color32; 3]) {
    let font = FontId::proportional(WORDS);
    let whole = area.whole;
    for (share, words) in area.span.marks() {
        let y = area.y(share);
        painter.hline(whole.x_range(), y, Stroke::new(1.0, line));
        painter.text(egui::pos2(whole.left() - 6.0, y), Align2::RIGHT_CENTER, words, font.clone(), weak);
    }
    if area.span.has_unplaced {
        painter.hline(whole.x_range(), area.placed.bottom(), Stroke::new(1.0, weak));
        let at = egui::pos2(whole.left() - 6.0, whole.bottom() - STRIP / 2.0);
        painter.text(at, Align2::RIGHT_CENTER, "≤ 0", font.clone(), weak);
    }
    let labels = 1 + area.last / 12;
    for step in (0..=area.last).step_by(labels) {
        let at = egui::pos2(area.x(step), whole.bottom() + 4.0);
        painter.text(at, Align2::CENTER_TOP, step.to_string(), font.clone(), weak);
    }
    painter.rect_stroke(whole, 0.0, Stroke::new(1.0, weak), egui::StrokeKind::Inside);
    let unit = format!("{} ({})", shown.curve.title, shown.curve.unit);
    painter.text(whole.left_top() - egui::vec2(0.0, 4.0), Align2::LEFT_BOTTOM, unit, font.clone(), text);
    let at = egui::pos2(whole.center().x, whole.bottom() + 6.0 + WORDS);
    painter.text(at, Align2::CENTER_TOP, "Step", font, text);
}

/// Paints the values: dots and lines between neighbours, and hollow triangles for values without a place.
fn values(painter: &Painter, area: &Area, shown: &ShownCurve, colour: Color32) {
    let has_dots = shown.values.len() <= MOST_POINTS;
    let mut before: Option<Pos2> = None;
    for (step, value) in shown.values.iter().enumerate() {
        let Some((at, is_placed)) = value.map(|value| area.at(step, value)) else {
            before = None;
            continue;
        };
        if !is_placed {
            let corners = [(-5.0, -4.0), (5.0, -4.0), (0.0, 5.0)].map(|(x, y)| at + egui::vec2(x, y));
            painter.add(Shape::closed_line(corners.to_vec(), Stroke::new(1.5, colour)));
        } else if let Some(before) = before {
            painter.line_segment([before, at], Stroke::new(1.8, colour));
        }
        if is_placed && has_dots {
            painter.circle_filled(at, 3.0, colour);
        }
        before = is_placed.then_some(at);
    }
}
