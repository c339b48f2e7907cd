//! Keyboard shortcuts: one table serves the keyboard, the tooltips and the list of keys. The arrow keys move the selected
//! pins by pixels of the picture; while a key is held, that is one gesture.

use eframe::egui::{self, Key, KeyboardShortcut, Modifiers};
use glam::DVec2;

use super::{Editor, Purpose, Request, Shading, StepTarget, Tool};
use crate::mesh::VertexId;
use crate::session::Action;

/// Pixels that Shift makes of one.
const LARGE: f64 = 10.0;

/// Without a picture a nudge is this part of the embedding's extent.
const PARTS: f64 = 512.0;

const ARROWS: [(Key, DVec2); 4] = [
    (Key::ArrowLeft, DVec2::NEG_X),
    (Key::ArrowRight, DVec2::X),
    (Key::ArrowUp, DVec2::Y),
    (Key::ArrowDown, DVec2::NEG_Y),
];

/// One shortcut.
pub struct Binding {
    /// The keys.
    pub shortcut: KeyboardShortcut,
    /// What it does, for people.
    pub about: &'static str,
    /// What it asks for.
    pub request: fn() -> Request,
}

const NONE: Modifiers = Modifiers::NONE;
const SHIFT: Modifiers = Modifiers::SHIFT;
const ALT: Modifiers = Modifiers::ALT;
const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers { alt: false, ctrl: false, shift: true, mac_cmd: false, command: true };

const fn bind(modifiers: Modifiers, key: Key, about: &'static str, request: fn() -> Request) -> Binding {
    Binding { shortcut: KeyboardShortcut::new(modifiers, key), about, request }
}

/// All shortcuts.
pub const BINDINGS: &[Binding] = &[
    bind(ALT, Key::F, "The File menu; from there the arrows", || Request::OpenMenu(0)),
    bind(ALT, Key::E, "The Edit menu", || Request::OpenMenu(1)),
    bind(ALT, Key::V, "The View menu", || Request::OpenMenu(2)),
    bind(ALT, Key::S, "The Solve menu", || Request::OpenMenu(3)),
    bind(ALT, Key::H, "The Help menu", || Request::OpenMenu(4)),
    bind(CTRL_SHIFT, Key::Z, "Redo", || Request::Do(Action::Redo)),
    bind(CTRL, Key::Y, "Redo", || Request::Do(Action::Redo)),
    bind(CTRL, Key::Z, "Undo", || Request::Do(Action::Undo)),
    bind(CTRL, Key::O, "Open a mesh or a project", || Request::Ask(Purpose::Open)),
    bind(CTRL_SHIFT, Key::S, "Save the project under another name", || Request::Ask(Purpose::SaveProject)),
    bind(CTRL, Key::S, "Save the project", || Request::SaveProject),
    bind(CTRL, Key::E, "Export: mesh, layout, pictures, report", || Request::ToggleExports),
    bind(CTRL, Key::Q, "Quit", || Request::Quit),
    bind(CTRL, Key::Enter, "Solve afresh: go on from nothing that was there", || Request::Do(Action::Solve)),
    bind(NONE, Key::R, "Relax: lower the distortion of a planar embedding", || Request::Do(Action::Relax)),
    bind(SHIFT, Key::D, "Previous defect", || Request::StepDefect(-1)),
    bind(NONE, Key::D, "Next defect", || Request::StepDefect(1)),
    bind(NONE, Key::PageUp, "Previous chart", || Request::StepChart(-1)),
    bind(NONE, Key::PageDown, "Next chart", || Request::StepChart(1)),
    bind(SHIFT, Key::Space, "Run, or pause the run", || Request::RunOrPause),
    bind(NONE, Key::Space, "Take one step", || Request::Do(Action::Step)),
    bind(NONE, Key::ArrowLeft, "Previous step", || Request::GoToStep(StepTarget::Previous)),
    bind(NONE, Key::ArrowRight, "Next step", || Request::GoToStep(StepTarget::Next)),
    bind(NONE, Key::Home, "First step", || Request::GoToStep(StepTarget::First)),
    bind(NONE, Key::End, "Last step", || Request::GoToStep(StepTarget::Last)),
    bind(NONE, Key::V, Tool::Select.words()[2], || Request::SetTool(Tool::Select)),
    bind(NONE, Key::P, Tool::Fix.words()[2], || Request::SetTool(Tool::Fix)),
    bind(NONE, Key::C, Tool::Constrain.words()[2], || Request::SetTool(Tool::Constrain)),
    bind(NONE, Key::X, Tool::Seam.words()[2], || Request::SetTool(Tool::Seam)),
    bind(NONE, Key::Enter, "End the seam that is being drawn", || Request::EndSeam),
    bind(NONE, Key::Delete, "Free the selected pins", || Request::UnpinSelected),
    bind(NONE, Key::Backspace, "Free the selected pins", || Request::UnpinSelected),
    bind(SHIFT, Key::C, "Compare methods side by side, and back", || Request::ToggleComparison),
    bind(NONE, Key::F, "Frame the selection, or all", || Request::Frame),
    bind(NONE, Key::G, "Go to a vertex, edge or face by number", || Request::AskGoTo),
    bind(NONE, Key::Num1, "Plain shading", || Request::SetShading(Shading::Plain)),
    bind(NONE, Key::Num2, Shading::Checker.title(), || Request::SetShading(Shading::Checker)),
    bind(NONE, Key::Num3, Shading::Picture.title(), || Request::SetShading(Shading::Picture)),
    bind(NONE, Key::Num4, Shading::Angle.title(), || Request::SetShading(Shading::Angle)),
    bind(NONE, Key::Num5, Shading::Area.title(), || Request::SetShading(Shading::Area)),
    bind(NONE, Key::Num6, Shading::Stretch.title(), || Request::SetShading(Shading::Stretch)),
    bind(NONE, Key::Num7, "Move since the compared step, or the one before", || Request::SetShading(Shading::Move)),
    bind(NONE, Key::Num8, "See-through embedding", || Request::SetShading(Shading::SeeThrough)),
    bind(NONE, Key::W, "Wireframe", || Request::ToggleWireframe),
    bind(NONE, Key::H, "Hull and pockets of the virtual boundary", || Request::ToggleHull),
    bind(NONE, Key::Tab, "The pane under the pointer in full size, and back", || Request::TogglePane),
    bind(NONE, Key::Escape, "End the gesture, then the tool, then the selection", || Request::Escape),
    bind(NONE, Key::F10, "The File menu", || Request::OpenMenu(0)),
    bind(NONE, Key::F1, "This list", || Request::ToggleKeys),
    bind(NONE, Key::Questionmark, "This list", || Request::ToggleKeys),
];

/// What the keys pressed in this pass ask for, each press as often as it came. While a text field has the keyboard, only
/// Esc and combinations with Ctrl are the window's; Ctrl+Z stays the field's. While a menu or a list is open, Esc, Space
/// and the arrows are the menu's; otherwise what has the keyboard's focus keeps those of them that it needs. Shift+Tab
/// moves the focus, as it does everywhere.
pub(super) fn requests(context: &egui::Context, editor: &Editor) -> Vec<Request> {
    if editor.is_asking() {
        let is_left = context.input_mut(|input| input.consume_key(NONE, Key::Escape));
        return if is_left { vec![Request::Escape] } else { Vec::new() };
    }
    // Before the others: with pins selected the arrows are not the timeline's.
    let nudges = nudges(context, editor);
    let keyboard = Keyboard::of(context);
    let mut requests = Vec::new();
    context.input_mut(|input| {
        input.events.retain(|event| {
            let Some((binding, is_repeat)) = keyboard.press_of(event) else { return true };
            let request = (binding.request)();
            // No steps that nobody waits for any more when the key is let go.
            let is_wanted = request.repeats() && !(editor.session.is_running() && request == Request::Do(Action::Step));
            requests.extend(Some(request).filter(|_| !is_repeat || is_wanted));
            false
        });
    });
    if requests.contains(&Request::TogglePane) {
        // Tab has its work here; egui would also hand the keyboard to the next control.
        context.memory_mut(|memory| memory.move_focus(egui::FocusDirection::None));
    }
    requests.extend(nudges);
    requests
}

/// Who has the keyboard.
struct Keyboard {
    is_typing: bool,
    menu_open: bool,
    focus: Focus,
}

/// What has the keyboard's focus.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Focus {
    Nothing,
    /// A control that moves by the arrows, or a list.
    Control,
    /// One that Space clicks.
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

    /// The binding that an event presses, where its keys are the window's, and whether they are held down.
    fn press_of(&self, event: &egui::Event) -> Option<(&'static Binding, bool)> {
        let &egui::Event::Key { key, pressed: true, repeat, modifiers, .. } = event else { return None };
        let binding = BINDINGS.iter().find(|binding| binding.is_pressed(key, modifiers))?;
        self.leaves(binding).then_some((binding, repeat))
    }

    /// Whether the keys of a binding are the window's.
    fn leaves(&self, binding: &Binding) -> bool {
        let is_of_another = match binding.shortcut.logical_key {
            Key::Escape => self.menu_open,
            // Once a control has the keyboard, Tab walks on to the next.
            Key::Tab => self.focus != Focus::Nothing,
            Key::Space | Key::Enter if !binding.shortcut.modifiers.command => {
                self.menu_open || self.focus == Focus::Clickable
            }
            Key::ArrowLeft | Key::ArrowRight | Key::Home | Key::End => self.menu_open || self.focus != Focus::Nothing,
            _ => false,
        };
        let is_edit = matches!(binding.shortcut.logical_key, Key::Z | Key::Y);
        !is_of_another && (!self.is_typing || (binding.shortcut.modifiers.command && !is_edit))
    }
}

impl Binding {
    /// Whether a press is exactly that of its keys: with Alt it is another. The question mark needs Shift on most keyboards.
    fn is_pressed(&self, key: Key, modifiers: Modifiers) -> bool {
        let modifiers = if key == Key::Questionmark { Modifiers { shift: false, ..modifiers } } else { modifiers };
        key == self.shortcut.logical_key && modifiers.matches_exact(self.shortcut.modifiers)
    }
}

impl Request {
    /// Whether a key that is held down asks for it again and again.
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

/// The keys of a request, such as "Ctrl+Z", for tooltips and menus. Empty where it has none.
pub(super) fn keys_of(context: &egui::Context, request: &Request) -> String {
    BINDINGS
        .iter()
        .find(|binding| (binding.request)() == *request)
        .map(|binding| context.format_shortcut(&binding.shortcut))
        .unwrap_or_default()
}

/// The mouse, for the list of keys.
pub(super) const MOUSE: &[(&str, &str)] = &[
    ("Left drag on the mesh", "Orbit"),
    ("Left drag on the embedding", "Pan; on a pin: move it"),
    ("Ctrl + left drag", "Select the vertices and pins in a box"),
    ("Arrows, with pins selected", "Nudge them by a pixel of the picture; Shift by ten"),
    ("Alt, while a place is chosen", "Between the pixels of the picture"),
    ("Middle, right or Shift + left drag", "Pan"),
    ("Wheel or pinch", "Zoom to the pointer"),
    ("Double click on the mesh", "Set the point to orbit about"),
    ("Click, Shift + click", "The tool's work; add to the selection"),
    ("Shift + click on a step", "Compare with it the step on the screen"),
    ("Shift + Tab, then Tab", "From control to control"),
];

/// What the arrow keys ask for in this frame, where pins are selected. They are then nobody else's.
fn nudges(context: &egui::Context, editor: &Editor) -> Vec<Request> {
    let is_elsewhere = context.text_edit_focused()
        || egui::Popup::is_any_open(context)
        || context.memory(egui::Memory::focused).is_some();
    let mut requests = Vec::new();
    if !is_elsewhere && editor.tools.dragged().is_none() && editor.pins_selected().next().is_some() {
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

/// The sum of all presses of arrow keys, which are taken out of the input.
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
    /// Moves the selected pins by pixels of the picture; y runs up.
    pub(super) fn nudge(&mut self, pixels: DVec2) {
        let document = self.session.document();
        let frame = document.frame();
        let step = match &document.picture {
            Some(picture) => 1.0 / f64::from(picture.pixels.height),
            None => self.plane.scene().map_or(1.0, |scene| scene.arrays.bounds.extent()) / PARTS,
        };
        // The frame has no offset: it takes differences to differences.
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
