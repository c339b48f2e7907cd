//! Hull and pockets of the virtual boundary, stage by stage.

use eframe::egui;
use egui::Key;
use freebound::examples::Example;
use freebound::ui::HullStage;
use freebound_core::problem::Embedding;
use glam::DVec2;

use crate::harness::{Window, sheet};
use freebound_testkit::assert_message;

/// The built-in face. The virtual boundary removes its three folds within the hull.
fn bent() -> Window {
    let mut window = Window::with_example(Example::Face);
    window.choose("Method", "Virtual boundary");
    assert!(window.outcome().step.candidate.virtual_boundary.is_some(), "the face bends");
    window
}

/// Caption of hull and pockets, which the pane shows.
fn caption(window: &Window) -> String {
    let caption = window.editor().plane.hull_scene().expect("shown").caption.clone();
    assert!(window.shows(&caption), "{caption:?} in {:?}", window.words());
    caption
}

/// True if the step on the screen has stages of a virtual boundary to show.
fn has_stages(window: &Window) -> bool {
    window.editor().plane.hull_scene().expect("shown").has_stages
}

fn positions(window: &Window) -> Embedding {
    window.editor().plane.drawn().expect("solved").positions().clone()
}

#[test]
fn h_shows_the_stages_and_hides_them_again() {
    let mut window = bent();
    assert!(!window.has_button("Pockets"));
    window.key(Key::H);
    let pockets = window.outcome().step.candidate.virtual_boundary.clone().expect("bent").pockets.len();
    let caption = caption(&window);
    assert!(has_stages(&window) && caption.split(' ').any(|word| word == pockets.to_string()), "{caption}");
    assert_message("hull-window-caption-of-pockets", &caption);
    for stage in HullStage::ALL {
        window.click(stage.words()[0]);
        assert_eq!(window.editor().plane.stage(), stage);
    }
    window.key(Key::H);
    assert!(!window.has_button("Pockets"));
    window.menu(&["View", "Show", "Hull and pockets"]);
    assert!(window.has_button("Pockets"));
    window.click("Hull");
    assert!(!window.has_button("Pockets"));
}

#[test]
fn each_stage_shows_the_mesh_where_it_was_then() {
    let mut window = bent();
    let result = window.embedding();
    let stages = window.outcome().step.candidate.virtual_boundary.clone().expect("bent");
    window.key(Key::H);
    let extent = window.editor().plane.drawn().expect("solved").arrays.bounds.extent();
    let gap = |a: &[DVec2], b: &[DVec2]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / extent;

    let pockets = positions(&window);
    window.click("Before");
    assert_eq!(positions(&window), pockets);
    assert!(gap(&pockets, &result) > 1e-3, "the folds are still there");
    window.click("Solved");
    let solved = positions(&window);
    assert!(gap(&solved[..result.len()], &result) < 1e-9, "{}", gap(&solved, &result));
    for v in &stages.hull {
        assert!(solved[v.index()].distance(pockets[v.index()]) < 1e-9 * extent, "the hull stays at {v}");
    }
    window.click("Peeled");
    assert_eq!(positions(&window), result);
}

#[test]
fn the_folds_of_the_stage_before_are_drawn_with_it() {
    // The result is planar, so red faces can only belong to the stage.
    let mut window = bent();
    assert!(window.is_proved(), "{}", window.verdict());
    window.key(Key::H);
    let flipped = |window: &Window| window.editor().plane.hull_scene().expect("shown").flipped_count();
    assert_eq!(flipped(&window), 3);
    window.click("Solved");
    assert_eq!(flipped(&window), 0);
}

#[test]
fn pins_are_not_dragged_in_a_stage_before_the_result() {
    let mut window = bent();
    let pin = |window: &Window| window.controls().iter().any(|(_, name, _)| name.starts_with("Gauge pin"));
    assert!(pin(&window));
    window.key(Key::H);
    assert!(!pin(&window));
    window.click("Peeled");
    assert!(pin(&window));
}

#[test]
fn a_vertex_is_picked_where_the_stage_shows_it() {
    let mut window = bent();
    window.key(Key::H);
    window.click("Before");
    let boundary = window.editor().session.model().expect("open").disk().expect("a disk").boundary_loop()[7];
    let at = window.place_in_plane(positions(&window)[boundary.index()]);
    window.click_at(at, egui::Modifiers::NONE);
    assert_eq!(*window.editor().selection.vertices(), [boundary].into());
}

#[test]
fn the_camera_comes_back_where_the_stages_needed_more_room() {
    let mut window = bent();
    // Zooms in beyond the whole hull.
    let camera = window.editor_mut().plane.pane.camera_mut().expect("framed");
    camera.zoom_at(DVec2::splat(100.0), 1.5, DVec2::splat(400.0));
    let before = *camera;
    window.key(Key::H);
    assert_ne!(window.editor().plane.pane.camera(), Some(before), "all of the hull is framed");
    window.key(Key::H);
    assert_eq!(window.editor().plane.pane.camera(), Some(before));
    // If the user moved the camera in between, it stays.
    window.key(Key::H);
    window.editor_mut().plane.pane.camera_mut().expect("framed").pan(DVec2::splat(10.0));
    let moved = window.editor().plane.pane.camera();
    window.key(Key::H);
    assert_eq!(window.editor().plane.pane.camera(), moved);
}

#[test]
fn a_step_without_a_virtual_boundary_says_so_and_shows_its_hull() {
    let mut window = Window::with_example(Example::Ell);
    window.key(Key::H);
    assert!(!has_stages(&window) && !window.has_button("Pockets"), "{:?}", window.words());
    assert_message("hull-window-no-virtual-boundary", &caption(&window));
    assert_eq!(positions(&window), window.embedding());
}

#[test]
fn another_step_shows_its_own_hull() {
    let mut window = bent();
    window.key(Key::H);
    window.choose("Method", "Natural boundary");
    let natural = caption(&window);
    assert!(!has_stages(&window), "{natural}");
    window.choose("Method", "Virtual boundary");
    assert!(has_stages(&window) && window.has_button("Pockets"));
    assert_ne!(caption(&window), natural);
}

#[test]
fn another_mesh_has_another_hull() {
    let mut window = bent();
    window.key(Key::H);
    let path = window.path("sheet.obj");
    crate::harness::write_obj(&path, &sheet(6, 0.0));
    let before = caption(&window);
    window.open(&path);
    assert!(!has_stages(&window), "{:?}", window.words());
    assert_ne!(caption(&window), before);
}

#[test]
fn lee_s_padding_shows_up_to_its_outermost_ring() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.choose("Method", "Lee's virtual boundary");
    window.key(Key::H);
    // Two layers around 24 vertices.
    let caption = caption(&window);
    assert!(caption.starts_with("96 "), "{caption}");
    assert_message("hull-window-caption-of-layers", &caption);
}

#[test]
fn a_convex_boundary_says_that_all_of_it_is_pinned() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.choose("Method", "Convex boundary");
    window.key(Key::H);
    let caption = caption(&window);
    assert!(caption.starts_with("24 of 24 "), "{caption}");
    assert_message("hull-window-caption-of-a-convex-boundary", &caption);
}
