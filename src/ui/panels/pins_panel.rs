//! The pins as a table: select, move by typing, choose how each is held, free. Below it what concerns all of them.

use eframe::egui;
use egui::{DragValue, RichText, Role, Sense, Vec2, WidgetInfo};
use glam::DVec2;

use super::picture_panel;
use crate::mesh::VertexId;
use crate::session::Action;
use crate::solver::{Hold, Pin};
use crate::ui::panes::pin_drag::conflict_words;
use crate::ui::panes::pins::{self, Emphasis, PinKind};
use crate::ui::theme::theme_of;
use crate::ui::{Editor, Purpose, Request, Tool, keys_of};

/// Height that is kept free below the table, points.
const BELOW: f32 = 250.0;

/// Widths of a coordinate's and a weight's field, points.
const FIELDS: [f32; 2] = [56.0, 44.0];

/// Shows the panel.
pub(in crate::ui) fn pins_panel(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let document = editor.session.document();
    if !document.settings.method.uses_pins() {
        ui.label(
            "A convex boundary needs no pins: every boundary vertex has its place. Pins come back with another method.",
        );
        return;
    }
    if document.pins.is_empty() {
        no_pins(ui);
    } else {
        table(ui, editor, requests);
        together(ui, editor, requests);
        conflicts(ui, editor, requests);
        errors(ui, editor);
    }
    ui.separator();
    egui::ScrollArea::vertical().id_salt("below the pins").auto_shrink([false, true]).show(ui, |ui| {
        all_of_them(ui, editor, requests);
        ui.separator();
        picture_panel::picture_ui(ui, editor, requests);
    });
}

fn no_pins(ui: &mut egui::Ui) {
    let fix = keys_of(ui.ctx(), &Request::SetTool(Tool::Fix));
    let constrain = keys_of(ui.ctx(), &Request::SetTool(Tool::Constrain));
    ui.label(format!(
        "No pins of yours. The hollow squares are gauge pins: they only fix position, turn and size.\n\nConstrain \
         ({constrain}): click a vertex and its place on the picture. Fix ({fix}): pin vertices where they lie, then drag \
         them. Dragging a hollow square makes it yours."
    ));
}

/// A pin in the table.
#[derive(Clone, Copy)]
struct Row {
    vertex: VertexId,
    pin: Pin,
    /// How the solver holds it: a treatment may weigh what was asked for exactly.
    held: Hold,
    /// How far a coordinate goes with a point of a drag.
    speed: f64,
}

fn table(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let document = editor.session.document();
    let speed = editor.plane_scene().map_or(0.01, |plane| plane.arrays.bounds().extent() / 500.0);
    let height = (ui.available_height() - BELOW).max(80.0);
    egui::ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
        ui.spacing_mut().button_padding.x = 4.0;
        egui::Grid::new("pins").num_columns(6).min_col_width(0.0).spacing([4.0, 4.0]).striped(true).show(ui, |ui| {
            for words in ["", "Vertex", "u", "v", "Weight", ""] {
                ui.weak(words);
            }
            ui.end_row();
            let held = document.settings.held(&document.pins);
            for ((&vertex, &pin), held) in document.pins.iter().zip(held.values()) {
                row(ui, editor, Row { vertex, pin, held: held.hold, speed }, requests);
                ui.end_row();
            }
        });
    });
}

fn row(ui: &mut egui::Ui, editor: &Editor, row: Row, requests: &mut Vec<Request>) {
    let Row { vertex, pin, held, speed } = row;
    hold_button(ui, row, requests);
    let selected = editor.selection.contains(&vertex);
    let label = ui.selectable_label(selected, vertex.to_string());
    let label = label.on_hover_text("Select; Shift selects all up to it, Ctrl adds it, a double click shows it");
    if label.double_clicked() {
        requests.push(Request::GoTo(vec![vertex]));
    } else if label.clicked() {
        requests.push(chosen(ui, editor, vertex));
    }
    coordinates(ui, (vertex, pin.target, speed), requests);
    match (pin.hold, held) {
        (Hold::Weighted(weight), _) => weight_field(ui, (vertex, weight), requests),
        (Hold::Fixed | Hold::Hard, Hold::Weighted(weight)) => {
            ui.weak(weight_words(weight)).on_hover_text("This treatment of pinned vertices weighs exact pins as well");
        }
        (Hold::Fixed | Hold::Hard, Hold::Fixed | Hold::Hard) => exact(ui, editor, vertex),
    }
    let free = ui.small_button("×").on_hover_text("Free this pin");
    free.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Free pin {vertex}")));
    if free.clicked() {
        requests.push(Request::Do(Action::Unpin(vec![vertex])));
    }
}

/// What there is to say about a pin that is to be met exactly.
fn exact(ui: &mut egui::Ui, editor: &Editor, vertex: VertexId) {
    let theme = theme_of(ui);
    if editor.unmet_shown().contains(&vertex) {
        let label = ui.colored_label(theme.unmet, "not met");
        label.on_hover_text("The embedding on the screen is planar, but this vertex is not on its target");
    } else if let Some(conflict) = editor.session.conflict_of(vertex) {
        ui.colored_label(theme.stale, "conflict").on_hover_text(conflict_words(conflict));
    } else {
        ui.weak("exact");
    }
}

/// The pin's mark; a click makes a hard one weighted and a weighted one hard.
fn hold_button(ui: &mut egui::Ui, Row { vertex, pin, held, .. }: Row, requests: &mut Vec<Request>) {
    let (rect, response) = ui.allocate_exact_size(Vec2::new(16.0, 20.0), Sense::click());
    let emphasis = if response.hovered() || response.has_focus() { Emphasis::Strong } else { Emphasis::Plain };
    pins::mark(ui.painter(), rect.center(), theme_of(ui), (PinKind::User(held), emphasis));
    let (words, other) = match pin.hold {
        Hold::Weighted(_) => ("weighted", Hold::Hard),
        Hold::Fixed => ("fixed", Hold::Weighted(Pin::DEFAULT_WEIGHT)),
        Hold::Hard => ("hard", Hold::Weighted(Pin::DEFAULT_WEIGHT)),
    };
    let is_weighed = pin.hold != held;
    let note = if is_weighed { ", weighed by the treatment" } else { "" };
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Hold of pin {vertex}: {words}{note}")));
    let tip = match other {
        Hold::Weighted(_) if is_weighed => {
            "To be met exactly, but this treatment of pinned vertices weighs it. Click: give it a weight of its own"
        }
        Hold::Weighted(_) => "Met exactly. Click: let it pull with a weight instead",
        Hold::Fixed | Hold::Hard => "Pulls with a weight. Click: meet it exactly",
    };
    if response.on_hover_text(tip).clicked() {
        requests.push(Request::Do(Action::SetHold { vertices: vec![vertex], hold: other }));
    }
}

/// What a click on a row selects.
fn chosen(ui: &egui::Ui, editor: &Editor, vertex: VertexId) -> Request {
    let modifiers = ui.input(|input| input.modifiers);
    let from = editor.pins_selected().next().filter(|_| modifiers.shift);
    match from {
        Some(from) => {
            let range = from.min(vertex)..=from.max(vertex);
            let pins = editor.session.document().pins.range(range);
            Request::Select(pins.map(|(&vertex, _)| vertex).collect())
        }
        None if modifiers.command => Request::ToggleSelected(vertex),
        None => Request::Select(vec![vertex]),
    }
}

fn coordinates(ui: &mut egui::Ui, (vertex, target, speed): (VertexId, DVec2, f64), requests: &mut Vec<Request>) {
    let mut moved = target;
    let mut ended = false;
    for (axis, name) in [(0, "u"), (1, "v")] {
        let tip = format!("{name} = {:?}", target[axis]);
        let field = ui.add_sized([FIELDS[0], 20.0], coordinate(&mut moved[axis], speed)).on_hover_text(tip);
        field.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, format!("{name} of pin {vertex}")));
        ended |= field.drag_stopped() || field.lost_focus();
    }
    if moved != target && moved.is_finite() {
        requests.push(Request::Do(Action::MovePin { vertex, target: moved }));
    }
    if ended {
        requests.push(Request::Do(Action::EndGesture));
    }
}

fn weight_field(ui: &mut egui::Ui, (vertex, weight): (VertexId, f64), requests: &mut Vec<Request>) {
    let name = format!("Weight of pin {vertex}");
    if let Some(request) = weight_request(ui, (weight, &name), &[vertex]) {
        requests.push(request);
    }
}

/// A field for a weight: what is typed is one edit, made when the field is left; a drag is one gesture.
fn weight_request(ui: &mut egui::Ui, (weight, name): (f64, &str), vertices: &[VertexId]) -> Option<Request> {
    let mut typed = weight;
    let shown = weight_words(weight);
    let drag = DragValue::new(&mut typed).range(1e-9..=1e9).speed(weight * 0.02).update_while_editing(false);
    // A weight that is only looked at keeps all of its digits.
    let drag = drag.custom_formatter(|weight, _| weight_words(weight)).custom_parser(move |text| {
        let text = text.trim();
        if text == shown { Some(weight) } else { text.parse().ok().filter(|weight: &f64| weight.is_finite()) }
    });
    let field = ui.add_sized([FIELDS[1], 20.0], drag).on_hover_text("How strongly it pulls: drag, or type");
    field.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, name));
    let vertices = vertices.to_vec();
    if field.drag_stopped() {
        return Some(Request::Do(Action::EndGesture));
    }
    let hold = Hold::Weighted(typed);
    let has_changed = typed.to_bits() != weight.to_bits();
    let action =
        if field.dragged() { Action::SlideHold { vertices, hold } } else { Action::SetHold { vertices, hold } };
    has_changed.then_some(Request::Do(action))
}

/// What is done to several selected pins at once.
fn together(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let selected: Vec<VertexId> = editor.pins_selected().collect();
    if selected.len() < 2 {
        return;
    }
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.label(format!("{} selected:", selected.len()));
        if ui.small_button("Hard").on_hover_text("Meet them exactly").clicked() {
            requests.push(Request::SetHold(Hold::Hard));
        }
        let pins = &editor.session.document().pins;
        let weights = selected.iter().filter_map(|vertex| match pins.get(vertex)?.hold {
            Hold::Weighted(weight) => Some(weight),
            Hold::Fixed | Hold::Hard => None,
        });
        let weight = weights.max_by(f64::total_cmp);
        if ui.small_button("Weighted").on_hover_text("Let them pull with a weight").clicked() {
            requests.push(Request::SetHold(Hold::Weighted(weight.unwrap_or(Pin::DEFAULT_WEIGHT))));
        }
        if let Some(weight) = weight {
            requests.extend(weight_request(ui, (weight, "Weight of the selected pins"), &selected));
        }
        if ui.small_button("Free").on_hover_text("Free the selected pins").clicked() {
            requests.push(Request::UnpinSelected);
        }
    });
}

/// Constraints that contradict each other on the mesh as it is, before anything is solved.
fn conflicts(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let found = editor.session.conflicts();
    let Some(first) = found.first() else { return };
    ui.add_space(4.0);
    let words = match found.iter().filter(|conflict| conflict.needs_new_vertices()).count() {
        0 => "Targets too near to each other".to_owned(),
        1 => "1 conflict needs new vertices".to_owned(),
        count => format!("{count} conflicts need new vertices"),
    };
    let link = ui.link(RichText::new(words).color(theme_of(ui).stale));
    if link.on_hover_text(conflict_words(first)).clicked() {
        requests.push(Request::GoTo(first.vertices()));
    }
}

/// How far the worst of the exact and of the weighted pins is from its target, in texture coordinates.
fn errors(ui: &mut egui::Ui, editor: &Editor) {
    let Some(outcome) = editor.session.outcome().filter(|_| editor.session.is_current()) else { return };
    let worst = |is_exact: bool| {
        let errors = outcome.pin_errors().filter(|(_, pin, _)| outcome.settings.is_exact(pin.hold) == is_exact);
        errors.map(|(vertex, _, error)| (error, vertex)).max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let words: Vec<String> = [(worst(true), "exact"), (worst(false), "weighted")]
        .into_iter()
        .filter_map(|(worst, kind)| {
            let (error, vertex) = worst?;
            Some(if error == 0.0 { format!("{kind} 0") } else { format!("{kind} {error:.2e} at {vertex}") })
        })
        .collect();
    if !words.is_empty() {
        let words = format!("Largest error: {}", words.join(", "));
        ui.label(RichText::new(words).small().color(theme_of(ui).weak_text));
    }
    if editor.session.document().pins.len() == 1 {
        let words = "One pin only moves the embedding. A second one turns and scales it, more bend it.";
        ui.label(RichText::new(words).small().color(theme_of(ui).weak_text));
    }
}

/// What concerns all pins.
fn all_of_them(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let count = editor.session.document().pins.len();
    let has_disk = editor.session.model().is_some_and(|model| model.disk().is_some());
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let buttons = [
            (count > 0, "Mirror", "Mirror all targets left to right", Request::Do(Action::MirrorTargets)),
            (
                count > 1,
                "Fit",
                "Turn, scale and move all targets together, to fit the mesh",
                Request::Do(Action::FitTargets),
            ),
            (has_disk, "Import…", "Take over the constraints of a file", Request::Ask(Purpose::ImportConstraints)),
            (count > 0, "Export…", "Write the pins as a constraint file", Request::Ask(Purpose::ExportConstraints)),
            (count > 0, "Free all", "Free all pins; undo brings them back", Request::Do(Action::UnpinAll)),
        ];
        for (enabled, words, tip, request) in buttons {
            if ui.add_enabled(enabled, egui::Button::new(words).small()).on_hover_text(tip).clicked() {
                requests.push(request);
            }
        }
    });
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

/// A weight with a few digits that mean something.
fn weight_words(weight: f64) -> String {
    if (1e-3..1e6).contains(&weight) { ((weight * 1e4).round() / 1e4).to_string() } else { format!("{weight:.3e}") }
}

/// Five digits behind the point, or as many that mean something.
fn digits(value: f64) -> String {
    if value == 0.0 || (1e-3..1e3).contains(&value.abs()) { format!("{value:.5}") } else { format!("{value:.3e}") }
}
