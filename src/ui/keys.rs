//! Keyboard shortcuts: one table for the keyboard, the tooltips and the list of keys.

use eframe::egui::{self, Key, KeyboardShortcut, Modifiers};

use super::key_map::KeyMap;
use super::state::{FileDialogKind, PageRequest, Request, SelectBy, SelectionKind, ShadingMode, StepTarget, Tool};
use crate::session::Action;

/// Keyboard shortcut and its request.
pub struct Binding {
    /// Keys of the shortcut, unless the user changes them.
    pub shortcut: KeyboardShortcut,
    /// Description for the user.
    pub about: &'static str,
    /// Request of the shortcut.
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
    bind(ALT, Key::F, "Open the File menu; arrow keys lead to the others", || Request::OpenMenu(0)),
    bind(ALT, Key::E, "Open the Edit menu", || Request::OpenMenu(1)),
    bind(ALT, Key::V, "Open the View menu", || Request::OpenMenu(2)),
    bind(ALT, Key::S, "Open the Solve menu", || Request::OpenMenu(3)),
    bind(ALT, Key::H, "Open the Help menu", || Request::OpenMenu(4)),
    bind(CTRL_SHIFT, Key::Z, "Redo", || Request::Do(Action::Redo)),
    bind(CTRL, Key::Y, "Redo", || Request::Do(Action::Redo)),
    bind(CTRL, Key::Z, "Undo", || Request::Do(Action::Undo)),
    bind(CTRL, Key::O, "Open a mesh, a project or a picture", || Request::Ask(FileDialogKind::Open)),
    bind(CTRL_SHIFT, Key::S, "Save the project under another name", || Request::Ask(FileDialogKind::SaveProject)),
    bind(CTRL, Key::S, "Save the project", || Request::SaveProject),
    bind(CTRL, Key::E, "Export: mesh, layout, pictures, report", || Request::ToggleExports),
    bind(CTRL, Key::Q, "Quit", || Request::Quit),
    bind(CTRL, Key::Enter, "Solve from scratch, ignoring the current map", || Request::Do(Action::Solve)),
    bind(NONE, Key::R, "Relax: lower the distortion of a planar embedding", || Request::Do(Action::Relax)),
    bind(NONE, Key::U, "Unwrap: repair the mesh and cut it along short seams", || Request::Do(Action::Unwrap(None))),
    bind(SHIFT, Key::D, "Previous defect", || Request::StepDefect(-1)),
    bind(NONE, Key::D, "Next defect", || Request::StepDefect(1)),
    bind(NONE, Key::PageUp, "Previous chart", || Request::StepChart(-1)),
    bind(NONE, Key::PageDown, "Next chart", || Request::StepChart(1)),
    bind(NONE, Key::L, "Lock the selected charts where they lie, or unlock them", || Request::ToggleLock),
    bind(NONE, Key::Y, "Show all charts on the page, or one chart alone", || Request::Page(PageRequest::Toggle)),
    bind(CTRL, Key::Num1, "Select vertices", || Request::SetSelectionKind(SelectionKind::ALL[0])),
    bind(CTRL, Key::Num2, "Select edges", || Request::SetSelectionKind(SelectionKind::ALL[1])),
    bind(CTRL, Key::Num3, "Select faces", || Request::SetSelectionKind(SelectionKind::ALL[2])),
    bind(CTRL, Key::Num4, "Select charts of the page", || Request::SetSelectionKind(SelectionKind::Charts)),
    bind(CTRL, Key::A, "Select all vertices, edges, faces or charts", || Request::SelectBy(SelectBy::All)),
    bind(CTRL, Key::I, "Select what is not selected", || Request::SelectBy(SelectBy::Invert)),
    bind(CTRL, Key::CloseBracket, "Grow the selection by its neighbours", || Request::SelectBy(SelectBy::Grow)),
    bind(CTRL, Key::OpenBracket, "Shrink the selection by its rim", || Request::SelectBy(SelectBy::Shrink)),
    bind(CTRL, Key::L, "Select all that is connected with the selection", || Request::SelectBy(SelectBy::Connected)),
    bind(ALT, Key::L, "Select the edge loops of the selected edges", || Request::SelectBy(SelectBy::Loops)),
    bind(ALT, Key::R, "Select the edge rings of the selected edges", || Request::SelectBy(SelectBy::Rings)),
    bind(ALT, Key::Z, "Select through the mesh, or only what is seen", || Request::ToggleThrough),
    bind(SHIFT, Key::P, "Pack the selected charts around the others, or all", || Request::Page(PageRequest::Pack)),
    bind(SHIFT, Key::Space, "Run or pause", || Request::RunOrPause),
    bind(NONE, Key::Space, "Take one step", || Request::Do(Action::Step)),
    bind(NONE, Key::ArrowLeft, "Previous step", || Request::GoToStep(StepTarget::Previous)),
    bind(NONE, Key::ArrowRight, "Next step", || Request::GoToStep(StepTarget::Next)),
    bind(NONE, Key::Home, "First step", || Request::GoToStep(StepTarget::First)),
    bind(NONE, Key::End, "Last step", || Request::GoToStep(StepTarget::Last)),
    bind(NONE, Key::V, Tool::Select.words()[3], || Request::SetTool(Tool::Select)),
    bind(NONE, Key::P, Tool::Fix.words()[3], || Request::SetTool(Tool::Fix)),
    bind(NONE, Key::C, Tool::Constrain.words()[3], || Request::SetTool(Tool::Constrain)),
    bind(NONE, Key::X, Tool::Seam.words()[3], || Request::SetTool(Tool::Seam)),
    bind(SHIFT, Key::X, "Cut along the selected edges, or around the selected faces", || Request::CutSelection),
    bind(NONE, Key::B, Tool::Brush.words()[3], || Request::SetTool(Tool::Brush)),
    bind(NONE, Key::OpenBracket, "Make the brush smaller", || Request::ResizeBrush { grows: false }),
    bind(NONE, Key::CloseBracket, "Make the brush larger", || Request::ResizeBrush { grows: true }),
    bind(NONE, Key::Enter, "End the seam that is being drawn", || Request::EndSeam),
    bind(NONE, Key::Delete, "Free the selected pins", || Request::UnpinSelected),
    bind(NONE, Key::Backspace, "Free the selected pins", || Request::UnpinSelected),
    bind(SHIFT, Key::C, "Show or hide the comparison of methods", || Request::ToggleComparison),
    bind(CTRL, Key::P, "Find a command by words of its name", || Request::TogglePalette),
    bind(CTRL, Key::B, "Show or hide the panels at the right", || Request::TogglePanels),
    bind(NONE, Key::F, "Frame the selection, or all", || Request::Frame),
    bind(NONE, Key::Period, "Frame the selection, or all", || Request::Frame),
    bind(NONE, Key::G, "Go to a vertex, edge or face by number", || Request::AskGoTo),
    bind(NONE, Key::Num1, "Plain shading", || Request::SetShading(ShadingMode::Plain)),
    bind(NONE, Key::Num2, ShadingMode::Checker.title(), || Request::SetShading(ShadingMode::Checker)),
    bind(NONE, Key::Num3, ShadingMode::Picture.title(), || Request::SetShading(ShadingMode::Picture)),
    bind(NONE, Key::Num4, ShadingMode::Angle.title(), || Request::SetShading(ShadingMode::Angle)),
    bind(NONE, Key::Num5, ShadingMode::Area.title(), || Request::SetShading(ShadingMode::Area)),
    bind(NONE, Key::Num6, ShadingMode::Stretch.title(), || Request::SetShading(ShadingMode::Stretch)),
    bind(NONE, Key::Num7, "Movement since the compared or the previous step", || {
        Request::SetShading(ShadingMode::Move)
    }),
    bind(NONE, Key::Num8, "See-through embedding", || Request::SetShading(ShadingMode::SeeThrough)),
    bind(NONE, Key::W, "Wireframe", || Request::ToggleWireframe),
    bind(NONE, Key::H, "Hull and pockets of the virtual boundary", || Request::ToggleHull),
    bind(NONE, Key::Tab, "Maximise or restore the pane under the pointer", || Request::TogglePane),
    bind(NONE, Key::Escape, "End the gesture, then the tool, then the selection", || Request::Escape),
    bind(NONE, Key::F10, "Open the File menu", || Request::OpenMenu(0)),
    bind(NONE, Key::F1, "Show or hide this list", || Request::ToggleKeys),
    bind(NONE, Key::Questionmark, "Show or hide this list", || Request::ToggleKeys),
];

/// Keys of a request, such as "Ctrl+Z", for tooltips and menus. Empty if it has none.
pub(super) fn keys_of(context: &egui::Context, request: &Request) -> String {
    if let Request::Page(PageRequest::Begin(kind)) = request {
        return kind.key().name().to_owned();
    }
    let shortcut = KeyMap::of(context).shortcut_of(request);
    shortcut.map(|shortcut| shortcut_words(context, shortcut)).unwrap_or_default()
}

/// Words that name usual keys between two other words, with the keys that the user has set.
pub(super) fn with_keys_set(
    context: &egui::Context,
    words: &str,
    [before, usual, after]: [&str; 3],
    request: &Request,
) -> String {
    let now = keys_of(context, request);
    words.replace(&format!("{before}{usual}{after}"), &format!("{before}{now}{after}"))
}

/// Mouse gestures, for the list of keys.
pub(super) const MOUSE: &[(&str, &str)] = &[
    ("Left drag on the mesh", "Orbit"),
    ("Left drag on the embedding", "Pan; on a pin: move it"),
    ("Ctrl + left drag", "Select the elements, pins or charts in a box"),
    ("Ctrl + Alt + left drag", "Select the elements, pins or charts in a lasso"),
    ("Ctrl + Shift + left drag", "Select the elements, pins or charts under a stroke"),
    ("Arrows, with pins selected", "Move them by a pixel of the picture; with Shift, by ten"),
    ("Alt, while choosing a position", "Do not snap to pixels of the picture"),
    ("Left drag on a chart", "Move the selected charts; Ctrl snaps, Alt lets them overlap"),
    ("G, R, S, with charts selected", "Move, turn or scale; X or Y: axis; digits: a number"),
    ("Arrows, with charts selected", "Move them by a pixel of the picture; with Shift, by ten"),
    ("Double click on a chart", "Show the chart alone"),
    ("Middle, right or Shift + left drag", "Pan"),
    ("Wheel or pinch", "Zoom to the pointer"),
    ("Double click on the mesh", "Set the point to orbit about"),
    ("Click, Shift + click", "Use the tool; add to the selection"),
    ("Shift + click on a step", "Compare the step on the screen with it"),
    ("Shift + Tab, then Tab", "Move from control to control"),
];

/// Keys of a shortcut for a person: keys of a character show the character.
pub(in crate::ui) fn shortcut_words(context: &egui::Context, shortcut: KeyboardShortcut) -> String {
    context.format_shortcut(&shortcut).replace("OpenBracket", "[").replace("CloseBracket", "]")
}
