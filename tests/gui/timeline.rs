//! Strip below the panes: buttons and keys, steps, curves, playback.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use freebound::app::LaunchFile;
use freebound::session::{Action, StopConditions};
use freebound::ui::Request;
use freebound_core::mesh::{TriMesh, VertexId};
use freebound_core::problem::{Family, Method, Settings};

use crate::harness::{Pill, SIZE, Window, sheet};
use freebound_testkit::assert_message;

/// Window at its very first start.
pub(crate) fn at_first_start(size: Vec2) -> Window {
    Window::start(size, LaunchFile::default())
}

/// The built-in face after its natural step and three more.
fn with_four_steps() -> Window {
    let mut window = at_first_start(SIZE);
    for _ in 0..3 {
        window.key(Key::Space);
    }
    assert_eq!(step_count(&window), 4);
    window
}

pub(crate) fn step_count(window: &Window) -> usize {
    window.editor().session.timeline().records().len()
}

pub(crate) fn shown(window: &Window) -> usize {
    window.editor().session.timeline().shown().expect("solved")
}

/// Full name of a step in the row.
fn name_of_step(window: &Window, index: usize) -> String {
    let start = format!("Step {index}: ");
    let mut controls = window.controls().into_iter();
    controls.find(|(_, name, _)| name.starts_with(&start)).map(|(_, name, _)| name).expect("a step in the row")
}

#[test]
fn keys_go_through_the_steps() {
    let mut window = with_four_steps();
    for (key, expected) in [
        (Key::ArrowLeft, 2),
        (Key::ArrowLeft, 1),
        (Key::ArrowRight, 2),
        (Key::Home, 0),
        (Key::ArrowLeft, 0),
        (Key::End, 3),
        (Key::ArrowRight, 3),
    ] {
        window.key(key);
        assert_eq!(shown(&window), expected, "{key:?}");
        assert_eq!(window.outcome().step.index, expected);
    }
    assert_eq!(step_count(&window), 4, "looking takes no steps");
}

#[test]
fn buttons_and_menu_go_through_the_steps() {
    let mut window = with_four_steps();
    assert!(!window.is_enabled("Next step") && !window.is_enabled("Last step"));
    for (button, expected) in [("Previous step", 2), ("First step", 0), ("Next step", 1), ("Last step", 3)] {
        window.click(button);
        assert_eq!(shown(&window), expected, "{button}");
    }
    for (entry, expected) in [("Previous step", 2), ("First step", 0), ("Next step", 1), ("Last step", 3)] {
        window.click("Solve");
        // The entry has its keys after its name, the button in the strip does not.
        let with_keys = format!("{entry} ");
        let is_entry = |node: &egui_kittest::Node<'_>| {
            node.accesskit_node().label().is_some_and(|label| label.starts_with(&with_keys))
        };
        window.harness.query_all_by_role(Role::Button).find(is_entry).expect("an entry").click();
        window.settle();
        assert_eq!(shown(&window), expected, "{entry}");
    }
    window.click("First step");
    assert!(!window.is_enabled("Previous step") && !window.is_enabled("First step"));
}

#[test]
fn each_step_says_what_it_is_and_shows_by_a_click() {
    let mut window = with_four_steps();
    let records = window.editor().session.timeline().records().to_vec();
    let names: Vec<String> = (0..4).map(|step| name_of_step(&window, step)).collect();
    for (record, name) in records.iter().zip(&names) {
        let (title, state) = name.split_once(", ").expect("a stage and a state");
        assert_eq!(title, format!("Step {}: {}", record.index, record.stage.short_words()));
        let defects = state.split(' ').find_map(|word| word.parse::<usize>().ok());
        assert_eq!((defects.is_none(), defects.unwrap_or(0)), (record.planar, record.defect_count()), "{name}");
    }
    assert_message("timeline-window-names-of-steps", &names.join("\n"));
    assert!(records[0].defect_count() > 0 && records[3].planar, "it folds, and is repaired");
    window.click(&name_of_step(&window, 0));
    assert_eq!(shown(&window), 0);
    assert_eq!(window.pill(), Pill::Bad, "the verdict is that of the step on the screen");
    window.click(&name_of_step(&window, 3));
    assert!(shown(&window) == 3 && window.is_proved(), "{}", window.verdict());
}

#[test]
fn a_click_with_shift_and_the_context_menu_choose_what_to_compare_with() {
    let mut window = with_four_steps();
    let at = |window: &Window, index| window.rect(Role::Button, &name_of_step(window, index)).center();
    let place = at(&window, 1);
    window.click_at(place, Modifiers::SHIFT);
    assert_eq!((window.editor().session.timeline().compared(), shown(&window)), (Some(1), 3));
    assert!(name_of_step(&window, 1).ends_with(", compared"));
    window.click_at(place, Modifiers::SHIFT);
    assert_eq!(window.editor().session.timeline().compared(), None, "the same again ends it");
    let name = name_of_step(&window, 0);
    window.harness.get_by_role_and_label(Role::Button, &name).click_secondary();
    window.settle();
    window.click("Compare with this");
    assert_eq!(window.editor().session.timeline().compared(), Some(0));
    let name = name_of_step(&window, 2);
    window.harness.get_by_role_and_label(Role::Button, &name).click_secondary();
    window.settle();
    window.click("Stop comparing");
    assert_eq!(window.editor().session.timeline().compared(), None);
}

#[test]
fn the_numbers_of_a_step_show_under_the_pointer() {
    let mut window = with_four_steps();
    let (name, before) = (name_of_step(&window, 1), window.words());
    window.harness.get_by_role_and_label(Role::Button, &name).hover();
    for _ in 0..60 {
        window.step();
    }
    // Numbers differ between machines by rounding, and times between runs.
    let is_name = |words: &String| !before.contains(words) && !words.contains(|letter: char| letter.is_ascii_digit());
    let names: Vec<String> = window.words().into_iter().filter(is_name).collect();
    assert_message("timeline-window-numbers-of-a-step", &names.join("\n"));
}

#[test]
fn a_click_on_a_curve_goes_to_the_step_under_it() {
    let mut window = with_four_steps();
    for curve in ["Curve: flipped faces", OTHER] {
        let rect = window.rect(Role::Image, curve);
        // The first and the last step are near the ends, the others evenly spaced between them.
        for (share, expected) in [(0.05, 0), (0.36, 1), (0.64, 2), (0.95, 3)] {
            let at = egui::pos2(rect.left() + share * rect.width(), rect.center().y);
            window.click_at(at, Modifiers::NONE);
            assert_eq!(shown(&window), expected, "{curve} at {share}");
        }
    }
}

/// Curve that is always shown.
const OTHER: &str = "Curve: |A z| of all equations relative to their terms; by powers of ten";

#[test]
fn curves_can_be_put_away_one_by_one_and_all_together() {
    let mut window = with_four_steps();
    let has_curve = |window: &Window, name: &str| window.harness.query_by_role_and_label(Role::Image, name).is_some();
    assert!(has_curve(&window, "Curve: flipped faces"));
    window.click("Choice of curves");
    window.harness.get_by_role_and_label(Role::CheckBox, "Flipped").click();
    window.settle();
    window.key(Key::Escape);
    assert!(!has_curve(&window, "Curve: flipped faces"));
    assert!(has_curve(&window, OTHER));
    let before = window.plane_view().height();
    window.click("Hide the curves");
    assert!(!has_curve(&window, OTHER));
    assert!(window.plane_view().height() > before + 100.0, "the panes have the room");
    window.menu(&["View", "Show", "Curves of the steps"]);
    assert!(has_curve(&window, OTHER));
}

#[test]
fn steps_are_played_from_the_first_to_the_last() {
    let mut window = with_four_steps();
    window.click("Play the steps");
    assert_eq!(shown(&window), 0);
    let mut seen = vec![0];
    for _ in 0..60 * 10 {
        window.step();
        if seen.last() != Some(&shown(&window)) {
            seen.push(shown(&window));
        }
    }
    assert_eq!(seen, [0, 1, 2, 3]);
    assert!(window.editor().timeline.playing_since.is_none(), "it ends by itself");
    window.click("Play the steps");
    window.click("Stop playing");
    window.key(Key::Home);
    window.click("Play the steps");
    window.key(Key::ArrowRight);
    assert!(window.editor().timeline.playing_since.is_none(), "who looks for himself has stopped it");
}

#[test]
fn typing_into_a_field_takes_no_step() {
    let mut window = with_four_steps();
    window.key(Key::G);
    for key in [Key::Space, Key::ArrowLeft, Key::Home, Key::End] {
        window.key(key);
    }
    window.press(Modifiers::SHIFT, Key::Space);
    assert_eq!((step_count(&window), shown(&window)), (4, 3));
    assert!(window.editor().layout.go_to.is_some());
}

#[test]
fn space_on_a_control_with_the_focus_is_the_control_s() {
    let mut window = at_first_start(SIZE);
    window.harness.get_by_role_and_label(Role::Button, "Hide the curves").focus();
    window.step();
    window.key(Key::Space);
    assert_eq!(step_count(&window), 1);
    assert!(!window.editor().timeline.curves_shown());
}

#[test]
fn what_is_no_disk_has_no_timeline() {
    let cap = sheet(4, 0.3);
    let mut triangles = cap.triangles.clone();
    triangles[3].reverse();
    let mut window = Window::with_faulty(
        "turned.obj",
        &TriMesh::new(cap.positions, &triangles.iter().map(|t| t.map(VertexId::number)).collect::<Vec<_>>()),
    );
    assert!(!window.editor().has_disk() && !window.has_button("Run"));
    window.key(Key::Space);
    assert_eq!(step_count(&window), 0);
}

#[test]
fn many_steps_scroll_and_the_one_on_the_screen_is_in_sight() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let session = &mut window.editor_mut().session;
    session.handle(Action::SetStop(StopConditions { planar: false, stalled: false, ..StopConditions::default() }));
    session.handle(Action::SetSettings(Settings::new(Method::Iterate, Family::Conformal)));
    window.settle();
    assert_eq!(step_count(&window), 61);
    for _ in 0..60 {
        window.step();
    }
    let strip = window.rect(Role::Button, "Stop conditions");
    for (request, index) in [(None, 60), (Some(Action::ShowStep(0)), 0), (Some(Action::ShowStep(30)), 30)] {
        if let Some(action) = request {
            window.editor_mut().handle(Request::Do(action));
            window.settle();
            for _ in 0..60 {
                window.step();
            }
        }
        let chip = window.rect(Role::Button, &name_of_step(&window, index));
        assert!(chip.right() < strip.left() && chip.left() > 0.0, "step {index} at {chip:?}");
    }
}

#[test]
fn the_step_that_shows_is_always_in_sight_and_none_is_cut() {
    for size in [egui::vec2(640.0, 420.0), SIZE] {
        let mesh = Window::with_mesh("sheet.obj", &sheet(4, 0.5));
        let mut window =
            Window::start(size, LaunchFile { file: Some(mesh.path("sheet.obj")), ..LaunchFile::default() });
        window.editor_mut().pane_shading.glides = false;
        for _ in 0..24 {
            window.editor_mut().session.handle(Action::Step);
            window.settle();
        }
        let newest = step_count(&window) - 1;
        for wanted in [newest, 0, newest / 2, 3, newest] {
            window.editor_mut().session.handle(Action::ShowStep(wanted));
            window.settle();
            assert_whole_steps(&window, wanted);
        }
        window.harness.set_size(egui::vec2(size.x + 60.0, size.y + 60.0));
        window.settle();
        assert_whole_steps(&window, newest);
        window.editor_mut().handle(Request::TogglePanels);
        window.settle();
        assert_whole_steps(&window, newest);
    }
}

/// Asserts that a step is in the row, and that all steps in the row have their full width.
fn assert_whole_steps(window: &Window, wanted: usize) {
    let row: Vec<_> = window.controls().into_iter().filter(|(_, name, _)| name.starts_with("Step ")).collect();
    let is_there = row.iter().any(|(_, name, _)| name.starts_with(&format!("Step {wanted}: ")));
    assert!(is_there, "step {wanted} is not among {row:?}");
    let seen = window.rect(Role::Button, "Stop conditions").left();
    for (_, name, rect) in row {
        assert!(rect.width() > 20.0 && rect.right() <= seen + 0.5, "{name} at {rect:?}, before {seen}");
    }
}

#[test]
fn curves_say_their_least_and_greatest_value() {
    let window = with_four_steps();
    let moves: Vec<f64> = window.editor().session.timeline().records().iter().filter_map(|r| r.max_move).collect();
    let greatest = moves.iter().copied().fold(0.0, f64::max);
    let flips = window.editor().session.timeline().records().iter().map(|r| r.flipped_faces).max().expect("steps");
    let words = window.words();
    let shows = |value: f64| words.iter().any(|w| w.parse::<f64>().is_ok_and(|w| (w - value).abs() <= 0.05 * value));
    assert!(shows(greatest), "{greatest} in {words:?}");
    assert!(words.contains(&flips.to_string()), "{flips} in {words:?}");
}

#[test]
fn the_checker_keeps_its_scale_while_steps_are_played() {
    let mut window = with_four_steps();
    window.key(Key::Home);
    let before = window.editor().pane_shading.checker.check_size();
    window.click("Play the steps");
    for _ in 0..600 {
        window.step();
        assert_eq!(window.editor().pane_shading.checker.check_size(), before);
        if window.editor().timeline.playing_since.is_none() {
            break;
        }
    }
    assert_eq!(shown(&window), 3, "played to the end");
}
