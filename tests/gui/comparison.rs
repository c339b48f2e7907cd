//! Methods side by side in the window.

use std::fs;

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Rect, Vec2};
use egui_kittest::Node;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use freebound::app::LaunchFile;
use freebound::examples::Example;
use freebound::session::{Action, Compared, ContenderState};
use freebound::ui::{Pane, Request, ShadingMode, Tab};
use freebound::view::Quantity;
use freebound_core::mesh::VertexId;
use freebound_core::problem::{BoundaryShape, Family, Method, NamedOption as _, Variant};

use crate::harness::{PLANE_VIEW, SIZE, Window, sheet};
use freebound_testkit::assert_message;

fn comparing(mut window: Window) -> Window {
    window.menu(&["Solve", "Compare methods…"]);
    window
}

fn with_sheet() -> Window {
    comparing(Window::with_mesh("sheet.obj", &sheet(6, 0.3)))
}

fn titles(window: &Window) -> Vec<String> {
    window.editor().session.contenders().iter().map(|contender| contender.variant().title()).collect()
}

/// Result of a method.
fn found(window: &Window, title: &str) -> std::sync::Arc<Compared> {
    let contenders = window.editor().session.contenders();
    let contender = contenders
        .iter()
        .find(|contender| contender.variant().title() == title)
        .unwrap_or_else(|| panic!("{title} of {:?}", titles(window)));
    assert_eq!(window.editor().session.contender_state(contender), ContenderState::Done, "{title}");
    contender.found().expect("it has run").clone()
}

/// Names and bounds of the cells.
fn cells(window: &Window) -> Vec<(String, Rect)> {
    let titles = titles(window);
    let is_cell = |name: &str| titles.iter().any(|title| name.starts_with(&format!("{title}: ")));
    let nodes = window.harness.root().children_recursive();
    let of = |node: Node<'_>| {
        let words = node.accesskit_node();
        let name = words.label().filter(|name| words.role() == Role::Button && is_cell(name))?;
        Some((name, node.rect()))
    };
    nodes.filter_map(of).collect()
}

fn click_cell(window: &mut Window, title: &str) {
    let (name, _) =
        cells(window).into_iter().find(|(name, _)| name.starts_with(&format!("{title}: "))).expect("a cell");
    window.harness.get_by_role_and_label(Role::Button, &name).click();
    window.settle();
}

#[test]
fn the_menu_shows_six_methods_side_by_side_and_escape_leads_back() {
    let mut window = with_sheet();
    assert!(window.editor().plane.comparison.is_shown());
    let now = titles(&window);
    let place = |title: &String| Method::ALL.iter().position(|method| title.starts_with(method.labels().title));
    assert!(now.len() == 6 && now.is_sorted_by(|a, b| place(a) < place(b)), "{now:?}");
    assert!(now[0].starts_with("Auto") && now[1].starts_with("Natural"), "{now:?}");
    let maps = window.editor().session.contenders().iter().skip(1).map(|contender| contender.variant().method);
    assert!(maps.into_iter().all(|method| !method.continues_from_layout()), "each has a map of its own: {now:?}");
    let cells = cells(&window);
    assert_eq!(cells.len(), 6);
    for ((name, place), title) in cells.iter().zip(&now) {
        let report = &found(&window, title).report;
        assert!(name.starts_with(title.as_str()) && name.contains(&report.verdict_line()), "{name}");
        assert!(window.shows(&report.verdict_line()) && place.width() > 150.0 && place.height() > 150.0, "{place:?}");
        assert!(report.number_lines().iter().all(|line| name.contains(line) && window.shows(line)), "{name}");
    }
    for (k, (name, place)) in cells.iter().enumerate() {
        assert!(cells[k + 1..].iter().all(|(_, other)| !place.intersects(*other)), "{name}");
    }
    assert!(window.harness.query_by_label(PLANE_VIEW).is_none(), "it stands in the embedding's place");
    window.key(Key::Escape);
    assert!(!window.editor().plane.comparison.is_shown() && window.editor().session.contenders().is_empty());
    assert_eq!(window.editor().layout.full(), None);
    assert!(window.plane_view().width() > 100.0 && window.mesh_view().width() > 100.0);
}

#[test]
fn a_method_says_in_its_cell_what_it_says_as_that_of_the_document() {
    let mut window = with_sheet();
    for title in titles(&window) {
        let compared = found(&window, &title);
        click_cell(&mut window, &title);
        let settings = window.editor().session.document().settings.clone();
        assert_eq!(Variant::of(&settings), Variant::of(&compared.problem.settings), "{title}");
        let (own, other) = (window.outcome(), compared.outcome.as_ref().expect("an embedding"));
        assert_eq!(own.step.candidate.solution.embedding, other.step.candidate.solution.embedding, "{title}");
        assert_eq!(own.step.verdict, other.step.verdict, "{title}");
        assert_eq!(own.distortion, other.distortion, "{title}");
    }
}

#[test]
fn a_click_on_a_cell_takes_its_method_and_undo_gives_it_back() {
    let mut window = with_sheet();
    let before = window.editor().session.document().settings.clone();
    let convex = titles(&window).into_iter().find(|title| title.starts_with("Convex")).expect("it takes part");
    let of_convex = found(&window, &convex);
    click_cell(&mut window, &convex);
    assert_eq!(window.editor().session.document().settings.method, Method::Convex(BoundaryShape::Circle));
    assert!(std::sync::Arc::ptr_eq(&of_convex, &found(&window, &convex)), "nothing has to run again for it");
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.editor().session.document().settings, before);
    assert!(window.editor().plane.comparison.is_shown());
}

#[test]
fn all_run_again_where_pins_change_and_what_was_found_stays_until_then() {
    let mut window = with_sheet();
    let before: Vec<_> = titles(&window).iter().map(|title| found(&window, title)).collect();
    window.editor_mut().session.handle(Action::Fix(vec![VertexId::new(0), VertexId::new(3)]));
    window.step();
    let session = &window.editor().session;
    let is_kept = |k: usize| session.contenders()[k].found().is_some_and(|now| std::sync::Arc::ptr_eq(now, &before[k]));
    assert!((0..6).all(|k| is_kept(k) || session.contender_state(&session.contenders()[k]) == ContenderState::Done));
    assert!((0..6).any(|k| session.contender_state(&session.contenders()[k]) != ContenderState::Done));
    window.settle();
    for (title, before) in titles(&window).iter().zip(&before) {
        let now = found(&window, title);
        // A convex boundary takes no pins, so its result is unchanged.
        let takes_pins = now.problem.settings.method.uses_pins();
        assert_eq!(std::sync::Arc::ptr_eq(&now, before), !takes_pins, "{title}");
        assert_eq!(now.problem.targets.len(), if takes_pins { 2 } else { 0 }, "{title}");
    }
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(titles(&window).iter().all(|title| found(&window, title).problem.targets.is_empty()));
}

#[test]
fn methods_are_checked_in_a_list_two_to_six() {
    let mut window = with_sheet();
    window.click("Methods that are compared");
    let checked = |window: &Window, name: &str| {
        let node = window.harness.get_by_role_and_label(Role::CheckBox, name);
        let node = node.accesskit_node();
        (node.toggled() == Some(egui::accesskit::Toggled::True), node.is_disabled())
    };
    let levy = Method::Levy.labels().title;
    assert_eq!(checked(&window, levy), (false, true), "six take part already");
    let toggle = |window: &mut Window, name: &str| {
        window.harness.get_by_role_and_label(Role::CheckBox, name).click();
        window.settle();
    };
    for title in titles(&window).into_iter().take(4) {
        assert_eq!(checked(&window, &title), (true, false));
        toggle(&mut window, &title);
    }
    let left = titles(&window);
    assert_eq!(left.len(), 2);
    assert!(left.iter().all(|title| checked(&window, title) == (true, true)), "a comparison has two");
    toggle(&mut window, levy);
    assert_eq!(titles(&window)[2], levy);
    assert!(found(&window, levy).outcome.is_some());
    // A method that only meets constraints has nothing to do.
    assert_eq!(checked(&window, Method::Matchmaker.labels().title), (false, true));
    window.harness.get_by_label("Other weights and boundaries").click();
    window.settle();
    // The section opens with an animation.
    window.harness.run_steps(30);
    let wachspress = Variant { method: Method::Auto, family: Some(Family::Wachspress) }.title();
    toggle(&mut window, &wachspress);
    assert_eq!(found(&window, &wachspress).problem.settings.family(), Family::Wachspress);
    // Scrolls to entries farther down the list.
    let tutte = Variant { method: Method::Convex(BoundaryShape::Square), family: Some(Family::Uniform) };
    window.editor_mut().handle(Request::ToggleContender(tutte.clone()));
    window.settle();
    let tutte = tutte.title();
    assert_message("comparison-window-title-of-a-variant", &tutte);
    assert!(found(&window, &tutte).report.result.as_ref().expect("an embedding").verdict.planar);
    // The choice is restored.
    let before = titles(&window);
    window.key(Key::Escape);
    window.key(Key::Escape);
    assert!(!window.editor().plane.comparison.is_shown());
    window.press(Modifiers::SHIFT, Key::C);
    assert_eq!(titles(&window), before);
}

#[test]
fn the_table_is_sorted_by_any_column_up_and_down() {
    let mut window = with_sheet();
    let rows = |window: &Window| -> Vec<String> {
        let names = window.harness.query_all(egui_kittest::kittest::By::new().role(Role::Button));
        let takes = names.filter_map(|node| Some((node.accesskit_node().label()?, node.rect().top())));
        let mut takes: Vec<(String, f32)> = takes.filter(|(name, _)| name.starts_with("Use ")).collect();
        takes.sort_by(|a, b| a.1.total_cmp(&b.1));
        takes.into_iter().map(|(name, _)| name.trim_start_matches("Use ").to_owned()).collect()
    };
    let as_chosen = titles(&window);
    assert_eq!(rows(&window), as_chosen);
    let energy = |window: &Window, title: &String| {
        found(window, title).report.result.as_ref().expect("an embedding").distortion.symmetric_dirichlet.mean
    };
    window.click("Sort by Energy");
    let up: Vec<f64> = rows(&window).iter().map(|title| energy(&window, title)).collect();
    assert!(up.is_sorted() && up.len() == 6, "{up:?}");
    window.click("Sort by Energy, ascending");
    let down: Vec<f64> = rows(&window).iter().map(|title| energy(&window, title)).collect();
    assert!(down.is_sorted_by(|a, b| a >= b), "{down:?}");
    window.click("Sort by Energy, descending");
    assert_eq!(rows(&window), as_chosen);
    for title in &as_chosen {
        let words = format!("{title}, Energy: {:.3}", energy(&window, title));
        window.harness.get_by_role_and_label(Role::Label, &words);
    }
    let natural = &as_chosen[1];
    window.click(&format!("Use {natural}"));
    assert_eq!(window.editor().session.document().settings.method, Method::Natural);
}

#[test]
fn one_camera_moves_all_and_frames_all_again() {
    let mut window = with_sheet();
    let camera = |window: &Window| window.editor().plane.comparison.camera_now().expect("embeddings show");
    let before = camera(&window);
    let (_, place) = cells(&window)[3];
    let at = place.center() - Vec2::new(0.0, 40.0);
    window.drag(at, at + Vec2::new(30.0, 10.0), Modifiers::NONE);
    let moved = camera(&window);
    assert!(moved.center() != before.center() && moved.points_per_unit() == before.points_per_unit());
    assert_eq!(window.editor().session.document().settings.method, Method::Auto, "a drag is no click");
    window.harness.hover_at(at);
    let notch = egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: Vec2::new(0.0, 2.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    };
    window.frame([notch]);
    assert!(camera(&window).points_per_unit() > 1.2 * moved.points_per_unit());
    window.key(Key::F);
    assert_eq!(camera(&window), before);
}

#[test]
fn faces_are_coloured_alike_in_all_cells_by_list_and_by_key() {
    let mut window = with_sheet();
    let quantity = |window: &Window| window.editor().plane.comparison.quantity();
    assert_eq!(quantity(&window), Some(Quantity::Angle));
    assert!(window.shows(Quantity::Angle.title()));
    window.choose("Colours of the comparison", "Stretch");
    assert_eq!(quantity(&window), Some(Quantity::Stretch));
    for (key, expected) in [(Key::Num5, Some(Quantity::Area)), (Key::Num1, None), (Key::Num4, Some(Quantity::Angle))] {
        window.key(key);
        assert_eq!(quantity(&window), expected);
    }
    assert_eq!(window.shadings(), [ShadingMode::Checker; 2], "the panes stay as they are");
    window.key(Key::Num8);
    assert_eq!(quantity(&window), Some(Quantity::Angle), "cells have no such shading");
}

#[test]
fn a_comparison_is_written_as_a_picture_and_as_tables() {
    let mut window = with_sheet();
    window.menu(&["Export the comparison", "Table…"]);
    assert!(window.editor().files.dialogs.is_open());
    window.click("Export");
    assert!(window.path("sheet-comparison.csv").is_file());
    let files = [("Picture…", "all.png"), ("Drawing…", "all.svg"), ("Document…", "all.pdf"), ("Steps…", "steps.csv")];
    for (what, name) in files {
        let path = window.path(name);
        window.menu(&["Export the comparison", what]);
        window.fill_in(Role::TextInput, "Name", path.to_str().expect("a path of text"));
        // The message about the earlier file does not cover the dialog.
        assert!(!window.has_button("Show in folder"));
        window.key(Key::Enter);
        assert!(path.is_file(), "{what}");
    }
    let lines = |name: &str| fs::read_to_string(window.path(name)).unwrap().lines().count();
    assert_eq!(lines("sheet-comparison.csv"), 7);
    let steps: usize = titles(&window).iter().map(|title| found(&window, title).report.steps.len()).sum();
    assert_eq!(lines("steps.csv"), 1 + steps);
    let drawing = fs::read_to_string(window.path("all.svg")).unwrap();
    let words = drawing.split("<text ").skip(1).filter_map(|rest| rest.split(['>', '<']).nth(1)).collect::<Vec<_>>();
    for title in titles(&window) {
        assert!(words.join(" ").contains(&title), "{title} in {words:?}");
    }
    assert!(fs::read(window.path("all.pdf")).unwrap().starts_with(b"%PDF-"));
    let picture = image::open(window.path("all.png")).unwrap();
    assert!(picture.width() > 1000 && picture.height() > 800);
}

#[test]
fn the_comparison_follows_another_mesh_and_says_where_there_is_nothing_to_compare() {
    let mut window = with_sheet();
    let first = found(&window, &titles(&window)[1]);
    let path = window.path("second.obj");
    crate::harness::write_obj(&path, &sheet(4, 0.2));
    window.open(&path);
    let title = titles(&window)[1].clone();
    let second = found(&window, &title);
    let count = |of: &Compared| of.outcome.as_ref().expect("an embedding").step.candidate.solution.embedding.len();
    assert!(count(&second) < count(&first));
    assert_eq!(cells(&window).len(), 6);
    fs::write(window.path("bad.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n")
        .unwrap();
    let bad = window.path("bad.obj");
    window.open(&bad);
    window.give_faults_back();
    assert!(window.is_faulty() && cells(&window).is_empty(), "{:?}", window.words());
    assert_message("comparison-window-nothing-to-compare", &window.text_with("prevent"));
}

#[test]
fn a_method_that_fails_says_why_in_its_cell() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.editor_mut().session.handle(Action::Fix(vec![VertexId::new(0), VertexId::new(3), VertexId::new(40)]));
    window.settle();
    let mut window = comparing(window);
    // With constraints, methods that take none are not selected by default.
    assert!(titles(&window).iter().all(|title| !title.starts_with("Virtual")), "{:?}", titles(&window));
    window.editor_mut().session.handle(Action::UnpinAll);
    window.settle();
    window.click("Methods that are compared");
    let bent = Variant { method: Method::VirtualBoundary, family: Some(Family::Conformal) };
    let [remove, add] = [titles(&window)[0].clone(), bent.title()];
    for title in [&remove, &add] {
        window.harness.get_by_role_and_label(Role::CheckBox, title).click();
        window.settle();
    }
    window.key(Key::Escape);
    window.press(Modifiers::COMMAND, Key::Z);
    let failed = found(&window, &add);
    let error = failed.report.error.as_ref().expect("it takes two pins");
    assert!(failed.outcome.is_none() && window.shows(&error.message), "{:?}", window.words());
    assert_eq!(error.kind, "too-many-pins");
    assert_message("comparison-window-too-many-pins", &error.message);
    let words = cells(&window).into_iter().find(|(name, _)| name.starts_with(&add)).expect("its cell").0;
    assert!(words.contains(error.kind), "{words}");
}

#[test]
fn both_panes_show_beside_each_other_and_pins_are_set_on_the_mesh() {
    let mut window = with_sheet();
    assert_eq!(window.editor().layout.full(), Some(Pane::Plane));
    window.click("Show both panes: Comparison");
    assert!(window.mesh_view().width() > 200.0);
    assert_eq!(cells(&window).len(), 6);
    window.editor_mut().handle(Request::SetTool(freebound::ui::Tool::Fix));
    window.settle();
    let vertex = window.vertex_in_the_middle();
    let at = window.place_on_mesh(vertex);
    window.click_at(at, Modifiers::NONE);
    assert!(window.editor().session.document().targets.contains_key(&vertex));
    let natural = titles(&window)[1].clone();
    assert_eq!(found(&window, &natural).problem.targets.len(), 1);
}

/// Uses the smallest window, with and without its panels.
#[test]
fn the_least_window_has_room_for_six_cells_or_the_table() {
    let mesh = Window::with_example(Example::Cube);
    let start = LaunchFile { file: Some(mesh.path("cube.obj")), dialogs_inside: true, ..LaunchFile::default() };
    let mut window = comparing(Window::start(Vec2::new(640.0, 420.0), start));
    for with_panels in [false, true] {
        if window.editor().layout.panels_shown() != with_panels {
            window.editor_mut().handle(Request::ShowTab(Tab::Method));
            window.settle();
        }
        let whole = Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(640.0, 420.0));
        let all = cells(&window);
        assert_eq!(all.len(), 6);
        for (k, (name, place)) in all.iter().enumerate() {
            assert!(whole.contains_rect(*place) && place.width() > 60.0 && place.height() > 60.0, "{name}: {place:?}");
            assert!(all[k + 1..].iter().all(|(_, other)| !place.intersects(*other)), "{name}");
        }
        let bar = window.rect(Role::Button, "Leave the comparison");
        assert!(whole.contains_rect(bar) && bar.bottom() <= all[0].1.top(), "{bar:?}");
        window.click("Table");
        assert!(cells(&window).is_empty(), "the table has the room alone");
        window.click("Sort by Flips");
        window.click("Sort by Flips, ascending");
        window.click("Sort by Flips, descending");
        window.click("Table");
    }
    assert_eq!(SIZE, Vec2::new(1280.0, 800.0));
}
