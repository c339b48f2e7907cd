//! Keyboard: shortcuts, Tab, Esc, and text fields that keep their letters.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use freebound::session::{Action, Document};
use freebound::ui::{
    BINDINGS, BrushChoice, Pane, Request, SeamClick, SelectBy, SelectionKind, ShadingMode, StepTarget, Tool,
};
use freebound::view::ElementKind;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::Stage;

use crate::harness::{Window, sheet};
use freebound_testkit::assert_message;

fn window() -> Window {
    Window::with_mesh("sheet.obj", &sheet(8, 0.4))
}

fn document(window: &Window) -> Document {
    window.editor().session.document().clone()
}

/// Number of steps, and index of the shown one.
fn steps(window: &Window) -> (usize, Option<usize>) {
    let timeline = window.editor().session.timeline();
    (timeline.records().len(), timeline.shown())
}

fn pin(window: &mut Window, vertices: &[u32]) {
    window.editor_mut().session.handle(Action::Fix(vertices.iter().map(|&v| VertexId::new(v)).collect()));
    window.settle();
}

#[test]
fn arrow_keys_lead_from_an_open_menu_to_the_others() {
    let mut window = window();
    let firsts = ["Open…", "Undo", "Shading of the mesh", "Take one step", "Documentation"];
    let shown = |window: &Window| firsts.iter().position(|first| window.has_button(first));
    window.press(Modifiers::ALT, Key::F);
    assert_eq!(shown(&window), Some(0));
    for place in [1, 2, 3, 4, 0] {
        window.key(Key::ArrowRight);
        assert_eq!(shown(&window), Some(place));
    }
    window.key(Key::ArrowLeft);
    assert_eq!(shown(&window), Some(4));
}

#[test]
fn no_key_is_bound_twice() {
    for (i, a) in BINDINGS.iter().enumerate() {
        for b in &BINDINGS[i + 1..] {
            assert_ne!(a.shortcut, b.shortcut, "{} and {}", a.about, b.about);
        }
    }
}

/// Window with three pins, one of them selected, the Fix tool, and the second of three steps shown.
fn busy_window() -> Window {
    let mut window = window();
    pin(&mut window, &[0, 40, 80]);
    window.editor_mut().session.handle(Action::UnpinAll);
    window.settle();
    window.editor_mut().session.handle(Action::Undo);
    window.settle();
    window.editor_mut().selection.add([VertexId::new(40)]);
    window.editor_mut().tools.take_up(Tool::Fix);
    window.settle();
    for action in [Action::Step, Action::Step] {
        window.editor_mut().session.handle(action);
        window.settle();
    }
    window.editor_mut().session.handle(Action::ShowStep(1));
    window.settle();
    assert_eq!(steps(&window), (3, Some(1)));
    window
}

fn begin_seam(window: &mut Window) {
    window.editor_mut().tools.take_up(Tool::Seam);
    let click = SeamClick { vertex: VertexId::new(0), erases: false };
    window.editor_mut().handle(Request::ClickSeam(click));
    assert_eq!(window.editor().tools.seam.last(), Some(VertexId::new(0)));
}

/// Number of vertices of the sheet that are selected after one of them was.
fn selected_by(by: SelectBy) -> usize {
    match by {
        SelectBy::All | SelectBy::Connected => 81,
        SelectBy::Invert => 80,
        SelectBy::Grow => 7,
        SelectBy::Shrink => 0,
        // A single vertex has no edge.
        SelectBy::Loops | SelectBy::Rings => 1,
        _ => panic!("{by:?} has a key that no test knows"),
    }
}

/// Sets up the state in which a request changes something.
fn prepare(window: &mut Window, request: &Request) {
    match request {
        // With a selected pin the arrows move the pin.
        Request::GoToStep(_) => window.editor_mut().selection.select([VertexId::new(41)]),
        Request::SetTool(Tool::Fix) => window.editor_mut().tools.take_up(Tool::Select),
        Request::EndSeam => begin_seam(window),
        Request::CutSelection => window.editor_mut().selection.select([39, 40, 41].map(VertexId::new)),
        _ => {}
    }
}

#[test]
fn shortcuts_do_what_the_table_says() {
    for binding in BINDINGS {
        let mut window = busy_window();
        let (pins, orbit) = (document(&window).targets.len(), window.editor().mesh.pane.camera());
        assert_eq!(pins, 3);
        let request = (binding.request)();
        prepare(&mut window, &request);
        window.press(binding.shortcut.modifiers, binding.shortcut.logical_key);
        let editor = window.editor();
        let done = match request {
            Request::Do(Action::Undo | Action::Redo) => document(&window).targets.is_empty(),
            Request::Do(Action::Solve) => editor.session.is_current() && steps(&window) == (1, Some(0)),
            Request::Do(Action::Relax) => {
                steps(&window).0 > 3 && window.is_proved() && window.outcome().step.candidate.stage == Stage::Relax
            }
            // The sheet has little distortion without seams.
            Request::Do(Action::Unwrap(None)) => editor.session.seams().bound().is_some(),
            Request::Do(Action::Step) => steps(&window) == (4, Some(3)),
            // The map is planar, so there is nothing to run.
            Request::RunOrPause => steps(&window).0 == 3 && !editor.session.is_running(),
            Request::GoToStep(StepTarget::First | StepTarget::Previous) => steps(&window) == (3, Some(0)),
            Request::GoToStep(StepTarget::Next | StepTarget::Last) => steps(&window) == (3, Some(2)),
            // Never saved before, so it asks for a path.
            Request::Ask(_) | Request::SaveProject => editor.files.dialogs.is_open(),
            Request::ToggleExports => editor.layout.exports_shown,
            // There is unsaved work.
            Request::Quit => editor.files.unsaved.is_asked(),
            // There is no defect to jump to.
            Request::StepDefect(_) => editor.selection.defect().is_none(),
            // The mesh is a single chart.
            Request::StepChart(_) | Request::ToggleLock | Request::Page(_) => {
                editor.session.chart_on_screen().is_none()
            }
            Request::SetTool(tool) => editor.tools.tool() == tool,
            Request::ResizeBrush { grows } => (editor.tools.brush.radius > BrushChoice::default().radius) == grows,
            Request::EndSeam => editor.tools.seam.last().is_none() && editor.tools.tool() == Tool::Seam,
            // The sheet is a single chart.
            Request::SetSelectionKind(SelectionKind::Charts) => editor.element_kind() == Some(ElementKind::Vertices),
            Request::SetSelectionKind(kind) => editor.selection_kind_shown() == kind,
            Request::CutSelection => editor.session.seams().edges().len() == 2,
            Request::SelectBy(by) => editor.selection.vertices().len() == selected_by(by),
            Request::ToggleThrough => editor.selection.through,
            Request::UnpinSelected => document(&window).targets.len() == pins - 1,
            Request::Frame => editor.mesh.pane.camera() != orbit,
            Request::AskGoTo => editor.layout.go_to.is_some(),
            Request::SetShading(shading) => editor.shading(Pane::Plane) == shading,
            Request::ToggleComparison => editor.plane.comparison.is_shown() && editor.session.contenders().len() == 6,
            Request::ToggleHull => editor.plane.hull_shown(),
            Request::ToggleWireframe => editor.pane_shading.wireframe,
            Request::TogglePane => editor.layout.full() == Some(Pane::Plane),
            Request::Escape => editor.tools.tool() == Tool::Select,
            Request::OpenMenu(place) => {
                let first = ["Open…", "Undo", "Shading of the mesh", "Take one step", "Documentation"][place];
                window.has_button(first)
            }
            Request::ToggleKeys => editor.layout.keys_shown,
            Request::TogglePalette => editor.layout.help.has_palette(),
            Request::TogglePanels => !editor.layout.panels_shown(),
            other => panic!("{other:?} has a key that no test knows"),
        };
        assert!(done, "{}: {:?}", binding.about, binding.shortcut);
    }
}

#[test]
fn ctrl_and_enter_solve_afresh_what_went_on_from_the_map_before() {
    let mut window = window();
    pin(&mut window, &[0, 8, 72, 80]);
    window.click("Method");
    assert!(!window.shows("Continued"));
    let (vertex, before) = (VertexId::new(40), window.embedding());
    let target = Target::hard(before[vertex] + 0.1 * before.bounds().size());
    window.editor_mut().session.handle(Action::Place { vertex, target });
    window.settle();
    assert!(window.is_proved() && window.editor().session.is_continued());
    assert_message("shortcuts-window-continued", &window.text_with("Continued"));
    let gone_on = window.embedding();
    window.press(Modifiers::COMMAND, Key::Enter);
    assert!(!window.shows("Continued") && window.is_proved() && !window.editor().session.is_continued());
    let first = window.editor().session.timeline().records()[0].stage.clone();
    assert!(first == Stage::Natural && window.embedding() != gone_on);
    assert_eq!(window.embedding()[vertex], target.uv);
}

#[test]
fn tab_shows_the_pane_under_the_pointer_in_full_size_and_back() {
    let mut window = window();
    for (view, pane) in [(window.mesh_view(), Pane::Mesh), (window.plane_view(), Pane::Plane)] {
        window.harness.hover_at(view.center());
        window.settle();
        window.key(Key::Tab);
        assert_eq!(window.editor().layout.full(), Some(pane));
        window.key(Key::Tab);
        assert_eq!(window.editor().layout.full(), None);
    }
}

#[test]
fn tab_leaves_the_keyboard_with_the_window() {
    let mut window = window();
    for _ in 0..8 {
        window.key(Key::Tab);
    }
    assert_eq!(window.harness.ctx.memory(egui::Memory::focused), None, "no control takes the keyboard");
    window.key(Key::W);
    assert!(window.editor().pane_shading.wireframe, "shortcuts still reach the window");
}

#[test]
fn typing_into_a_field_triggers_no_shortcut() {
    let mut window = window();
    pin(&mut window, &[0, 40, 80]);
    let before = document(&window);
    window.editor_mut().selection.add([VertexId::new(40)]);
    window.key(Key::G);
    window.type_text("vpdfw126");
    window.key(Key::Backspace);
    window.key(Key::Delete);
    window.press(Modifiers::COMMAND, Key::Z);
    let editor = window.editor();
    assert_eq!(document(&window), before);
    assert_eq!(
        (editor.tools.tool(), editor.shading(Pane::Mesh), editor.pane_shading.wireframe),
        (Tool::Select, ShadingMode::Checker, false)
    );
    assert!(editor.layout.go_to.is_some() && !editor.layout.keys_shown && editor.selection.defect().is_none());
}

#[test]
fn escape_closes_what_has_the_keyboard() {
    let mut window = window();
    window.key(Key::P);
    window.key(Key::G);
    window.type_text("12");
    window.key(Key::Escape);
    assert!(window.editor().layout.go_to.is_none());
    assert_eq!(window.editor().tools.tool(), Tool::Fix, "and nothing else");
}

#[test]
fn a_slide_of_weights_by_keys_and_a_drag_are_two_undo_steps() {
    let mut window = window();
    pin(&mut window, &[0, 40, 80]);
    window.choose("Weights", "Power");
    let before = document(&window);
    window.harness.get_by_role_and_label(Role::Slider, "Power of the weights").focus();
    window.step();
    window.key(Key::ArrowLeft);
    let slid = document(&window);
    assert_ne!(slid, before);
    let from = window.place_in_plane(window.embedding()[40]);
    window.drag(from, from + Vec2::new(40.0, 30.0), Modifiers::NONE);
    assert_ne!(document(&window), slid);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(document(&window), slid);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(document(&window), before);
}

#[test]
fn escape_closes_an_open_menu_and_nothing_else() {
    let mut window = window();
    window.editor_mut().selection.add([VertexId::new(3)]);
    window.key(Key::P);
    window.click("File");
    assert!(window.has_button("Open…"));
    window.key(Key::Escape);
    assert!(!window.has_button("Open…"));
    assert_eq!((window.editor().tools.tool(), window.editor().selection.vertices().len()), (Tool::Fix, 1));
    window.open_list("Weights");
    window.key(Key::Escape);
    assert!(!window.has_button("Power"));
    assert_eq!((window.editor().tools.tool(), window.editor().selection.vertices().len()), (Tool::Fix, 1));
}

#[test]
fn shift_and_tab_walk_through_the_controls() {
    let mut window = window();
    window.press(Modifiers::SHIFT, Key::Tab);
    assert_eq!(window.editor().layout.full(), None);
    assert!(window.harness.ctx.memory(egui::Memory::focused).is_some());
}

#[test]
fn menus_are_opened_and_walked_through_by_the_keyboard_alone() {
    let mut window = window();
    window.key(Key::F10);
    assert!(window.has_button("Open…"), "the File menu");
    window.key(Key::Escape);
    assert!(!window.has_button("Open…"));
    window.press(Modifiers::ALT, Key::V);
    assert!(window.has_button("Wireframe") && !window.editor().pane_shading.wireframe);
    assert_eq!(window.editor().tools.tool(), Tool::Select, "V alone is another key");
    for _ in 0..20 {
        let focused = window
            .harness
            .query_by(|node| node.is_focused() && node.label().is_some())
            .and_then(|node| node.accesskit_node().label());
        if focused.is_some_and(|name| name.starts_with("Wireframe")) {
            break;
        }
        window.key(Key::ArrowDown);
    }
    window.key(Key::Enter);
    assert!(window.editor().pane_shading.wireframe, "reached by the arrows");
}

#[test]
fn tab_walks_on_once_a_control_has_the_keyboard() {
    let mut window = window();
    window.press(Modifiers::SHIFT, Key::Tab);
    let focused = |window: &Window| window.harness.ctx.memory(egui::Memory::focused);
    let mut seen = vec![focused(&window)];
    for _ in 0..200 {
        window.key(Key::Tab);
        if focused(&window) == seen[0] {
            break;
        }
        seen.push(focused(&window));
    }
    assert_eq!(window.editor().layout.full(), None);
    let clickable = window.controls().into_iter().filter(|(role, ..)| *role == Role::Button).count();
    assert!(seen.len() >= clickable, "{} of {clickable} buttons at least", seen.len());
    assert!(seen.iter().all(Option::is_some));
}

#[test]
fn the_list_of_keys_is_in_groups() {
    let mut window = window();
    window.key(Key::F1);
    let place = |words: &str| window.harness.get_by_role_and_label(Role::Label, words).rect().top();
    let heads = ["View", "Select", "Pins", "Seams", "Charts", "Steps", "Files", "Menus and help", "Mouse"];
    let heads = heads.map(place);
    assert!(heads.is_sorted(), "{heads:?}");
    let [view, select, pins, seams, charts, steps, files, help, _] = heads;
    for (request, from, to) in [
        (Request::ToggleWireframe, view, select),
        (Request::SetTool(Tool::Fix), pins, seams),
        (Request::SetTool(Tool::Seam), seams, charts),
        (Request::Do(Action::Step), steps, files),
        (Request::SaveProject, files, help),
    ] {
        let words = BINDINGS.iter().find(|binding| (binding.request)() == request).expect("a key").about;
        let mut found = window.harness.query_all_by_role_and_label(Role::Label, words);
        let at = found.next().expect("listed").rect().top();
        assert!((from..to).contains(&at), "{words} at {at} of {heads:?}");
    }
}
