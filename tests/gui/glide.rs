//! Animation of the embedding from step to step, and the window's texts meanwhile.

use eframe::egui;
use egui::{Event, Key, Modifiers, Vec2};
use freebound::session::Action;
use freebound::ui::PinMark;
use freebound_core::mesh::VertexId;
use freebound_core::problem::{Family, Method, Settings};
use glam::DVec2;

use crate::harness::{Pill, Window, sheet};
use crate::timeline::shown;
use freebound_testkit::assert_message;

/// Window after its first step and three more.
fn with_four_steps() -> Window {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    for _ in 0..3 {
        window.editor_mut().session.handle(Action::Step);
        window.settle();
    }
    assert_eq!(shown(&window), 3);
    window
}

/// Index of the step that the finished animation shows.
fn drawn_step(window: &Window) -> usize {
    window.editor().plane.scene().expect("solved").outcome.step.index
}

fn drawn(window: &Window) -> Vec<DVec2> {
    window.editor().plane.drawn().expect("solved").positions().to_vec()
}

/// Runs frames until the animation starts.
fn step_until_it_moves(window: &mut Window) {
    for _ in 0..2000 {
        if window.editor().plane.is_easing() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
        window.step();
    }
    panic!("the sheet does not move: {}", window.verdict());
}

/// Runs frames until the animation has ended, and calls `look` after each.
fn each_frame(window: &mut Window, mut look: impl FnMut(&Window)) {
    let mut at_rest = 0;
    while at_rest < 3 {
        std::thread::sleep(std::time::Duration::from_millis(1));
        window.step();
        look(window);
        at_rest = if window.is_settled() { at_rest + 1 } else { 0 };
    }
}

#[test]
fn the_pill_says_that_the_sheet_moves_as_long_as_it_does() {
    let mut window = with_four_steps();
    window.key_now(Key::ArrowLeft);
    let mut moving = Vec::new();
    each_frame(&mut window, |window| {
        let is_there = drawn_step(window) == 2 && !window.editor().plane.is_easing();
        let expected = if is_there { (Pill::Proved, vec![]) } else { (Pill::AtWork, vec![3, 2]) };
        assert_eq!((window.pill(), window.numbers_of_verdict()), expected, "{}", window.verdict());
        moving.extend(window.editor().plane.is_easing().then(|| window.verdict()));
    });
    assert!(moving.len() >= 5, "{} frames of a glide", moving.len());
    assert_message("glide-window-moving", &moving[0]);
}

#[test]
fn a_click_on_the_pill_of_a_sheet_that_moves_goes_to_no_defect() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    crate::defects::fold_any(&mut window);
    window.key(Key::Space);
    window.key(Key::Home);
    window.key_now(Key::ArrowRight);
    step_until_it_moves(&mut window);
    let pill = |window: &Window| format!("Verdict: {}", window.verdict());
    let click_it = |window: &mut Window| {
        let place = window.rect(egui::accesskit::Role::Button, &pill(window)).center();
        window.frame(crate::presses::click(place, Modifiers::NONE));
    };
    assert_eq!((window.pill(), window.numbers_of_verdict()), (Pill::AtWork, vec![0, 1]), "{}", window.verdict());
    click_it(&mut window);
    assert_eq!(window.editor().selection.defect(), None);
    window.key(Key::Home);
    assert_eq!(window.pill(), Pill::Bad, "{}", window.verdict());
    click_it(&mut window);
    assert_eq!(window.editor().selection.defect(), Some(0));
}

#[test]
fn gauge_pins_stay_on_the_sheet_while_it_moves() {
    let mut window = with_four_steps();
    window.key_now(Key::Home);
    let mut looked = 0;
    each_frame(&mut window, |window| {
        let positions = drawn(window);
        for pin in window.editor().pins_shown() {
            assert_eq!(pin.kind, PinMark::Gauge);
            assert!(pin.target.distance(positions[pin.vertex.index()]) < 1e-12, "{}", pin.vertex);
            looked += usize::from(window.editor().plane.is_easing());
        }
    });
    assert!(looked >= 10);
}

#[test]
fn the_next_step_waits_until_the_sheet_has_arrived() {
    let mut window = with_four_steps();
    let mut seen = vec![3];
    window.key_now(Key::ArrowLeft);
    step_until_it_moves(&mut window);
    window.key_now(Key::ArrowLeft);
    assert_eq!(shown(&window), 1, "the step is asked for at once");
    each_frame(&mut window, |window| {
        if seen.last() != Some(&drawn_step(window)) {
            seen.push(drawn_step(window));
        }
    });
    assert_eq!(seen, [3, 2, 1]);
}

#[test]
fn slow_frames_have_no_glide_and_the_sheet_is_there_at_once() {
    let mut window = with_four_steps();
    for i in 0..5_u8 {
        let at = window.plane_view().min + Vec2::splat(3.0 * f32::from(i));
        window.frame_after(0.1, [Event::PointerMoved(at)]);
    }
    for (key, expected) in [(Key::ArrowLeft, 2), (Key::Home, 0), (Key::End, 3)] {
        window.frame_after(0.1, crate::presses::key(key, Modifiers::NONE));
        while drawn_step(&window) != expected {
            assert!(!window.editor().plane.is_easing());
            std::thread::sleep(std::time::Duration::from_millis(1));
            window.frame_after(0.1, []);
        }
        assert!(!window.editor().plane.is_easing());
        assert_eq!(window.pill(), Pill::Proved, "{}", window.verdict());
    }
}

#[test]
fn a_sheet_that_followed_a_pin_goes_on_from_there_to_what_is_solved() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    // A single step gives a single animation.
    window.editor_mut().session.handle(Action::SetSettings(Settings::new(Method::Natural, Family::default())));
    window.settle();
    window.editor_mut().session.handle(Action::Fix([0, 40, 80].map(VertexId::new).to_vec()));
    window.settle();
    let from = window.place_in_plane(window.embedding()[40]);
    let to = from + Vec2::new(90.0, -60.0);
    window.begin_drag(from, to, Modifiers::NONE);
    window.settle_while_held();
    let preview = drawn(&window);
    let mut frames = vec![preview.clone()];
    window.frame([crate::presses::button(to, false, Modifiers::NONE)]);
    each_frame(&mut window, |window| frames.push(drawn(window)));
    let solved = window.embedding();
    let extent = window.editor().plane.drawn().expect("solved").arrays.bounds.extent();
    for positions in &frames {
        for ((at, a), b) in positions.iter().zip(&preview).zip(&solved) {
            let detour = at.distance(*a) + at.distance(*b) - a.distance(*b);
            assert!(detour <= 1e-9 * extent, "a vertex left the straight way by {detour}");
        }
    }
    assert_eq!(frames.last(), Some(&solved.to_vec()));
}

#[test]
fn a_drag_that_is_given_up_goes_back_without_a_word_of_a_verdict_on_the_way() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    window.editor_mut().session.handle(Action::Fix([0, 40, 80].map(VertexId::new).to_vec()));
    window.settle();
    let before = drawn(&window);
    let from = window.place_in_plane(window.embedding()[40]);
    window.begin_drag(from, from + Vec2::new(90.0, -60.0), Modifiers::NONE);
    window.settle_while_held();
    window.key_now(Key::Escape);
    each_frame(&mut window, |window| {
        let is_there = drawn(window) == before;
        assert!(is_there || !matches!(window.pill(), Pill::Proved | Pill::Unmet), "{}", window.verdict());
    });
    assert_eq!(drawn(&window), before);
}

/// Runs frames until none requests another at once.
fn rest(window: &mut Window) {
    let asks =
        |window: &Window| window.harness.output().viewport_output[&egui::ViewportId::ROOT].repaint_delay.is_zero();
    window.settle();
    while asks(window) {
        window.step();
    }
}

#[test]
fn a_rest_between_frames_is_no_slow_frame() {
    let mut window = with_four_steps();
    // Unsaved work is copied every few seconds, so each frame requests a later one.
    window.editor_mut().session.handle(Action::Fix([0, 40, 80].map(VertexId::new).to_vec()));
    for _ in 0..2 {
        window.editor_mut().session.handle(Action::Step);
        window.settle();
    }
    let newest = shown(&window);
    for woken in [false, true] {
        rest(&mut window);
        if woken {
            // Wakes the window as the background does.
            window.harness.ctx.request_repaint();
        }
        window.frame_after(3.0, []);
        window.editor_mut().session.handle(Action::ShowStep(if woken { newest } else { newest - 1 }));
        while !window.editor().plane.is_easing() {
            assert!(window.editor().plane.is_moving(&window.editor().session), "no glide; news: {woken}");
            std::thread::sleep(std::time::Duration::from_millis(1));
            // A frame of zero length does not advance the animation.
            window.frame_after(0.0, []);
        }
        let mut frames = 0;
        while window.editor().plane.is_easing() {
            window.step();
            frames += 1;
        }
        assert!(frames >= 8, "{frames} frames of a glide; news: {woken}");
    }
}
