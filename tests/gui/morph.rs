//! Morph between two methods in the window: choice, computation, slider, playback, and export.

use std::fs::File;
use std::io::BufReader;
use std::sync::Arc;

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use freebound::session::{Action, Compared, MorphState, MorphTour};
use freebound::ui::{MorphRequest, MorphView, Request};
use freebound::view::Quantity;
use freebound_core::mesh::VertexId;
use freebound_core::problem::{Embedding, Variant};
use freebound_core::verify::verdict;
use glam::DVec2;

use crate::harness::{Window, sheet};
use freebound_testkit::assert_message;

/// Compared methods.
const METHODS: [&str; 4] = ["natural", "convex/uniform", "schnyder", "natural/mean-value"];

fn variants(names: &[&str]) -> Vec<Variant> {
    names.iter().map(|name| name.parse().expect("a method")).collect()
}

/// Compares these methods on a small sheet.
fn comparing(names: &[&str]) -> Window {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.4));
    window.menu(&["Solve", "Compare methods…"]);
    window.editor_mut().session.handle(Action::CompareMethods(variants(names)));
    window.settle();
    window
}

/// Window with the morph that it chooses by default.
fn morphing() -> Window {
    let mut window = comparing(&METHODS);
    window.click("Morph");
    window
}

fn view(window: &Window) -> &MorphView {
    &window.editor().plane.comparison.morph
}

fn tour(window: &Window) -> Arc<MorphTour> {
    match window.editor().session.morph() {
        MorphState::Done(tour) => tour,
        state => panic!("no morph: {state:?}"),
    }
}

fn names(window: &Window) -> Vec<String> {
    tour(window).stops.stops.iter().map(|stop| stop.name.clone()).collect()
}

/// Map of a method.
fn map_of(window: &Window, name: &str) -> Embedding {
    let variant = variants(&[name])[0].clone();
    let contenders = window.editor().session.contenders();
    let contender = contenders.iter().find(|contender| {
        let found: Option<&Arc<Compared>> = contender.found();
        found.is_some_and(|found| found.report.name == variant.to_string())
    });
    let found = contender.and_then(|contender| contender.found().cloned()).expect("it has run");
    found.outcome.as_ref().expect("a map").step.candidate.solution.embedding.clone()
}

/// Words of the large view, if it shows.
fn words_of_frame(window: &Window) -> Option<String> {
    let mut images = window.harness.query_all_by_role(Role::Image);
    images.find_map(|node| Some(node.accesskit_node().label()?.strip_prefix("Morph: ")?.to_owned()))
}

/// Number of the frame in the large view, and number of all frames.
fn frame(window: &Window) -> Option<[usize; 2]> {
    let words = words_of_frame(window)?;
    let mut numbers = words.split(' ').filter_map(|word| word.parse().ok());
    Some([numbers.next()?, numbers.next()?])
}

#[test]
fn a_click_finds_the_morph_between_two_maps_and_the_slider_goes_through_its_proved_frames() {
    let mut window = morphing();
    assert!(view(&window).is_shown());
    assert_eq!(names(&window), METHODS[..2], "the document's method has no part: the first two");
    let tour = tour(&window);
    let mesh = window.editor().session.model().and_then(|model| model.disk()).expect("a disk").clone();
    let frames = &tour.legs[0].frames;
    assert_eq!(frames.len(), 49);
    assert!(frames.iter().all(|frame| verdict(&mesh, frame).planar));
    assert_eq!([&frames[0], &frames[48]], [&map_of(&window, METHODS[0]), &map_of(&window, METHODS[1])]);
    assert_eq!(frame(&window), Some([1, 49]), "{:?}", window.words());
    let words = words_of_frame(&window).expect("a frame");
    assert!(words.contains(&tour.legs[0].verdicts[0].summary()) && window.shows(&words), "{words}");
    assert_message("morph-window-first-frame", &words);
    assert!(window.shows(Quantity::Angle.title()));
    for (share, number) in [(0.5, 25), (1.0, 49), (0.013, 2), (0.0, 1)] {
        window.editor_mut().handle(Request::Morph(MorphRequest::Seek(share)));
        window.settle();
        assert_eq!(frame(&window), Some([number, 49]), "{share}: {:?}", window.words());
        assert_eq!(view(&window).bounds_drawn(), Some(frames[number - 1].bounds()));
    }
    // By mouse.
    let slider = window.rect(Role::Slider, "Frame of the morph");
    let at = |share: f32| slider.left_center() + egui::vec2(8.0 + share * (slider.width() - 70.0), 0.0);
    window.drag(at(0.1), at(0.7), Modifiers::NONE);
    assert!((0.3..1.0).contains(&view(&window).share()), "{}", view(&window).share());
    // By keyboard.
    window.editor_mut().handle(Request::Morph(MorphRequest::Seek(0.0)));
    window.settle();
    window.harness.get_by_role_and_label(Role::Slider, "Frame of the morph").focus();
    window.step();
    for number in [2, 3] {
        window.key(Key::ArrowRight);
        assert_eq!(frame(&window), Some([number, 49]), "{:?}", window.words());
    }
    window.key(Key::ArrowLeft);
    assert_eq!(frame(&window), Some([2, 49]), "{:?}", window.words());
}

#[test]
fn both_ends_are_chosen_from_the_planar_maps_and_change_places() {
    let mut window = morphing();
    window.choose("Method that the morph ends with", &variants(&["schnyder"])[0].title());
    assert_eq!(names(&window), ["natural", "schnyder"]);
    window.choose("Method that the morph begins with", &variants(&["natural/mean-value"])[0].title());
    assert_eq!(names(&window), ["natural/mean-value", "schnyder"]);
    let there = tour(&window);
    window.editor_mut().handle(Request::Morph(MorphRequest::From(variants(&["schnyder"])[0].clone())));
    window.settle();
    assert_eq!(names(&window), ["schnyder", "natural/mean-value"], "no method is both");
    let back = tour(&window);
    assert_eq!(
        (&there.legs[0].frames[0], &there.legs[0].frames[48]),
        (&back.legs[0].frames[48], &back.legs[0].frames[0])
    );
}

#[test]
fn it_plays_to_its_end_and_again_from_its_beginning() {
    let mut window = morphing();
    window.harness.get_by_role_and_label(Role::Button, "Play the morph").click();
    window.step();
    let mut before = view(&window).share();
    for _ in 0..5 {
        window.frame_after(0.3, []);
        let now = view(&window).share();
        assert!(view(&window).is_playing() && now > before, "{now} after {before}");
        before = now;
    }
    window.click("Pause the morph");
    let paused = view(&window).share();
    window.frame_after(0.5, []);
    assert!(!view(&window).is_playing() && (view(&window).share() - paused).abs() < f64::EPSILON);
    window.harness.get_by_role_and_label(Role::Button, "Play the morph").click();
    window.step();
    window.frame_after(5.0, []);
    window.frame_after(0.1, []);
    assert!(!view(&window).is_playing() && frame(&window) == Some([49, 49]), "{}", view(&window).share());
    window.harness.get_by_role_and_label(Role::Button, "Play the morph").click();
    window.step();
    window.frame_after(0.1, []);
    assert!(view(&window).is_playing() && view(&window).share() < 0.5);
}

#[test]
fn where_the_document_changes_the_morph_goes_and_comes_again_between_the_new_maps() {
    let mut window = morphing();
    let before = tour(&window);
    let corners = [0, 4].map(VertexId::new);
    window.editor_mut().session.handle(Action::Fix(corners.to_vec()));
    let target = DVec2::new(-0.4, 0.1);
    window.editor_mut().session.handle(Action::MovePin { vertex: corners[0], target });
    assert!(matches!(window.editor().session.morph(), MorphState::Waiting | MorphState::Done(_)));
    window.step();
    assert!(!matches!(window.editor().session.morph(), MorphState::Done(_)), "maps of other pins are none of these");
    assert_eq!(words_of_frame(&window), None, "and nothing old shows: {:?}", window.words());
    assert_eq!(view(&window).bounds_drawn(), None, "nor is it kept");
    assert!(window.editor().session.is_in_gesture());
    assert_message("morph-window-waits-for-a-gesture", &window.text_with("waits"));
    window.editor_mut().session.handle(Action::EndGesture);
    window.settle();
    let after = tour(&window);
    assert!(!Arc::ptr_eq(&before, &after));
    let frames = &after.legs[0].frames;
    assert_ne!(frames[0], before.legs[0].frames[0]);
    assert_eq!([&frames[0], &frames[48]], [&map_of(&window, METHODS[0]), &map_of(&window, METHODS[1])]);
    // A removed method is no longer an end of the morph.
    window.editor_mut().session.handle(Action::CompareMethods(variants(&METHODS[1..])));
    window.settle();
    assert_eq!(names(&window), METHODS[1..3]);
}

#[test]
fn escape_and_the_switch_lead_back_to_the_cells() {
    let mut window = morphing();
    window.key(Key::Escape);
    assert!(!view(&window).is_shown() && window.editor().plane.comparison.is_shown());
    assert_eq!(window.editor().session.morph_between(), None);
    window.click("Morph");
    assert_eq!(frame(&window), Some([1, 49]));
    window.click("Morph");
    assert!(!view(&window).is_shown() && words_of_frame(&window).is_none());
    window.click("Morph");
    window.click("Leave the comparison");
    assert!(!window.editor().plane.comparison.is_shown() && window.editor().session.morph_between().is_none());
    window.menu(&["Solve", "Compare methods…"]);
    assert!(!view(&window).is_shown(), "it begins with the cells");
}

#[test]
fn without_two_planar_maps_it_says_what_there_is_to_do() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.4));
    // Drags one corner across the sheet.
    window.editor_mut().session.handle(Action::Fix([0, 4, 24].map(VertexId::new).to_vec()));
    window.settle();
    let far = window.embedding()[24];
    let target = far + (far - window.embedding()[0]);
    window.editor_mut().session.handle(Action::MovePin { vertex: VertexId::new(0), target });
    window.editor_mut().session.handle(Action::EndGesture);
    window.settle();
    window.menu(&["Solve", "Compare methods…"]);
    window.editor_mut().session.handle(Action::CompareMethods(variants(&["natural", "levy", "lscm"])));
    window.settle();
    window.click("Morph");
    assert!(matches!(window.editor().session.morph(), MorphState::Waiting));
    assert!(window.editor().session.morph_ends().len() < 2);
    let [first, second] = ["two", "Choose"].map(|word| window.text_with(word));
    window.harness.get_by_role_and_label(Role::Label, &format!("{first}. {second}"));
    assert_message("morph-window-needs-two-maps", &[first, second].join("\n"));
    window.click("Export the comparison");
    assert!(!window.is_enabled("Animated picture…"));
}

#[test]
fn while_something_is_dragged_the_morph_waits_for_the_end_of_that() {
    let mut window = morphing();
    window.editor_mut().session.handle(Action::Fix([0, 4].map(VertexId::new).to_vec()));
    window.settle();
    tour(&window);
    for step in 1..4 {
        let target = DVec2::new(-0.1 * f64::from(step), 0.1);
        window.editor_mut().session.handle(Action::MovePin { vertex: VertexId::new(0), target });
        window.step();
        assert_eq!(words_of_frame(&window), None);
        assert!(window.editor().session.is_in_gesture());
        window.harness.get_by_role_and_label(Role::Label, &window.text_with("waits"));
    }
    window.editor_mut().session.handle(Action::EndGesture);
    window.settle();
    assert_eq!(frame(&window), Some([1, 49]), "{:?}", window.words());
}

#[test]
fn a_morph_that_would_take_more_than_half_of_the_memory_is_not_sought() {
    let mut window = comparing(&METHODS);
    // 49 frames of 25 vertices of 16 bytes.
    window.editor_mut().session.heed_memory(2 * 49 * 25 * 16 - 1);
    window.click("Morph");
    let MorphState::TooLarge(shortage) = window.editor().session.morph() else { panic!("{:?}", window.words()) };
    assert_eq!((shortage.frames, shortage.needed), (49, 49 * 25 * 16));
    assert!(window.shows(&shortage.to_string()), "{:?}", window.words());
    assert_message("morph-window-too-large-for-memory", &window.text_with("KiB"));
    window.click("Morph");
    window.editor_mut().session.heed_memory(2 * 49 * 25 * 16);
    window.click("Morph");
    assert_eq!(frame(&window), Some([1, 49]), "{:?}", window.words());
}

#[test]
fn the_morph_that_shows_is_written_as_an_animated_picture() {
    let mut window = morphing();
    window.menu(&["Export the comparison", "Animated picture…"]);
    assert!(window.editor().files.dialogs.is_open());
    window.click("Export");
    let path = window.path("sheet-morph.png");
    let file = BufReader::new(File::open(path).expect("it was written"));
    let reader = png::Decoder::new(file).read_info().expect("a PNG");
    let control = reader.info().animation_control.expect("it is animated");
    assert_eq!((control.num_frames, control.num_plays), (96, 0), "49 there and 47 back");
}

#[test]
fn controls_of_the_bar_lie_beside_each_other_at_every_width() {
    let mut window = comparing(&METHODS);
    for width in [640.0, 820.0, 900.0, 960.0, 1040.0, 1280.0] {
        window.harness.set_size(egui::vec2(width, 600.0));
        window.settle();
        let names = ["Table", "Morph", "Export the comparison", "Leave the comparison"];
        let buttons = names.map(|name| window.rect(Role::Button, name));
        let colours = window.rect(Role::ComboBox, "Colours of the comparison");
        for (k, rect) in buttons.iter().enumerate() {
            assert!(colours.right() <= rect.left(), "{}: {rect:?} over {colours:?} at {width}", names[k]);
            let mut others = buttons[k + 1..].iter();
            assert!(others.all(|other| rect.right() <= other.left()), "{} at {width}", names[k]);
        }
    }
}

#[test]
fn the_table_cannot_be_asked_for_while_the_morph_shows() {
    let mut window = morphing();
    assert!(!window.has_button("Table"));
    window.click("Morph");
    assert!(window.has_button("Table"));
}
