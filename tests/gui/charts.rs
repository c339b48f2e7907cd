//! Meshes of several charts in the window: the list, the layout, and switching between charts.

use std::time::{Duration, Instant};

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use freebound::session::{Action, ChartState, LockState};
use freebound::ui::{Tab, sentence};
use freebound_core::mesh::{FaceId, TriMesh, VertexId};

use crate::harness::{Window, sheet};
use freebound_testkit::assert_message;

/// Three sheets side by side, in increasing size.
fn sheets() -> TriMesh {
    beside_each_other([4, 6, 9].map(|rows| sheet(rows, 0.3)))
}

/// Parts side by side in one mesh.
pub(crate) fn beside_each_other(parts: impl IntoIterator<Item = TriMesh>) -> TriMesh {
    let mut whole = TriMesh::default();
    for (number, part) in parts.into_iter().enumerate() {
        let offset = whole.positions.len();
        let aside = 30.0 * number as f64 * glam::DVec3::X;
        whole.positions.extend(part.positions.iter().map(|&at| at + aside));
        let moved = |vertex: VertexId| VertexId::from_index(offset + vertex.index());
        whole.triangles.extend(part.triangles.iter().map(|corners| corners.map(moved)));
    }
    whole
}

pub(crate) fn with_sheets() -> Window {
    let mut window = Window::with_mesh("sheets.obj", &sheets());
    until_laid_out(&mut window);
    window
}

/// Window with one of three sheets alone, as it is for work on its vertices.
pub(crate) fn with_sheet_alone() -> Window {
    let mut window = with_sheets();
    window.press(Modifiers::NONE, Key::Y);
    assert!(!window.editor().shows_page());
    window
}

#[track_caller]
pub(crate) fn until_laid_out(window: &mut Window) {
    let start = Instant::now();
    while window.editor().session.atlas().is_none() {
        assert!(start.elapsed() < Duration::from_mins(1), "{:?}", window.words());
        std::thread::sleep(Duration::from_millis(1));
        window.step();
    }
    window.settle();
}

fn chart(window: &Window) -> Option<usize> {
    window.editor().session.chart_on_screen()
}

/// Name of the row of a chart in the list, which has the numbers of the chart.
fn row(window: &Window, chart: usize) -> String {
    let session = &window.editor().session;
    let ChartState::Solved(outcome) = session.chart_state(chart) else { panic!("chart {chart} is not solved") };
    let energy = outcome.distortion.summary.symmetric_dirichlet.mean;
    let faces = session.charts().expect("three charts").faces(chart).len();
    let name = window.name_of(Role::Button, &format!("Chart {chart}, "));
    let has = |number: String| name.split([' ', ',']).any(|word| word == number);
    assert!(outcome.step.verdict.planar && has(faces.to_string()) && has(format!("{energy:.2}")), "{name}");
    name
}

#[test]
fn a_mesh_of_several_parts_opens_with_the_list_of_its_charts() {
    let window = with_sheets();
    assert_eq!(window.editor().layout.tab(), Tab::Charts);
    let verdict = &window.editor().session.atlas().expect("laid out").verdict;
    assert!(verdict.planar && window.shows(&sentence(&verdict.summary())), "{:?}", window.words());
    assert_message("charts-window-list", &[0, 1, 2].map(|chart| row(&window, chart)).join("\n"));
    assert_eq!(chart(&window), Some(2), "the largest");
    assert!(window.is_proved());
}

#[test]
fn a_click_in_the_list_and_the_page_keys_lead_from_chart_to_chart() {
    let mut window = with_sheet_alone();
    let name = row(&window, 0);
    window.click(&name);
    assert_eq!(chart(&window), Some(0));
    assert!(window.is_proved());
    assert_eq!(window.embedding().len(), 25);
    for (key, expected) in [(Key::PageDown, 1), (Key::PageDown, 2), (Key::PageDown, 0), (Key::PageUp, 2)] {
        window.press(Modifiers::NONE, key);
        assert_eq!(chart(&window), Some(expected));
    }
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(chart(&window), Some(0));
}

#[test]
fn charts_have_the_names_of_the_objects_and_groups_in_their_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("named.obj");
    let quad = |x: f64| format!("v {x} 0 0\nv {} 0 0\nv {} 1 0\nv {x} 1 0\n", x + 1.0, x + 1.0);
    let [a, b, c] = [0.0, 3.0, 6.0].map(quad);
    let text = format!("o Table\n{a}g Top\nf 1 2 3 4\n{b}g\nf 5 6 7 8\n{c}o\nf 9 10 11 12\n");
    std::fs::write(&path, text).expect("a writable folder");
    let mut window = Window::with_file(&path);
    until_laid_out(&mut window);
    let names = [0, 1, 2].map(|chart| window.editor().session.chart_name(chart).map(str::to_owned));
    assert_eq!(names, [Some("Top".to_owned()), Some("Table".to_owned()), None]);
    window.click("Charts 3");
    let rows = window.controls().into_iter().filter(|(role, name, _)| *role == Role::Button && name.contains(", Top,"));
    assert_eq!(rows.count(), 1);
}

#[test]
fn the_chart_on_the_screen_is_packed_larger_by_a_typed_size() {
    let mut window = with_sheets();
    let densities = |window: &Window| window.editor().session.atlas().expect("laid out").densities.clone();
    assert!((densities(&window)[2] / densities(&window)[0] - 1.0).abs() < 1e-9);
    window.fill_in(Role::SpinButton, "Size of the chart on the screen", "2.5");
    window.press(Modifiers::NONE, Key::Enter);
    until_laid_out(&mut window);
    assert!((densities(&window)[2] / densities(&window)[0] - 2.5).abs() < 1e-9, "{:?}", densities(&window));
    let density = format!("{:.1} px per unit", densities(&window)[0]);
    assert!(window.shows(&density), "{density}: {:?}", window.words());
    window.press(Modifiers::COMMAND, Key::Z);
    until_laid_out(&mut window);
    assert!((densities(&window)[2] / densities(&window)[0] - 1.0).abs() < 1e-9);
}

#[test]
fn a_size_that_is_dragged_back_to_what_it_was_stays() {
    let mut window = with_sheets();
    let from = window.rect(Role::SpinButton, "Size of the chart on the screen").center();
    let sizes = window.editor().session.sizes();
    window.begin_drag(from, from + egui::vec2(64.0, 0.0), Modifiers::NONE);
    for aside in [48.0, 32.0, 16.0, 0.0] {
        window.harness.hover_at(from + egui::vec2(aside, 0.0));
        window.step();
    }
    window.end_drag(from);
    assert_eq!(window.editor().session.sizes(), sizes);
    window.harness.get_by_label("Packing options").click();
    window.settle();
    let from = window.rect(Role::SpinButton, "Gap between charts in pixels").center();
    let before = window.editor().session.packing();
    window.begin_drag(from, from + egui::vec2(64.0, 0.0), Modifiers::NONE);
    for aside in [48.0, 32.0, 16.0, 0.0] {
        window.harness.hover_at(from + egui::vec2(aside, 0.0));
        window.step();
    }
    window.end_drag(from);
    assert_eq!(window.editor().session.packing(), before);
}

#[test]
fn the_lock_of_a_row_and_its_key_keep_a_chart_where_it_is() {
    let mut window = with_sheet_alone();
    let place = |window: &Window| window.editor().session.atlas().expect("laid out").coordinates[0].clone();
    let before = place(&window);
    window.click("Lock chart 0");
    until_laid_out(&mut window);
    assert_eq!(window.editor().session.lock_state(0), LockState::Locked);
    assert!(row(&window, 0).ends_with(", locked") && window.has_button("Unlock chart 0"));
    window.harness.get_by_label("Packing options").click();
    window.settle();
    window.fill_in(Role::SpinButton, "Gap between charts in pixels", "30");
    window.press(Modifiers::NONE, Key::Enter);
    until_laid_out(&mut window);
    assert_eq!(place(&window), before);
    let shown = chart(&window).expect("the largest");
    window.press(Modifiers::NONE, Key::L);
    assert_eq!(window.editor().session.lock_state(shown), LockState::Locked);
    until_laid_out(&mut window);
    window.press(Modifiers::NONE, Key::L);
    until_laid_out(&mut window);
    window.click("Unlock chart 0");
    until_laid_out(&mut window);
    assert!(window.editor().session.document().layout.locked.is_empty());
}

#[test]
fn a_fixed_density_starts_at_the_density_that_was_found() {
    let mut window = with_sheets();
    window.harness.get_by_label("Packing options").click();
    window.settle();
    let toggle = |window: &mut Window| {
        window.harness.get_by_role_and_label(Role::CheckBox, "Fixed density").click();
        window.settle();
    };
    let found = window.editor().session.atlas().and_then(|atlas| atlas.packing).expect("packed").density;
    toggle(&mut window);
    assert_eq!(window.editor().session.packing().density, Some(found));
    until_laid_out(&mut window);
    window.fill_in(Role::SpinButton, "Largest number of tiles", "4");
    window.press(Modifiers::NONE, Key::Enter);
    until_laid_out(&mut window);
    assert_eq!(window.editor().session.packing().tiles, 4);
    toggle(&mut window);
    until_laid_out(&mut window);
    let packing = window.editor().session.atlas().and_then(|atlas| atlas.packing).expect("packed");
    assert!(packing.tiles > 1 && packing.density > found, "{packing:?}");
    assert!(row(&window, 0).contains("tile 100"), "{:?}", window.words());
}

#[test]
fn the_selection_does_not_go_over_to_another_chart() {
    let mut window = with_sheet_alone();
    window.editor_mut().selection.select([VertexId::new(3)]);
    window.press(Modifiers::NONE, Key::PageDown);
    assert!(window.editor().selection.vertices().is_empty());
}

fn selected(window: &Window) -> Vec<VertexId> {
    window.editor().selection.vertices().iter().copied().collect()
}

/// Types the number of an element into the window "Go to".
fn go_to(window: &mut Window, number: &str) {
    window.key(Key::G);
    window.type_text(number);
    window.key(Key::Enter);
}

#[test]
fn a_vertex_of_a_later_chart_has_the_number_of_the_file_everywhere() {
    let mut window = with_sheet_alone();
    let own = VertexId::new(33);
    // Vertices have equations in maps by a linear solve.
    window.editor_mut().layout.show_tab(Tab::Method);
    window.settle();
    window.choose("Method", "Natural boundary");
    window.editor_mut().selection.select([own]);
    window.click("Vertex");
    // The charts before it have 25 and 49 vertices.
    let number = window.editor().session.model().expect("open").vertex_in_file(own);
    assert_eq!((chart(&window), number), (Some(2), VertexId::new(25 + 49 + 33)));
    let paints = |window: &Window, wanted: &str| window.words().iter().any(|words| words == wanted);
    assert!(paints(&window, "v107") && paints(&window, "Chart 2"), "{:?}", window.words());
    assert!(!paints(&window, "v33"), "{:?}", window.words());
    let disk = window.editor().session.model().and_then(|model| model.disk()).cloned().expect("a disk");
    let neighbours: Vec<VertexId> = disk.outgoing(own).map(|halfedge| disk.head(halfedge)).collect();
    // The table of the equation may have more rows than the panel shows at once.
    let is_named = |vertex: &&VertexId| paints(&window, &window.editor().session.number_of(**vertex).to_string());
    assert!(neighbours.iter().filter(is_named).count() > 1, "{:?}", window.words());
    assert!(!neighbours.iter().any(|own| paints(&window, &own.to_string())), "{:?}", window.words());
    window.harness.get_by_label("Copy").click();
    window.step();
    let commands = &window.harness.output().platform_output.commands;
    let is_copied =
        |command: &egui::OutputCommand| matches!(command, egui::OutputCommand::CopyText(text) if text == "107");
    assert!(commands.iter().any(is_copied), "{commands:?}");
    window.harness.hover_at(window.place_in_plane(window.embedding()[own]));
    window.harness.run_steps(2);
    assert_eq!(window.editor().pointer.vertex(), Some(own));
    assert!(window.shows("  ·  v107"), "in the status bar: {:?}", window.words());
    window.editor_mut().session.handle(Action::Fix(vec![own]));
    window.settle();
    window.click("Pins");
    assert!(window.has_button("Free pin v107") && window.has_button("Pin v107"), "{:?}", window.controls());
}

#[test]
fn go_to_takes_the_numbers_of_the_file_and_shows_their_charts() {
    let mut window = with_sheet_alone();
    let vertices = [("24", 0, 24), ("v25", 1, 0), ("73", 1, 48), ("107", 2, 33), ("3", 0, 3), ("4", 0, 4)];
    for (number, of, own) in vertices {
        go_to(&mut window, number);
        assert_eq!((chart(&window), selected(&window)), (Some(of), vec![VertexId::new(own)]), "{number}");
    }
    // The first chart has 32 faces.
    go_to(&mut window, "f37");
    let mesh = window.editor().session.model().expect("open").mesh().clone();
    let mut corners = mesh.triangles[5].to_vec();
    corners.sort_unstable();
    assert_eq!((chart(&window), mesh.polygon(FaceId::new(5)), selected(&window)), (Some(1), 37, corners));
    for beyond in ["174", "f266"] {
        window.key(Key::G);
        window.type_text(beyond);
        assert!(!window.is_enabled("Go"), "{beyond}");
        window.key(Key::Escape);
    }
}

#[test]
fn a_message_about_a_vertex_of_another_chart_leads_there() {
    let mut window = with_sheet_alone();
    let file = window.path("pins.txt");
    std::fs::write(&file, "30 0 0 -1\n").expect("written");
    window.editor_mut().session.handle(Action::ImportConstraints(file));
    window.settle();
    let message = window.editor().session.messages().last().expect("it is said");
    assert_eq!(message.vertices, [VertexId::new(30)]);
    window.click("Go to vertex v30");
    assert_eq!((chart(&window), selected(&window)), (Some(1), vec![VertexId::new(5)]));
}

#[test]
fn the_tab_of_the_charts_stays_where_there_is_one_chart_and_offers_to_unwrap_it() {
    let mut window = with_sheets();
    let path = window.path("one.obj");
    crate::harness::write_obj(&path, &sheet(5, 0.3));
    window.open(&path);
    window.step();
    assert_eq!(window.editor().layout.tab(), Tab::Charts);
    assert!(!window.has_button("Charts 3") && window.has_button("Charts") && window.has_button("Unwrap"));
}
