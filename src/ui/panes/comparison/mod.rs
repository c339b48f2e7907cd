//! Method comparison in place of the embedding: a cell for each method, a common camera and colour scale, and a
//! table.
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | the bar above, and the division of the room between cells and table |
//! | `chooser.rs` | choice of the compared methods |
//! | `cell.rs` | cell of a method: its embedding, and numbers below |
//! | `morph.rs` | the morph between two methods, in place of the cells |
//! | `table.rs` | the numbers of all methods, sorted by any column |

mod cell;
mod chooser;
mod morph;
mod table;

use eframe::egui::{self, Rect, Role, Vec2};

use super::{bars, legend, pane};
use crate::session::MorphState;
use crate::ui::{
    ComparisonExport, Control, Editor, FileDialogKind, MorphRequest, Pane, Request, theme_of, tip_with_keys,
};
use crate::view::Quantity;
use freebound_core::pipeline::Surface;

/// Gap between cells, points.
const GAP: f32 = 6.0;

/// Height of the bar, points.
const BAR: f32 = 26.0;

/// Height of the strip with the legend, points.
const LEGEND: f32 = 30.0;

/// Least height of a pane for cells and table together, points. A lower pane shows cells, or on request the table.
const ROOM_FOR_BOTH: f32 = 480.0;

/// Least width of a pane with a title in its bar, points.
const ROOM_FOR_WORDS: f32 = 640.0;

/// Least width of a pane whose bar is a single row, points.
const ROOM_FOR_ONE_ROW: f32 = 400.0;

pub(in crate::ui) fn comparison_ui(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    let is_roomy = ui.available_height() - BAR >= ROOM_FOR_BOTH;
    editor.plane.comparison.set_roomy(is_roomy);
    bar(ui, editor, requests);
    let room = ui.available_rect_before_wrap();
    let theme = theme_of(ui);
    ui.painter_at(room).rect_filled(room, 0.0, theme.background);
    bars::over(ui, room, editor, Pane::Plane, requests);
    if let Some(words) = nothing_to_compare(editor) {
        return pane::empty_state(ui, room, &words);
    }
    if editor.plane.comparison.morph.is_shown() {
        return morph::morph_ui(ui, room, editor, requests);
    }
    let has_table = editor.plane.comparison.has_table();
    let has_cells = is_roomy || !has_table;
    let height = if has_table { table::height(editor, room) } else { 0.0 };
    let cells = Rect::from_min_max(room.min, room.max - Vec2::new(0.0, if has_cells { height } else { room.height() }));
    if has_cells {
        let strip = if editor.plane.comparison.legend().is_some() { LEGEND } else { 0.0 };
        let [above, below] = cells.split_top_bottom_at_y(cells.bottom() - strip).into();
        grid(ui, above, editor, requests);
        if let Some((quantity, shown)) = editor.plane.comparison.legend() {
            legend::strip(ui, below, quantity.title(), shown);
        }
    }
    if has_table {
        let below = Rect::from_min_max(egui::pos2(room.left(), cells.bottom()), room.max);
        table::table(ui, below, editor, requests);
    }
}

/// Message if no method can run.
fn nothing_to_compare(editor: &Editor) -> Option<Vec<&'static str>> {
    match editor.session.model().map(|model| &model.prepared.surface) {
        None => Some(vec!["Nothing to compare", "Open a mesh: the methods run on it one after the other"]),
        Some(Surface::Faulty(..)) => Some(vec![
            "This mesh has faults that prevent flattening",
            "The bars above the mesh and the Defects tab list the faults",
        ]),
        Some(Surface::Disk(_)) => None,
    }
}

/// Bar with title, methods, colours, table, exports, and the button to close.
fn bar(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let width = ui.available_width();
    let has_one_row = width >= ROOM_FOR_ONE_ROW;
    row(ui, |ui| {
        if width >= ROOM_FOR_WORDS {
            ui.strong("Methods side by side");
        }
        chooser::chooser(ui, editor, requests);
        let others = if has_one_row { 220.0 } else { 4.0 };
        colours(ui, editor, ui.available_width() - others, requests);
        if has_one_row {
            switches(ui, editor, requests);
        }
    });
    if !has_one_row {
        row(ui, |ui| switches(ui, editor, requests));
    }
}

fn row(ui: &mut egui::Ui, add: impl FnOnce(&mut egui::Ui)) {
    ui.horizontal(|ui| {
        ui.set_min_height(BAR);
        ui.add_space(8.0);
        add(ui);
    });
}

/// Switches of the bar, exports, and the buttons for full size and to close, from the right.
fn switches(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        ui.add_space(4.0);
        let tip = tip_with_keys(ui, "Show the embedding of the document again", &Request::ToggleComparison);
        let back = ui.add(egui::Button::new("Back").frame(false)).on_hover_text(tip);
        back.named(Role::Button, "Leave the comparison").asks(Request::ToggleComparison, requests);
        let (glyph, words) = match editor.layout.full() {
            Some(_) => ("Both", "Show both panes"),
            None => ("Full", "Show this pane alone"),
        };
        let full = ui.add(egui::Button::new(glyph).frame(false)).on_hover_text(words);
        let full = full.named(Role::Button, &format!("{words}: Comparison"));
        full.asks(Request::ToggleFull(Pane::Plane), requests);
        exports(ui, editor, requests);
        morph_switch(ui, editor, requests);
        if !editor.plane.comparison.morph.is_shown() {
            numbers_switch(ui, editor, requests);
        }
    });
}

/// Switch of the table.
fn numbers_switch(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let switch = ui.selectable_label(editor.plane.comparison.has_table(), "Table");
    let switch = switch.on_hover_text("Show or hide the table of all numbers");
    switch.asks(Request::ToggleComparisonTable, requests);
}

/// Switch of the morph.
fn morph_switch(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let switch = ui.selectable_label(editor.plane.comparison.morph.is_shown(), "Morph");
    let switch = switch.on_hover_text(
        "Morph from one method's map to another's, with every frame proved planar; or show all methods again",
    );
    switch.asks(Request::Morph(MorphRequest::Toggle), requests);
}

/// List of the quantities that colour the faces.
fn colours(ui: &mut egui::Ui, editor: &Editor, room: f32, requests: &mut Vec<Request>) {
    let now = editor.plane.comparison.quantity();
    let title = |quantity: Option<Quantity>| quantity.map_or("Plain", Quantity::title);
    let width = ui.spacing().combo_width.min(room.max(60.0));
    // Truncate a long name.
    ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Truncate);
    let menu = crate::ui::list(ui, "Colours of the comparison", width, title(now), |ui| {
        for quantity in std::iter::once(None).chain(Quantity::ALL.map(Some)) {
            let entry = ui.selectable_label(now == quantity, title(quantity));
            entry.asks(Request::ColourComparison(quantity), requests);
        }
    });
    menu.on_hover_text("Quantity that colours the faces, on one scale in all cells");
}

/// Menu of the exports.
fn exports(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let is_there = editor.session.contenders().iter().any(|contender| contender.found().is_some());
    ui.add_enabled_ui(is_there, |ui| {
        let menu = ui.menu_button("Export", |ui| {
            let has_morph = matches!(editor.session.morph(), MorphState::Done(_));
            for what in ComparisonExport::ALL {
                let [words, about] = what.words();
                let entry = ui.add_enabled(has_morph || what != ComparisonExport::Morph, egui::Button::new(words));
                let entry = entry.on_hover_text(about).on_disabled_hover_text("Show a morph first");
                if entry.asks(Request::Ask(FileDialogKind::Comparison(what)), requests) {
                    ui.close();
                }
            }
        });
        menu.response.named(Role::Button, "Export the comparison");
    });
}

/// Grid of the cells.
fn grid(ui: &mut egui::Ui, room: Rect, editor: &mut Editor, requests: &mut Vec<Request>) {
    let count = editor.session.contenders().len();
    if count == 0 || room.width() < 1.0 || room.height() < 1.0 {
        return;
    }
    let columns = columns(room.size(), count);
    let rows = count.div_ceil(columns);
    let of = |whole: f32, parts: usize| ((whole - GAP) / parts as f32 - GAP).max(1.0);
    let size = Vec2::new(of(room.width(), columns), of(room.height(), rows));
    let place = |number: usize| {
        let [column, row] = [number % columns, number / columns].map(|at| at as f32);
        Rect::from_min_size(room.min + Vec2::splat(GAP) + Vec2::new(column, row) * (size + Vec2::splat(GAP)), size)
    };
    for number in 0..count {
        cell::cell(ui, place(number), editor, number, requests);
    }
}

/// Number of columns that makes the embeddings largest.
fn columns(room: Vec2, count: usize) -> usize {
    let side = |columns: usize| {
        let size = room / Vec2::new(columns as f32, count.div_ceil(columns) as f32);
        let view = cell::view_of(Rect::from_min_size(egui::Pos2::ZERO, size), size);
        view.width().min(view.height())
    };
    (1..=count).max_by(|&a, &b| side(a).total_cmp(&side(b)).then(b.cmp(&a))).unwrap_or(1)
}
