//! Runs in the window: first use, run and pause, end of a run, previews, settings of the method panel.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Vec2};
use egui_kittest::kittest::Queryable;
use freebound::examples::Example;
use freebound::session::{Action, RunStop, Status, StopConditions};
use freebound_core::problem::{Family, Growth, Method, Pin, Settings, Treatment};

use crate::harness::{Pill, SIZE, Window, sheet};
use crate::timeline::{at_first_start, shown, step_count};
use freebound_testkit::assert_message;

fn stop(window: &Window) -> StopConditions {
    window.editor().session.stop_conditions()
}

#[test]
fn a_newcomer_repairs_the_first_fold_in_under_five_keys() {
    let mut window = at_first_start(SIZE);
    assert_eq!(window.pill(), Pill::Bad, "{}", window.verdict());
    assert_message("timeline-run-window-first-hint", &window.text_with("Space"));
    let mut keys = 0;
    while !window.is_proved() {
        window.key(Key::Space);
        keys += 1;
        assert!(keys < 5, "{}", window.verdict());
    }
    assert!(!window.shows("Space"), "whoever has done it need not be told");
    assert_eq!(step_count(&window), keys + 1);
}

#[test]
fn a_low_window_has_the_hint_too() {
    let mut window = at_first_start(Vec2::new(640.0, 420.0));
    assert!(!window.editor().timeline.curves_shown());
    assert!(window.shows("Space"));
    window.key(Key::Space);
    assert!(!window.shows("Space"));
}

#[test]
fn run_goes_on_until_it_is_planar() {
    let mut window = at_first_start(SIZE);
    window.click("Run");
    assert!(window.is_proved(), "{}", window.verdict());
    assert!(!window.is_enabled("Run"), "there is nothing left to run for");
    let count = step_count(&window);
    assert!(count > 1, "the first step folds");
    window.click("Step");
    assert_eq!((step_count(&window), shown(&window)), (count + 1, count), "a single step goes on all the same");

    let mut window = at_first_start(SIZE);
    window.press(Modifiers::SHIFT, Key::Space);
    assert!(window.is_proved() && step_count(&window) == count, "{}", window.verdict());
}

#[test]
fn an_embedding_that_leaves_the_pane_is_framed_anew_unless_a_detail_is_looked_at() {
    let mut window = at_first_start(SIZE);
    // A picture would be framed instead.
    for action in [Action::RemovePicture, Action::UnpinAll] {
        window.editor_mut().session.handle(action);
        window.settle();
    }
    window.key(Key::Home);
    let is_in_sight = |window: &Window| {
        let view = window.plane_view();
        window.embedding().iter().all(|point| view.contains(window.place_in_plane(*point)))
    };
    assert!(is_in_sight(&window));
    window.key(Key::ArrowRight);
    assert!(is_in_sight(&window), "the step moves the top of the face out of a view that stays");
    let mut camera = window.editor().plane.pane.camera().expect("framed");
    camera.zoom_at(window.editor().plane.pane.size() / 2.0, 4.0, window.editor().plane.pane.size());
    window.editor_mut().plane.pane.set_camera(camera);
    window.key(Key::ArrowLeft);
    assert_eq!(window.editor().plane.pane.camera(), Some(camera), "whoever looks at a detail keeps it");
}

#[test]
fn run_becomes_pause_while_it_goes_on() {
    let mut window = long_run();
    while step_count(&window) < 3 {
        window.step();
    }
    assert!(window.has_button("Pause") && !window.has_button("Run"));
    window.click("Pause");
    let paused_at = step_count(&window);
    assert!(paused_at < 100_000 && window.has_button("Run") && window.is_enabled("Run"));
    window.key(Key::Space);
    assert_eq!(step_count(&window), paused_at + 1);
}

/// Window with a long run.
fn long_run() -> Window {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    let session = &mut window.editor_mut().session;
    session.handle(Action::SetStop(StopConditions { planar: false, stalled: false, ..StopConditions::default() }));
    let settings = Settings { max_steps: Some(100_000), ..Settings::new(Method::Iterate, Family::Conformal) };
    session.handle(Action::SetSettings(settings));
    window.step();
    window
}

#[test]
fn a_key_that_is_held_down_leaves_no_steps_behind() {
    let mut window = at_first_start(SIZE);
    window.harness.key_down(Key::Space);
    window.step();
    let repeat = egui::Event::Key {
        key: Key::Space,
        physical_key: None,
        pressed: true,
        repeat: true,
        modifiers: Modifiers::NONE,
    };
    while step_count(&window) < 3 {
        window.harness.event(repeat.clone());
        window.step();
    }
    window.harness.key_up(Key::Space);
    let when_let_go = step_count(&window);
    window.settle();
    assert!(step_count(&window) <= when_let_go + 1, "{when_let_go} steps, then {}", step_count(&window));
}

#[test]
fn the_stop_menu_says_where_a_run_comes_to_rest() {
    let mut window = at_first_start(SIZE);
    assert_eq!(stop(&window), StopConditions::default());
    assert_message("timeline-run-window-stop-by-default", &window.text_with("Stop: "));
    window.click("Stop conditions");
    for name in ["it is planar", "it stalls", "the boundary crosses", "it reaches step"] {
        window.harness.get_by_role_and_label(Role::CheckBox, name).click();
        window.settle();
    }
    assert_eq!(stop(&window), StopConditions { planar: false, stalled: false, crossing: true, at_step: Some(10) });
    window.fill_in(Role::SpinButton, "Step to stop at", "5");
    window.key(Key::Enter);
    assert_eq!(step_count(&window), 1, "neither menu nor typing takes a step");
    window.key(Key::Escape);
    assert_eq!(stop(&window).at_step, Some(5));
    assert_message("timeline-run-window-stop-as-chosen", &window.text_with("Stop: "));
    window.click("Run");
    assert_eq!(step_count(&window), 6);
    assert_eq!(window.editor().session.stopped(), Some(RunStop::AtStep));
    assert!(window.shows(RunStop::AtStep.words()), "{:?}", window.words());
}

#[test]
fn a_drag_of_a_folded_sheet_shows_a_preview_and_says_so() {
    let mut window = at_first_start(SIZE);
    let (&vertex, &Pin { target: place, .. }) =
        window.outcome().step.candidate.solution.pins.iter().next().expect("a gauge pin");
    assert!(!window.outcome().step.verdict.planar, "as it is at first start");
    let from = window.place_in_plane(place);
    let to = from + Vec2::new(30.0, 12.0);
    window.begin_drag(from, to, Modifiers::NONE);
    window.settle_while_held();
    let is_preview = |window: &Window| matches!(window.editor().session.status(), Status::Preview(_));
    assert!(is_preview(&window) && window.pill() == Pill::Stale, "{}", window.verdict());
    window.end_drag(to);
    assert!(!is_preview(&window) && window.pill() != Pill::Stale, "{}", window.verdict());
    assert!(window.editor().session.document().targets.contains_key(&vertex));
}

#[test]
fn treatment_step_limit_and_growth_are_chosen_in_the_method_panel() {
    let mut window = Window::with_example(Example::Ell);
    window.choose("Equations of pinned vertices", "Eliminate");
    assert_eq!(window.editor().session.document().settings.treatment, Some(Treatment::Eliminate));
    window.choose("Equations of pinned vertices", "Automatic");
    assert!(window.harness.query_by_role_and_label(Role::SpinButton, "Step limit").is_none(), "folded away");
    window.harness.get_by_label("More").click();
    window.settle();
    window.fill_in(Role::SpinButton, "Step limit", "7");
    window.key(Key::Enter);
    window.choose("Growth of the virtual boundary", "One more");
    let expected = Settings { max_steps: Some(7), growth: Growth::One, ..Settings::default() };
    assert_eq!(window.editor().session.document().settings, expected);
    assert_eq!(window.outcome().problem.settings, expected, "and it is solved");
    window.choose("Method", "Convex boundary");
    assert!(window.harness.query_by_label("More").is_none(), "nothing of it matters there");
}
