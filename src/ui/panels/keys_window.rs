//! List of keys and mouse gestures, by task. Every key can be changed here.

use eframe::egui::{self, Align2, Id, Key, Role};

use crate::session::Action;
use crate::ui::commands::matches_words;
use crate::ui::key_map::{KeyMap, KeyPreset, shortcut_of_press};
use crate::ui::keys::{BINDINGS, MOUSE, shortcut_words};
use crate::ui::state::{KeyClash, KeyList};
use crate::ui::{Control, Editor, Request, Tool, accented_if, remark, theme_of};

/// Tasks that the list is grouped by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Group {
    View,
    Select,
    Pins,
    Seams,
    Brushes,
    Charts,
    Steps,
    Files,
    Window,
    Mouse,
}

impl Group {
    const ALL: [Self; 10] = [
        Self::View,
        Self::Select,
        Self::Pins,
        Self::Seams,
        Self::Brushes,
        Self::Charts,
        Self::Steps,
        Self::Files,
        Self::Window,
        Self::Mouse,
    ];

    const fn title(self) -> &'static str {
        ["View", "Select", "Pins", "Seams", "Brushes", "Charts", "Steps", "Files", "Menus and help", "Mouse"]
            [self as usize]
    }

    const fn of(request: &Request) -> Self {
        match request {
            Request::SetTool(Tool::Select)
            | Request::Escape
            | Request::AskGoTo
            | Request::StepDefect(_)
            | Request::SetSelectionKind(_)
            | Request::ToggleThrough
            | Request::SelectBy(_) => Self::Select,
            Request::SetTool(Tool::Seam)
            | Request::EndSeam
            | Request::CutSelection
            | Request::JoinSelection
            | Request::Do(Action::Unwrap(_)) => Self::Seams,
            Request::SetTool(Tool::Brush) | Request::ResizeBrush { .. } => Self::Brushes,
            Request::SetTool(_) | Request::FixSelection | Request::UnpinSelected => Self::Pins,
            Request::Page(_) | Request::StepChart(_) | Request::ToggleLock => Self::Charts,
            Request::Do(Action::Undo | Action::Redo)
            | Request::Ask(_)
            | Request::SaveProject
            | Request::ToggleExports
            | Request::Quit => Self::Files,
            Request::Do(_) | Request::RunOrPause | Request::GoToStep(_) => Self::Steps,
            Request::OpenMenu(_) | Request::ToggleKeys | Request::TogglePalette => Self::Window,
            _ => Self::View,
        }
    }
}

/// Least width of the column of keys, points.
const KEYS_WIDTH: f32 = 96.0;

/// Least width of the column of words, points.
const WORDS_WIDTH: f32 = 340.0;

/// Shows the list if it is open.
pub(super) fn keys_window(context: &egui::Context, editor: &mut Editor) {
    if !editor.layout.keys_shown {
        editor.layout.help.keys = KeyList::default();
        return;
    }
    let mut list = std::mem::take(&mut editor.layout.help.keys);
    let mut map = (*KeyMap::of(context)).clone();
    listen(context, &mut list, &mut map);
    let height = (context.content_rect().height() - 120.0).max(160.0);
    egui::Window::new("Keys and mouse")
        .open(&mut editor.layout.keys_shown)
        .collapsible(false)
        .default_size([560.0_f32.min(context.content_rect().width() - 60.0), height.min(620.0)])
        .pivot(Align2::CENTER_CENTER)
        .default_pos(context.content_rect().center())
        .show(context, |ui| {
            head(ui, &mut list, &mut map);
            egui::ScrollArea::vertical().auto_shrink(false).max_height(height).show(ui, |ui| {
                for group in Group::ALL {
                    group_ui(ui, group, &mut list, &map);
                }
            });
        });
    if map != *KeyMap::of(context) {
        map.put_on(context);
    }
    editor.layout.help.keys = list;
}

/// Takes the press that a binding waits for. Esc leaves the keys as they are.
fn listen(context: &egui::Context, list: &mut KeyList, map: &mut KeyMap) {
    let Some(place) = list.listens_for else { return };
    let mut press = None;
    context.input_mut(|input| {
        input.events.retain(|event| {
            let &egui::Event::Key { key, pressed: true, repeat, modifiers, .. } = event else { return true };
            if !repeat {
                press.get_or_insert((key, modifiers));
            }
            false
        });
    });
    let Some((key, modifiers)) = press else { return };
    list.listens_for = None;
    if key == Key::Escape {
        return;
    }
    let shortcut = shortcut_of_press(key, modifiers);
    match map.owner(shortcut).filter(|owner| *owner != place) {
        Some(owner) => list.clash = Some(KeyClash { place, shortcut, owner }),
        None => map.change(place, shortcut),
    }
}

/// Search field, presets, and the question about keys of another binding.
fn head(ui: &mut egui::Ui, list: &mut KeyList, map: &mut KeyMap) {
    ui.horizontal_wrapped(|ui| {
        let field = egui::TextEdit::singleline(&mut list.query)
            .id(Id::unique("field of the list of keys"))
            .hint_text("Find a key: type what it does")
            .desired_width(220.0);
        let field = ui.add(field).named(Role::SearchInput, "Find a key");
        if !std::mem::replace(&mut list.has_focus, true) {
            field.request_focus();
        }
        for preset in KeyPreset::ALL {
            let is_on = *map == preset.map();
            let tip = "Use these keys. Your own changes are lost";
            if ui.selectable_label(is_on, preset.title()).on_hover_text(tip).clicked() {
                *map = preset.map();
                list.clash = None;
            }
        }
        let is_changed = *map != KeyMap::default();
        let reset = ui.add_enabled(is_changed, egui::Button::new("Reset"));
        if reset.on_hover_text("Restore the keys of Freebound").clicked() {
            *map = KeyMap::default();
            list.clash = None;
        }
    });
    let Some(KeyClash { place, shortcut, owner }) = list.clash else { return };
    ui.horizontal_wrapped(|ui| {
        let keys = shortcut_words(ui.ctx(), shortcut);
        let words = format!("{keys} belongs to “{}”.", BINDINGS[owner].about);
        ui.colored_label(theme_of(ui).stale, words);
        let other = shortcut_words(ui.ctx(), map.shortcut(place));
        let tip = format!("“{}” gets {other}", BINDINGS[owner].about);
        // The binding that ends gestures keeps its key.
        let can_swap = is_free(owner);
        if accented_if(ui, can_swap, "Swap", theme_of(ui)).on_hover_text(tip).clicked() {
            map.change(place, shortcut);
            list.clash = None;
        }
        if ui.button("Leave both").on_hover_text("Change no key").clicked() {
            list.clash = None;
        }
    });
}

/// True if the keys of a binding may be changed. Esc always ends what is going on.
fn is_free(place: usize) -> bool {
    (BINDINGS[place].request)() != Request::Escape
}

fn group_ui(ui: &mut egui::Ui, group: Group, list: &mut KeyList, map: &KeyMap) {
    let query = list.query.clone();
    let is_shown = |keys: &str, about: &str| matches_words(&format!("{keys} {about} {}", group.title()), &query);
    let keys = |place: usize| shortcut_words(ui.ctx(), map.shortcut(place));
    let mut places: Vec<usize> =
        (0..BINDINGS.len()).filter(|&place| Group::of(&(BINDINGS[place].request)()) == group).collect();
    places.retain(|&place| is_shown(&keys(place), BINDINGS[place].about));
    // Keys without modifiers first; the table itself has the opposite order.
    places.sort_by_key(|&place| (map.shortcut(place).modifiers.any(), BINDINGS[place].about));
    let gestures = MOUSE.iter().filter(|(gesture, about)| group == Group::Mouse && is_shown(gesture, about));
    let gestures: Vec<_> = gestures.collect();
    if places.is_empty() && gestures.is_empty() {
        return;
    }
    ui.strong(group.title());
    egui::Grid::new(group.title()).num_columns(3).spacing([16.0, 3.0]).show(ui, |ui| {
        for place in places {
            row(ui, place, list, map);
            ui.end_row();
        }
        for (gesture, about) in gestures {
            ui.monospace(*gesture);
            ui.label(*about);
            ui.end_row();
        }
    });
    ui.add_space(8.0);
}

/// Keys of a binding, its words, and the button that changes it.
fn row(ui: &mut egui::Ui, place: usize, list: &mut KeyList, map: &KeyMap) {
    let about = BINDINGS[place].about;
    let is_listening = list.listens_for == Some(place);
    let written = shortcut_words(ui.ctx(), map.shortcut(place));
    let keys = egui::RichText::new(&written).monospace();
    let accent = theme_of(ui).accent;
    // The columns of all groups lie below each other.
    ui.horizontal(|ui| {
        ui.set_min_width(KEYS_WIDTH);
        ui.label(if map.is_changed(place) { keys.color(accent).strong() } else { keys });
    });
    ui.horizontal(|ui| {
        ui.set_min_width(WORDS_WIDTH);
        ui.label(about);
    });
    if is_listening {
        remark(ui, "Press the new keys; Esc cancels");
    } else if is_free(place) {
        let button = ui.small_button("Change").named(Role::Button, &format!("Change {written}: {about}"));
        if button.on_hover_text("Then press the new keys").clicked() {
            (list.listens_for, list.clash) = (Some(place), None);
            // The focused control would take the press.
            ui.ctx().memory_mut(egui::Memory::stop_text_input);
            if let Some(focused) = ui.ctx().memory(egui::Memory::focused) {
                ui.ctx().memory_mut(|memory| memory.surrender_focus(focused));
            }
        }
    }
}
