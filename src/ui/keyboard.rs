//! Requests of key presses. The arrow keys move the selected pins by pixels of the picture; all moves while a key is
//! held form one gesture.

use eframe::egui::{self, Key, Modifiers};
use glam::DVec2;

use super::editor::Editor;
use super::key_map::KeyMap;
use super::keys::Binding;
use super::state::{Axis, GestureKind, PageRequest, Request};
use crate::session::Action;
use freebound_core::mesh::VertexId;

const NONE: Modifiers = Modifiers::NONE;

/// Pixels of a nudge with Shift.
const LARGE: f64 = 10.0;

/// Number of nudges across the embedding, for documents without a picture.
const PARTS: f64 = 512.0;

const ARROWS: [(Key, DVec2); 4] = [
    (Key::ArrowLeft, DVec2::NEG_X),
    (Key::ArrowRight, DVec2::X),
    (Key::ArrowUp, DVec2::Y),
    (Key::ArrowDown, DVec2::NEG_Y),
];

/// Requests of the keys pressed in this pass, one for each press. While a text field has the focus, the window uses
/// only Esc, F1, F3, F10 and combinations with Ctrl, except Ctrl+A, Ctrl+Z and Ctrl+Y. While a menu or a list is open,
/// Esc, Space and the arrows belong to the menu. Otherwise the focused control keeps those of these keys that it needs.
/// Shift+Tab always moves the focus.
pub(super) fn requests(context: &egui::Context, editor: &Editor) -> Vec<Request> {
    if editor.layout.help.keys.listens_for.is_some() {
        // The list of keys takes the next press.
        return Vec::new();
    }
    let map = KeyMap::of(context);
    if editor.layout.help.has_palette() && takes_palette_key(context, &map) {
        return vec![Request::TogglePalette];
    }
    if editor.is_asking() || editor.files.dialogs.is_inside() || editor.layout.help.has_palette() {
        let is_left = context.input_mut(|input| input.consume_key(NONE, Key::Escape));
        return if is_left { vec![Request::Escape] } else { Vec::new() };
    }
    let of_page = page_keys(context, editor);
    // Before the other keys: if pins are selected, the arrows do not move along the timeline.
    let nudges = nudges(context, editor);
    let keyboard = Keyboard::of(context);
    let (mut requests, mut has_taken_tab) = (Vec::new(), false);
    context.input_mut(|input| {
        input.events.retain(|event| {
            let Some((binding, is_repeat)) = keyboard.press_of(event, &map) else { return true };
            has_taken_tab |= matches!(event, egui::Event::Key { key: Key::Tab, .. });
            let request = (binding.request)();
            // Ignore repeats during a run, whose steps would continue after the key is released.
            let is_wanted = request.repeats() && !(editor.session.is_running() && request == Request::Do(Action::Step));
            requests.extend(Some(request).filter(|_| !is_repeat || is_wanted));
            false
        });
    });
    if has_taken_tab {
        // Tab is a command here; egui would also move the focus to the next control.
        context.memory_mut(|memory| memory.move_focus(egui::FocusDirection::None));
    }
    requests.extend(of_page);
    requests.extend(nudges);
    requests
}

/// Requests of the keys that belong to selected charts or elements, or to a gesture on charts. These keys are removed
/// from the input.
fn page_keys(context: &egui::Context, editor: &Editor) -> Vec<Request> {
    let has_charts = !editor.plane.page.selected().is_empty();
    let has_selection = editor.shows_page() && (has_charts || !editor.plane.page.elements().is_empty());
    if !has_selection || context.text_edit_focused() || egui::Popup::is_any_open(context) {
        return Vec::new();
    }
    let is_in_gesture = editor.plane.page.gesture().is_some();
    let has_focus = context.memory(egui::Memory::focused).is_some();
    let mut requests = Vec::new();
    context.input_mut(|input| {
        input.events.retain(|event| {
            let &egui::Event::Key { key, pressed: true, modifiers, repeat, .. } = event else { return true };
            let request = if modifiers.any() {
                None
            } else if is_in_gesture {
                gesture_key(key).filter(|request| !repeat || !matches!(request, PageRequest::Begin(_)))
            } else {
                // A button that has the focus takes Enter.
                let is_for = has_charts || key == Key::Enter;
                begin_key(key).filter(|_| is_for && !(repeat || key == Key::Enter && has_focus))
            };
            let is_left = request.is_none();
            requests.extend(request.map(Request::Page));
            is_left
        });
    });
    requests
}

/// Request of a key that starts a gesture on the selected charts, or shows one alone.
fn begin_key(key: Key) -> Option<PageRequest> {
    let gesture = GestureKind::ALL.into_iter().find(|kind| kind.key() == key).map(PageRequest::Begin);
    gesture.or_else(|| (key == Key::Enter).then_some(PageRequest::Open(None)))
}

/// Request of a key during a gesture on charts.
fn gesture_key(key: Key) -> Option<PageRequest> {
    Some(match key {
        Key::X => PageRequest::Lock(Axis::X),
        Key::Y => PageRequest::Lock(Axis::Y),
        Key::Enter => PageRequest::End,
        Key::Backspace => PageRequest::Type(None),
        Key::Minus => PageRequest::Type(Some('-')),
        Key::Period | Key::Comma => PageRequest::Type(Some('.')),
        Key::G | Key::R | Key::S => return begin_key(key),
        // The name of a digit's key is the digit.
        digit => {
            let letter = digit.name().chars().next().filter(|_| digit.name().len() == 1)?;
            PageRequest::Type(Some(letter.is_ascii_digit().then_some(letter)?))
        }
    })
}

/// True if a text field has no use for a press.
fn types_nothing(key: Key, modifiers: Modifiers) -> bool {
    let is_edit = matches!(key, Key::Z | Key::Y | Key::A);
    matches!(key, Key::F1 | Key::F3 | Key::F10) || (modifiers.command && !is_edit)
}

/// Takes a press of the keys that close the open command palette. Letters belong to its field.
fn takes_palette_key(context: &egui::Context, map: &KeyMap) -> bool {
    let closes = |event: &egui::Event| {
        let &egui::Event::Key { key, pressed: true, modifiers, .. } = event else { return false };
        let binding = map.pressed(key, modifiers).filter(|_| types_nothing(key, modifiers));
        binding.is_some_and(|binding| (binding.request)() == Request::TogglePalette)
    };
    context.input_mut(|input| {
        let before = input.events.len();
        input.events.retain(|event| !closes(event));
        input.events.len() < before
    })
}

/// Owner of the keyboard.
struct Keyboard {
    is_typing: bool,
    menu_open: bool,
    focus: Focus,
}

/// Kinds of controls with the keyboard focus.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Focus {
    Nothing,
    /// Control that moves by the arrows, or a list.
    Control,
    /// Control that Space clicks.
    Clickable,
}

impl Keyboard {
    fn of(context: &egui::Context) -> Self {
        let focused = context.memory(egui::Memory::focused);
        let response = focused.and_then(|id| context.read_response(id));
        let focus = match focused {
            None => Focus::Nothing,
            Some(_) if response.is_some_and(|response| response.sense.senses_click()) => Focus::Clickable,
            Some(_) => Focus::Control,
        };
        Self { is_typing: context.text_edit_focused(), menu_open: egui::Popup::is_any_open(context), focus }
    }

    /// Binding that an event presses, if its keys belong to the window, and true if the key repeats.
    fn press_of(&self, event: &egui::Event, map: &KeyMap) -> Option<(&'static Binding, bool)> {
        let &egui::Event::Key { key, pressed: true, repeat, modifiers, .. } = event else { return None };
        let binding = map.pressed(key, modifiers)?;
        self.leaves(key, modifiers).then_some((binding, repeat))
    }

    /// True if the keys of a binding belong to the window.
    fn leaves(&self, key: Key, modifiers: Modifiers) -> bool {
        let is_of_another = match key {
            Key::Escape => self.menu_open,
            // Once a control has the focus, Tab moves it to the next control.
            Key::Tab => self.focus != Focus::Nothing,
            Key::Space | Key::Enter if !modifiers.command => self.menu_open || self.focus == Focus::Clickable,
            Key::ArrowLeft | Key::ArrowRight | Key::Home | Key::End => self.menu_open || self.focus != Focus::Nothing,
            _ => false,
        };
        !is_of_another && (!self.is_typing || types_nothing(key, modifiers))
    }
}

impl Request {
    /// True if a held key repeats the request.
    fn repeats(&self) -> bool {
        matches!(
            self,
            Self::Do(Action::Undo | Action::Redo | Action::Step)
                | Self::GoToStep(_)
                | Self::StepDefect(_)
                | Self::StepChart(_)
        )
    }
}

/// Requests of the arrow keys in this frame, if pins are selected. The arrow keys then belong to these pins alone.
fn nudges(context: &egui::Context, editor: &Editor) -> Vec<Request> {
    let is_elsewhere = context.text_edit_focused()
        || egui::Popup::is_any_open(context)
        || context.memory(egui::Memory::focused).is_some();
    let mut requests = Vec::new();
    let has_pins = editor.pins_selected().next().is_some() && !editor.shows_page();
    let is_free = editor.plane.page.gesture().is_none() && !editor.session.is_brushing();
    let has_charts = editor.shows_page() && !editor.plane.page.selected().is_empty() && is_free;
    if !is_elsewhere && editor.tools.dragged().is_none() && (has_pins || has_charts) {
        let push = context.input_mut(take_push);
        if push != DVec2::ZERO {
            requests.push(Request::Nudge(push));
        }
    }
    let is_held = context.input(|input| ARROWS.iter().any(|(key, _)| input.key_down(*key)));
    if !is_held && (editor.tools.is_nudging() || !requests.is_empty()) {
        requests.push(Request::EndNudge);
    }
    requests
}

/// Sum of all presses of arrow keys, which are removed from the input.
fn take_push(input: &mut egui::InputState) -> DVec2 {
    let mut push = DVec2::ZERO;
    input.events.retain(|event| {
        let egui::Event::Key { key, pressed: true, modifiers, .. } = event else { return true };
        let Some((_, way)) = ARROWS.iter().find(|(arrow, _)| arrow == key) else { return true };
        if modifiers.command || modifiers.alt {
            return true;
        }
        push += *way * if modifiers.shift { LARGE } else { 1.0 };
        false
    });
    push
}

impl Editor {
    /// Moves the selected pins by pixels of the picture; y points up.
    pub(super) fn nudge(&mut self, pixels: DVec2) {
        if self.shows_page() {
            return self.nudge_charts(pixels);
        }
        let document = self.session.document();
        let frame = document.frame();
        let step = match &document.picture {
            Some(picture) => 1.0 / f64::from(picture.pixels.height),
            None => self.plane.scene().map_or(1.0, |scene| scene.arrays.bounds.extent()) / PARTS,
        };
        // The frame has no offset, so it maps differences to differences.
        let by = frame.uv_from_plane(pixels * step);
        let nudged = |vertex: VertexId| Some((vertex, document.targets.get(&vertex)?.uv + by));
        let moves: Vec<(VertexId, DVec2)> = self.pins_selected().filter_map(nudged).collect();
        if !self.tools.is_nudging() {
            self.tools.set_nudging(true);
            self.session.handle(Action::EndGesture);
        }
        self.session.handle(Action::MovePins(moves));
    }

    pub(super) fn end_nudge(&mut self) {
        self.tools.set_nudging(false);
        self.session.handle(Action::EndGesture);
    }
}
