//! Constraints by mouse and keyboard: pairs in both orders, several at once, nudges.

use eframe::egui;
use egui::{Key, Modifiers, Pos2, Vec2};
use freebound::session::Action;
use freebound::ui::{Half, Intent, Tool};
use freebound_core::geom::Picture;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Target, Targets};
use glam::DVec2;

use crate::dialogs::dropped;
use crate::harness::{Window, sheet};
use freebound_testkit::assert_message;

pub(crate) fn window() -> Window {
    Window::with_mesh("sheet.obj", &sheet(8, 0.4))
}

pub(crate) fn pins(window: &Window) -> Targets {
    window.editor().session.document().targets.clone()
}

pub(crate) fn place(window: &mut Window, pins: &[(u32, Target)]) {
    for &(vertex, pin) in pins {
        window.editor_mut().session.handle(Action::Place { vertex: VertexId::new(vertex), target: pin });
    }
    window.settle();
}

/// Places the sheet's corners on those of the unit square, and a vertex between them.
pub(crate) fn corners(window: &mut Window) {
    let at = |x: f64, y: f64| Target::hard(DVec2::new(x, y));
    place(window, &[(0, at(0.0, 0.0)), (8, at(1.0, 0.0)), (72, at(0.0, 1.0)), (80, at(1.0, 1.0)), (40, at(0.5, 0.5))]);
    window.key(Key::F);
}

fn in_embedding(window: &Window, at: Pos2) -> DVec2 {
    let relative = at - window.plane_view().min;
    let camera = window.editor().plane.pane.camera().expect("an embedding shows");
    camera.embedding_from_pane(DVec2::new(relative.x.into(), relative.y.into()), window.editor().plane.pane.size())
}

/// Point of the plane's pane without a vertex nearby.
pub(crate) fn free_place(window: &Window) -> Pos2 {
    window.plane_view().left_top() + Vec2::splat(24.0)
}

#[test]
fn a_vertex_and_then_its_place_make_a_constraint() {
    let mut window = window();
    let vertex = window.vertex_in_the_middle();
    let to = free_place(&window);
    let target = in_embedding(&window, to);
    window.key(Key::C);
    window.click_at(window.place_on_mesh(vertex), Modifiers::NONE);
    assert_eq!(window.editor().tools.pair(), Some(Half::Vertex(vertex)));
    assert!(pins(&window).is_empty(), "half a pair pins nothing");
    window.click_at(to, Modifiers::NONE);
    assert_eq!(window.editor().tools.pair(), None);
    assert_eq!(pins(&window), [(vertex, Target::hard(target))].into());
    assert!(window.has_button(&format!("Constraint {vertex}")));
    assert_eq!(*window.editor().selection.vertices(), [vertex].into());
    assert_eq!(window.editor().tools.tool(), Tool::Constrain, "the next pair can follow");
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(pins(&window).is_empty(), "one undo step");
}

#[test]
fn a_place_and_then_its_vertex_make_the_same_constraint() {
    let mut window = window();
    let vertex = window.vertex_in_the_middle();
    let to = free_place(&window);
    let target = in_embedding(&window, to);
    window.key(Key::C);
    window.click_at(to, Modifiers::NONE);
    assert_eq!(window.editor().tools.pair(), Some(Half::Target(target)));
    window.click_at(window.place_on_mesh(vertex), Modifiers::NONE);
    assert_eq!(pins(&window), [(vertex, Target::hard(target))].into());
}

#[test]
fn a_vertex_can_be_taken_in_the_embedding() {
    let mut window = window();
    window.key(Key::C);
    window.click_at(window.place_in_plane(window.embedding()[40]), Modifiers::NONE);
    assert_eq!(window.editor().tools.pair(), Some(Half::Vertex(VertexId::new(40))));
    let to = free_place(&window);
    let target = in_embedding(&window, to);
    window.click_at(to, Modifiers::NONE);
    assert_eq!(pins(&window), [(VertexId::new(40), Target::hard(target))].into());
}

#[test]
fn what_a_click_would_do_is_said_before_it() {
    let mut window = window();
    let vertex = window.vertex_in_the_middle();
    window.click("Constrain: choose the position of a vertex");
    assert_message("constraints-window-hint-at-first", &window.text_with("Click"));
    window.harness.hover_at(window.place_on_mesh(vertex));
    window.settle();
    assert_eq!(window.editor().tools.intent(), Intent::TakeVertex(vertex));
    assert_message("constraints-window-hint-over-a-vertex", &window.text_with("Click"));
    assert!(window.has_ring_at(window.place_on_mesh(vertex)));
    window.click_at(window.place_on_mesh(vertex), Modifiers::NONE);
    let to = free_place(&window);
    window.harness.hover_at(to);
    window.settle();
    let Intent::Join(joined, target) = window.editor().tools.intent() else {
        panic!("{:?}", window.editor().tools.intent())
    };
    assert_eq!((joined, target), (vertex, in_embedding(&window, to)));
    let hint = window.text_with("Click");
    let parts = [vertex.to_string(), format!("u {:.4} v {:.4}", target.x, target.y)];
    assert!(parts.iter().all(|part| hint.contains(part)), "{hint}");
    let from = window.place_in_plane(window.embedding()[vertex.index()]);
    let is_joined = |[a, b]: &[Pos2; 2]| a.distance(from) < 1.0 && b.distance(to) < 1.0;
    assert!(window.lines().iter().any(is_joined), "a line joins the vertex with the pointer");
}

#[test]
fn escape_gives_up_the_pair_and_then_the_tool() {
    let mut window = window();
    window.key(Key::C);
    window.click_at(window.place_on_mesh(window.vertex_in_the_middle()), Modifiers::NONE);
    assert!(window.editor().tools.pair().is_some());
    window.key(Key::Escape);
    assert_eq!((window.editor().tools.pair(), window.editor().tools.tool()), (None, Tool::Constrain));
    window.key(Key::Escape);
    assert_eq!(window.editor().tools.tool(), Tool::Select);
    assert!(pins(&window).is_empty());
}

#[test]
fn a_click_on_a_constraint_selects_it() {
    let mut window = window();
    corners(&mut window);
    window.key(Key::C);
    let before = pins(&window);
    window.click_at(window.place_in_plane(DVec2::new(0.5, 0.5)), Modifiers::NONE);
    assert_eq!(*window.editor().selection.vertices(), [VertexId::new(40)].into());
    assert_eq!((window.editor().tools.pair(), pins(&window)), (None, before));
}

#[test]
fn a_place_can_lie_near_another_constraint() {
    let mut window = window();
    corners(&mut window);
    window.key(Key::C);
    let to = window.place_in_plane(DVec2::new(0.5, 0.5)) + Vec2::new(6.0, 0.0);
    let target = in_embedding(&window, to);
    window.editor_mut().tools.set_pair(Some(Half::Vertex(VertexId::new(30))));
    window.click_at(to, Modifiers::NONE);
    assert_eq!(pins(&window).get(&VertexId::new(30)), Some(&Target::hard(target)));
}

#[test]
fn a_click_on_another_pin_s_mark_completes_the_pair_as_the_status_line_says() {
    let mut window = window();
    corners(&mut window);
    window.key(Key::C);
    let target = DVec2::new(0.3, 0.7);
    window.editor_mut().tools.set_pair(Some(Half::Target(target)));
    let mark = window.place_in_plane(DVec2::new(0.5, 0.5));
    window.harness.hover_at(mark);
    window.settle();
    assert_eq!(window.editor().tools.intent(), Intent::Join(VertexId::new(40), target));
    assert_message("constraints-window-hint-that-joins", &window.text_with("Click"));
    window.click_at(mark, Modifiers::NONE);
    assert_eq!(pins(&window)[&VertexId::new(40)], Target::hard(target));
    assert_eq!(window.editor().tools.pair(), None);
}

#[test]
fn a_click_on_a_mark_far_from_its_vertex_selects_as_the_status_line_says() {
    let mut window = window();
    corners(&mut window);
    let target = DVec2::new(0.9, 0.1);
    place(&mut window, &[(30, Target::weighted(target, 0.5))]);
    // An inset over a defect would cover the embedding below it.
    window.editor_mut().pane_shading.magnifier = false;
    window.key(Key::C);
    let mark = window.place_in_plane(target);
    window.harness.hover_at(mark);
    window.settle();
    assert_eq!(window.editor().tools.intent(), Intent::Select(VertexId::new(30)));
    assert_message("constraints-window-hint-that-selects", &window.text_with("Click"));
    window.click_at(mark, Modifiers::NONE);
    assert_eq!(*window.editor().selection.vertices(), [VertexId::new(30)].into());
    assert_eq!(window.editor().tools.pair(), None);
}

#[test]
fn one_of_several_selected_pins_takes_the_others_along() {
    let mut window = window();
    corners(&mut window);
    let before = pins(&window);
    let at = |z: DVec2| z;
    window.click_at(window.place_in_plane(at(DVec2::new(0.5, 0.5))), Modifiers::NONE);
    window.click_at(window.place_in_plane(at(DVec2::ONE)), Modifiers::SHIFT);
    assert_eq!(*window.editor().selection.vertices(), [40, 80].map(VertexId::new).into());
    let from = window.place_in_plane(DVec2::new(0.5, 0.5));
    let to = from + Vec2::new(-20.0, 15.0);
    let by = in_embedding(&window, to) - in_embedding(&window, from);
    window.drag(from, to, Modifiers::NONE);
    for (vertex, pin) in pins(&window) {
        let moved = if [40, 80].contains(&vertex.number()) { by } else { DVec2::ZERO };
        assert!((pin.uv - before[&vertex].uv).distance(moved) < 1e-6, "{vertex}");
    }
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(pins(&window), before, "one undo step");
}

#[test]
fn a_box_selects_the_pins_in_it() {
    let mut window = window();
    corners(&mut window);
    let at = |x, y| window.place_in_plane(DVec2::new(x, y));
    let (from, to) = (at(0.9, 1.1), at(1.1, -0.1));
    window.drag(from, to, Modifiers::COMMAND);
    let selected = window.editor().selection.vertices();
    assert!(selected.contains(&VertexId::new(8)) && selected.contains(&VertexId::new(80)), "{selected:?}");
    assert!(!selected.contains(&VertexId::new(40)) && !selected.contains(&VertexId::new(0)));
}

#[test]
fn a_pin_dragged_out_of_the_pane_stays_in_the_hand() {
    let mut window = window();
    corners(&mut window);
    let from = window.place_in_plane(DVec2::new(0.5, 0.5));
    let outside = Pos2::new(window.plane_view().left() - 120.0, from.y);
    let back = from + Vec2::new(10.0, 0.0);
    // Computed before the drag, whose end may move the camera.
    let expected = in_embedding(&window, back);
    window.begin_drag(from, outside, Modifiers::NONE);
    window.settle_while_held();
    assert_eq!(window.editor().tools.dragged(), Some(VertexId::new(40)));
    window.harness.hover_at(back);
    window.step();
    window.end_drag(back);
    let target = pins(&window)[&VertexId::new(40)].uv;
    assert!(target.distance(expected) < 1e-6, "{target}");
    assert_eq!(pins(&window).len(), 5, "none is lost");
}

#[test]
fn arrows_nudge_selected_pins_and_only_them() {
    let mut window = window();
    corners(&mut window);
    let before = pins(&window);
    window.editor_mut().selection.select([8, 40].map(VertexId::new));
    let step = window.editor().plane.scene().expect("solved").arrays.bounds.extent() / 512.0;
    window.key(Key::ArrowRight);
    for (vertex, by) in [(8, step), (40, step), (0, 0.0)] {
        let moved = pins(&window)[&VertexId::new(vertex)].uv - before[&VertexId::new(vertex)].uv;
        assert!(moved.distance(DVec2::new(by, 0.0)) < 1e-12, "{vertex}: {moved}");
    }
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(pins(&window), before, "one undo step");
    window.press(Modifiers::SHIFT, Key::ArrowUp);
    let moved = pins(&window)[&VertexId::new(40)].uv - before[&VertexId::new(40)].uv;
    assert!(moved.distance(DVec2::new(0.0, 10.0 * step)) < 1e-9, "{moved}");
}

#[test]
fn a_held_arrow_is_one_undo_step() {
    let mut window = window();
    corners(&mut window);
    let before = pins(&window);
    window.editor_mut().selection.select([VertexId::new(40)]);
    for repeat in [false, true, true] {
        window.harness.event(egui::Event::Key {
            key: Key::ArrowLeft,
            physical_key: None,
            pressed: true,
            repeat,
            modifiers: Modifiers::NONE,
        });
        window.step();
    }
    assert!(window.editor().tools.is_nudging());
    window.harness.key_up(Key::ArrowLeft);
    window.settle();
    assert!(!window.editor().tools.is_nudging());
    assert_ne!(pins(&window), before);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(pins(&window), before);
}

#[test]
fn arrows_step_through_the_timeline_where_no_pin_is_selected() {
    let mut window = window();
    corners(&mut window);
    let before = pins(&window);
    window.editor_mut().selection.select([VertexId::new(30)]);
    window.key(Key::ArrowRight);
    assert_eq!(pins(&window), before);
}

#[test]
fn delete_frees_all_selected_constraints() {
    let mut window = window();
    corners(&mut window);
    window.editor_mut().selection.select([8, 40].map(VertexId::new));
    window.key(Key::Delete);
    assert_eq!(pins(&window).keys().map(|v| v.number()).collect::<Vec<_>>(), [0, 72, 80]);
}

#[test]
fn v_turned_around_and_back_is_the_same_document_to_the_last_bit() {
    let mut window = window();
    window.choose("Method", "Least-squares conformal");
    let values = [0.1, 0.3, 1e-20, 1.0 / 3.0, -7.7, 0.0];
    for (i, v) in values.into_iter().enumerate() {
        place(&mut window, &[(8 * u32::try_from(i).expect("few"), Target::hard(DVec2::new(0.1 * i as f64, v)))]);
    }
    assert!(values.iter().any(|v| 1.0 - (1.0 - v) != *v), "rounding alone would change some");
    let before = window.editor().session.document().clone();
    window.click(&format!("Pins {}", values.len()));
    for _ in 0..2 {
        window.click("v down");
        assert_ne!(pins(&window), before.targets);
        window.click("v up");
        assert_eq!(*window.editor().session.document(), before);
    }
}

/// Window on which a picture of 40 × 40 pixels and its landmarks were dropped. `points` is the file after its version.
fn window_with_landmarks(points: &str) -> Window {
    let mut window = window();
    let [picture, landmarks] = ["photo.png", "photo.pts"].map(|name| window.path(name));
    let mut file = std::fs::File::create(&picture).expect("created");
    let pixels = Picture::filled(40, 40, [10, 120, 200, 255]);
    freebound_io::raster::write_png(&pixels, &mut file).expect("written");
    std::fs::write(&landmarks, format!("version: 1\n{points}")).expect("written");
    for file in [picture, landmarks] {
        window.harness.input_mut().dropped_files.push(dropped(file));
        window.settle();
    }
    window
}

#[test]
fn landmarks_of_a_picture_are_placed_one_after_the_other() {
    let mut window = window_with_landmarks("n_points: 3\n{\n10.5 30.5\n30.5 30.5\n20.5 10.5\n}\n");
    window.click("Pins");
    assert!(window.shows("0 of 3 placed"), "{:?}", window.words());
    window.click("Place next");
    let vertices = [10, 16, 67].map(VertexId::new);
    for (count, vertex) in vertices.into_iter().enumerate() {
        assert!(window.editor().tools.pair().is_some(), "landmark {count} waits");
        window.click_at(window.place_on_mesh(vertex), Modifiers::NONE);
        window.settle();
        assert_eq!(pins(&window).len(), count + 1);
    }
    assert_eq!(window.editor().tools.pair(), None, "all are placed");
    let at = |vertex: VertexId| pins(&window)[&vertex].uv;
    assert_eq!(vertices.map(at), [[0.25, 0.25], [0.75, 0.25], [0.5, 0.75]].map(DVec2::from));
    let names = vertices.map(|vertex| window.editor().session.pin_name(vertex).map(ToString::to_string));
    assert_eq!(names, ["point 1", "point 2", "point 3"].map(|name| Some(name.to_owned())));
    window.press(Modifiers::COMMAND, Key::Z);
    window.click("Place next");
    assert!(window.editor().tools.pair().is_some() && window.shows("2 of 3 placed"));
    window.click("Close");
    assert!(!window.shows("2 of 3 placed"));
    assert_eq!(window.editor().tools.pair(), None, "a click pins nothing at a landmark that is gone");
}

#[test]
fn a_click_near_a_landmark_takes_it() {
    let mut window = window_with_landmarks("n_points: 1\n{\n10.5 30.5\n}\n");
    window.key(Key::F);
    window.key(Key::C);
    let near = window.place_in_plane(DVec2::new(0.25, 0.25)) + Vec2::new(3.0, -2.0);
    window.click_at(near, Modifiers::NONE);
    assert_eq!(window.editor().tools.pair(), Some(Half::Target(DVec2::new(0.25, 0.25))));
}
