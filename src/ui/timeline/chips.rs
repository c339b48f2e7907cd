//! The steps in a row: number, rung, and how good each is.

use eframe::egui;
use egui::{Align2, Color32, FontId, Modifiers, Rect, Role, ScrollArea, Sense, Stroke, StrokeKind, WidgetInfo};

use super::ROW_HEIGHT;
use crate::io::StepReport;
use crate::session::{Action, Standing, Timeline};
use crate::solver::Progress;
use crate::ui::icons::{self, Sign};
use crate::ui::panels::status::short;
use crate::ui::theme::{Theme, theme_of};
use crate::ui::{Editor, Request};

/// Height of a step, points.
const CHIP: f32 = 22.0;

/// Room before and after what a step says, points.
const PADDING: f32 = 8.0;

/// Between two steps, points.
const GAP: f32 = 4.0;

/// Side of the sign that tells good from bad, points.
const SIGN: f32 = 9.0;

/// Size of the letters, points.
const LETTERS: f32 = 12.0;

/// The rung of a step, as a person calls it.
pub(in crate::ui) fn rung_words(rung: &str) -> &str {
    match rung {
        "iterate" => "mean value",
        "relax" => "relaxed",
        "virtual-boundary" => "virtual boundary",
        "matchmaker" => "new vertices",
        other => other,
    }
}

/// A step in words, without its place on the screen.
fn name_of(record: &StepReport, timeline: &Timeline) -> String {
    let unmet = timeline.standings()[record.index].unmet;
    let state = match record.defect_count() {
        _ if record.planar && unmet > 0 => format!("planar, constraints not met: {unmet}"),
        _ if record.planar => "planar".to_owned(),
        1 => "1 defect".to_owned(),
        count => format!("{count} defects"),
    };
    let compared = if timeline.compared() == Some(record.index) { ", compared" } else { "" };
    format!("Step {}: {}, {state}{compared}", record.index, rung_words(record.rung))
}

/// What a step shows: its number, and its rung where that is another one than before.
fn label_of(records: &[StepReport], index: usize) -> String {
    let rung = records[index].rung;
    let is_new = index == 0 || records[index - 1].rung != rung;
    if is_new { format!("{index} {}", rung_words(rung)) } else { index.to_string() }
}

/// Shows the steps.
pub(in crate::ui) fn chips(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    let timeline = editor.session.timeline();
    let places = places(ui, timeline);
    let width = places.last().map_or(0.0, |place| place.1);
    let scrolls_to = timeline.shown().filter(|_| editor.timeline.scrolled_to != timeline.shown());
    ui.style_mut().always_scroll_the_only_direction = true;
    let area = ScrollArea::horizontal().id_salt("steps").auto_shrink([false, true]);
    area.show_viewport(ui, |ui, viewport| {
        let (all, _) = ui.allocate_exact_size(egui::vec2(width, ROW_HEIGHT), Sense::hover());
        let rect_of = |(left, right): (f32, f32)| {
            let middle = all.center().y;
            Rect::from_x_y_ranges(all.left() + left..=all.left() + right, middle - CHIP / 2.0..=middle + CHIP / 2.0)
        };
        let in_view = |place: &(f32, f32)| place.1 >= viewport.left() && place.0 <= viewport.right();
        for (index, &place) in places.iter().enumerate().filter(|(_, place)| in_view(place)) {
            chip(ui, rect_of(place), timeline, index, requests);
        }
        if let Some(&place) = scrolls_to.and_then(|shown| places.get(shown)) {
            ui.scroll_to_rect(rect_of(place).expand2(egui::vec2(40.0, 0.0)), None);
        }
    });
    editor.timeline.scrolled_to = editor.session.timeline().shown();
}

/// Where each step lies: left and right end.
fn places(ui: &egui::Ui, timeline: &Timeline) -> Vec<(f32, f32)> {
    let records = timeline.records();
    let font = FontId::proportional(LETTERS);
    let width_of = |text: String| ui.painter().layout_no_wrap(text, font.clone(), Color32::PLACEHOLDER).size().x;
    // Figures are all of one width; only names are measured.
    let figure = width_of("0".to_owned());
    let mut left = 0.0;
    let mut places = Vec::with_capacity(records.len());
    for index in 0..records.len() {
        let label = label_of(records, index);
        let is_number = label.bytes().all(|byte| byte.is_ascii_digit());
        let letters = if is_number { figure * label.len() as f32 } else { width_of(label) };
        let number = Score::of(timeline, index).number();
        let count = number.map_or(0.0, |number| 3.0 + figure * number.to_string().len() as f32);
        let right = left + 2.0 * PADDING + letters + 6.0 + SIGN + count;
        places.push((left, right));
        left = right + GAP;
    }
    places
}

fn chip(ui: &egui::Ui, rect: Rect, timeline: &Timeline, index: usize, requests: &mut Vec<Request>) {
    let records = timeline.records();
    let record = &records[index];
    let is_shown = timeline.shown() == Some(index);
    let response = ui.interact(rect, ui.scope_id().with(("step", index)), Sense::click());
    let name = name_of(record, timeline);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_shown, &name));
    let theme = theme_of(ui);
    let look = Look {
        is_shown,
        is_compared: timeline.compared() == Some(index),
        is_kept: timeline.outcome(index).is_some(),
        is_pointed_at: response.hovered(),
        has_focus: response.has_focus(),
    };
    paint(ui.painter(), rect, theme, &look);
    let ink = if look.is_kept { theme.text } else { theme.weak_text };
    write(ui.painter(), rect, theme, (&label_of(records, index), ink), Score::of(timeline, index));
    if response.clicked() {
        let is_comparing = ui.input(|input| input.modifiers.matches_exact(Modifiers::SHIFT));
        let compared = (timeline.compared() != Some(index)).then_some(index);
        let action = if is_comparing { Action::Compare(compared) } else { Action::ShowStep(index) };
        requests.push(Request::Do(action));
    }
    response.context_menu(|ui| chip_menu(ui, timeline, index, requests));
    let hint = if look.is_kept { "Click shows it, Shift+click compares." } else { "Only its numbers were kept." };
    response.on_hover_ui(|ui| tip(ui, (record, &timeline.standings()[index]), hint));
}

/// How a step looks.
#[expect(clippy::struct_excessive_bools, reason = "each changes the look by itself")]
struct Look {
    is_shown: bool,
    is_compared: bool,
    is_kept: bool,
    is_pointed_at: bool,
    has_focus: bool,
}

fn paint(painter: &egui::Painter, rect: Rect, theme: &Theme, look: &Look) {
    let fill = if look.is_shown {
        theme.accent.gamma_multiply(0.24)
    } else if look.is_pointed_at {
        theme.accent.gamma_multiply(0.12)
    } else {
        theme.separator.gamma_multiply(0.45)
    };
    painter.rect_filled(rect, CHIP / 2.0, fill);
    let outline = if look.has_focus || look.is_shown {
        Some(Stroke::new(1.0, theme.accent))
    } else {
        look.is_compared.then(|| Stroke::new(1.5, theme.weak_text))
    };
    if let Some(outline) = outline {
        painter.rect_stroke(rect, CHIP / 2.0, outline, StrokeKind::Inside);
    }
}

/// How good a step is.
#[derive(Clone, Copy)]
enum Score {
    /// Planar, and every constraint met.
    Good,
    /// Planar, with so many constraints not met.
    Unmet(usize),
    /// Not planar, with so many defects.
    Bad(usize),
}

impl Score {
    fn of(timeline: &Timeline, index: usize) -> Self {
        let (record, unmet) = (&timeline.records()[index], timeline.standings()[index].unmet);
        match record.planar {
            false => Self::Bad(record.defect_count()),
            true if unmet > 0 => Self::Unmet(unmet),
            true => Self::Good,
        }
    }

    /// The number behind the sign.
    fn number(self) -> Option<usize> {
        match self {
            Self::Good => None,
            Self::Unmet(count) | Self::Bad(count) => Some(count),
        }
    }
}

/// Number, rung, and a check mark, or the number of defects or of constraints that are not met.
fn write(painter: &egui::Painter, rect: Rect, theme: &Theme, (label, ink): (&str, Color32), score: Score) {
    let font = FontId::proportional(LETTERS);
    let at = rect.left_center() + egui::vec2(PADDING, 0.0);
    let written = painter.text(at, Align2::LEFT_CENTER, label, font.clone(), ink);
    let middle = egui::pos2(written.right() + 6.0 + SIGN / 2.0, rect.center().y);
    let square = Rect::from_center_size(middle, egui::Vec2::splat(SIGN));
    let (sign, colour) = match score {
        Score::Good => (Sign::Good, theme.planar),
        Score::Unmet(_) => (Sign::Warning, theme.unmet),
        Score::Bad(_) => (Sign::Bad, theme.flipped),
    };
    icons::sign(painter, if sign == Sign::Bad { square.shrink(0.5) } else { square }, sign, colour);
    if let Some(number) = score.number() {
        let at = square.right_center() + egui::vec2(3.0, 0.0);
        painter.text(at, Align2::LEFT_CENTER, number.to_string(), font, colour);
    }
}

fn chip_menu(ui: &mut egui::Ui, timeline: &Timeline, index: usize, requests: &mut Vec<Request>) {
    let entries = [
        ("Show this step", Action::ShowStep(index), timeline.shown() != Some(index)),
        ("Compare with this", Action::Compare(Some(index)), timeline.compared() != Some(index)),
        ("Stop comparing", Action::Compare(None), timeline.compared().is_some()),
    ];
    for (words, action, enabled) in entries {
        if ui.add_enabled(enabled, egui::Button::new(words)).clicked() {
            requests.push(Request::Do(action));
            ui.close();
        }
    }
}

/// All numbers of a step.
fn tip(ui: &mut egui::Ui, (record, standing): (&StepReport, &Standing), hint: &str) {
    ui.strong(format!("Step {}: {}", record.index, rung_words(record.rung)));
    egui::Grid::new("numbers of a step").num_columns(2).spacing([16.0, 2.0]).show(ui, |ui| {
        for (name, value) in numbers_of(record, standing) {
            ui.label(name);
            ui.monospace(value);
            ui.end_row();
        }
    });
    if let Some(note) = &record.note {
        ui.label(crate::ui::sentence(note));
    }
    ui.label(egui::RichText::new(hint).small().color(theme_of(ui).weak_text));
}

/// A residual; a step that solves no linear system has none.
pub(in crate::ui) fn residual_words(residual: Option<f64>) -> String {
    residual.map_or_else(|| "–".to_owned(), |residual| format!("{residual:.1e}"))
}

fn numbers_of(record: &StepReport, standing: &Standing) -> Vec<(&'static str, String)> {
    let mut numbers = vec![
        ("Flipped faces", record.flipped_faces.to_string()),
        ("Boundary crossings", record.boundary_crossings.to_string()),
        ("Overwound vertices", record.overwound_vertices.to_string()),
        ("Turning number", record.turning_number.map_or_else(|| "none".to_owned(), |number| number.to_string())),
        ("Planar", if record.planar { "proved".to_owned() } else { "no".to_owned() }),
    ];
    numbers.extend(record.max_move.map(|moved| ("Largest move, in units of the plane", short(moved))));
    if let Some(Progress { energy, least_determinant, distance_left }) = standing.progress {
        numbers.push(("Energy", format!("{energy:.4}")));
        numbers.push(("Smallest determinant", short(least_determinant)));
        numbers.push(("Distance left, in units of the plane", short(distance_left)));
    }
    numbers.push(("Residual", residual_words(record.residual)));
    numbers.push(("Equation residual", residual_words(record.equation_residual)));
    let counts = [
        ("Constraints not met", standing.unmet),
        ("New vertices", standing.new_vertices),
        ("Boundary vertices bent", record.bent_vertices),
        ("Corners bounded", record.bounded_corners),
        ("Pivots replaced", record.replaced_pivots),
    ];
    numbers.extend(counts.into_iter().filter(|(_, count)| *count > 0).map(|(name, count)| (name, count.to_string())));
    numbers.push(("Factors", format!("{:.1} MB", record.factor_bytes as f64 / 1e6)));
    numbers.push(("Time, proof included", format!("{:.0} ms", 1000.0 * record.seconds)));
    numbers
}
