//! Table of the numbers of all compared methods, sorted by any column.

use eframe::egui::{self, FontId, Rect, RichText, Role, Vec2, WidgetInfo};

use crate::session::{Contender, ContenderState};
use crate::ui::{Control, Editor, Measure, Request, icons, sentence, theme_of};
use freebound_core::problem::{NamedOption as _, Variant};
use freebound_io::{Column, Direction};

/// Height of a row, points.
const ROW: f32 = 21.0;

/// Font size of the numbers, points.
const FIGURES: f32 = 11.0;

/// Gap between columns, points.
const GAP: f32 = 6.0;

/// Largest share of the pane for the table beside the cells.
const MOST: f32 = 0.45;

/// Height of the table, limited to its share of the room.
pub(super) fn height(editor: &Editor, room: Rect) -> f32 {
    let rows = editor.session.contenders().len() as f32 + 1.0;
    // Includes the horizontal scroll bar.
    (rows * (ROW + 2.0) + 20.0).min(MOST * room.height())
}

pub(super) fn table(ui: &mut egui::Ui, room: Rect, editor: &Editor, requests: &mut Vec<Request>) {
    ui.painter().rect_filled(room, 0.0, theme_of(ui).panel);
    ui.scope_builder(egui::UiBuilder::new().max_rect(room.shrink2(Vec2::new(8.0, 4.0))), |ui| {
        ui.set_clip_rect(room.intersect(ui.clip_rect()));
        egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().button_padding.x = 5.0;
            let grid = egui::Grid::new("comparison").num_columns(Column::ALL.len() + 1).spacing([GAP, 2.0]);
            grid.min_row_height(ROW).striped(true).show(ui, |ui| {
                for &column in Column::ALL {
                    head(ui, editor, column, requests);
                }
                // Empty column that takes the remaining width.
                ui.label("");
                ui.end_row();
                for contender in editor.contenders_sorted() {
                    row(ui, editor, contender, requests);
                    ui.end_row();
                }
            });
        });
    });
}

/// Head of a column. Clicks sort by the column: ascending, descending, unsorted.
fn head(ui: &mut egui::Ui, editor: &Editor, column: Column, requests: &mut Vec<Request>) {
    let sort = editor.plane.comparison.sort().filter(|(by, _)| *by == column).map(|(_, direction)| direction);
    let order = match sort {
        Some(Direction::Up) => ", ascending",
        Some(Direction::Down) => ", descending",
        None => "",
    };
    let title = column.labels().title;
    let mut add = |ui: &mut egui::Ui| {
        // Room for the arrow.
        let room = if sort.is_some() { "\u{a0}\u{a0}\u{a0}\u{a0}" } else { "" };
        let label = ui.selectable_label(sort.is_some(), RichText::new(format!("{title}{room}")).small());
        if let Some(direction) = sort {
            let square = Rect::from_center_size(label.rect.right_center() - Vec2::new(11.0, 0.0), Vec2::splat(8.0));
            icons::order(ui.painter(), square, direction, theme_of(ui).text);
        }
        label.widget_info(|| {
            WidgetInfo::selected(Role::Button, true, sort.is_some(), format!("Sort by {title}{order}"))
        });
        let about = sentence(column.labels().about);
        let explained = Measure::of_column(column).map(|measure| format!("{about}.\n{}", measure.tip()));
        let label = label.on_hover_text(explained.unwrap_or(about));
        label.asks(Request::SortComparison(column), requests);
    };
    if column.is_of_words() { add(ui) } else { at_right(ui, add) }
}

fn at_right(ui: &mut egui::Ui, add: impl FnOnce(&mut egui::Ui)) {
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), add);
}

/// Row of a method. A click on its name sets the document's settings to those of the method.
fn row(ui: &mut egui::Ui, editor: &Editor, contender: &Contender, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let variant = contender.variant();
    let title = variant.title();
    let is_own = Variant::of(&editor.session.document().settings) == variant;
    let label = ui.selectable_label(is_own, &title).on_hover_text("Use this method for the document");
    let label = label.named(Role::Button, &format!("Use {title}"));
    if !is_own {
        label.asks(Request::TakeContender(variant), requests);
    }
    let is_done = editor.session.contender_state(contender) == ContenderState::Done;
    for &column in Column::ALL.iter().skip(1) {
        let cell = contender.found().map(|found| column.cell(&found.report));
        let words = cell.map_or_else(|| "…".to_owned(), |cell| cell.words());
        // Dim numbers that are being computed again.
        let colour = if is_done { theme.text } else { theme.weak_text };
        let name = format!("{title}, {}: {words}", column.labels().title);
        let text = RichText::new(words).color(colour);
        if column.is_of_words() {
            ui.label(text).named(Role::Label, &name);
        } else {
            at_right(ui, |ui| {
                ui.add_space(5.0);
                ui.label(text.font(FontId::monospace(FIGURES))).named(Role::Label, &name);
            });
        }
    }
}
