//! The brush tool in the embedding pane.

use eframe::egui::{Key, Modifiers, Pos2, Vec2};
use freebound::examples::Example;
use freebound::ui::Tool;
use freebound_core::bijective::BrushKind;
use freebound_core::mesh::VertexId;

use crate::harness::Window;
use crate::presses::button;

/// Window with a planar map and the brush tool.
fn window() -> Window {
    let mut window = Window::with_example(Example::Dome);
    window.key(Key::B);
    assert_eq!(window.editor().tools.tool(), Tool::Brush);
    window
}

/// Middle of the map on the screen.
fn middle(window: &Window) -> Pos2 {
    window.place_in_plane(window.embedding().bounds().middle())
}

fn can_undo(window: &Window) -> bool {
    window.editor().session.history().can_undo()
}

#[test]
fn a_drag_with_each_brush_is_one_edit_of_the_map_and_keeps_the_camera() {
    let mut window = window();
    let before = window.embedding();
    let camera = window.editor().plane.pane.camera();
    for (name, kind) in [
        ("Relax", BrushKind::Relax),
        ("Grab", BrushKind::Grab),
        ("Pinch", BrushKind::Pinch),
        ("Texels", BrushKind::Texels),
    ] {
        window.click(&format!("{name} brush"));
        assert_eq!(window.editor().tools.brush.kind, kind);
        let from = middle(&window);
        assert!(!can_undo(&window), "a click on the bar is no stroke");
        window.drag(from, from + Vec2::new(30.0, 12.0), Modifiers::NONE);
        assert!(window.embedding() != before, "{name}");
        assert_eq!(window.editor().session.history().depth(), 1, "{name}");
        assert!(window.is_proved(), "{name}: {}", window.verdict());
        assert_eq!(window.editor().plane.pane.camera(), camera);
        window.press(Modifiers::COMMAND, Key::Z);
        assert!(window.embedding() == before, "{name} {}", window.editor().session.history().depth());
        assert!(!can_undo(&window), "{name}");
    }
}

#[test]
fn the_run_after_a_stroke_shows_in_the_frame_in_which_it_begins() {
    let mut window = window();
    window.click("Grab brush");
    let from = middle(&window);
    window.begin_drag(from, from + Vec2::new(30.0, 12.0), Modifiers::NONE);
    let mut has_run = false;
    window.harness.event(button(from + Vec2::new(30.0, 12.0), false, Modifiers::NONE));
    // The stroke begins the run once its last frame is there.
    for _ in 0..5000 {
        std::thread::sleep(std::time::Duration::from_millis(1));
        window.step();
        let is_running = window.editor().session.is_running();
        has_run |= is_running;
        assert_eq!(window.has_button("Pause"), is_running);
        if has_run && !is_running {
            return;
        }
    }
    panic!("no run begins, or it does not end: {has_run}");
}

#[test]
fn control_inverts_a_pinch() {
    let area_near_the_middle = |modifiers: Modifiers| {
        let mut window = window();
        window.click("Pinch brush");
        let at = middle(&window);
        let flat = window.embedding();
        let centre = flat.bounds().middle();
        let nearest = (0..flat.len()).min_by(|&a, &b| flat[a].distance(centre).total_cmp(&flat[b].distance(centre)));
        let vertex = nearest.expect("vertices");
        let mesh = Example::Dome.mesh();
        let neighbours: Vec<usize> = mesh
            .triangles
            .iter()
            .map(|corners| corners.map(VertexId::index))
            .filter(|corners| corners.contains(&vertex))
            .flatten()
            .collect();
        window.drag(at, at + Vec2::new(1.0, 0.0), modifiers);
        let after = window.embedding();
        neighbours.iter().map(|&other| after[other].distance(after[vertex])).sum::<f64>()
    };
    let [pinched, spread] = [Modifiers::NONE, Modifiers::COMMAND].map(area_near_the_middle);
    assert!(pinched < spread, "{pinched} {spread}");
}

#[test]
fn escape_during_a_stroke_restores_the_map_and_then_puts_the_brush_away() {
    let mut window = window();
    window.click("Grab brush");
    let before = window.embedding();
    let from = middle(&window);
    window.begin_drag(from, from + Vec2::new(40.0, 0.0), Modifiers::NONE);
    assert!(window.editor().session.is_brushing());
    window.harness.key_press(Key::Escape);
    window.step();
    assert!(!window.editor().session.is_brushing());
    window.end_drag(from);
    assert!(window.embedding() == before);
    assert!(!can_undo(&window));
    window.key(Key::Escape);
    assert_eq!(window.editor().tools.tool(), Tool::Select);
}

#[test]
fn keys_resize_the_brush_and_a_click_beside_the_map_changes_nothing() {
    let mut window = window();
    let radius = |window: &Window| window.editor().tools.brush.radius;
    let before = radius(&window);
    window.key(Key::CloseBracket);
    assert!(radius(&window) > before);
    window.key(Key::OpenBracket);
    window.key(Key::OpenBracket);
    assert!(radius(&window) < before);
    let beside = window.plane_view().right_bottom() - Vec2::new(12.0, 12.0);
    let map = window.embedding();
    window.click_at(beside, Modifiers::NONE);
    assert!(window.embedding() == map);
    assert!(!can_undo(&window));
}
