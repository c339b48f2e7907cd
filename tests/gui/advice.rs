//! Advice beside the verdict: a single button in the accent's colour.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use freebound::examples::Example;
use freebound::session::Action;
use freebound::ui::theme;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::{Method, Settings};
use glam::DVec2;

use crate::defects::fold;
use crate::harness::{Pill, Window, sheet};
use freebound_testkit::{assert_message, tower};

/// First word of the button that offers to relax.
const OF_AREAS: &str = "Areas ";

/// Number of areas in the accent's colour in the last frame.
fn accents(window: &Window) -> usize {
    let accents = [theme::LIGHT.accent, theme::DARK.accent];
    let is_accented = |shape: &egui::Shape| matches!(shape, egui::Shape::Rect(rect) if accents.contains(&rect.fill));
    let shapes = &window.harness.output().shapes;
    shapes.iter().filter(|shape| is_accented(&shape.shape)).count()
}

#[test]
fn repair_is_the_one_blue_button_while_the_embedding_is_at_fault() {
    let mut window = Window::with_example(Example::Face);
    assert_eq!((accents(&window), window.has_button("Repair")), (0, false), "the ladder has repaired it");
    window.choose("Method", "Natural boundary");
    assert_eq!(window.pill(), Pill::Bad, "{}", window.verdict());
    assert_eq!((accents(&window), window.has_button("Repair")), (1, true));
    window.click("Repair");
    assert!(window.is_proved(), "{}", window.verdict());
    assert_eq!(window.editor().session.document().settings.method, Method::Auto);
    assert_eq!((accents(&window), window.has_button("Repair")), (0, false));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.editor().session.document().settings.method, Method::Natural, "an edit like any other");
}

#[test]
fn repair_is_in_sight_in_the_least_window() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    fold(&mut window);
    window.harness.set_size(egui::vec2(640.0, 420.0));
    window.settle();
    let rect = window.rect(Role::Button, "Repair");
    assert!(rect.left() > 0.0 && rect.right() < 640.0 && rect.bottom() <= 30.0, "{rect:?}");
}

#[test]
fn a_planar_embedding_with_areas_that_differ_badly_offers_to_relax() {
    let mut window = Window::with_mesh("tower.obj", &tower());
    // The automatic strategy would relax by itself.
    window.choose("Method", "Convex boundary");
    window.choose("Weights", "Uniform");
    assert!(window.is_proved(), "{}", window.verdict());
    let before = window.outcome().distortion.summary.area.max;
    assert!(before >= 100.0, "{before}");
    assert_eq!(accents(&window), 0, "nothing is at fault");
    let button = window.name_of(Role::Button, OF_AREAS);
    assert_message("advice-window-areas-differ", &button);
    window.click(&button);
    assert!(window.is_proved() && window.outcome().distortion.summary.area.max < before);
}

#[test]
fn a_good_embedding_has_no_advice() {
    let window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let offers_to_relax = window.controls().iter().any(|(_, name, _)| name.starts_with(OF_AREAS));
    assert!(!offers_to_relax && !window.has_button("Repair"));
}

/// Square of a single polygon, with its corners pinned so that it is concave.
fn concave() -> Window {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("square.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n").expect("written");
    let mut window = Window::with_file(&path);
    window.editor_mut().session.handle(Action::SetSettings(Settings { new_vertices: false, ..Settings::default() }));
    for (vertex, u, v) in [(0, 0.7, 0.7), (1, 1.0, 0.0), (2, 1.0, 1.0), (3, 0.0, 1.0)] {
        let (vertex, target) = (VertexId::new(vertex), Target::hard(DVec2::new(u, v)));
        window.editor_mut().session.handle(Action::Place { vertex, target });
    }
    window.settle();
    window
}

#[test]
fn where_the_ladder_has_no_step_left_it_is_said_what_can_still_be_changed() {
    let mut window = concave();
    assert!(!window.outcome().step.verdict.planar, "one cut of the square folds it");
    assert!(!window.has_button("Repair"), "all steps were taken");
    assert_eq!(accents(&window), 1);
    window.click("Allow new vertices");
    assert!(window.is_proved(), "{}", window.verdict());
    assert_eq!((accents(&window), window.has_button("Repair")), (0, false));
}

#[test]
fn where_constraints_are_not_met_without_new_vertices_these_are_offered() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.0));
    window.editor_mut().session.handle(Action::SetSettings(Settings { new_vertices: false, ..Settings::default() }));
    // Vertices, and vertices whose positions are their targets: too many that block each other.
    for (vertex, place) in [(28, 12), (39, 28), (40, 40), (20, 67), (24, 39), (12, 24), (15, 15), (67, 20)] {
        let at = DVec2::new(f64::from(place % 9), f64::from(place / 9)) / 8.0;
        window.editor_mut().session.handle(Action::Place { vertex: VertexId::new(vertex), target: Target::hard(at) });
    }
    window.settle();
    assert_eq!(window.pill(), Pill::Unmet, "{}", window.verdict());
    assert_eq!(accents(&window), 1);
    window.click("Allow new vertices");
    assert!(window.is_proved() && window.outcome().new_vertex_count() > 0, "{}", window.verdict());
    assert_eq!((accents(&window), window.has_button("Allow new vertices")), (0, false));
}

#[test]
fn an_older_step_at_fault_gets_no_advice_once_the_run_has_ended_planar() {
    let mut window = Window::with_example(Example::Face);
    assert!(window.is_proved(), "{}", window.verdict());
    window.key(Key::Home);
    assert!(!window.is_proved(), "the first step folds");
    assert_eq!(accents(&window), 0, "{:?}", window.words());
    for words in ["Free a pin", "Other weights", "Allow new vertices"] {
        assert!(!window.has_button(words), "{words}");
    }
}
