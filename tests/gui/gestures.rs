//! Mouse gestures in both panes: picking, fixing, dragging, cancelling.

use eframe::egui;
use egui::{Key, Modifiers, Pos2, Rect, Vec2};
use freebound::examples::Example;
use freebound::session::{Action, Document};
use freebound::ui::{Pane, Tool};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use glam::DVec2;

use crate::harness::{Pill, Window, sheet};
use freebound_testkit::assert_message;

fn window() -> Window {
    Window::with_mesh("sheet.obj", &sheet(8, 0.4))
}

fn document(window: &Window) -> Document {
    window.editor().session.document().clone()
}

fn pin(window: &mut Window, vertices: &[u32]) {
    window.editor_mut().session.handle(Action::Fix(vertices.iter().map(|&v| VertexId::new(v)).collect()));
    window.settle();
}

/// Point of the embedding at a point of the screen.
pub(crate) fn in_embedding(window: &Window, at: Pos2) -> DVec2 {
    let relative = at - window.plane_view().min;
    let camera = window.editor().plane.pane.camera().expect("an embedding shows");
    camera.embedding_from_pane(DVec2::new(relative.x.into(), relative.y.into()), window.editor().plane.pane.size())
}

fn distance(a: &[DVec2], b: &[DVec2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

#[test]
fn a_click_of_the_fix_tool_on_the_mesh_pins_the_vertex_where_it_lies() {
    for example in [Example::Ell, Example::Dome, Example::BumpyCap] {
        let mut window = Window::with_example(example);
        let before = window.embedding();
        let vertex = window.vertex_in_the_middle();
        window.key(Key::P);
        window.click_at(window.place_on_mesh(vertex), Modifiers::NONE);
        assert_eq!(
            document(&window).targets.into_iter().collect::<Vec<_>>(),
            [(vertex, Target::fixed(before[vertex.index()]))]
        );
        assert!(distance(&before, &window.embedding()) < 1e-9, "{}", example.name());
    }
}

#[test]
fn fixing_more_vertices_of_a_flat_mesh_leaves_the_picture_as_it_is() {
    let mut window = Window::with_example(Example::Ell);
    let before = window.embedding();
    window.key(Key::P);
    // Insets cover the right half.
    let is_left = |i: &usize| window.place_in_plane(before[*i]).x < window.plane_view().center().x;
    let third = (300..before.len()).find(is_left).expect("half of the sheet");
    for i in [10, 200, third] {
        window.click_at(window.place_in_plane(before[i]), Modifiers::NONE);
    }
    assert_eq!(document(&window).targets.len(), 3);
    assert!(distance(&before, &window.embedding()) < 1e-9 * 100.0);
}

#[test]
fn the_vertex_under_the_pointer_is_known_in_both_panes() {
    let mut window = window();
    let vertex = window.vertex_in_the_middle();
    window.harness.hover_at(window.place_on_mesh(vertex));
    window.settle();
    assert_eq!(window.editor().pointer.vertex(), Some(vertex));
    assert_eq!(window.editor().pointer.pane(), Some(Pane::Mesh));
    assert!(window.shows(&vertex.to_string()), "the status bar names it");
    window.harness.hover_at(window.place_in_plane(window.embedding()[30]));
    window.settle();
    assert_eq!(window.editor().pointer.vertex(), Some(VertexId::new(30)));
    assert_eq!(window.editor().pointer.pane(), Some(Pane::Plane));
    assert!(window.shows("v30") && window.shows("u "), "{:?}", window.words());
    window.harness.remove_cursor();
    window.step();
    assert_eq!(window.editor().pointer.vertex(), None);
}

#[test]
fn the_vertex_under_the_pointer_is_marked_in_both_panes() {
    let mut window = window();
    let vertex = window.vertex_in_the_middle();
    let places = [window.place_on_mesh(vertex), window.place_in_plane(window.embedding()[vertex.index()])];
    for pointer in places {
        window.harness.hover_at(pointer);
        window.settle();
        for place in places {
            assert!(window.has_ring_at(place), "the pointer at {pointer}, the mark at {place}");
        }
    }
    window.harness.remove_cursor();
    window.settle();
    assert!(!places.iter().any(|place| window.has_ring_at(*place)));
}

#[test]
fn clicks_select_and_shift_adds() {
    let mut window = window();
    let at = |window: &Window, i: usize| window.place_in_plane(window.embedding()[i]);
    window.click_at(at(&window, 30), Modifiers::NONE);
    window.click_at(at(&window, 40), Modifiers::SHIFT);
    assert_eq!(*window.editor().selection.vertices(), [30, 40].map(VertexId::new).into());
    window.click_at(at(&window, 50), Modifiers::NONE);
    assert_eq!(*window.editor().selection.vertices(), [VertexId::new(50)].into());
    assert!(document(&window).targets.is_empty(), "selecting pins nothing");
    let empty = window.plane_view().left_top() + Vec2::splat(5.0);
    window.click_at(empty, Modifiers::NONE);
    assert!(window.editor().selection.vertices().is_empty(), "a click on nothing deselects");
}

#[test]
fn a_box_drawn_with_ctrl_selects_what_is_in_it() {
    let mut window = window();
    let embedding = window.embedding();
    let view = window.plane_view();
    let orbit = window.editor().mesh.pane.camera();
    // Starts just beside a vertex: the box starts at the point of the press.
    let corner = window.place_in_plane(embedding[30]) - Vec2::splat(4.0);
    window.drag(corner, view.max - Vec2::splat(2.0), Modifiers::COMMAND);
    let inside = |z: &DVec2| Rect::from_min_max(corner, view.max).contains(window.place_in_plane(*z));
    let expected: Vec<u32> = (0..).zip(&embedding).filter(|(_, z)| inside(z)).map(|(i, _)| i).collect();
    let selected: Vec<u32> = window.editor().selection.vertices().iter().map(|v| v.number()).collect();
    assert!(expected.contains(&30) && expected.len() < embedding.len());
    assert_eq!(selected, expected);
    assert_eq!(window.editor().mesh.pane.camera(), orbit);
    let view = window.mesh_view();
    window.editor_mut().selection.select([]);
    window.drag(view.min + Vec2::splat(2.0), view.max - Vec2::splat(2.0), Modifiers::COMMAND);
    assert_eq!(window.editor().selection.vertices().len(), embedding.len(), "all of the mesh from the front");
    assert_eq!(window.editor().mesh.pane.camera(), orbit, "a box does not turn the mesh");
}

#[test]
fn a_stroke_drawn_with_ctrl_and_shift_selects_what_lies_near_its_line() {
    let mut window = window();
    let view = window.plane_view();
    let [a, b] = [[0.2, 0.3], [0.8, 0.6]].map(|[x, y]| view.min + view.size() * Vec2::new(x, y));
    window.drag(a, b, Modifiers::COMMAND | Modifiers::SHIFT);
    let from_line = |at: egui::Pos2| {
        let share = ((at - a).dot(b - a) / (b - a).length_sq()).clamp(0.0, 1.0);
        (a + share * (b - a)).distance(at)
    };
    let embedding = window.embedding();
    let places: Vec<egui::Pos2> = embedding.iter().map(|z| window.place_in_plane(*z)).collect();
    let near = |width: f32| places.iter().filter(|at| from_line(**at) <= width).count();
    let selected = window.editor().selection.vertices().clone();
    assert!(selected.iter().all(|vertex| from_line(places[vertex.index()]) <= 15.0));
    assert!(selected.len() >= near(13.0) && selected.len() > 1 && selected.len() < embedding.len() / 2);
}

#[test]
fn a_lasso_drawn_with_ctrl_and_alt_selects_what_it_surrounds() {
    let mut window = window();
    let embedding = window.embedding();
    // A triangle: its box holds vertices that it does not surround.
    let [a, b, c] = [[0.1, 0.1], [0.9, 0.15], [0.2, 0.9]].map(|[x, y]| {
        let view = window.plane_view();
        view.min + view.size() * Vec2::new(x, y)
    });
    let modifiers = Modifiers::COMMAND | Modifiers::ALT;
    window.begin_drag(a, a + (b - a) * 0.1, modifiers);
    for (from, to) in [(a, b), (b, c)] {
        for step in 1..=20_u8 {
            window.harness.hover_at(from + (to - from) * (f32::from(step) / 20.0));
            window.step();
        }
    }
    window.end_drag(c);
    let side = |from: egui::Pos2, to: egui::Pos2, at: egui::Pos2| {
        let (edge, out) = (to - from, at - from);
        edge.x * out.y - edge.y * out.x
    };
    let is_inside = |at: egui::Pos2| [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| side(from, to, at) > 0.0);
    let places: Vec<egui::Pos2> = embedding.iter().map(|z| window.place_in_plane(*z)).collect();
    let expected: Vec<u32> = (0..).zip(&places).filter(|(_, at)| is_inside(**at)).map(|(i, _)| i).collect();
    let in_box = places.iter().filter(|at| Rect::from_points(&[a, b, c]).contains(**at)).count();
    assert!(!expected.is_empty() && expected.len() < in_box);
    let selected: Vec<u32> = window.editor().selection.vertices().iter().map(|v| v.number()).collect();
    assert_eq!(selected, expected);
}

#[test]
fn a_dragged_pin_goes_where_it_is_dropped_and_no_other_moves() {
    let mut window = window();
    pin(&mut window, &[0, 40, 80]);
    let before = document(&window);
    let from = window.place_in_plane(before.targets[&VertexId::new(40)].uv);
    let to = from + Vec2::new(60.0, -35.0);
    // Computed before the drag, whose end may move the camera.
    let target = in_embedding(&window, to);
    window.drag(from, to, Modifiers::NONE);
    let mut expected = before.targets.clone();
    expected.insert(VertexId::new(40), Target::fixed(target));
    assert_eq!(document(&window).targets, expected);
    assert_eq!(window.embedding()[40], target, "and the embedding follows");
    assert!(window.editor().session.is_current());
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(document(&window), before, "a drag is one undo step");
    window.press(Modifiers::COMMAND, Key::Y);
    assert_eq!(document(&window).targets, expected);
    window.menu(&["Edit", "Undo"]);
    assert_eq!(document(&window), before);
    window.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(document(&window).targets, expected);
}

#[test]
fn the_embedding_follows_while_a_pin_is_dragged() {
    let mut window = window();
    pin(&mut window, &[0, 40, 80]);
    let from = window.place_in_plane(window.embedding()[40]);
    let to = from + Vec2::new(60.0, -35.0);
    window.begin_drag(from, to, Modifiers::NONE);
    window.settle_while_held();
    assert_eq!(window.editor().tools.dragged(), Some(VertexId::new(40)));
    let drawn = window.editor().plane.drawn().expect("solved").positions()[40];
    assert!(drawn.distance(in_embedding(&window, to)) < 1e-9, "{drawn}");
    assert_eq!(window.pill(), Pill::Proved, "{}", window.verdict());
    assert_message("gestures-window-hint-during-a-drag", &window.text_with("Esc"));
    window.end_drag(to);
    assert_eq!(window.editor().tools.dragged(), None);
}

#[test]
fn escape_during_a_drag_gives_it_up() {
    let mut window = window();
    pin(&mut window, &[0, 40, 80]);
    let before = document(&window);
    let from = window.place_in_plane(window.embedding()[40]);
    let to = from + Vec2::new(60.0, -35.0);
    window.begin_drag(from, to, Modifiers::NONE);
    assert_ne!(document(&window), before);
    window.key(Key::Escape);
    assert_eq!(document(&window), before);
    window.harness.hover_at(to + Vec2::splat(30.0));
    window.step();
    assert_eq!(document(&window), before, "the rest of the way counts no more");
    window.end_drag(to);
    assert_eq!(document(&window), before);
    assert!(!window.editor().session.history().can_redo(), "what was given up is not done again");
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(document(&window).targets.is_empty(), "undo takes back the step before the drag");
}

#[test]
fn escape_before_a_pin_has_moved_takes_nothing_back() {
    let mut window = window();
    pin(&mut window, &[0, 40, 80]);
    let before = document(&window);
    let at = window.place_in_plane(window.embedding()[40]);
    window.harness.hover_at(at);
    window.harness.drag_at(at);
    window.step();
    // After a press of more than a second without motion, egui reports a drag.
    window.harness.run_steps(90);
    window.key(Key::Escape);
    assert_eq!(document(&window), before);
    window.end_drag(at);
    assert_eq!(document(&window), before);
}

#[test]
fn dragging_a_gauge_pin_makes_both_the_user_s() {
    let mut window = window();
    let before = window.embedding();
    let gauge = window.outcome().step.candidate.solution.pins.clone();
    let [(first, _), (second, at)] = gauge.iter().map(|(&v, &pin)| (v, pin)).collect::<Vec<_>>()[..] else {
        panic!("two gauge pins: {gauge:?}")
    };
    assert!(window.has_button(&format!("Gauge pin {first}")));
    let from = window.place_in_plane(gauge[&first].target);
    let to = from + Vec2::new(30.0, 40.0);
    window.drag(from, to, Modifiers::NONE);
    let expected =
        [(first, Target::fixed(in_embedding(&window, to))), (second, Target { uv: at.target, kind: at.kind })];
    assert_eq!(document(&window).targets.into_iter().collect::<Vec<_>>(), expected);
    assert!(window.has_button(&format!("Pin {first}")) && window.has_button(&format!("Pin {second}")));
    assert!(!window.has_button(&format!("Gauge pin {first}")));
    assert!(distance(&before, &window.embedding()) > 0.01);
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(document(&window).targets.is_empty(), "one step");
    assert!(distance(&before, &window.embedding()) < 1e-9);
}

#[test]
fn a_click_on_a_pin_selects_it_and_moves_nothing() {
    let mut window = window();
    pin(&mut window, &[0, 40, 80]);
    let before = document(&window);
    window.click_at(window.place_in_plane(window.embedding()[40]) + Vec2::new(4.0, 3.0), Modifiers::NONE);
    assert_eq!(*window.editor().selection.vertices(), [VertexId::new(40)].into());
    assert_eq!(document(&window), before);
}

#[test]
fn a_pin_grabbed_beside_its_middle_does_not_jump() {
    let mut window = window();
    pin(&mut window, &[0, 40, 80]);
    let at = window.place_in_plane(window.embedding()[40]);
    let grabbed = at + Vec2::new(5.0, 5.0);
    // Computed before the drag, whose end may move the camera.
    let expected = in_embedding(&window, at + Vec2::new(40.0, 0.0));
    window.drag(grabbed, grabbed + Vec2::new(40.0, 0.0), Modifiers::NONE);
    let moved = document(&window).targets[&VertexId::new(40)].uv;
    assert!(moved.distance(expected) < 1e-4, "{moved} for {expected}");
}

#[test]
fn escape_ends_the_tool_and_then_the_selection() {
    let mut window = window();
    window.click("Fix: pin a vertex at its current position");
    window.editor_mut().selection.add([VertexId::new(3)]);
    window.key(Key::Escape);
    assert_eq!(window.editor().tools.tool(), Tool::Select);
    assert_eq!(window.editor().selection.vertices().len(), 1);
    window.key(Key::Escape);
    assert!(window.editor().selection.vertices().is_empty());
}

#[test]
fn a_drag_on_the_mesh_orbits_and_with_shift_pans() {
    let mut window = window();
    let before = window.editor().mesh.pane.camera().expect("a mesh shows");
    let from = window.mesh_view().center();
    window.drag(from, from + Vec2::new(50.0, 20.0), Modifiers::NONE);
    let orbited = window.editor().mesh.pane.camera().expect("a mesh shows");
    assert_ne!(orbited, before);
    window.drag(from, from + Vec2::new(50.0, 20.0), Modifiers::SHIFT);
    let panned = window.editor().mesh.pane.camera().expect("a mesh shows");
    assert_ne!(panned, orbited);
    window.key(Key::F);
    assert!(document(&window).targets.is_empty() && window.editor().selection.vertices().is_empty());
}

#[test]
fn a_drag_on_the_embedding_pans_and_the_wheel_zooms_to_the_pointer() {
    let mut window = window();
    let from = window.plane_view().center();
    let grabbed = in_embedding(&window, from);
    window.drag(from, from + Vec2::new(50.0, 20.0), Modifiers::NONE);
    assert!(in_embedding(&window, from + Vec2::new(50.0, 20.0)).distance(grabbed) < 1e-6, "it stays under the pointer");
    let scale = in_embedding(&window, from + Vec2::X).distance(in_embedding(&window, from));
    let anchor = in_embedding(&window, from);
    window.harness.hover_at(from);
    window.harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: Vec2::new(0.0, 2.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    window.settle();
    assert!(in_embedding(&window, from).distance(anchor) < 1e-6);
    let zoomed = in_embedding(&window, from + Vec2::X).distance(in_embedding(&window, from));
    assert!(zoomed < 0.9 * scale, "{zoomed} {scale}");
    window.key(Key::F);
    let framed = in_embedding(&window, from + Vec2::X).distance(in_embedding(&window, from));
    assert!((framed / scale - 1.0).abs() < 1e-6, "framed again");
}

#[test]
fn the_menu_of_a_vertex_closes_with_its_mesh() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let vertex = window.vertex_in_the_middle();
    window.harness.hover_at(window.place_on_mesh(vertex));
    window.harness.run_steps(2);
    let button = egui::PointerButton::Secondary;
    for pressed in [true, false] {
        let (pos, modifiers) = (window.place_on_mesh(vertex), Modifiers::NONE);
        window.harness.event(egui::Event::PointerButton { pos, button, pressed, modifiers });
    }
    window.settle();
    assert!(window.has_button("Fix at its current position") && window.shows(&vertex.to_string()));
    let small = window.path("small.obj");
    crate::harness::write_obj(&small, &sheet(2, 0.3));
    window.open(&small);
    assert!(!window.has_button("Fix at its current position"), "{:?}", window.words());
}
