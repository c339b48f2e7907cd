//! Last stages of the flattener in the window: pill and steps, the scaffold on H, relaxation, conflicts, the
//! question about mirrored targets.

use std::time::{Duration, Instant};

use eframe::egui;
use egui::Key;
use egui::accesskit::{Role, Toggled};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use freebound::session::{Action, StopConditions};
use freebound::ui::Tab;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::{Family, Method, Settings};
use glam::DVec2;

use crate::harness::{Window, sheet};
use crate::timeline::step_count;

fn window() -> Window {
    Window::with_mesh("sheet.obj", &sheet(8, 0.4))
}

fn place(window: &mut Window, pins: &[(u32, [f64; 2])]) {
    for &(vertex, target) in pins {
        let pin = Target::hard(DVec2::from(target));
        window.editor_mut().session.handle(Action::Place { vertex: VertexId::new(vertex), target: pin });
    }
    window.settle();
}

/// Targets of the sheet's corners at those of the unit square, and four vertices around its middle rotated by a
/// quarter turn.
const TWIST: [(u32, [f64; 2]); 8] = [
    (0, [0.0, 0.0]),
    (8, [1.0, 0.0]),
    (72, [0.0, 1.0]),
    (80, [1.0, 1.0]),
    (30, [0.625, 0.375]),
    (32, [0.625, 0.625]),
    (48, [0.375, 0.375]),
    (50, [0.375, 0.625]),
];

/// Corners of a face, with targets that flip it.
const TURNED: [(u32, [f64; 2]); 3] = [(30, [0.4, 0.4]), (31, [0.4, 0.6]), (40, [0.6, 0.4])];

fn twisted() -> Window {
    let mut window = window();
    place(&mut window, &TWIST);
    window
}

#[test]
fn the_pill_names_the_rung_that_the_picture_comes_from() {
    let mut window = twisted();
    assert_eq!(window.verdict(), "Planar: proved · relaxed");
    assert!(window.controls().iter().any(|(_, name, _)| name.ends_with(": continuation, planar")));
    assert!(window.shows("Distance left"), "its curve: {:?}", window.words());
    window.key(Key::Home);
    assert!(window.verdict().contains("flipped"), "the linear solve: {}", window.verdict());
}

#[test]
fn a_planar_step_with_constraints_not_met_says_so_and_marks_them() {
    let mut window = window();
    let at_step = |index| Action::SetStop(StopConditions { at_step: Some(index), ..StopConditions::default() });
    window.editor_mut().session.handle(at_step(0));
    let settings = Settings::new(Method::Continuation, Family::Conformal);
    // Turning the faces twice discards the earlier planar start.
    for action in [Action::SetSettings(settings), Action::TurnFaces, Action::TurnFaces] {
        window.editor_mut().session.handle(action);
        window.settle();
    }
    place(&mut window, &TWIST);
    assert_eq!(window.outcome().step.unmet().len(), TWIST.len(), "without the constraints first");
    window.editor_mut().session.handle(at_step(1));
    window.editor_mut().session.handle(Action::Run);
    window.settle();
    let unmet = window.outcome().step.unmet();
    assert!(step_count(&window) == 2 && !unmet.is_empty(), "the planar start");
    assert_eq!(window.verdict(), format!("Planar, constraints not met: {} · continuation", unmet.len()));
    window.click("Pins 8");
    assert_eq!(window.words().iter().filter(|words| *words == "not met").count(), unmet.len());
    let place = window.place_in_plane(window.embedding()[unmet[0].index()]);
    assert!(window.has_ring_at(place), "{unmet:?}");
    let pill = format!("Verdict: {}", window.verdict());
    window.click(&pill);
    assert!(window.editor().selection.vertices().iter().eq(&unmet), "a click shows them");
}

#[test]
fn h_shows_the_outside_that_keeps_the_boundary_simple() {
    let mut window = twisted();
    let outside = window.outcome().step.candidate.outside.clone().expect("a continuation has one");
    window.key(Key::H);
    let caption = format!("{} triangles between mesh and frame", outside.triangles.len());
    assert!(window.shows(&caption), "{:?}", window.words());
    let drawn = window.editor().plane.drawn().expect("solved").positions().to_vec();
    let embedding = window.embedding();
    assert_eq!(drawn[..embedding.len()], *embedding);
    assert_eq!(drawn[embedding.len()..], outside.frame);
    assert!(window.controls().iter().any(|(_, name, _)| name.starts_with("Constraint v30")), "pins can be dragged");
    window.key(Key::H);
    assert!(!window.shows(&caption));
}

#[test]
fn relax_is_a_button_a_key_and_an_entry() {
    let mut window = twisted();
    let count = step_count(&window);
    window.click("Relax");
    let relaxed = step_count(&window);
    assert!(relaxed > count);
    assert_eq!(window.verdict(), "Planar: proved · relaxed");
    window.key(Key::R);
    window.menu(&["Solve"]);
    assert!(window.has_button("Relax"));
    window.key(Key::Escape);
    window.choose("Method", "Natural boundary");
    assert!(!window.outcome().step.verdict.planar && !window.is_enabled("Relax"));
}

#[test]
fn new_vertices_are_allowed_by_a_box() {
    let mut window = window();
    let allowed = |window: &Window| {
        let state =
            window.harness.get_by_role_and_label(Role::CheckBox, "Allow new vertices").accesskit_node().toggled();
        assert_eq!(state == Some(Toggled::True), window.editor().session.document().settings.new_vertices);
        state == Some(Toggled::True)
    };
    assert!(allowed(&window));
    window.harness.get_by_role_and_label(Role::CheckBox, "Allow new vertices").click();
    window.settle();
    assert!(!allowed(&window));
    window.choose("Method", "Natural boundary");
    assert!(window.harness.query_by_label("Allow new vertices").is_none(), "one linear solve makes none");
}

#[test]
fn a_constraint_that_needs_new_vertices_is_marked() {
    let mut window = window();
    window.choose("Method", "Natural boundary");
    place(&mut window, &TURNED);
    window.editor_mut().layout.show_tab(Tab::Pins);
    window.settle();
    assert_eq!(window.words().iter().filter(|words| *words == "conflict").count(), 3);
    assert!(window.shows("1 conflict needs new vertices"));
    window.key(Key::F);
    let target = window.editor().pins_shown()[0].target;
    assert!(window.has_ring_at(window.place_in_plane(target)), "a mark on the pin");
}

#[test]
fn mirrored_targets_are_asked_about() {
    let mut window = window();
    window.choose("Method", "Natural boundary");
    let mirrored = [(0, [1.0, 0.0]), (8, [0.0, 0.05]), (72, [0.95, 1.0]), (80, [0.0, 1.0])];
    let asks = |window: &Window| window.shows("Are the targets mirrored?");
    let wait = |window: &mut Window| {
        let begun = Instant::now();
        while !asks(window) {
            assert!(begun.elapsed() < Duration::from_secs(90), "{:?}", window.words());
            std::thread::sleep(Duration::from_millis(1));
            window.step();
        }
    };
    place(&mut window, &mirrored);
    wait(&mut window);
    window.click("Mirror them");
    assert!(!asks(&window));
    window.press(egui::Modifiers::COMMAND, Key::Z);
    wait(&mut window);
    window.click("Leave the targets");
    assert!(!asks(&window));
}
