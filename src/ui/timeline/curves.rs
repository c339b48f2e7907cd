//! Curves of the numbers of the steps, side by side. A click shows the step under the pointer.

use eframe::egui::{self, Align, Color32, Layout, Rect, RichText, Role, Sense};
use egui_plot::{HPlacement, Line, LineStyle, Plot, PlotPoint, PlotPoints, PlotResponse, Points, VLine};

use super::buttons::lasting_menu;
use super::marks::Marks;
use crate::session::{Action, StepDistortion, Timeline};
use crate::ui::state::CURVE_COUNT;
use crate::ui::{Control, Editor, Request, Theme, remark, short, theme_of};
use freebound_io::StepReport;

/// Least width of a curve, points.
const LEAST_WIDTH: f32 = 118.0;

/// Gap between two curves, points.
const GAP: f32 = 12.0;

/// Greatest number of steps for which single points are drawn.
const MOST_POINTS: usize = 80;

/// Exponent that stands for 0 on a logarithmic scale.
const LEAST_POWER: f64 = -17.0;

/// Curve of one number of each step.
pub(super) struct Curve {
    title: &'static str,
    about: &'static str,
    pub(super) scale: CurveScale,
    value: ValueOf,
    colour: ColourOf,
}

/// Scale of a curve.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum CurveScale {
    /// Linear from 0, for counts.
    Count,
    /// Logarithmic.
    Powers,
}

type ValueOf = fn(&StepReport, &StepDistortion) -> Option<f64>;
type ColourOf = fn(&Theme) -> Color32;

const fn count(title: &'static str, about: &'static str, value: ValueOf, colour: ColourOf) -> Curve {
    Curve { title, about, scale: CurveScale::Count, value, colour }
}

const fn size(title: &'static str, about: &'static str, value: ValueOf, colour: ColourOf) -> Curve {
    Curve { title, about, scale: CurveScale::Powers, value, colour }
}

const CURVES: [Curve; CURVE_COUNT] = [
    count("Flipped", "flipped faces", |record, _| Some(record.flipped_faces as f64), |theme| theme.flipped),
    count(
        "Crossings",
        "pairs of boundary edges that cross",
        |record, _| Some(record.boundary_crossings as f64),
        |theme| theme.crossing,
    ),
    size(
        "Largest move",
        "largest move of a vertex since the previous step, in units of the plane; by powers of ten",
        |record, _| record.max_move,
        |theme| theme.accent,
    ),
    size(
        "Distance left",
        "largest distance of a hard pin from its target, in units of the plane; by powers of ten",
        |_, standing| Some(standing.progress?.distance_left),
        |theme| theme.unmet,
    ),
    size(
        "Energy",
        "mean symmetric Dirichlet energy: 4 without distortion",
        |_, standing| Some(standing.progress?.energy),
        |theme| theme.constraint,
    ),
    size(
        "Equation residual",
        "|A z| of all equations relative to their terms; by powers of ten",
        |record, _| record.equation_residual.filter(|residual| residual.is_finite()),
        |theme| theme.accent,
    ),
    count("Concave", "concave polygons", |record, _| Some(record.concave_polygons as f64), |theme| theme.concave),
    count(
        "Overwound",
        "overwound vertices",
        |record, _| Some(record.overwound_vertices as f64),
        |theme| theme.overwound,
    ),
    count(
        "Outside hull",
        "vertices outside the hull of their neighbours",
        |record, _| Some(record.outside_hull_vertices as f64),
        |theme| theme.outside_hull,
    ),
    size(
        "Residual",
        "|Ax − b| / |b| of the step's linear solve; by powers of ten",
        |record, _| record.residual.filter(|residual| residual.is_finite()),
        |theme| theme.weak_text,
    ),
    size(
        "Determinant",
        "smallest determinant of a face's map, at equal total areas; by powers of ten",
        |_, standing| Some(standing.progress?.least_determinant),
        |theme| theme.planar,
    ),
];

impl Curve {
    /// Height of a value in the plot.
    pub(super) fn height_of(&self, value: f64) -> f64 {
        match self.scale {
            CurveScale::Count => value,
            CurveScale::Powers => value.log10().max(LEAST_POWER),
        }
    }

    /// Number of a step, if it has one.
    fn value_at(&self, timeline: &Timeline, index: usize) -> Option<f64> {
        (self.value)(timeline.records().get(index)?, timeline.standings().get(index)?).filter(|value| value.is_finite())
    }

    /// Least and greatest value over all steps.
    fn ends(&self, timeline: &Timeline) -> Option<[f64; 2]> {
        let values = (0..timeline.records().len()).filter_map(|index| self.value_at(timeline, index));
        values.fold(None, |ends, value| match ends {
            None => Some([value; 2]),
            Some([least, greatest]) => Some([value.min(least), value.max(greatest)]),
        })
    }

    /// Formats a value.
    pub(super) fn words(&self, value: f64) -> String {
        match self.scale {
            CurveScale::Count => format!("{value:.0}"),
            CurveScale::Powers if value == 0.0 => "0".to_owned(),
            CurveScale::Powers if (0.01..1e4).contains(&value) => short(value),
            CurveScale::Powers => format!("{value:.1e}"),
        }
    }
}

/// Menu that hides or shows curves. Entries name curves without numbers and curves that are 0 in every step.
pub(super) fn curves_menu(ui: &mut egui::Ui, editor: &mut Editor) {
    let (timeline, hidden) = (editor.session.timeline(), &mut editor.timeline.curves_hidden);
    let response = lasting_menu(ui, "Curves", |ui| {
        for (curve, hidden) in CURVES.iter().zip(hidden) {
            let mut shown = !*hidden;
            let words = match curve.ends(timeline) {
                None => format!("{}: no numbers", curve.title),
                Some(ends) if says_nothing(ends) => format!("{}: 0 in every step", curve.title),
                Some(_) => curve.title.to_owned(),
            };
            ui.checkbox(&mut shown, words).on_hover_text(curve.about);
            *hidden = !shown;
        }
    });
    response
        .named(Role::Button, "Choice of curves")
        .on_hover_text("Choose the curves to show. Default: the first ones with numbers other than 0, as many as fit.");
}

/// True if all numbers between these ends are 0.
fn says_nothing(ends: [f64; 2]) -> bool {
    ends.iter().all(|end| end.abs() <= 0.0)
}

/// Shows the first visible curves that fit side by side.
pub(in crate::ui) fn curves(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let all = ui.available_rect_before_wrap().shrink2(egui::vec2(4.0, 0.0));
    let timeline = editor.session.timeline();
    let has_numbers = |curve: &Curve| curve.ends(timeline).is_some_and(|ends| !says_nothing(ends));
    let wanted = CURVES.iter().zip(editor.timeline.curves_hidden).filter(|(_, hidden)| !hidden).map(|(curve, _)| curve);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few curves have room")]
    let room = (((all.width() + GAP) / (LEAST_WIDTH + GAP)) as usize).max(1);
    let shown: Vec<&Curve> = wanted.filter(|curve| has_numbers(curve)).take(room).collect();
    let width = (all.width() + GAP) / shown.len().max(1) as f32 - GAP;
    for (place, curve) in shown.into_iter().enumerate() {
        let left = all.left() + place as f32 * (width + GAP);
        let rect = Rect::from_x_y_ranges(left..=left + width, all.y_range());
        ui.scope_builder(egui::UiBuilder::new().max_rect(rect).id_salt(curve.title), |ui| {
            show_curve(ui, curve, timeline, requests);
        });
    }
}

fn show_curve(ui: &mut egui::Ui, curve: &Curve, timeline: &Timeline, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let records = timeline.records();
    ui.horizontal(|ui| {
        remark(ui, curve.title).on_hover_text(curve.about);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if let Some(shown) = timeline.shown() {
                let words = curve.value_at(timeline, shown).map_or_else(|| "–".to_owned(), |v| curve.words(v));
                ui.label(RichText::new(words).small().color(theme.text));
            }
        });
    });
    let Some(ends) = curve.ends(timeline) else { return };
    let marks = Marks::new(ui, curve, ends);
    let room = ui.available_rect_before_wrap();
    let inner = room.with_min_x(room.left() + marks.width());
    let plot = |ui: &mut egui::Ui| plot(ui, curve, timeline);
    let PlotResponse { response, transform, .. } = ui.scope_builder(egui::UiBuilder::new().max_rect(inner), plot).inner;
    let response = response.named(Role::Image, &format!("Curve: {}", curve.about));
    let at = |height: f64| transform.position_from_point(&PlotPoint::new(0.0, height)).y;
    marks.paint(ui, room.left(), response.rect, &at);
    let Some(pointer) = response.hover_pos() else { return };
    let index = nearest(transform.value_from_position(pointer).x, records.len());
    ui.painter().with_clip_rect(response.rect).vline(
        transform.position_from_point_x(index as f64),
        response.rect.y_range(),
        egui::Stroke::new(1.0, theme.weak_text.gamma_multiply(0.6)),
    );
    response.asks(Action::ShowStep(index), requests);
    let value = curve.value_at(timeline, index);
    let words = value.map_or_else(|| "this step has no such number".to_owned(), |value| curve.words(value));
    response.on_hover_text_at_pointer(format!("Step {index}: {words}\n{}", curve.about));
}

/// Step nearest to a place of the horizontal axis.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the steps that there are")]
fn nearest(place: f64, count: usize) -> usize {
    place.round().clamp(0.0, count.saturating_sub(1) as f64) as usize
}

fn plot(ui: &mut egui::Ui, curve: &Curve, timeline: &Timeline) -> PlotResponse<()> {
    let theme = theme_of(ui);
    let records = timeline.records();
    let colour = (curve.colour)(theme);
    let point = |index: usize| curve.value_at(timeline, index).map(|v| [index as f64, curve.height_of(v)]);
    let points: Vec<[f64; 2]> = (0..records.len()).filter_map(point).collect();
    let shown = timeline.shown();
    let at_shown = shown.and_then(point);
    let compared = timeline.compared();
    let few = records.len() <= MOST_POINTS;
    base(theme, curve, &points, records.len()).show(ui, move |plot| {
        if let Some(compared) = compared {
            let style = LineStyle::dashed_dense();
            plot.vline(VLine::new("compared", compared as f64).color(theme.weak_text).width(1.0).style(style));
        }
        if let Some(shown) = shown {
            plot.vline(VLine::new("shown", shown as f64).color(theme.accent.gamma_multiply(0.5)).width(1.0));
        }
        plot.line(Line::new(curve.title, PlotPoints::from(points.clone())).color(colour).width(1.5));
        if few {
            plot.points(Points::new(curve.title, PlotPoints::from(points)).color(colour).radius(2.0));
        }
        if let Some(at) = at_shown {
            plot.points(Points::new("here", PlotPoints::from(vec![at])).color(colour).radius(4.0));
        }
    })
}

/// Plot without interaction, scaled to the range of the run.
fn base<'a>(theme: &Theme, curve: &Curve, points: &[[f64; 2]], count: usize) -> Plot<'a> {
    let heights = || points.iter().map(|point| point[1]);
    let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
    let (low, high) = match curve.scale {
        CurveScale::Count => (0.0, high.max(1.0)),
        CurveScale::Powers if low <= high => (low - 0.5, high + 0.5),
        CurveScale::Powers => (-1.0, 1.0),
    };
    Plot::new(curve.title)
        .show_axes([false, false])
        .show_grid([false, curve.scale == CurveScale::Count])
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
        .include_x(count.saturating_sub(1).max(1) as f64)
        .include_y(low)
        .include_y(high)
}
