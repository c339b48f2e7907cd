//! Comparison of steps: the animation between them, the outline of one over the other, and the distance that faces
//! moved.

use eframe::egui;
use egui::Key;
use freebound::examples::Example;
use freebound::session::Action;
use freebound::ui::{HullStage, Pane, ShadingMode};
use freebound_core::mesh::VertexId;
use freebound_core::problem::{Embedding, Method, Settings};
use glam::DVec2;

use crate::harness::{Window, sheet};
use freebound_testkit::assert_message;

/// The built-in face after its first iteration: two steps, with the second shown.
fn two_steps() -> Window {
    let mut window = Window::with_example(Example::Face);
    let settings = Settings { method: Method::Iterate, ..Settings::default() };
    window.editor_mut().session.handle(Action::SetSettings(settings));
    window.settle();
    while window.editor().session.timeline().records().len() < 2 {
        window.key(Key::Space);
    }
    window.editor_mut().session.handle(Action::ShowStep(1));
    window.settle();
    window
}

fn drawn(window: &Window) -> Embedding {
    window.editor().plane.drawn().expect("solved").positions().clone()
}

/// Runs frames until vertices are animated, or for half a second.
fn step_until_easing(window: &mut Window) -> bool {
    for _ in 0..500 {
        window.step();
        if window.editor().plane.is_easing() {
            return true;
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    false
}

/// Largest distance between corresponding vertices of two embeddings.
fn gap(a: &[DVec2], b: &[DVec2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

#[test]
fn vertices_glide_from_step_to_step() {
    let mut window = two_steps();
    let last = window.embedding();
    window.key_now(Key::ArrowLeft);
    assert!(step_until_easing(&mut window));
    let first = window.embedding();
    let whole = gap(&first, &last);
    let mut left = whole;
    let mut frames = 0;
    while window.editor().plane.is_easing() {
        let now = gap(&drawn(&window), &first);
        assert!(now <= left + 1e-12 && now < whole + 1e-12, "{now} after {left}");
        (left, frames) = (now, frames + 1);
        window.step();
    }
    assert!((8..=20).contains(&frames), "a quarter of a second at 60 frames a second: {frames}");
    assert_eq!(drawn(&window), first);
}

#[test]
fn who_wants_no_motion_gets_none() {
    let mut window = two_steps();
    window.menu(&["View", "Show", "Animate changes of step"]);
    window.key_now(Key::ArrowLeft);
    assert!(!step_until_easing(&mut window));
    assert_eq!(window.editor().session.timeline().shown(), Some(0));
    assert_eq!(drawn(&window), window.embedding());
}

/// True if the whole embedding lies within its pane.
fn all_shows(window: &Window) -> bool {
    let view = window.plane_view();
    window.embedding().iter().all(|&z| view.contains(window.place_in_plane(z)))
}

#[test]
fn the_camera_goes_along_with_an_embedding_that_would_leave_the_pane() {
    for wanted in [true, false] {
        let mut window = two_steps();
        window.editor_mut().pane_shading.glides = wanted;
        window.key(Key::ArrowLeft);
        window.key(Key::F);
        window.settle();
        assert!(all_shows(&window));
        window.key(Key::ArrowRight);
        assert!(all_shows(&window), "with ease: {wanted}");
    }
}

#[test]
fn a_camera_that_somebody_moved_stays() {
    let mut window = two_steps();
    window.key(Key::ArrowLeft);
    window.editor_mut().plane.pane.camera_mut().expect("framed").pan(DVec2::splat(150.0));
    let camera = window.editor().plane.pane.camera();
    window.key(Key::ArrowRight);
    assert_eq!(window.editor().plane.pane.camera(), camera);
    window.harness.set_size(egui::vec2(900.0, 700.0));
    window.settle();
    assert_eq!(window.editor().plane.pane.camera(), camera);
}

#[test]
fn an_embedding_that_was_framed_stays_framed_when_the_pane_changes() {
    let mut window = two_steps();
    window.key(Key::F);
    window.harness.set_size(egui::vec2(700.0, 500.0));
    window.settle();
    assert!(all_shows(&window));
    window.harness.set_size(egui::vec2(1800.0, 1100.0));
    window.settle();
    let width = window.plane_view().size();
    let bounds = window.editor().plane.drawn().expect("solved").arrays.bounds;
    let shown = window.place_in_plane(bounds.high) - window.place_in_plane(bounds.low);
    assert!((shown.x / width.x).max(-shown.y / width.y) > 0.85, "it fills the pane: {shown} of {width}");
}

#[test]
fn a_dragged_pin_is_followed_without_delay() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let corner = VertexId::new(0);
    window.editor_mut().session.handle(Action::Fix(vec![corner, VertexId::new(6)]));
    window.settle();
    let target = window.embedding()[0] + 0.1;
    window.editor_mut().session.handle(Action::MovePin { vertex: corner, target });
    assert!(!step_until_easing(&mut window), "other pins are another run");
    window.editor_mut().session.handle(Action::EndGesture);
    window.settle();
}

#[test]
fn the_outline_of_the_compared_step_shows_and_goes() {
    let mut window = two_steps();
    window.editor_mut().session.handle(Action::Compare(Some(0)));
    window.settle();
    assert_eq!(window.editor().plane.ghost_step(), Some(0));
    assert_message("compare-window-outline", &window.text_with("Outline"));
    window.key(Key::ArrowLeft);
    assert_eq!(window.editor().plane.ghost_step(), None, "a step is not compared with itself");
    window.key(Key::ArrowRight);
    assert_eq!(window.editor().plane.ghost_step(), Some(0));
    window.editor_mut().session.handle(Action::Compare(None));
    window.settle();
    assert_eq!(window.editor().plane.ghost_step(), None);
    assert!(!window.shows("Outline"));
}

#[test]
fn moves_are_measured_from_the_compared_step_or_else_from_the_one_before() {
    let mut window = two_steps();
    let base = |window: &Window| window.editor().plane.moved_from(&window.editor().session).map(|base| base.step.index);
    window.key(Key::Num7);
    assert_eq!(base(&window), Some(0));
    assert_message("compare-window-moved-from-the-step-before", &window.text_with("Move "));
    let legend = window.editor().pane_shading.paint(Pane::Mesh).expect("painted").legend.clone().expect("a legend");
    assert!(legend.range.low.abs() < f64::EPSILON && legend.range.high > 0.0);
    let max_move = window.outcome().step.max_move.expect("not the first");
    assert!(legend.range.high <= max_move, "{:?} is at most {max_move}", legend.range);

    window.key(Key::ArrowLeft);
    assert!(window.editor().pane_shading.paint(Pane::Mesh).expect("painted").legend.is_none(), "nothing comes before");
    assert_message("compare-window-nothing-has-moved", &window.text_with("movement"));
    window.editor_mut().session.handle(Action::Compare(Some(1)));
    window.settle();
    assert_eq!(base(&window), Some(1));
    assert_message("compare-window-moved-from-the-compared-step", &window.text_with("Move "));
}

#[test]
fn the_stages_of_a_virtual_boundary_show_no_outline_of_another_step() {
    let mut window = Window::with_example(Example::Face);
    window.choose("Method", "Virtual boundary");
    window.editor_mut().session.handle(Action::Compare(Some(0)));
    window.settle();
    assert!(window.shows("Outline"));
    window.key(Key::H);
    assert_eq!(window.editor().plane.stage(), HullStage::Pockets);
    assert!(!window.shows("Outline"));
}

#[test]
fn move_is_one_of_the_shadings() {
    let mut window = two_steps();
    window.choose("Shading of the mesh", "Move");
    assert_eq!(window.shadings(), [ShadingMode::Move, ShadingMode::Checker]);
    window.menu(&["View", "Shading of the mesh", "Checker"]);
    window.menu(&["View", "Shading of the embedding", "Move"]);
    assert_eq!(window.shadings(), [ShadingMode::Checker, ShadingMode::Move]);
}

#[test]
fn the_cross_of_the_legend_ends_the_comparison() {
    let mut window = two_steps();
    window.editor_mut().session.handle(Action::Compare(Some(0)));
    window.settle();
    window.click("Stop comparing");
    assert_eq!(window.editor().session.timeline().compared(), None);
    assert!(!window.has_button("Stop comparing") && !window.shows("Outline"));
}

#[test]
fn the_panel_shows_the_numbers_of_both_steps_and_their_difference() {
    let mut window = two_steps();
    assert!(!window.shows("Compared"));
    window.editor_mut().session.handle(Action::Compare(Some(0)));
    window.settle();
    assert!(window.shows("step 0") && window.shows("step 1"), "{:?}", window.words());
    let timeline = window.editor().session.timeline();
    let [before, now] = [0, 1].map(|step| timeline.outcome(step).expect("kept").distortion.summary.angle.mean);
    let words = window.words().iter().map(|words| words.trim().to_owned()).collect::<Vec<_>>();
    for value in [format!("{before:.3}"), format!("{now:.3}")] {
        assert!(words.contains(&value), "{value} in {words:?}");
    }
    let difference = now - before;
    let is_it =
        |word: &String| word.parse::<f64>().is_ok_and(|number| (number - difference).abs() <= 5e-4 * difference.abs());
    assert!(words.iter().any(is_it), "{difference} in {words:?}");
}

#[test]
fn the_numbers_of_a_comparison_are_those_of_the_sheet_that_is_drawn() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    for _ in 0..2 {
        window.editor_mut().session.handle(Action::Step);
        window.settle();
    }
    window.editor_mut().session.handle(Action::Compare(Some(0)));
    window.settle();
    window.key_now(Key::ArrowLeft);
    assert!(step_until_easing(&mut window));
    let heads = |window: &Window| window.words().iter().filter(|words| words.trim() == "step 2").count();
    while window.editor().plane.is_easing() {
        assert_eq!(heads(&window), 1, "{:?}", window.words());
        window.step();
    }
    window.settle();
    assert!(heads(&window) == 0 && window.words().iter().any(|words| words.trim() == "step 1"));
}
