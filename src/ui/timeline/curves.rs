//! Curves of the numbers of the steps, side by side. A click shows the step under the pointer; a click on the name
//! enlarges the curve.

use eframe::egui::{self, Align, Button, Layout, Rect, Response, RichText, Role, Sense};
use egui_plot::{HPlacement, Line, LineStyle, MarkerShape, Plot, PlotPoint, PlotPoints, PlotResponse, Points, VLine};

use super::buttons::lasting_menu;
use super::marks::Marks;
use crate::session::{Action, Timeline};
use crate::ui::editor::step_curve::ShownCurve;
use crate::ui::state::CurveRequest;
use crate::ui::{Control, CurvesExport, Editor, FileDialogKind, Request, Theme, theme_of};
use freebound_io::figure::{AxisScale, AxisSpan};

/// Least width of a curve, points.
const LEAST_WIDTH: f32 = 110.0;

/// Gap between two curves, points.
const GAP: f32 = 20.0;

/// Greatest number of steps for which single points are drawn.
pub(super) const MOST_POINTS: usize = 80;

/// Distance of numbers without a place on the scale from the lowest number with one, in shares of the height.
const BELOW: f64 = 0.14;

/// Menu that hides or shows curves, and exports them. Entries name curves without numbers and curves that are 0 in
/// every step.
pub(super) fn curves_menu(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    let (timeline, view) = (editor.session.timeline(), &mut editor.timeline);
    let response = lasting_menu(ui, "Curves", |ui| {
        for shown in ShownCurve::all(timeline, view) {
            let hidden = &mut view.curves_hidden[shown.place];
            let mut is_wanted = !*hidden;
            let words = match shown.says_something() {
                true => shown.curve.title.to_owned(),
                false if shown.is_empty() => format!("{}: no numbers", shown.curve.title),
                false => format!("{}: 0 in every step", shown.curve.title),
            };
            ui.checkbox(&mut is_wanted, words).on_hover_text(shown.about());
            *hidden = !is_wanted;
        }
        ui.separator();
        export_entries(ui, requests);
    });
    response
        .named(Role::Button, "Choice of curves")
        .on_hover_text("Choose the curves to show. Default: the first ones with numbers other than 0, as many as fit.");
}

/// Entries that export the curves.
pub(super) fn export_entries(ui: &mut egui::Ui, requests: &mut Vec<Request>) {
    for what in CurvesExport::ALL {
        let [words, about] = what.words();
        let entry = ui.button(words).on_hover_text(about);
        if entry.asks(Request::Ask(FileDialogKind::Curves(what)), requests) {
            ui.close();
        }
    }
}

/// Entries that choose the scale of a curve. Returns true if one was clicked.
pub(super) fn scale_entries(ui: &mut egui::Ui, shown: &ShownCurve, requests: &mut Vec<Request>) -> bool {
    let scales = [
        (AxisScale::Linear, "Linear", "Equal distances for equal differences"),
        (AxisScale::Logarithmic, "Logarithmic", "Equal distances for equal factors; numbers up to 0 are marked below"),
    ];
    let mut is_clicked = false;
    for (scale, words, about) in scales {
        let entry = ui.selectable_label(shown.scale == scale, words).on_hover_text(about);
        is_clicked |= entry.asks(Request::Curve(CurveRequest::SetScale(shown.place, scale)), requests);
    }
    is_clicked
}

/// Shows the first visible curves that fit side by side.
pub(in crate::ui) fn curves(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let all = ui.available_rect_before_wrap().shrink2(egui::vec2(4.0, 0.0));
    let timeline = editor.session.timeline();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few curves have room")]
    let room = (((all.width() + GAP) / (LEAST_WIDTH + GAP)) as usize).max(1);
    let mut shown = ShownCurve::telling(timeline, &editor.timeline);
    shown.truncate(room);
    let width = (all.width() + GAP) / shown.len().max(1) as f32 - GAP;
    for (place, curve) in shown.iter().enumerate() {
        let left = all.left() + place as f32 * (width + GAP);
        let rect = Rect::from_x_y_ranges(left..=left + width, all.y_range());
        ui.scope_builder(egui::UiBuilder::new().max_rect(rect).id_salt(curve.curve.title), |ui| {
            show_curve(ui, curve, timeline, requests);
        });
    }
}

fn show_curve(ui: &mut egui::Ui, curve: &ShownCurve, timeline: &Timeline, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    ui.horizontal(|ui| {
        title(ui, curve, requests);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if let Some(shown) = timeline.shown() {
                let value = curve.values[shown];
                let words = value.map_or_else(|| "–".to_owned(), |value| curve.words(value));
                ui.label(RichText::new(words).small().color(theme.text));
            }
        });
    });
    let marks = Marks::new(ui, curve, unplaced_height(&curve.span()));
    let room = ui.available_rect_before_wrap();
    let inner = room.with_min_x(room.left() + marks.width());
    let plot = |ui: &mut egui::Ui| plot(ui, curve, timeline);
    let PlotResponse { response, transform, .. } = ui.scope_builder(egui::UiBuilder::new().max_rect(inner), plot).inner;
    let response = response.named(Role::Image, &format!("Curve: {}", curve.about()));
    let at = |height: f64| transform.position_from_point(&PlotPoint::new(0.0, height)).y;
    marks.paint(ui, room.left(), response.rect, &at);
    context_menu(&response, curve, requests);
    if response.double_clicked() {
        requests.push(Request::Curve(CurveRequest::Enlarge(curve.place)));
    }
    let Some(pointer) = response.hover_pos() else { return };
    let index = nearest(transform.value_from_position(pointer).x, curve.values.len());
    ui.painter().with_clip_rect(response.rect).vline(
        transform.position_from_point_x(index as f64),
        response.rect.y_range(),
        egui::Stroke::new(1.0, theme.weak_text.gamma_multiply(0.6)),
    );
    response.asks(Action::ShowStep(index), requests);
    response.on_hover_text_at_pointer(format!("Step {index}: {}\n{}", curve.words_at(index), curve.about()));
}

/// Name of a curve, a button that enlarges it.
fn title(ui: &mut egui::Ui, curve: &ShownCurve, requests: &mut Vec<Request>) {
    let words = RichText::new(curve.curve.title).small().color(theme_of(ui).weak_text);
    let response = ui.add(Button::new(words).frame(false).min_size(egui::Vec2::ZERO));
    let response = response.named(Role::Button, &format!("Enlarge the curve: {}", curve.curve.title));
    context_menu(&response, curve, requests);
    let response = response.on_hover_text(format!("{}. Click to enlarge", curve.about()));
    response.asks(Request::Curve(CurveRequest::Enlarge(curve.place)), requests);
}

fn context_menu(response: &Response, curve: &ShownCurve, requests: &mut Vec<Request>) {
    response.context_menu(|ui| {
        if ui.button("Enlarge").asks(Request::Curve(CurveRequest::Enlarge(curve.place)), requests) {
            ui.close();
        }
        ui.separator();
        if scale_entries(ui, curve, requests) {
            ui.close();
        }
        ui.separator();
        export_entries(ui, requests);
    });
}

/// Step nearest to a place of the horizontal axis.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the steps that there are")]
pub(super) fn nearest(place: f64, count: usize) -> usize {
    place.round().clamp(0.0, count.saturating_sub(1) as f64) as usize
}

/// Height at which numbers without a place on the scale are marked, if there are some.
fn unplaced_height(span: &AxisSpan) -> Option<f64> {
    span.has_unplaced.then_some(span.low - BELOW * (span.high - span.low))
}

fn plot(ui: &mut egui::Ui, curve: &ShownCurve, timeline: &Timeline) -> PlotResponse<()> {
    let theme = theme_of(ui);
    let colour = curve.colour(theme);
    let span = curve.span();
    let below = unplaced_height(&span);
    let height = |value: f64| curve.scale.height_of(value).or(below);
    let point = |index: usize| Some([index as f64, height(curve.values[index]?)?]);
    let count = curve.values.len();
    let is_placed = |index: usize| curve.values[index].is_some_and(|value| curve.scale.height_of(value).is_some());
    let points = |placed: bool| (0..count).filter(|&k| is_placed(k) == placed).filter_map(point).collect::<Vec<_>>();
    let (placed, unplaced) = (points(true), points(false));
    let shown = timeline.shown();
    let at_shown = shown.filter(|&shown| is_placed(shown)).and_then(point);
    let compared = timeline.compared();
    let title = curve.curve.title;
    base(theme, curve, &span).show(ui, move |plot| {
        if let Some(compared) = compared {
            let style = LineStyle::dashed_dense();
            plot.vline(VLine::new("compared", compared as f64).color(theme.weak_text).width(1.0).style(style));
        }
        if let Some(shown) = shown {
            plot.vline(VLine::new("shown", shown as f64).color(theme.accent.gamma_multiply(0.5)).width(1.0));
        }
        plot.line(Line::new(title, PlotPoints::from(placed.clone())).color(colour).width(1.5));
        if count <= MOST_POINTS {
            plot.points(Points::new(title, PlotPoints::from(placed)).color(colour).radius(2.0));
        }
        let marks = Points::new("no place on the scale", PlotPoints::from(unplaced)).shape(MarkerShape::Down);
        plot.points(marks.color(colour).filled(false).radius(3.0));
        if let Some(at) = at_shown {
            plot.points(Points::new("here", PlotPoints::from(vec![at])).color(colour).radius(4.0));
        }
    })
}

/// Plot without interaction, scaled to the range of the run.
fn base<'a>(theme: &Theme, curve: &ShownCurve, span: &AxisSpan) -> Plot<'a> {
    Plot::new(curve.curve.title)
        .show_axes([false, false])
        .show_grid([false, curve.scale == AxisScale::Linear])
        .grid_color(theme.separator)
        .grid_fade(0.0)
        .show_background(false)
        .show_x(false)
        .show_y(false)
        .show_crosshair(false)
        .label_formatter(|_| None)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_axis_zoom_drag(false)
        .allow_double_click_reset(false)
        .sense(Sense::click())
        .min_size(egui::vec2(40.0, 30.0))
        .set_margin_fraction(egui::vec2(0.04, 0.12))
        .y_axis_position(HPlacement::Left)
        .include_x(0.0)
        .include_x(curve.values.len().saturating_sub(1).max(1) as f64)
        .include_y(unplaced_height(span).unwrap_or(span.low))
        .include_y(span.high)
}
