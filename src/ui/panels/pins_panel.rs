//! Tab of the pins: a table to select, move, set the kind and remove. Actions for all pins follow below.

use std::ops::RangeInclusive;

use eframe::egui::containers::menu::MenuButton;
use eframe::egui::{self, DragValue, RichText, Role, Sense, Vec2};

use super::{landmarks_section, picture_panel};
use crate::session::{Action, named};
use crate::ui::panes::pins::{Emphasis, PinMark};
use crate::ui::panes::vertex_menu::{hold_entries, vertex_menu};
use crate::ui::{
    Control, Editor, FileDialogKind, Offer, Request, Tool, Typed, counted, five_digits, keys_of, read_more, remark,
    sentence, theme_of,
};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::{Pin, PinKind};
use freebound_core::verify::Conflict;
use freebound_io::{LandmarkSet, PinName};

/// Height reserved below the table, points.
const BELOW: f32 = 250.0;

/// Widths of the fields for a coordinate and for a weight, points.
const FIELDS: [f32; 2] = [50.0, 44.0];

/// Width and height of the name of a pin, points.
const NAME: [f32; 2] = [160.0, 17.0];

/// Width of the menu of names, points.
const NAMES: f32 = 50.0;

/// Gaps between columns and between rows of the table, points.
const GAPS: [f32; 2] = [7.0, 4.0];

/// Range of weights.
const WEIGHTS: RangeInclusive<f64> = 1e-9..=1e9;

pub(in crate::ui) fn pins_panel(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let document = editor.session.document();
    if !document.settings.method.uses_pins() {
        ui.label(
            "A convex boundary takes no pins: the method places every boundary vertex. Your pins return with another \
             method.",
        );
        return;
    }
    of_other_charts(ui, editor);
    if document.targets.is_empty() {
        no_pins(ui, editor.shows_page());
        read_more(ui, "How to place pins", "window.md#pins", requests);
    } else {
        table(ui, editor, requests);
        together(ui, editor, requests);
        conflicts(ui, editor, requests);
        errors(ui, editor);
    }
    ui.separator();
    egui::ScrollArea::vertical().id_salt("below the pins").auto_shrink([false, true]).show(ui, |ui| {
        all_of_them(ui, editor, requests);
        landmarks_section::landmarks_ui(ui, editor, requests);
        ui.separator();
        picture_panel::picture_ui(ui, editor, requests);
    });
}

/// On the page: the chart whose pins the table lists, and the number of pins of the others.
fn of_other_charts(ui: &mut egui::Ui, editor: &Editor) {
    let Some(shown) = editor.session.chart_on_screen().filter(|_| editor.shows_page()) else { return };
    let others = editor.pins_by_chart().into_iter().filter(|(chart, _)| *chart != shown);
    let counts: Vec<usize> = others.map(|(_, pins)| pins.len()).collect();
    if !counts.is_empty() {
        let pins = counts.iter().sum();
        let words = format!("{} on {}", counted(pins, "pin", "pins"), counted(counts.len(), "chart", "charts"));
        ui.weak(format!("Pins of chart {shown}. There are {words} beside it: show a chart alone to edit them."));
    }
}

fn no_pins(ui: &mut egui::Ui, is_on_page: bool) {
    let [fix, constrain] = [Tool::Fix, Tool::Constrain].map(|tool| keys_of(ui.ctx(), &Request::SetTool(tool)));
    let gauge = if is_on_page {
        "A tool for pins shows one chart alone. Fix the selection (menu Edit) pins selected vertices of all charts."
    } else {
        "The hollow squares are gauge pins: they only fix position, rotation and size. Drag one to make it your own."
    };
    ui.label(format!(
        "No pins yet. {gauge}\n\nConstrain \
         ({constrain}): click a vertex, then its position on the picture. Fix ({fix}): pin vertices at their current \
         positions, then drag them."
    ));
}

/// Row of a pin in the table.
#[derive(Clone, Copy)]
struct Row {
    vertex: VertexId,
    /// Number of the vertex in files.
    number: VertexId,
    target: Target,
    /// Kind that the solver uses: a treatment may make a hard pin soft.
    held: PinKind,
    /// Change of a coordinate per point of a drag.
    speed: f64,
}

fn table(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let document = editor.session.document();
    let mut selected = editor.pins_selected();
    let chosen_pin = selected.next().filter(|_| selected.next().is_none());
    let speed = editor.plane.scene().map_or(0.01, |plane| plane.arrays.bounds.extent() / 500.0);
    let height = (ui.available_height() - BELOW).max(80.0);
    egui::ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
        ui.spacing_mut().button_padding.x = 2.0;
        egui::Grid::new("pins").num_columns(6).min_col_width(0.0).spacing(GAPS).striped(true).show(ui, |ui| {
            for words in ["", "Vertex"] {
                ui.weak(words);
            }
            for words in ["u", "v"] {
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.weak(words));
            }
            for words in ["Weight", ""] {
                ui.weak(words);
            }
            ui.end_row();
            for (&vertex, &target) in &document.targets {
                let held = document.settings.kind_of(target.kind);
                let number = editor.session.number_of(vertex);
                row(ui, editor, Row { vertex, number, target, held, speed }, requests);
                ui.end_row();
                if editor.session.pin_name(vertex).is_some() || chosen_pin == Some(vertex) {
                    name_row(ui, editor, vertex, requests);
                    ui.end_row();
                }
            }
        });
    });
}

fn row(ui: &mut egui::Ui, editor: &Editor, row: Row, requests: &mut Vec<Request>) {
    let Row { vertex, number, target, held, .. } = row;
    hold_button(ui, row, requests);
    let selected = editor.selection.vertices().contains(&vertex);
    let label = ui.selectable_label(selected, number.to_string());
    label.context_menu(|ui| vertex_menu(ui, editor, vertex, requests));
    let tip = "Click: select. Shift: select a range. Ctrl: add. Double click: show";
    let side = editor.mesh_scene().and_then(|scene| scene.side_of(vertex));
    let label = label.on_hover_text(side.map_or_else(|| tip.to_owned(), |side| format!("{side}\n{tip}")));
    if label.double_clicked() {
        requests.push(Request::GoTo(vec![vertex]));
    } else if label.clicked() {
        requests.push(chosen(ui, editor, vertex));
    }
    coordinates(ui, row, requests);
    match (target.kind, held) {
        (PinKind::Soft(weight), _) => {
            weight_field(ui, &format!("Weight of pin {number}"), weight, &[vertex], requests);
        }
        (PinKind::Fixed | PinKind::Hard, PinKind::Soft(weight)) => {
            ui.weak(five_digits(weight)).on_hover_text("This treatment of pinned vertices makes hard pins soft");
        }
        (PinKind::Fixed | PinKind::Hard, PinKind::Fixed | PinKind::Hard) => exact(ui, editor, row, requests),
    }
    let free = ui.small_button("×").on_hover_text("Free this pin").named(Role::Button, &format!("Free pin {number}"));
    free.asks(Action::Unpin(vec![vertex]), requests);
}

/// Name of a pin, under its numbers. It is edited in place; Enter or a click elsewhere takes the new name.
fn name_row(ui: &mut egui::Ui, editor: &Editor, vertex: VertexId, requests: &mut Vec<Request>) {
    ui.label("");
    // The cell takes no width, because a name is longer than the column.
    let (cell, _) = ui.allocate_exact_size(Vec2::new(1.0, NAME[1]), Sense::hover());
    let place = egui::Rect::from_min_size(cell.min, NAME.into());
    let name = editor.session.pin_name(vertex).map_or("", PinName::as_str);
    let key = egui::Id::unique(("name of a pin", vertex));
    let mut text = ui.data_mut(|data| data.get_temp::<String>(key)).unwrap_or_else(|| name.to_owned());
    let weak = theme_of(ui).weak_text;
    let hint = RichText::new("Name this pin, such as \"left eye\"").small();
    let field = egui::TextEdit::singleline(&mut text).font(egui::TextStyle::Small).hint_text(hint);
    let field = field.text_color(weak).frame(egui::Frame::NONE).char_limit(PinName::LONGEST);
    // A child of its own, because `put` would widen the column.
    let mut child = ui.new_child(egui::UiBuilder::new().max_rect(place));
    let response = child.add_sized(place.size(), field.desired_width(place.width()));
    let response = response.named(Role::TextInput, &format!("Name of pin {}", editor.session.number_of(vertex)));
    names_menu(&mut child, editor, vertex, requests);
    let tip = "Name of this pin. It is saved, and joins the pin with a landmark of that name";
    let response = response.on_hover_text(if name.is_empty() { tip.to_owned() } else { format!("{name}\n{tip}") });
    if !response.lost_focus() {
        if response.has_focus() {
            ui.data_mut(|data| data.insert_temp(key, text));
        }
        return;
    }
    ui.data_mut(|data| data.remove::<String>(key));
    let gives_up = ui.input(|input| input.key_pressed(egui::Key::Escape));
    if text != name && !gives_up {
        requests.push(Action::NamePin { vertex, name: PinName::new(&text).ok() }.into());
    }
}

/// Menu with the names of landmarks on faces that no pin has yet, beside the field of a name.
fn names_menu(ui: &mut egui::Ui, editor: &Editor, vertex: VertexId, requests: &mut Vec<Request>) {
    let at = ui.max_rect().right_top() + Vec2::new(2.0, 0.0);
    let place = egui::Rect::from_min_size(at, Vec2::new(NAMES, NAME[1]));
    let mut child = ui.new_child(egui::UiBuilder::new().max_rect(place));
    let button = egui::Button::new(RichText::new("Names").small()).small();
    let (menu, _) = MenuButton::from_button(button).ui(&mut child, |ui| {
        let taken = editor.session.taken_names();
        for set in LandmarkSet::ALL.into_iter().rev() {
            let title = format!("{} points of a face", set.names().len());
            ui.menu_button(title, |ui| {
                egui::ScrollArea::vertical().max_height(300.0).show(ui, |ui| {
                    let free = set.names().iter().filter_map(|name| PinName::new(name).ok());
                    for name in free.filter(|name| !taken.contains(&name.key())) {
                        let entry = ui.button(name.as_str());
                        entry.asks(Action::NamePin { vertex, name: Some(name) }, requests);
                    }
                });
            });
        }
    });
    let name = format!("Names for pin {}", editor.session.number_of(vertex));
    menu.on_hover_text("Names of landmarks on faces").named(Role::Button, &name);
}

/// Cell of a hard pin: its state, and a menu of other kinds.
fn exact(ui: &mut egui::Ui, editor: &Editor, row: Row, requests: &mut Vec<Request>) {
    let (theme, vertex) = (theme_of(ui), row.vertex);
    let (words, colour, tip) = if editor.unmet_shown().contains(&vertex) {
        let tip = "The embedding on the screen is planar, but this vertex is not on its target";
        ("not met", theme.unmet, tip.to_owned())
    } else if let Some(conflict) = editor.session.conflict_of(vertex) {
        ("conflict", theme.stale, sentence(&editor.session.conflict_words(conflict)))
    } else {
        ("hard", theme.weak_text, "Hard pin: its target is met exactly. Click: choose another kind".to_owned())
    };
    let button = egui::Button::new(RichText::new(words).color(colour)).frame(false);
    let (menu, _) = MenuButton::from_button(button).ui(ui, |ui| hold_entries(ui, vertex, row.target.kind, requests));
    menu.on_hover_text(tip).named(Role::Button, &format!("State of pin {}: {words}", row.number));
}

/// Mark of the pin. A click makes a hard pin soft and a soft pin hard.
fn hold_button(ui: &mut egui::Ui, Row { vertex, number, target, held, .. }: Row, requests: &mut Vec<Request>) {
    let (rect, response) = ui.allocate_exact_size(Vec2::new(14.0, 20.0), Sense::click());
    let emphasis = if response.hovered() || response.has_focus() { Emphasis::Strong } else { Emphasis::Plain };
    PinMark::User(held).mark(ui.painter(), rect.center(), theme_of(ui), emphasis);
    let words = match target.kind {
        PinKind::Soft(_) => "soft",
        PinKind::Fixed => "fixed",
        PinKind::Hard => "hard",
    };
    let (note, tip) = if target.kind != held {
        let tip = "Hard pin, made soft by this treatment of pinned vertices. Click: give it a weight of its own";
        (", made soft by the treatment", tip)
    } else if target.kind.is_hard() {
        ("", "Target met exactly. Click: make the pin soft")
    } else {
        ("", "Soft pin, pulls with a weight. Click: make it hard")
    };
    let kind = if target.kind.is_hard() { PinKind::Soft(Pin::DEFAULT_WEIGHT) } else { PinKind::Hard };
    let response = response.named(Role::Button, &format!("Kind of pin {number}: {words}{note}")).on_hover_text(tip);
    response.asks(Action::SetPinKind { vertices: vec![vertex], kind }, requests);
}

/// Selection after a click on a row.
fn chosen(ui: &egui::Ui, editor: &Editor, vertex: VertexId) -> Request {
    let modifiers = ui.input(|input| input.modifiers);
    let from = editor.pins_selected().next().filter(|_| modifiers.shift);
    match from {
        Some(from) => {
            let range = from.min(vertex)..=from.max(vertex);
            let pins = editor.session.document().targets.range(range);
            Request::Select(pins.map(|(&vertex, _)| vertex).collect())
        }
        None if modifiers.command => Request::ToggleSelected(vertex),
        None => Request::Select(vec![vertex]),
    }
}

fn coordinates(ui: &mut egui::Ui, Row { vertex, number, target, speed, .. }: Row, requests: &mut Vec<Request>) {
    let target = target.uv;
    let mut moved = target;
    let mut has_ended = false;
    for (axis, name) in [(0, "u"), (1, "v")] {
        let tip = format!("{name} = {:?}", target[axis]);
        let typed = Typed::new("a coordinate", f64::MIN..=f64::MAX);
        let drag = coordinate(&mut moved[axis], speed, &typed);
        let field = ui.add_sized([FIELDS[0], 20.0], drag).on_hover_text(tip);
        has_ended |= typed.name(ui, field, &format!("{name} of pin {number}")).has_ended();
    }
    if moved != target && moved.is_finite() {
        requests.push(Action::MovePin { vertex, target: moved }.into());
    }
    if has_ended {
        requests.push(Action::EndGesture.into());
    }
}

/// Field for the weight of pins. A typed weight is one edit, applied when the field loses focus; a drag is one
/// gesture.
fn weight_field(ui: &mut egui::Ui, name: &str, weight: f64, vertices: &[VertexId], requests: &mut Vec<Request>) {
    let mut typed = weight;
    let shown = five_digits(weight);
    let taken = Typed::new("a weight", WEIGHTS);
    let drag = DragValue::new(&mut typed).range(WEIGHTS).clamp_existing_to_range(false).speed(weight * 0.02);
    // A weight that is shown but not edited keeps all its digits.
    let drag = drag.update_while_editing(false).custom_formatter(|weight, _| five_digits(weight));
    let drag =
        drag.custom_parser(|text| if text.trim() == shown { Some(taken.again(weight)) } else { taken.number(text) });
    let field = ui.add_sized([FIELDS[1], 20.0], drag).on_hover_text("Strength of the pull. Drag, or click to type");
    let field = taken.name(ui, field, name);
    let (vertices, kind) = (vertices.to_vec(), PinKind::Soft(typed));
    if field.drag_stopped() {
        requests.push(Action::EndGesture.into());
    } else if typed.to_bits() != weight.to_bits() {
        let is_sliding = field.dragged();
        let action =
            if is_sliding { Action::SlideHold { vertices, kind } } else { Action::SetPinKind { vertices, kind } };
        requests.push(action.into());
    }
}

/// Actions for several selected pins.
fn together(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let selected: Vec<VertexId> = editor.pins_selected().collect();
    if selected.len() < 2 {
        return;
    }
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.label(format!("{} selected:", selected.len()));
        Offer::new(
            "Hard",
            "Make the selected pins hard: their targets are met exactly",
            Request::SetPinKind(PinKind::Hard),
        )
        .show(ui, requests);
        let pins = &editor.session.document().targets;
        let weights = selected.iter().filter_map(|vertex| match pins.get(vertex)?.kind {
            PinKind::Soft(weight) => Some(weight),
            PinKind::Fixed | PinKind::Hard => None,
        });
        let weight = weights.max_by(f64::total_cmp);
        let kind = PinKind::Soft(weight.unwrap_or(Pin::DEFAULT_WEIGHT));
        Offer::new("Soft", "Make the selected pins soft: they pull with a weight", Request::SetPinKind(kind))
            .show(ui, requests);
        if let Some(weight) = weight {
            weight_field(ui, "Weight of the selected pins", weight, &selected, requests);
        }
        Offer::new("Free", "Free the selected pins", Request::UnpinSelected).show(ui, requests);
    });
}

/// Constraints that conflict on the given mesh, known before any solve.
fn conflicts(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let found = editor.session.conflicts();
    let Some(first) = found.first() else { return };
    ui.add_space(4.0);
    let words = match found.iter().filter(|conflict| conflict.needs_new_vertices()).count() {
        0 => "Targets too close together".to_owned(),
        count => counted(count, "conflict needs new vertices", "conflicts need new vertices"),
    };
    let numbers: Vec<VertexId> = first.vertices().into_iter().map(|vertex| editor.session.number_of(vertex)).collect();
    let words = format!("{words}: {}", named(&numbers));
    let link = ui.link(RichText::new(words).color(theme_of(ui).stale));
    let about = sentence(&editor.session.conflict_words(first));
    link.on_hover_text(about).asks(Request::GoTo(first.vertices()), requests);
    let near = found.iter().find_map(|conflict| match conflict {
        Conflict::NearCoincidentTargets { vertices } => Some(*vertices),
        Conflict::TurnedFace { .. } | Conflict::CrossingEdges { .. } => None,
    });
    if let Some(pair) = near {
        equal_targets(ui, editor, pair, requests);
    }
}

/// Two pins with nearly equal targets, and one-click remedies.
fn equal_targets(ui: &mut egui::Ui, editor: &Editor, pair: [VertexId; 2], requests: &mut Vec<Request>) {
    let [kept, other] = pair;
    let [kept_words, other_words] = pair.map(|vertex| editor.session.pin_words(vertex));
    let [kept_number, other_number] = pair.map(|vertex| editor.session.number_of(vertex));
    remark(ui, format!("Pins {kept_words} and {other_words} have nearly equal targets."));
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let merge = ui.small_button(format!("Keep only {kept_number}"));
        let tip = format!("Merge: keep pin {kept_words} and free pin {other_words}");
        merge.on_hover_text(tip).asks(Action::MergePins(pair), requests);
        let merge = ui.small_button(format!("Keep only {other_number}"));
        let tip = format!("Merge: keep pin {other_words} and free pin {kept_words}");
        merge.on_hover_text(tip).asks(Action::MergePins([other, kept]), requests);
        let loosen = ui.small_button(format!("Loosen {other_number}"));
        let tip = format!("Make pin {other_words} soft: it pulls to its target, but need not meet it");
        let kind = PinKind::Soft(Pin::DEFAULT_WEIGHT);
        loosen.on_hover_text(tip).asks(Action::SetPinKind { vertices: vec![other], kind }, requests);
    });
}

/// Largest distance of a hard pin and of a soft pin from its target, in texture coordinates.
fn errors(ui: &mut egui::Ui, editor: &Editor) {
    let Some(outcome) =
        editor.step_on_screen().filter(|_| editor.session.is_current() && !editor.plane.is_moving(&editor.session))
    else {
        return;
    };
    let worst = |is_hard: bool| {
        let errors =
            outcome.pin_errors().filter(|(_, target, _)| outcome.problem.settings.is_hard(target.kind) == is_hard);
        errors.map(|(vertex, _, error)| (error, vertex)).max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let words: Vec<String> = [(worst(true), "hard"), (worst(false), "soft")]
        .into_iter()
        .filter_map(|(worst, kind)| {
            let (error, vertex) = worst?;
            let at = editor.session.number_of(vertex);
            Some(if error == 0.0 { format!("{kind} 0") } else { format!("{kind} {error:.2e} at {at}") })
        })
        .collect();
    if !words.is_empty() {
        remark(ui, format!("Largest error: {}", words.join(", ")));
    }
    if editor.session.document().targets.len() == 1 {
        remark(ui, "One pin only moves the embedding. Two also rotate and scale it. More deform it.");
    }
}

/// Actions for all pins.
fn all_of_them(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let count = editor.session.document().targets.len();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let offers = [
            Offer::new("Mirror", "Mirror all targets left to right", Action::MirrorTargets).when(count > 0),
            Offer::new("Fit", "Rotate, scale and move all targets together to fit the mesh", Action::FitTargets)
                .when(count > 1),
            Offer::new(
                "Import…",
                "Read constraints (TXT) or landmarks of the picture (PTS)",
                Request::Ask(FileDialogKind::ImportConstraints),
            )
            .when(editor.has_disk()),
            Offer::new(
                "Export…",
                "Write the pins as constraints (TXT) or landmarks (PTS)",
                Request::Ask(FileDialogKind::ExportConstraints),
            )
            .when(count > 0),
            Offer::new("Free all", "Free all pins; undo restores them", Request::UnpinAll)
                .when(editor.unpin_all_hindrance().is_none()),
        ];
        for offer in offers {
            offer.show(ui, requests);
        }
    });
}

/// Field for a coordinate. It shows few digits; an unedited value keeps all its digits.
fn coordinate<'a>(value: &'a mut f64, speed: f64, typed: &'a Typed) -> DragValue<'a> {
    let exact = *value;
    let shown = digits(exact);
    let drag = DragValue::new(value).speed(speed).custom_formatter(|value, _| digits(value));
    drag.custom_parser(move |text| {
        if text.trim().replace('−', "-") == shown { Some(typed.again(exact)) } else { typed.number(text) }
    })
}

/// Four decimals, which resolve a pixel of a large picture; fewer for large values.
fn digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0.0000".to_owned(),
        size if (1e-3..10.0).contains(&size) => format!("{value:.4}"),
        size if (10.0..1e3).contains(&size) => format!("{value:.2}"),
        _ => format!("{value:.1e}"),
    }
}
