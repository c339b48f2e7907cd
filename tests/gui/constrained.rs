//! Last stages of the flattener in the window: pill and steps, the scaffold on H, relaxation, conflicts, the
//! question about mirrored targets.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use eframe::egui;
use egui::Key;
use egui::accesskit::{Role, Toggled};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use freebound::session::{Action, StopConditions};
use freebound::ui::Tab;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::{Family, Method, Settings, Stage};
use freebound_io::StepReport;
use glam::DVec2;

use crate::harness::{Pill, Window, sheet};
use crate::timeline::step_count;
use freebound_testkit::assert_message;

fn window() -> Window {
    Window::with_mesh("sheet.obj", &sheet(8, 0.4))
}

/// Pins vertices at targets.
pub(crate) fn place(window: &mut Window, pins: &[(u32, [f64; 2])]) {
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
pub(crate) const TURNED: [(u32, [f64; 2]); 3] = [(30, [0.4, 0.4]), (31, [0.4, 0.6]), (40, [0.6, 0.4])];

/// True if the embedding on the screen was relaxed, and is proved.
fn is_relaxed(window: &Window) -> bool {
    window.is_proved() && window.outcome().step.candidate.stage == Stage::Relax
}

fn twisted() -> Window {
    let mut window = window();
    place(&mut window, &TWIST);
    window
}

#[test]
fn the_pill_names_the_rung_that_the_picture_comes_from() {
    let mut window = twisted();
    assert!(is_relaxed(&window), "{}", window.verdict());
    assert_message("constrained-window-verdict-of-relaxing", &window.verdict());
    let controls = window.controls();
    let has_chip = |record: &StepReport| {
        let start = format!("Step {}: ", record.index);
        controls.iter().any(|(_, name, _)| name.starts_with(&start))
    };
    let is_of_continuation = |record: &&StepReport| record.stage == Stage::Continuation && record.planar;
    let records = window.editor().session.timeline().records();
    assert!(records.iter().filter(is_of_continuation).any(has_chip), "{controls:?}");
    assert!(window.shows("Distance"), "its curve: {:?}", window.words());
    window.key(Key::Home);
    assert_eq!(window.pill(), Pill::Bad, "the linear solve: {}", window.verdict());
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
    assert_eq!((window.pill(), window.numbers_of_verdict()), (Pill::Unmet, vec![unmet.len()]));
    assert_message("constrained-window-verdict-of-unmet-constraints", &window.verdict());
    window.click("Pins 8");
    let state = |vertex: &VertexId| {
        let start = format!("State of pin {vertex}: ");
        window.name_of(Role::Button, &start)[start.len()..].to_owned()
    };
    let states: BTreeSet<String> = unmet.iter().map(state).collect();
    assert_message("constrained-window-state-of-unmet-pins", &states.iter().cloned().collect::<Vec<_>>().join("\n"));
    let mut met = window.editor().session.document().targets.keys().filter(|vertex| !unmet.contains(vertex));
    assert!(met.all(|vertex| !states.contains(&state(vertex))), "{states:?}");
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
    let caption = window.editor().plane.hull_scene().expect("shown").caption.clone();
    assert!(window.shows(&caption), "{:?}", window.words());
    assert!(caption.starts_with(&format!("{} ", outside.triangles.len())), "{caption}");
    assert_message("constrained-window-caption-of-the-outside", &caption);
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
    assert!(relaxed > count && is_relaxed(&window), "{}", window.verdict());
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
    assert_eq!(window.editor().session.conflicts().len(), 1);
    assert_message("constrained-window-conflict", &window.text_with("needs"));
    window.key(Key::F);
    let target = window.editor().pins_shown()[0].target;
    assert!(window.has_ring_at(window.place_in_plane(target)), "a mark on the pin");
}

#[test]
fn mirrored_targets_are_asked_about() {
    let mut window = window();
    window.choose("Method", "Natural boundary");
    let mirrored = [(0, [1.0, 0.0]), (8, [0.0, 0.05]), (72, [0.95, 1.0]), (80, [0.0, 1.0])];
    let asks = |window: &Window| window.has_button("Mirror them");
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
    assert!(window.editor().session.targets_look_mirrored());
    assert_message("constrained-window-mirrored-targets", &window.text_with("mirrored"));
    window.click("Mirror them");
    assert!(!asks(&window));
    window.press(egui::Modifiers::COMMAND, Key::Z);
    wait(&mut window);
    window.click("Leave the targets");
    assert!(!asks(&window));
}
