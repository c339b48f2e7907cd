//! Row of steps: number, stage, and verdict of each.

use eframe::egui;
use egui::{Align2, Color32, FontId, Modifiers, Rangef, Rect, Role, ScrollArea, Sense, Stroke, StrokeKind, WidgetInfo};

use super::room::Room;
use crate::session::{Action, StepDistortion, Timeline};
use crate::ui::icons::{self, Sign};
use crate::ui::state::ROW_HEIGHT;
use crate::ui::{Control, Editor, Request, Theme, counted, number, pairs, remark, sentence, short, theme_of};
use freebound_core::problem::Progress;
use freebound_io::StepReport;

/// Height of a chip, points.
const CHIP: f32 = 22.0;

/// Padding at both ends of a chip, points.
const PADDING: f32 = 8.0;

/// Gap between two chips, points.
const GAP: f32 = 4.0;

/// Side of the verdict sign, points.
const SIGN: f32 = 9.0;

/// Font size, points.
const LETTERS: f32 = 12.0;

/// Chip of a step.
struct Chip<'a> {
    index: usize,
    record: &'a StepReport,
    standing: &'a StepDistortion,
    /// Number of the step, and its stage if that has changed and there is room.
    label: String,
    is_shown: bool,
    is_compared: bool,
    /// True if the embedding of the step was kept, not only its numbers.
    is_kept: bool,
}

impl<'a> Chip<'a> {
    fn new(timeline: &'a Timeline, index: usize, room: Room) -> Self {
        let records = timeline.records();
        let stage = records[index].stage.clone();
        let is_new = room != Room::Tight && (index == 0 || records[index - 1].stage != stage);
        Self {
            index,
            record: &records[index],
            standing: &timeline.standings()[index],
            label: if is_new { format!("{index}: {}", stage.short_words()) } else { index.to_string() },
            is_shown: timeline.shown() == Some(index),
            is_compared: timeline.compared() == Some(index),
            is_kept: timeline.outcome(index).is_some(),
        }
    }

    /// Verdict sign of the step, and the number of defects or of unmet constraints.
    fn score(&self) -> (Sign, Option<usize>) {
        match (self.record.planar, self.standing.unmet) {
            (false, _) => (Sign::Bad, Some(self.record.defect_count())),
            (true, 0) => (Sign::Good, None),
            (true, unmet) => (Sign::Unmet, Some(unmet)),
        }
    }

    /// Description of the step for screen readers.
    fn name(&self) -> String {
        let state = match self.score() {
            (Sign::Unmet, Some(unmet)) => format!("planar, constraints not met: {unmet}"),
            (_, Some(defects)) => counted(defects, "defect", "defects"),
            (_, None) => "planar".to_owned(),
        };
        let compared = if self.is_compared { ", compared" } else { "" };
        format!("{}, {state}{compared}", title_of(self.record))
    }

    /// Width of the chip. `width_of` measures letters; `figure` is the width of a digit.
    fn width(&self, width_of: impl Fn(&str) -> f32, figure: f32) -> f32 {
        let is_number = self.label.bytes().all(|byte| byte.is_ascii_digit());
        let letters = if is_number { figure * self.label.len() as f32 } else { width_of(&self.label) };
        let count = self.score().1.map_or(0.0, |number| 3.0 + figure * number.to_string().len() as f32);
        2.0 * PADDING + letters + 6.0 + SIGN + count
    }

    fn show(&self, ui: &egui::Ui, rect: Rect, timeline: &Timeline, requests: &mut Vec<Request>) {
        let response = ui.interact(rect, ui.scope_id().with(("step", self.index)), Sense::click());
        let name = self.name();
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, self.is_shown, &name));
        self.paint_ground(ui, rect, &response);
        self.paint_words(ui.painter(), rect, theme_of(ui));
        if response.clicked() {
            let is_comparing = ui.input(|input| input.modifiers.matches_exact(Modifiers::SHIFT));
            let compared = (!self.is_compared).then_some(self.index);
            let action = if is_comparing { Action::Compare(compared) } else { Action::ShowStep(self.index) };
            requests.push(action.into());
        }
        response.context_menu(|ui| self.menu(ui, timeline, requests));
        response.on_hover_ui(|ui| self.tip(ui));
    }

    fn paint_ground(&self, ui: &egui::Ui, rect: Rect, response: &egui::Response) {
        let (painter, theme) = (ui.painter(), theme_of(ui));
        let fill = if self.is_shown {
            theme.accent.gamma_multiply(0.24)
        } else if response.hovered() {
            theme.accent.gamma_multiply(0.12)
        } else {
            theme.separator.gamma_multiply(0.45)
        };
        painter.rect_filled(rect, CHIP / 2.0, fill);
        let outline = if response.has_focus() || self.is_shown {
            Stroke::new(1.0, theme.accent)
        } else if self.is_compared {
            Stroke::new(1.5, theme.weak_text)
        } else {
            return;
        };
        painter.rect_stroke(rect, CHIP / 2.0, outline, StrokeKind::Inside);
    }

    /// Paints number, stage and verdict.
    fn paint_words(&self, painter: &egui::Painter, rect: Rect, theme: &Theme) {
        let font = FontId::proportional(LETTERS);
        let at = rect.left_center() + egui::vec2(PADDING, 0.0);
        let ink = if self.is_kept { theme.text } else { theme.weak_text };
        let written = painter.text(at, Align2::LEFT_CENTER, &self.label, font.clone(), ink);
        let middle = egui::pos2(written.right() + 6.0 + SIGN / 2.0, rect.center().y);
        let square = Rect::from_center_size(middle, egui::Vec2::splat(SIGN));
        let (sign, number) = self.score();
        icons::sign(painter, if sign == Sign::Bad { square.shrink(0.5) } else { square }, sign, theme);
        if let Some(number) = number {
            let at = square.right_center() + egui::vec2(3.0, 0.0);
            painter.text(at, Align2::LEFT_CENTER, number.to_string(), font, sign.colour(theme));
        }
    }

    fn menu(&self, ui: &mut egui::Ui, timeline: &Timeline, requests: &mut Vec<Request>) {
        let entries = [
            ("Show this step", Action::ShowStep(self.index), !self.is_shown),
            ("Compare with this", Action::Compare(Some(self.index)), !self.is_compared),
            ("Stop comparing", Action::Compare(None), timeline.compared().is_some()),
        ];
        for (words, action, enabled) in entries {
            if ui.add_enabled(enabled, egui::Button::new(words)).asks(action, requests) {
                ui.close();
            }
        }
    }

    /// Tooltip with all numbers of the step.
    fn tip(&self, ui: &mut egui::Ui) {
        ui.set_max_width(300.0);
        ui.strong(title_of(self.record));
        pairs(ui, "numbers of a step", [16.0, 2.0], |ui| {
            for (name, value) in numbers_of(self.record, self.standing) {
                number(ui, name, value);
            }
        });
        if let Some(note) = &self.record.note {
            ui.label(sentence(note));
        }
        let hint =
            if self.is_kept { "Click to show it, Shift + click to compare." } else { "Only its numbers were kept." };
        remark(ui, hint);
    }
}

fn title_of(record: &StepReport) -> String {
    format!("Step {}: {}", record.index, record.stage.short_words())
}

pub(super) fn chips(ui: &mut egui::Ui, editor: &mut Editor, room: Room, requests: &mut Vec<Request>) {
    let timeline = editor.session.timeline();
    let places = places(ui, timeline, room);
    let width = places.last().map_or(0.0, |place| place.max);
    let before = editor.timeline.scrolled_to;
    let mut row = 0.0;
    ui.style_mut().always_scroll_the_only_direction = true;
    let area = ScrollArea::horizontal().id_salt("steps").auto_shrink([false, true]);
    area.show_viewport(ui, |ui, viewport| {
        let (all, _) = ui.allocate_exact_size(egui::vec2(width, ROW_HEIGHT), Sense::hover());
        let middle = all.center().y;
        let rect_of = |place: &Rangef| {
            Rect::from_x_y_ranges(
                all.left() + place.min..=all.left() + place.max,
                middle - CHIP / 2.0..=middle + CHIP / 2.0,
            )
        };
        row = viewport.width();
        for (index, place) in places.iter().enumerate() {
            // Draw whole chips only: half a number would read as another number.
            let is_whole = place.min >= viewport.left() - 0.5 && place.max <= viewport.right() + 0.5;
            let is_wide = place.span() > row && place.max >= viewport.left() && place.min <= viewport.right();
            if is_whole || is_wide {
                // Clip a chip that is wider than the row, so that it does not overlap what follows the row.
                let rect = rect_of(place).intersect(ui.clip_rect());
                Chip::new(timeline, index, room).show(ui, rect, timeline, requests);
            }
        }
        let shown = timeline.shown().filter(|&shown| before != Some((shown, row)));
        if let Some(place) = shown.and_then(|shown| places.get(shown)) {
            let around = (0.5 * (row - place.span())).clamp(0.0, 40.0);
            let rect = rect_of(place).expand2(egui::vec2(around, 0.0));
            ui.scroll_to_rect_animation(rect, None, egui::style::ScrollAnimation::none());
        }
    });
    editor.timeline.scrolled_to = editor.session.timeline().shown().map(|shown| (shown, row));
}

/// Horizontal extent of each chip, from left to right.
fn places(ui: &egui::Ui, timeline: &Timeline, room: Room) -> Vec<Rangef> {
    let font = FontId::proportional(LETTERS);
    let width_of =
        |text: &str| ui.painter().layout_no_wrap(text.to_owned(), font.clone(), Color32::PLACEHOLDER).size().x;
    // All digits have equal width, so only names are measured.
    let figure = width_of("0");
    let mut left = 0.0;
    let place = |index| {
        let place = Rangef::new(left, left + Chip::new(timeline, index, room).width(width_of, figure));
        left = place.max + GAP;
        place
    };
    (0..timeline.records().len()).map(place).collect()
}

/// Formats a residual; a step without a linear solve has none.
pub(in crate::ui) fn residual_words(residual: Option<f64>) -> String {
    residual.map_or_else(|| "–".to_owned(), |residual| format!("{residual:.1e}"))
}

fn numbers_of(record: &StepReport, standing: &StepDistortion) -> Vec<(&'static str, String)> {
    let mut numbers = vec![
        ("Flipped faces", record.flipped_faces.to_string()),
        ("Concave polygons", record.concave_polygons.to_string()),
        ("Crossed holes", record.crossed_holes.to_string()),
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
    let inner = record.convergence.map(|inner| format!("{}: {}", inner.steps, inner.stop.words()));
    numbers.extend(inner.map(|words| ("Solves within the step", words)));
    let counts = [
        ("Outside the hull of their neighbours", record.outside_hull_vertices),
        ("Constraints not met", standing.unmet),
        ("New vertices", standing.new_vertices),
        ("Boundary vertices pinned", record.bent_vertices),
        ("Corners bounded", record.bounded_corners),
        ("Pivots replaced", record.replaced_pivots),
    ];
    numbers.extend(counts.into_iter().filter(|(_, count)| *count > 0).map(|(name, count)| (name, count.to_string())));
    numbers.push(("Factors", format!("{:.1} MB", record.factor_bytes as f64 / 1e6)));
    numbers.push(("Time, proof included", format!("{:.0} ms", 1000.0 * record.seconds)));
    numbers
}
