//! Constraints row by row: hard or soft, their errors, and the magnifier.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2};
use egui_kittest::kittest::Queryable as _;
use freebound::session::Action;
use freebound::ui::{Half, PinMark, Request, Tab};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::{Family, Method, Pin, PinKind, Settings, Treatment};
use glam::DVec2;

use crate::constraints::{corners, free_place, pins, place, window};
use crate::harness::{Window, sheet};
use freebound_testkit::assert_message;

#[test]
fn a_row_s_mark_makes_a_hard_constraint_pull_and_back() {
    let mut window = window();
    corners(&mut window);
    window.click("Pins 5");
    window.click("Kind of pin v40: hard");
    assert_eq!(pins(&window)[&VertexId::new(40)].kind, PinKind::Soft(Pin::DEFAULT_WEIGHT));
    window.fill_in(Role::SpinButton, "Weight of pin v40", "25");
    window.key(Key::Enter);
    assert_eq!(pins(&window)[&VertexId::new(40)].kind, PinKind::Soft(25.0));
    window.click("Kind of pin v40: soft");
    assert_eq!(pins(&window)[&VertexId::new(40)].kind, PinKind::Hard);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(pins(&window)[&VertexId::new(40)].kind, PinKind::Soft(25.0), "each is an undo step");
}

#[test]
fn a_typed_weight_is_one_undo_step() {
    let mut window = window();
    corners(&mut window);
    place(&mut window, &[(30, Target::weighted(DVec2::new(0.9, 0.1), 0.5))]);
    window.click("Pins 6");
    window.fill_in(Role::SpinButton, "Weight of pin v30", "250");
    assert_eq!(pins(&window)[&VertexId::new(30)].kind, PinKind::Soft(0.5), "not before it is whole");
    window.key(Key::Enter);
    assert_eq!(pins(&window)[&VertexId::new(30)].kind, PinKind::Soft(250.0));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(pins(&window)[&VertexId::new(30)].kind, PinKind::Soft(0.5));
}

#[test]
fn a_weight_that_is_only_looked_at_keeps_its_digits() {
    let mut window = window();
    corners(&mut window);
    for weight in [0.123_456_789, 2.5e-7] {
        place(&mut window, &[(30, Target::weighted(DVec2::new(0.9, 0.1), weight))]);
        window.click("Pins 6");
        window.harness.get_by_role_and_label(Role::SpinButton, "Weight of pin v30").click();
        window.settle();
        window.key(Key::Enter);
        assert_eq!(pins(&window)[&VertexId::new(30)].kind, PinKind::Soft(weight));
    }
}

#[test]
fn a_weight_out_of_range_changes_nothing_and_the_field_says_so_until_another_is_typed() {
    let mut window = window();
    corners(&mut window);
    place(&mut window, &[(30, Target::weighted(DVec2::new(0.9, 0.1), 0.5))]);
    window.click("Pins 6");
    let field = "Weight of pin v30";
    let mut shown = field.to_owned();
    for (case, typed) in [("too-large", "1e12"), ("negative", "-3"), ("no-number", "much")] {
        window.fill_in(Role::SpinButton, &shown, typed);
        window.key(Key::Enter);
        assert_eq!(pins(&window)[&VertexId::new(30)].kind, PinKind::Soft(0.5), "{typed}");
        shown = window.name_of(Role::SpinButton, &format!("{field}: "));
        assert_message(&format!("constraint-rows-window-weight-{case}"), &shown);
    }
    window.fill_in(Role::SpinButton, &shown, "250");
    window.key(Key::Enter);
    assert_eq!(pins(&window)[&VertexId::new(30)].kind, PinKind::Soft(250.0));
    window.harness.get_by_role_and_label(Role::SpinButton, field);
}

#[test]
fn a_weight_beyond_the_range_of_the_field_is_not_changed_by_being_shown() {
    let mut window = window();
    corners(&mut window);
    place(&mut window, &[(30, Target::weighted(DVec2::new(0.9, 0.1), 3e10))]);
    window.click("Pins 6");
    window.settle();
    assert_eq!(pins(&window)[&VertexId::new(30)].kind, PinKind::Soft(3e10));
}

#[test]
fn where_the_treatment_weighs_exact_pins_marks_and_rows_say_so() {
    let mut window = window();
    corners(&mut window);
    let natural = Settings::new(Method::Natural, Family::Conformal);
    let settings = Settings { treatment: Some(Treatment::Weighted), ..natural };
    window.editor_mut().session.handle(Action::SetSettings(settings));
    window.settle();
    let kind = PinMark::User(PinKind::Soft(Pin::DEFAULT_WEIGHT));
    let shown = window.editor().pins_shown();
    assert!(shown.len() == 5 && shown.iter().all(|pin| pin.kind == kind), "{shown:?}");
    window.click("Pins 5");
    let kind = window.name_of(Role::Button, "Kind of pin v40: ");
    assert_message("constraint-rows-window-hard-pin-made-soft", &kind);
    assert!(!window.words().iter().any(|words| words == "hard"), "{:?}", window.words());
    let errors = window.text_with("error: ");
    assert!(errors.contains("soft") && !errors.contains("hard"), "{errors}");
    assert!(pins(&window).values().all(|pin| pin.kind == PinKind::Hard), "what was asked for stays");
}

#[test]
fn selected_pins_are_held_alike_by_one_click() {
    let mut window = window();
    corners(&mut window);
    window.click("Pins 5");
    window.editor_mut().selection.select([0, 8, 40].map(VertexId::new));
    window.settle();
    assert!(window.shows("3 selected"));
    window.click("Soft");
    let weighted = pins(&window).into_iter().filter(|(_, pin)| !pin.kind.is_hard());
    assert_eq!(weighted.map(|(v, _)| v.number()).collect::<Vec<_>>(), [0, 8, 40]);
    window.click("Hard");
    assert!(pins(&window).values().all(|pin| pin.kind == PinKind::Hard));
}

#[test]
fn the_hold_chosen_last_is_that_of_the_next_constraint() {
    let mut window = window();
    corners(&mut window);
    window.click("Pins 5");
    window.editor_mut().selection.select([0, 8].map(VertexId::new));
    window.settle();
    window.click("Soft");
    window.key(Key::C);
    window.editor_mut().tools.set_pair(Some(Half::Vertex(VertexId::new(30))));
    window.click_at(free_place(&window), Modifiers::NONE);
    assert!(matches!(pins(&window)[&VertexId::new(30)].kind, PinKind::Soft(_)));
}

#[test]
fn the_largest_errors_of_exact_and_weighted_pins_show() {
    let mut window = window();
    corners(&mut window);
    place(&mut window, &[(30, Target::weighted(DVec2::new(0.9, 0.1), 0.5))]);
    window.click("Pins 6");
    let error = window.outcome().pin_errors().map(|(.., error)| error).fold(0.0, f64::max);
    assert!(error > 1e-3, "it cannot be met: {error}");
    let errors = window.text_with("error: ");
    let parts = ["hard 0".to_owned(), format!("soft {error:.2e}"), "v30".to_owned()];
    assert!(parts.iter().all(|part| errors.contains(part)), "{errors}");
}

#[test]
fn rows_are_selected_together_with_shift_and_ctrl() {
    let mut window = window();
    corners(&mut window);
    window.click("Pins 5");
    let row = |window: &Window, name: &str| window.rect(Role::Button, name).center();
    window.click_at(row(&window, "v8"), Modifiers::NONE);
    window.click_at(row(&window, "v72"), Modifiers::SHIFT);
    assert_eq!(*window.editor().selection.vertices(), [8, 40, 72].map(VertexId::new).into());
    window.click_at(row(&window, "v40"), Modifiers::COMMAND);
    assert_eq!(*window.editor().selection.vertices(), [8, 72].map(VertexId::new).into());
}

#[test]
fn a_residual_joins_a_weighted_vertex_with_its_target() {
    let mut window = window();
    corners(&mut window);
    let target = DVec2::new(0.9, 0.1);
    place(&mut window, &[(30, Target::weighted(target, 0.5))]);
    let [from, to] = [window.embedding()[30], target].map(|z| window.place_in_plane(z));
    assert!(from.distance(to) > 10.0, "they differ");
    let is_residual = |[a, b]: &[Pos2; 2]| a.distance(from) < 1.0 && b.distance(to) < 1.0;
    assert!(window.lines().iter().any(is_residual));
}

#[test]
fn the_selected_constraint_is_magnified_in_both_panes() {
    let mut window = window();
    corners(&mut window);
    let named = |window: &Window, name: &str| window.harness.query_by_role_and_label(Role::Image, name).is_some();
    assert!(!named(&window, "Magnifier: v40 on the mesh"));
    window.editor_mut().selection.select([VertexId::new(40)]);
    window.settle();
    assert!(named(&window, "Magnifier: v40 on the mesh") && named(&window, "Magnifier: the target of v40"));
    window.menu(&["View", "Show", "Magnifier"]);
    assert!(!named(&window, "Magnifier: v40 on the mesh"));
}

#[test]
fn a_pin_gets_the_name_of_a_landmark_that_no_pin_has_yet() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    window.editor_mut().session.handle(Action::Fix(vec![VertexId::new(3), VertexId::new(70)]));
    window.editor_mut().handle(Request::ShowTab(Tab::Pins));
    window.editor_mut().selection.select([VertexId::new(3)]);
    window.settle();
    window.click("Names for pin v3");
    window.click("5 points of a face");
    window.click("tip of the nose");
    let name =
        |window: &Window, vertex| window.editor().session.pin_name(VertexId::new(vertex)).map(ToString::to_string);
    assert_eq!(name(&window, 3).as_deref(), Some("tip of the nose"));
    window.editor_mut().selection.select([VertexId::new(70)]);
    window.settle();
    window.click("Names for pin v70");
    window.click("5 points of a face");
    assert!(window.has_button("left eye, centre") && !window.has_button("tip of the nose"));
}
