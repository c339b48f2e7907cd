//! Inset that magnifies a defect.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Rect};
use egui_kittest::kittest::Queryable as _;
use freebound::examples::Example;
use freebound::session::Action;
use freebound::ui::Defect;
use freebound_core::mesh::VertexId;

use crate::defects::fold;
use crate::harness::{Window, sheet};
use freebound_testkit::{corpus, corpus_test};

fn folded() -> Window {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    fold(&mut window);
    window
}

/// Name of the inset, if it is visible.
fn inset(window: &Window) -> Option<String> {
    let names = window.controls().into_iter().map(|(_, name, _)| name);
    names.into_iter().find(|name| name.starts_with("Magnifier: "))
}

fn inset_rect(window: &Window) -> Rect {
    window.rect(Role::Button, &inset(window).expect("it shows"))
}

/// Description of a defect, by its place in the list.
fn words_of(window: &Window, place: usize) -> String {
    let scene = window.editor().mesh_scene().expect("a mesh shows");
    window.editor().defects()[place].words(scene)
}

/// Magnification according to the inset's name.
fn factor(window: &Window) -> f64 {
    let name = inset(window).expect("it shows");
    name.rsplit("× ").next().expect("a factor").parse().expect("a number")
}

#[test]
fn it_shows_the_first_defect_and_goes_when_there_is_none() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    assert_eq!(inset(&window), None, "nothing is wrong yet");
    fold(&mut window);
    let first = words_of(&window, 0);
    assert!(inset(&window).expect("it shows").starts_with(&format!("Magnifier: {first}, × ")));
    assert!(factor(&window) > 1.5, "{}", factor(&window));
    window.menu(&["Edit", "Free all pins"]);
    assert_eq!(inset(&window), None, "nothing is wrong any more");
}

#[test]
fn it_shows_the_defect_gone_to() {
    let mut window = folded();
    window.key(Key::D);
    window.key(Key::D);
    let second = words_of(&window, 1);
    // The pane has zoomed in as far as the inset. Zoomed out, the inset shows the current defect.
    window.key(Key::Escape);
    window.key(Key::F);
    assert!(inset(&window).expect("it shows").contains(&second), "{:?} is {second}", inset(&window));
}

#[test]
fn a_click_goes_to_its_defect() {
    let mut window = folded();
    let name = inset(&window).expect("it shows");
    let before = window.editor().plane.pane.camera();
    window.click(&name);
    assert_eq!(window.editor().selection.defect(), Some(0));
    assert_ne!(window.editor().plane.pane.camera(), before);
}

#[test]
fn it_can_be_switched_off() {
    let mut window = folded();
    window.menu(&["View", "Show", "Magnifier"]);
    assert_eq!(inset(&window), None);
    window.menu(&["View", "Show", "Magnifier"]);
    assert!(inset(&window).is_some());
}

#[test]
fn the_frame_on_the_layout_lies_around_the_defect_and_not_under_the_inset() {
    let mut window = folded();
    let Defect::Flipped(face) = window.editor().defects()[0] else { panic!("flipped faces come first") };
    let corners = window.editor().session.model().expect("open").mesh().triangles[face.index()];
    let embedding = window.embedding();
    let place = |window: &Window| {
        let places = corners.map(|v: VertexId| window.place_in_plane(embedding[v]));
        Rect::from_points(&places)
    };
    assert!(window.has_frame_around(place(&window)));
    // Pans until the defect is where the inset was.
    let by = inset_rect(&window).center() - place(&window).center();
    let camera = window.editor_mut().plane.pane.camera_mut().expect("framed");
    camera.pan(glam::DVec2::new(by.x.into(), by.y.into()));
    window.settle();
    assert!(!inset_rect(&window).intersects(place(&window)), "it has made room");
    assert!(window.has_frame_around(place(&window)));
}

#[test]
fn what_the_pane_shows_as_large_is_not_magnified() {
    let mut window = folded();
    let Defect::Flipped(face) = window.editor().defects()[0] else { panic!("flipped faces come first") };
    let corner = window.editor().session.model().expect("open").mesh().triangles[face.index()][0];
    let at = window.embedding()[corner.index()];
    let camera = window.editor_mut().plane.pane.camera_mut().expect("framed");
    camera.frame(freebound_core::geom::Bounds { low: at - 1e-3, high: at + 1e-3 }, glam::DVec2::splat(400.0));
    window.settle();
    assert_eq!(inset(&window), None);
}

#[test]
fn the_pointer_over_it_picks_nothing_behind_it() {
    let mut window = folded();
    let corner = VertexId::new(6);
    let at = |window: &Window| window.place_in_plane(window.embedding()[corner.index()]);
    // The lower right corner of the sheet, which is unrelated to the defect.
    let up = glam::DVec2::new(0.0, -200.0);
    window.editor_mut().plane.pane.camera_mut().expect("framed").pan(up);
    window.settle();
    window.harness.hover_at(at(&window));
    window.harness.run_steps(2);
    assert_eq!(window.editor().pointer.vertex(), Some(corner), "as long as nothing lies over it");
    window.editor_mut().plane.pane.camera_mut().expect("framed").pan(-up);
    window.settle();
    assert!(inset_rect(&window).contains(at(&window)));
    window.harness.hover_at(at(&window));
    window.harness.run_steps(2);
    assert_eq!(window.editor().pointer.vertex(), None);
}

#[test]
fn a_small_pane_has_no_room_for_it() {
    let mut window = folded();
    window.harness.set_size(egui::vec2(640.0, 260.0));
    window.settle();
    assert_eq!(inset(&window), None);
    window.harness.set_size(egui::vec2(1280.0, 800.0));
    window.settle();
    assert!(inset(&window).is_some());
}

#[test]
fn a_stage_before_the_result_has_no_verdict_and_so_no_inset() {
    let mut window = Window::with_example(Example::Face);
    window.choose("Method", "Natural boundary");
    assert!(inset(&window).is_some());
    window.key(Key::H);
    assert!(inset(&window).is_some(), "without stages the result shows");
    window.choose("Method", "Virtual boundary");
    window.click("Before");
    assert!(window.editor().plane.hull_scene().expect("shown").flipped_count() > 0);
    assert_eq!(inset(&window), None, "folds, but no verdict");
}

corpus_test! {
    fn a_crossing_of_the_cow_is_shown_with_its_ring() {
        let mut window = Window::with_file(&corpus().join("cow_seamster.obj"));
        window.choose("Method", "Natural boundary");
        let flipped = window.outcome().step.verdict.flipped_faces.len();
        let crossing = window.editor().defects()[flipped];
        assert!(matches!(crossing, Defect::Crossing(_)));
        window.editor_mut().selection.set_defect(Some(flipped));
        window.editor_mut().session.handle(Action::EndGesture);
        window.settle();
        assert!(inset(&window).expect("it shows").contains(&words_of(&window, flipped)));
        // The magnified element is in the middle of the picture below the title.
        let rect = inset_rect(&window);
        assert!(window.has_ring_at(rect.center() + egui::vec2(0.0, 10.0)));
        assert!(window.harness.query_by_label(&inset(&window).expect("it shows")).is_some());
    }
}

#[test]
fn the_wheel_over_it_is_its_own() {
    let mut window = folded();
    let camera = window.editor().plane.pane.camera();
    let before = factor(&window);
    let middle = inset_rect(&window).center();
    window.harness.hover_at(middle);
    window.harness.run_steps(2);
    for _ in 0..3 {
        window.harness.event(egui::Event::MouseWheel {
            unit: egui::MouseWheelUnit::Line,
            delta: egui::vec2(0.0, 2.0),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: egui::Modifiers::NONE,
        });
        window.harness.run_steps(2);
    }
    assert!(factor(&window) > 2.0 * before, "{} after {before}", factor(&window));
    assert_eq!(window.editor().plane.pane.camera(), camera, "what lies under it stays");
}

#[test]
fn its_cross_closes_it_and_the_menu_opens_it_again() {
    let mut window = folded();
    let name = inset(&window).expect("it shows");
    window.click(&format!("Close: {name}"));
    assert_eq!(inset(&window), None);
    window.menu(&["View", "Show", "Magnifier"]);
    assert!(inset(&window).is_some());
}

#[test]
fn a_drag_pans_it_until_another_defect_is_shown() {
    let mut window = folded();
    let Defect::Flipped(face) = window.editor().defects()[0] else { panic!("flipped faces come first") };
    let corners = window.editor().session.model().expect("open").mesh().triangles[face.index()];
    let place = |window: &Window, v: VertexId| window.place_in_plane(window.embedding()[v.index()]);
    let around = |window: &Window| window.has_frame_around(Rect::from_points(&corners.map(|v| place(window, v))));
    assert!(around(&window), "the frame on the layout lies around the defect");
    let (camera, name) = (window.editor().plane.pane.camera(), inset(&window));
    let middle = inset_rect(&window).center();
    window.drag(middle, middle - egui::vec2(90.0, 0.0), egui::Modifiers::NONE);
    assert_eq!((window.editor().plane.pane.camera(), inset(&window)), (camera, name), "what lies under it stays");
    assert_eq!(window.editor().selection.defect(), None, "and a drag is no click");
    assert!(!around(&window), "it looks at what lies beside the defect");
    window.drag(middle, middle + egui::vec2(90.0, 0.0), egui::Modifiers::NONE);
    assert!(around(&window), "and back");
    window.drag(middle, middle - egui::vec2(90.0, 0.0), egui::Modifiers::NONE);
    window.editor_mut().selection.set_defect(Some(1));
    window.settle();
    window.editor_mut().selection.set_defect(Some(0));
    window.settle();
    assert!(!around(&window), "it was not dragged for the other");
}

#[test]
fn the_insets_of_a_pair_are_panned_each_by_itself() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let vertex = VertexId::new(24);
    window.editor_mut().session.handle(Action::Fix(vec![VertexId::new(0), vertex, VertexId::new(48)]));
    window.settle();
    window.editor_mut().selection.select([vertex]);
    window.settle();
    let [on_mesh, in_plane] = ["v24 on the mesh", "the target of v24"].map(|what| format!("Magnifier: {what}"));
    let rect = |window: &Window, name: &str| window.rect(Role::Image, name);
    for (dragged, other) in [(&on_mesh, &in_plane), (&in_plane, &on_mesh)] {
        let middle = rect(&window, dragged).center();
        assert!(window.has_ring_at(middle), "{dragged}: the vertex lies in the middle");
        window.drag(middle, middle + egui::vec2(0.0, 24.0), egui::Modifiers::NONE);
        assert!(!window.has_ring_at(middle), "{dragged}: it went with the drag");
        assert_eq!(window.has_ring_at(rect(&window, other).center()), *other == in_plane, "{other}");
    }
}
