//! Several presses of keys and buttons within one frame: each counts, at its position and with its modifiers.

use eframe::egui;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Vec2};
use freebound::session::Action;
use freebound::ui::{BINDINGS, ShadingMode, Tool};
use freebound_core::mesh::VertexId;
use glam::DVec2;

use crate::gestures::in_embedding;
use crate::harness::{Window, sheet};

fn window() -> Window {
    Window::with_mesh("sheet.obj", &sheet(8, 0.4))
}

fn pin(window: &mut Window, vertices: &[u32]) {
    window.editor_mut().session.handle(Action::Fix(vertices.iter().map(|&v| VertexId::new(v)).collect()));
    window.settle();
}

/// Press and release of a key.
pub(crate) fn key(key: Key, modifiers: Modifiers) -> [Event; 2] {
    [true, false].map(|pressed| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers })
}

pub(crate) fn button(pos: Pos2, pressed: bool, modifiers: Modifiers) -> Event {
    Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers }
}

/// Click with modifiers held only for its duration.
pub(crate) fn click(at: Pos2, modifiers: Modifiers) -> Vec<Event> {
    let [keys_down, keys_up] = [modifiers, Modifiers::NONE].map(Event::ModifiersChanged);
    let [down, up] = [true, false].map(|pressed| button(at, pressed, modifiers));
    vec![Event::PointerMoved(at), keys_down, down, up, keys_up]
}

fn place_of(window: &Window, vertex: usize) -> Pos2 {
    window.place_in_plane(window.embedding()[vertex])
}

fn selected(window: &Window) -> Vec<u32> {
    window.editor().selection.vertices().iter().map(|vertex| vertex.number()).collect()
}

fn target_of(window: &Window, vertex: u32) -> DVec2 {
    window.editor().session.document().targets[&VertexId::new(vertex)].uv
}

#[test]
fn undo_pressed_four_times_in_a_frame_undoes_four_times() {
    let mut window = window();
    for vertex in [0, 20, 40, 60, 80] {
        pin(&mut window, &[vertex]);
    }
    let undo = key(Key::Z, Modifiers::COMMAND);
    window.frame(undo.iter().cycle().take(8).cloned());
    let targets = &window.editor().session.document().targets;
    assert_eq!(targets.keys().map(|vertex| vertex.number()).collect::<Vec<_>>(), [0]);
}

#[test]
fn a_quick_click_keeps_its_shift() {
    let mut window = window();
    window.click_at(place_of(&window, 30), Modifiers::NONE);
    window.frame(click(place_of(&window, 40), Modifiers::SHIFT));
    assert_eq!(selected(&window), [30, 40]);
    // Shift may be released before the button is.
    let at = place_of(&window, 50);
    window.frame([
        Event::PointerMoved(at),
        Event::ModifiersChanged(Modifiers::SHIFT),
        button(at, true, Modifiers::SHIFT),
        Event::ModifiersChanged(Modifiers::NONE),
        button(at, false, Modifiers::NONE),
    ]);
    assert_eq!(selected(&window), [30, 40, 50]);
    window.frame(click(place_of(&window, 60), Modifiers::NONE));
    assert_eq!(selected(&window), [60], "and no other click has it");
}

#[test]
fn several_clicks_in_a_frame_each_count() {
    let mut window = window();
    let [a, b, c] = [30, 40, 50].map(|vertex| place_of(&window, vertex));
    let clicks = [click(a, Modifiers::NONE), click(b, Modifiers::SHIFT), click(c, Modifiers::SHIFT)];
    window.frame(clicks.concat());
    assert_eq!(selected(&window), [30, 40, 50]);
    for _ in 0..3 {
        window.editor_mut().session.handle(Action::Step);
        window.settle();
    }
    assert_eq!(window.editor().session.timeline().shown(), Some(3));
    let back = window.rect(egui::accesskit::Role::Button, "Previous step").center();
    window.frame([click(back, Modifiers::NONE), click(back, Modifiers::NONE)].concat());
    assert_eq!(window.editor().session.timeline().shown(), Some(1));
}

#[test]
fn more_presses_than_a_frame_has_room_for_count_in_the_next() {
    let mut window = window();
    let events = (0..81).step_by(2).flat_map(|vertex| click(place_of(&window, vertex), Modifiers::SHIFT));
    let events: Vec<Event> = events.collect();
    window.frame(events);
    window.settle();
    assert_eq!(selected(&window), (0..81).step_by(2).collect::<Vec<u32>>());
}

/// Drags pin 40 with events distributed over the given frames. Returns the window, and the distance from the
/// expected target.
fn dragged(frames: impl Fn(Pos2, Pos2) -> Vec<Vec<Event>>) -> (Window, f64) {
    let mut window = window();
    pin(&mut window, &[0, 40, 80]);
    let from = place_of(&window, 40);
    let to = from + Vec2::new(60.0, -35.0);
    // Computed before the drag, whose end may move the camera.
    let expected = in_embedding(&window, to);
    for events in frames(from, to) {
        window.frame(events);
    }
    window.settle();
    let off = target_of(&window, 40).distance(expected);
    (window, off)
}

#[test]
fn a_drag_leads_from_where_it_was_pressed_to_where_it_was_let_go_however_fast() {
    let down = |at| vec![Event::PointerMoved(at), button(at, true, Modifiers::NONE)];
    let moves = |from: Pos2, to| vec![Event::PointerMoved(from + Vec2::new(20.0, 9.0)), Event::PointerMoved(to)];
    let up = |at| vec![button(at, false, Modifiers::NONE)];
    let all_in_one = dragged(|from, to| vec![[down(from), moves(from, to), up(to)].concat()]);
    let in_two = dragged(|from, to| vec![down(from), [moves(from, to), up(to)].concat()]);
    let without_moves = dragged(|from, to| vec![down(from), up(to)]);
    let moved_on = |to: Pos2| Event::PointerMoved(to + Vec2::splat(90.0));
    let with_more_behind = dragged(|from, to| {
        let [down, moves, up] = [down(from), moves(from, to), up(to)];
        vec![down, [moves, up, vec![moved_on(to)]].concat()]
    });
    for (window, off) in [&all_in_one, &in_two, &without_moves, &with_more_behind] {
        assert!(*off < 1e-4, "{off}");
        assert_eq!(window.editor().tools.dragged(), None);
        assert!(window.editor().session.is_current());
    }
}

#[test]
fn a_tool_s_key_counts_for_the_click_behind_it_in_the_same_frame() {
    let mut window = window();
    let at = place_of(&window, 40);
    let events = [key(Key::P, Modifiers::NONE).to_vec(), click(at, Modifiers::NONE)].concat();
    window.frame(events);
    window.settle();
    assert!(window.editor().session.document().targets.contains_key(&VertexId::new(40)));
}

#[test]
fn a_number_typed_in_the_frame_of_go_to_is_the_field_s() {
    let mut window = window();
    let shadings = window.shadings();
    let typed = |(name, text): (Key, &str)| {
        let [down, up] = key(name, Modifiers::NONE);
        [down, Event::Text(text.to_owned()), up]
    };
    let letters = [(Key::G, "g"), (Key::Num1, "1"), (Key::Num2, "2")];
    window.frame(letters.into_iter().flat_map(typed).chain(key(Key::Enter, Modifiers::NONE)));
    window.settle();
    assert_eq!(selected(&window), [12]);
    assert_eq!(window.shadings(), shadings, "no letter was taken for a shortcut");
}

/// Text entered without key events, as by an input method or a paste, followed by Enter.
fn entered(text: Event) -> Vec<Event> {
    [vec![text], key(Key::Enter, Modifiers::NONE).to_vec()].concat()
}

#[test]
fn text_and_what_is_pasted_go_to_the_field_that_the_key_before_has_opened() {
    for (text, expected) in [(Event::Text("17".to_owned()), 17), (Event::Paste("23".to_owned()), 23)] {
        let mut window = window();
        let shadings = window.shadings();
        window.frame([key(Key::G, Modifiers::NONE).to_vec(), entered(text)].concat());
        window.settle();
        assert_eq!(selected(&window), [expected]);
        assert_eq!(window.shadings(), shadings);
    }
}

#[test]
fn a_field_that_a_key_opened_in_a_slow_frame_gets_what_comes_in_the_next() {
    let mut window = window();
    window.frame(key(Key::G, Modifiers::NONE));
    window.frame(entered(Event::Text("17".to_owned())));
    window.settle();
    assert_eq!(selected(&window), [17]);
}

#[test]
fn a_click_on_a_field_and_a_number_behind_it_in_the_same_frame_set_it() {
    let mut window = window();
    pin(&mut window, &[0, 40, 80]);
    window.click("Pins");
    let before = target_of(&window, 40);
    let field = window.rect(egui::accesskit::Role::SpinButton, "u of pin v40").center();
    window.frame([click(field, Modifiers::NONE), entered(Event::Text("0.25".to_owned()))].concat());
    window.settle();
    assert_eq!(target_of(&window, 40), DVec2::new(0.25, before.y));
}

#[test]
fn a_click_on_a_button_that_a_click_before_it_has_opened_counts() {
    let mut window = window();
    let place = |window: &Window, wanted: &str| {
        let controls = window.controls();
        let (_, _, rect) = controls.iter().find(|(_, name, _)| name.starts_with(wanted)).expect(wanted);
        rect.center()
    };
    let menu = place(&window, "View");
    window.click("View");
    let entry = place(&window, "Wireframe");
    window.key(Key::Escape);
    assert!(
        !window.editor().pane_shading.wireframe && !window.controls().iter().any(|(_, name, _)| name == "Wireframe")
    );
    window.frame([click(menu, Modifiers::NONE), click(entry, Modifiers::NONE)].concat());
    window.settle();
    assert!(window.editor().pane_shading.wireframe);
}

#[test]
fn a_key_acts_on_the_pane_that_the_pointer_was_over_when_it_was_pressed() {
    let mut window = window();
    let [mesh, plane] = [window.mesh_view(), window.plane_view()].map(|view| view.center());
    let shades = key(Key::Num4, Modifiers::NONE);
    window.frame([vec![Event::PointerMoved(mesh)], shades.to_vec(), vec![Event::PointerMoved(plane)]].concat());
    assert_eq!(window.shadings(), [ShadingMode::Angle, ShadingMode::default()], "that of the pane it was over, alone");
}

#[test]
fn keys_pressed_together_with_alt_or_an_unbound_ctrl_do_nothing() {
    let mut window = window();
    pin(&mut window, &[0, 40, 80]);
    window.editor_mut().selection.add([VertexId::new(40)]);
    window.editor_mut().tools.take_up(Tool::Fix);
    for _ in 0..2 {
        window.editor_mut().session.handle(Action::Step);
        window.settle();
    }
    window.editor_mut().session.handle(Action::ShowStep(1));
    window.settle();
    let state = |window: &Window| {
        let editor = window.editor();
        let layout = (editor.layout.keys_shown, editor.layout.go_to.clone(), editor.layout.full());
        let look = (window.shadings(), editor.pane_shading.wireframe, editor.plane.hull_shown(), editor.tools.tool());
        let timeline = editor.session.timeline();
        let cameras = (editor.mesh.pane.camera(), editor.plane.pane.camera());
        let steps = (timeline.shown(), timeline.records().len());
        (editor.session.document().clone(), layout, look, steps, cameras, selected(window))
    };
    let before = state(&window);
    for binding in BINDINGS {
        let (name, held) = (binding.shortcut.logical_key, binding.shortcut.modifiers);
        for other in [held | Modifiers::ALT, held | Modifiers::COMMAND, Modifiers::CTRL | Modifiers::COMMAND | held] {
            let is_bound = BINDINGS.iter().any(|b| b.shortcut.logical_key == name && other == b.shortcut.modifiers);
            let is_command = Modifiers { ctrl: false, ..other };
            let is_bound = is_bound
                || BINDINGS.iter().any(|b| b.shortcut.logical_key == name && is_command == b.shortcut.modifiers);
            if !is_bound && !matches!(name, Key::Tab | Key::Escape) {
                window.press(other, name);
                assert_eq!(state(&window), before, "{name:?} with {other:?}");
            }
        }
    }
}

#[test]
fn a_switch_does_not_flicker_while_its_key_is_held_down() {
    let mut window = window();
    let [down, up] = key(Key::W, Modifiers::NONE);
    window.frame([down.clone()]);
    for _ in 0..5 {
        window.frame([down.clone()]);
        assert!(window.editor().pane_shading.wireframe);
    }
    window.frame([up, down]);
    assert!(!window.editor().pane_shading.wireframe, "pressed again");
}
