//! Command palette: finds every command by words of its name.

use eframe::egui::{self, Align2, Id, Key, Modifiers, Rect, RichText, Role, Sense, Vec2, WidgetInfo};

use crate::ui::commands::{self, MenuCommand};
use crate::ui::state::Palette;
use crate::ui::theme::{HOVERED, SELECTED};
use crate::ui::{Control, Editor, Request, keys_of, theme_of};

/// Width of the palette, and height of a row, points.
const WIDTH: f32 = 560.0;
const ROW: f32 = 24.0;

/// Greatest number of rows in sight.
const ROWS: f32 = 12.0;

/// Distance from the upper edge of the window, points.
const ABOVE: f32 = 44.0;

/// Events of the palette in a frame.
#[derive(Default)]
struct Pressed {
    steps: isize,
    enters: bool,
}

/// Position of the list in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scroll {
    Free,
    Top,
    ToSelected,
}

/// Shows the palette if it is open.
pub(super) fn palette(context: &egui::Context, editor: &mut Editor, requests: &mut Vec<Request>) {
    let Some(mut palette) = editor.layout.help.palette.take() else { return };
    let pressed = pressed(context);
    let found = commands::ranked(commands::all(editor), &palette.query, &editor.layout.help.recent);
    let last = found.len().saturating_sub(1);
    let before = palette.row.min(last);
    palette.row = before.saturating_add_signed(pressed.steps).min(last);
    let id = Id::unique("command palette");
    let area = egui::Modal::default_area(id).anchor(Align2::CENTER_TOP, [0.0, ABOVE]);
    let modal = egui::Modal::new(id).area(area).show(context, |ui| {
        ui.set_width(WIDTH.min(context.content_rect().width() - 48.0));
        let scroll = match field(ui, &mut palette) {
            true => Scroll::Top,
            false if pressed.steps != 0 => Scroll::ToSelected,
            false => Scroll::Free,
        };
        let clicked = rows(ui, &found, palette.row, scroll);
        let reason = found.get(palette.row).and_then(|command| command.gate.err());
        let words = reason.map_or_else(String::new, |reason| format!("Not now: {reason}"));
        ui.add(egui::Label::new(RichText::new(words).color(theme_of(ui).weak_text)).wrap());
        clicked
    });
    let chosen = modal.inner.or_else(|| pressed.enters.then_some(palette.row));
    let chosen = chosen.and_then(|row| found.get(row)).filter(|command| command.gate.is_ok());
    if let Some(command) = chosen {
        editor.layout.help.remember(command.id());
        requests.push(command.request.clone());
    } else if !modal.backdrop_response.clicked() {
        editor.layout.help.palette = Some(palette);
    }
}

/// Takes the keys of the palette from the input. The text field gets the others.
fn pressed(context: &egui::Context) -> Pressed {
    context.input_mut(|input| {
        let mut count = |key| input.count_and_consume_key(Modifiers::NONE, key).cast_signed();
        let steps = count(Key::ArrowDown) - count(Key::ArrowUp) + 10 * (count(Key::PageDown) - count(Key::PageUp));
        Pressed { steps, enters: count(Key::Enter) > 0 }
    })
}

/// Shows the search field. Returns true if the list begins anew.
fn field(ui: &mut egui::Ui, palette: &mut Palette) -> bool {
    let field = egui::TextEdit::singleline(&mut palette.query)
        .id(Id::unique("field of the command palette"))
        .hint_text("Find a command: type words of its name, in any order")
        .desired_width(f32::INFINITY);
    let field = ui.add(field).named(Role::SearchInput, "Find a command");
    let is_fresh = !std::mem::replace(&mut palette.has_focus, true);
    if is_fresh {
        field.request_focus();
    }
    if field.changed() {
        palette.row = 0;
    }
    is_fresh || field.changed()
}

/// Rows in sight. Returns the row that was clicked.
fn rows(ui: &mut egui::Ui, found: &[MenuCommand], selected: usize, scroll: Scroll) -> Option<usize> {
    ui.spacing_mut().item_spacing.y = 0.0;
    ui.add_space(4.0);
    let room = ui.ctx().content_rect().height() - ABOVE - 80.0;
    let height = (ROWS * ROW).min((room / ROW).floor() * ROW).max(ROW);
    ui.set_min_height(height);
    if found.is_empty() {
        ui.weak("No command has these words.");
        return None;
    }
    let mut clicked = None;
    let area = egui::ScrollArea::vertical().max_height(height).auto_shrink([false, false]);
    let area = if scroll == Scroll::Top { area.vertical_scroll_offset(0.0) } else { area };
    area.show_rows(ui, ROW, found.len(), |ui, range| {
        if scroll == Scroll::ToSelected {
            let top = ui.max_rect().top() + (selected as f32 - range.start as f32) * ROW;
            let place = Rect::from_min_size(egui::pos2(ui.max_rect().left(), top), Vec2::new(1.0, ROW));
            ui.scroll_to_rect_animation(place, None, egui::style::ScrollAnimation::none());
        }
        for row in range {
            if row_ui(ui, &found[row], row == selected) {
                clicked = Some(row);
            }
        }
    });
    clicked
}

/// Row of a command: name, menu and keys. Returns true if it was clicked.
fn row_ui(ui: &mut egui::Ui, command: &MenuCommand, is_selected: bool) -> bool {
    // No focus of its own: the arrows move the selection.
    let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), ROW), Sense::CLICK);
    let theme = theme_of(ui);
    if is_selected || response.hovered() {
        let share = if is_selected { SELECTED } else { HOVERED };
        ui.painter().rect_filled(rect, 4.0, theme.accent.gamma_multiply(share));
    }
    let keys = keys_of(ui.ctx(), command.request_of_keys());
    let is_enabled = command.gate.is_ok();
    let place = rect.shrink2(Vec2::new(8.0, 0.0));
    let text = |words: &str, colour, width: f32| {
        let words = egui::WidgetText::from(RichText::new(words).color(colour));
        words.into_galley(ui, Some(egui::TextWrapMode::Truncate), width.max(8.0), egui::TextStyle::Body)
    };
    let keys_text = text(&keys, theme.weak_text, place.width() / 3.0);
    let keys_left = place.right() - keys_text.size().x;
    let name_colour = if is_enabled { theme.text } else { theme.weak_text.gamma_multiply(0.6) };
    let name = text(&command.words, name_colour, keys_left - place.left() - 12.0);
    let name_right = place.left() + name.size().x;
    let beside = text(&command.path, theme.weak_text, keys_left - name_right - 24.0);
    for (galley, left) in [(keys_text, keys_left), (name, place.left()), (beside, name_right + 12.0)] {
        let top = rect.center().y - galley.size().y / 2.0;
        ui.painter().galley(egui::pos2(left, top), galley, theme.text);
    }
    let spoken = format!("Command {}", command.id());
    response.widget_info(|| WidgetInfo::selected(Role::Button, is_enabled, is_selected, &spoken));
    let tip = command.gate.err().or(command.tip);
    let response = match tip {
        Some(tip) => response.on_hover_text(tip),
        None => response,
    };
    response.clicked()
}
