//! Unwrapping in the window: a mesh that opens closed, the slider, the brush, and the seam under the pointer.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use freebound::examples::Example;
use freebound::session::{Action, FirstMapWork, MapOrigin};
use freebound::ui::{Request, Tab, Tool};
use freebound_core::mesh::{Seams, TriMesh, VertexId};
use freebound_testkit::{assert_message, bumpy_ball};

use crate::harness::Window;

fn ball() -> TriMesh {
    bumpy_ball().triangulate()
}

fn window() -> Window {
    Window::with_mesh("ball.obj", &ball())
}

/// Automatic seams that the mesh is cut along.
fn seams(window: &Window) -> Vec<[VertexId; 2]> {
    window.editor().session.seams().automatic().iter().copied().collect()
}

fn energy(window: &Window) -> f64 {
    window.outcome().distortion.summary.symmetric_dirichlet.mean
}

#[test]
fn a_closed_mesh_opens_unwrapped_with_little_distortion_and_nothing_to_save() {
    let mut window = window();
    assert!(window.is_proved(), "{}", window.verdict());
    assert!(energy(&window) <= 4.1 && !seams(&window).is_empty());
    assert!(!window.editor().session.has_unsaved_work());
    assert_message("unwrapping-window-note", &window.text_with("nwrapped"));
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(window.is_faulty() && seams(&window).is_empty(), "{}", window.verdict());
    window.key(Key::U);
    assert!(window.is_proved() && !seams(&window).is_empty(), "{}", window.verdict());
}

/// Bumpy ball with two holes: the fans of two vertices are missing.
fn scan() -> TriMesh {
    let mut mesh = ball();
    let holes = [3, mesh.positions.len() / 2];
    mesh.triangles.retain(|corners| !corners.iter().any(|v| holes.contains(&v.index())));
    TriMesh { polygon_of: None, ..mesh }
}

#[test]
fn a_mesh_with_holes_opens_unwrapped_and_undo_shows_it_with_filled_holes() {
    let mut window = Window::with_mesh("scan.obj", &scan());
    assert!(window.is_proved() && energy(&window) <= 4.1, "{}", window.verdict());
    assert!(!window.editor().session.has_unsaved_work());
    let edges = window.editor().session.automatic_seams().expect("unwrapped").edges().len();
    assert_eq!(window.editor().session.map_origin(), Some(MapOrigin::AutomaticSeams(edges)));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.editor().session.map_origin(), Some(MapOrigin::Plain));
    assert!(window.is_proved() && energy(&window) > 4.1, "{}", energy(&window));
}

#[test]
fn a_distorted_disk_opens_as_it_is_and_a_button_unwraps_it() {
    let mut window = Window::with_mesh("cap.obj", &Example::BumpyCap.mesh());
    assert_eq!(window.editor().session.map_origin(), Some(MapOrigin::Plain));
    assert!(window.is_proved() && energy(&window) > 4.1);
    while window.has_button("Relax (R)") || !window.has_button("Unwrap (U)") {
        window.key(Key::R);
    }
    window.click("Unwrap (U)");
    assert!(window.is_proved() && energy(&window) <= 4.1, "{}", energy(&window));
}

#[test]
fn stopping_the_search_of_a_mesh_with_holes_solves_it_as_it_is() {
    let mut window = Window::with_mesh("scan.obj", &scan());
    let path = window.path("scan.obj");
    window.editor_mut().session.handle(Action::Open(path));
    let is_searching = |window: &Window| window.editor().session.first_map_work() == Some(FirstMapWork::Seams);
    while !is_searching(&window) {
        window.step();
    }
    window.editor_mut().session.handle(Action::Cancel);
    window.settle();
    assert_eq!(window.editor().session.map_origin(), Some(MapOrigin::Plain));
    assert!(window.is_proved() && energy(&window) > 4.1, "{}", window.verdict());
}

#[test]
fn unwrap_during_the_search_of_an_opened_mesh_and_stop_solve_it_as_it_is() {
    let mut window = Window::with_mesh("scan.obj", &scan());
    let path = window.path("scan.obj");
    window.editor_mut().session.handle(Action::Open(path));
    while window.editor().session.first_map_work() != Some(FirstMapWork::Seams) {
        window.step();
    }
    for action in [Action::Unwrap(None), Action::Cancel] {
        window.editor_mut().session.handle(action);
    }
    window.settle();
    assert_eq!(window.editor().session.map_origin(), Some(MapOrigin::Plain));
    assert!(window.is_proved(), "{}", window.verdict());
}

#[test]
fn seams_that_a_person_draws_are_told_apart_from_a_mesh_without_seams() {
    let mut window = Window::with_mesh("sheet.obj", &crate::harness::sheet(6, 0.3));
    assert_eq!(window.editor().session.map_origin(), Some(MapOrigin::Plain));
    let edge = [VertexId::new(0), VertexId::new(8)];
    window.editor_mut().session.handle(Action::SetSeams(Seams::default().with([edge])));
    window.settle();
    assert_eq!(window.editor().session.map_origin(), Some(MapOrigin::ChosenSeams));
}

#[test]
fn the_slider_trades_seams_for_distortion_in_one_edit_and_undo_returns() {
    let mut window = window();
    window.click("Charts");
    let (before, map) = (seams(&window), window.embedding());
    window.fill_in(Role::SpinButton, "Bound on the distortion", "4.5");
    window.settle();
    assert_eq!(window.editor().session.seams().bound(), Some(4.5));
    assert!(window.is_proved(), "{}", window.verdict());
    assert!(seams(&window).len() < before.len(), "{} of {}", seams(&window).len(), before.len());
    assert!(energy(&window) > 4.1 && energy(&window) <= 4.5, "{}", energy(&window));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!((seams(&window), window.embedding()), (before, map));
}

#[test]
fn a_moving_slider_shows_the_seams_to_be_and_cuts_nothing() {
    let mut window = window();
    let before = seams(&window);
    window.editor_mut().session.handle(Action::PreviewSeams(Some(4.5)));
    window.settle();
    assert_eq!(seams(&window), before);
    let shown = window.editor().session.seams_to_be().expect("seams that the mesh is not cut along");
    assert!(shown.len() < before.len());
    window.editor_mut().session.handle(Action::Unwrap(Some(4.5)));
    window.settle();
    assert_eq!(seams(&window), shown);
    assert!(window.editor().session.seams_to_be().is_none());
}

#[test]
fn seams_move_away_from_paint_and_return_when_it_is_taken_away() {
    let mut window = window();
    window.key(Key::X);
    window.click("Keep whole");
    let before = seams(&window);
    let painted: Vec<[VertexId; 2]> = before[..before.len() / 3].to_vec();
    window.editor_mut().session.handle(Action::PaintSeams { edges: painted.clone(), cost: 1000.0 });
    window.settle();
    assert!(seams(&window).iter().all(|edge| !painted.contains(edge)));
    assert!(window.is_proved() && energy(&window) <= 4.1, "{}", window.verdict());
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(seams(&window), before);
    assert!(window.editor().session.seams().costs().is_empty(), "paint and cut are one edit");
}

#[test]
fn a_drag_over_the_mesh_paints_and_a_drag_beside_it_orbits() {
    let mut window = window();
    window.key(Key::X);
    window.click("Keep whole");
    let (middle, camera) = (window.mesh_view().center(), window.editor().mesh.pane.camera());
    window.drag(middle, middle + egui::vec2(20.0, 0.0), Modifiers::NONE);
    window.settle();
    assert!(!window.editor().session.seams().costs().is_empty());
    assert_eq!(window.editor().mesh.pane.camera(), camera);
    let costs = window.editor().session.seams().costs().clone();
    let corner = window.mesh_view().left_bottom() + egui::vec2(12.0, -12.0);
    window.drag(corner, corner + egui::vec2(40.0, 0.0), Modifiers::NONE);
    window.settle();
    assert_eq!(*window.editor().session.seams().costs(), costs);
    assert_ne!(window.editor().mesh.pane.camera(), camera);
    window.click("Erase");
    window.drag(corner + egui::vec2(40.0, 0.0), corner, Modifiers::NONE);
    window.drag(middle, middle + egui::vec2(20.0, 0.0), Modifiers::NONE);
    window.settle();
    assert!(window.editor().session.seams().costs().len() < costs.len());
}

#[test]
fn the_seam_under_the_pointer_shows_on_both_of_its_sides() {
    let mut window = window();
    let model = window.editor().session.model().cloned().expect("open");
    let disk = model.disk().cloned().expect("a disk");
    let end = disk.boundary_loop()[0];
    window.harness.hover_at(window.place_in_plane(window.embedding()[end]));
    window.step();
    window.step();
    let sides = window.editor().tools.seam_hover.sides().to_vec();
    assert!(sides.len() >= 2 && sides.len().is_multiple_of(2), "{sides:?}");
    let at = |side: &[VertexId; 2]| {
        let mut ends = side.map(|end| disk.position(end).to_array().map(f64::to_bits));
        ends.sort_unstable();
        ends
    };
    for side in &sides {
        let twins = sides.iter().filter(|other| at(other) == at(side)).count();
        assert_eq!(twins, 2, "each edge has two sides");
    }
    window.harness.hover_at(window.plane_view().left_top() + egui::vec2(2.0, 2.0));
    window.step();
    window.step();
    assert!(window.editor().tools.seam_hover.sides().is_empty());
}

#[test]
fn stopping_a_search_leaves_the_faults_and_their_offers() {
    let mut window = window();
    window.press(Modifiers::COMMAND, Key::Z);
    window.editor_mut().session.handle(Action::Unwrap(Some(4.0002)));
    window.step();
    assert!(window.editor().session.seam_search().is_some());
    window.editor_mut().session.handle(Action::Cancel);
    window.settle();
    assert!(window.is_faulty() && seams(&window).is_empty());
    assert!(window.has_button("Show faults") && window.has_button("Dismiss"), "{:?}", window.words());
}

#[test]
fn the_tab_of_the_charts_says_how_long_the_seams_are() {
    let mut window = window();
    window.editor_mut().handle(Request::ShowTab(Tab::Charts));
    window.settle();
    let found = window.editor().session.automatic_seams().expect("cut").clone();
    let relative = format!("({:.2} √area)", found.relative_length());
    assert!(window.words().iter().any(|words| words.ends_with(&relative)), "{:?}", window.words());
    assert!(window.shows(&found.edges().len().to_string()));
    window.editor_mut().tools.take_up(Tool::Select);
}
