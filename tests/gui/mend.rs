//! Repair of a mesh that is not a disk, in the window.

use eframe::egui;
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;
use freebound::ui::sentence;
use freebound_core::mesh::{Repair, TriMesh, VertexId, WeldDistance};
use freebound_core::pipeline::Surface;
use glam::DVec3;

use crate::harness::{Window, sheet};
use freebound_testkit::{assert_message, tetrahedron};

/// Repairs of the mesh with their counts. The tab of the defects shows each.
fn done(window: &Window) -> Vec<(Repair, usize)> {
    let model = window.editor().session.model().expect("open");
    let done = model.prepared.repaired.iter().flat_map(|repaired| repaired.done());
    let shown = done.filter(|done| window.shows(&done.to_string()));
    shown.map(|done| (done.repair, done.count)).collect()
}

#[test]
fn a_mesh_that_can_be_mended_says_how_and_is_mended_by_one_click() {
    let mut window = Window::with_faulty("closed.obj", &tetrahedron());
    let remedy = window.editor().session.model().and_then(|model| model.prepared.remedy.clone()).expect("a remedy");
    assert_eq!(remedy.done().first().map(|done| (done.repair, done.count)), Some((Repair::Cut, 3)));
    assert_message("mend-window-offer-to-repair", &window.text_with("repaired"));
    window.click("Unwrap");
    assert!(window.is_proved(), "{}", window.verdict());
    assert!(!window.has_button("Show faults") && !window.has_button("Dismiss"), "{:?}", window.words());
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(window.is_faulty(), "{}", window.verdict());
    window.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert!(window.is_proved(), "{}", window.verdict());
}

#[test]
fn the_panel_of_defects_leads_from_each_element_of_a_fault_to_the_next() {
    let mut mesh = sheet(6, 0.3);
    for face in [10, 20, 30] {
        mesh.triangles[face].reverse();
    }
    let mut window = Window::with_faulty("turned.obj", &mesh);
    window.click("Defects");
    let model = window.editor().session.model().cloned().expect("open");
    let Surface::Faulty(_, diagnosis) = &model.prepared.surface else { panic!("faces are turned over") };
    let fault = diagnosis.faults.iter().find(|fault| fault.name() == "mixed-orientation").expect("a fault");
    assert!(window.shows(&sentence(fault.remedy())), "{:?}", window.words());
    assert_message("mend-window-remedy-of-turned-faces", fault.remedy());
    let selected = |window: &Window| window.editor().selection.vertices().iter().copied().collect::<Vec<VertexId>>();
    let corners = |face: usize| {
        let mut corners = mesh.triangles[face].to_vec();
        corners.sort_unstable();
        corners
    };
    for face in [10, 20, 30, 10] {
        window.click("Next of mixed orientation");
        assert_eq!(selected(&window), corners(face));
    }
    assert!(window.shows("1 of 3"), "{:?}", window.words());
    window.click("Previous of mixed orientation");
    assert_eq!(selected(&window), corners(30));
    window.click("Unwrap");
    assert!(window.is_proved(), "{}", window.verdict());
    assert!(done(&window).contains(&(Repair::TurnFaces, 3)), "{:?}", done(&window));
}

#[test]
fn what_is_harmless_is_told_beside_the_verdict() {
    let mut mesh = sheet(6, 0.3);
    mesh.positions[23] = mesh.positions[24];
    let positions = [&mesh.positions[..], &[glam::DVec3::splat(9.0)]].concat();
    let mut window = Window::with_mesh("odd.obj", &TriMesh { positions, ..mesh });
    assert!(window.is_proved(), "{}", window.verdict());
    window.click("Defects");
    let disk = window.editor().session.model().and_then(|model| model.disk()).cloned().expect("a disk");
    assert!(disk.vertex_count() == disk.used_vertex_count() + 1 && disk.mollification() > 0.0);
    let notes = window.words().into_iter().filter(|words| words.starts_with("Mesh: "));
    // A length that depends on rounding follows the comma.
    let notes: Vec<String> = notes.map(|words| words.split(',').next().unwrap_or_default().to_owned()).collect();
    assert_message("mend-window-notes", &notes.join("\n"));
}

#[test]
fn each_fault_has_a_remedy_of_its_own_and_what_is_left_is_told() {
    let mut mesh = tetrahedron();
    mesh.triangles[2].swap(0, 1);
    let mut window = Window::with_faulty("odd.obj", &mesh);
    window.click("Defects");
    assert!(window.has_button("Turn faces over") && window.has_button("Cut open"), "{:?}", window.words());
    window.click("Turn faces over");
    assert!(done(&window).contains(&(Repair::TurnFaces, 1)), "{:?}", done(&window));
    assert!(!window.has_button("Turn faces over") && !window.is_proved(), "{:?}", window.words());
    window.click("Cut open");
    assert!(window.is_proved(), "{}", window.verdict());
    for _ in 0..2 {
        window.press(Modifiers::COMMAND, Key::Z);
    }
    assert!(window.has_button("Turn faces over") && window.has_button("Cut open"), "{:?}", window.words());
}

#[test]
fn vertices_within_a_distance_are_counted_before_they_are_welded() {
    let left = sheet(6, 0.3);
    let width = left.positions.iter().map(|place| place.x).fold(f64::MIN, f64::max)
        - left.positions.iter().map(|place| place.x).fold(f64::MAX, f64::min);
    let count = left.vertex_count();
    let right = left.positions.iter().map(|place| *place + DVec3::X * (width + 1e-3));
    let moved = left.triangles.iter().map(|face| face.map(|v| VertexId::from_index(v.index() + count)));
    let triangles = left.triangles.iter().copied().chain(moved).collect();
    let positions = left.positions.iter().copied().chain(right).collect();
    let mut window = Window::with_mesh("halves.obj", &TriMesh { positions, triangles, ..TriMesh::default() });
    assert_eq!(window.editor().session.charts().map(|charts| charts.count()), Some(2));
    window.click("Defects");
    window.harness.get_by_label("Weld within a distance").click();
    window.settle();
    let field = "Distance of vertices to weld, in the mesh's units";
    window.fill_in(Role::SpinButton, field, "0.0005");
    window.settle();
    assert_message("mend-window-nothing-to-weld", &window.text_with("No "));
    assert!(!window.is_enabled("Weld vertices"));
    window.fill_in(Role::SpinButton, field, "0.4");
    window.settle();
    assert_message("mend-window-count-before-welding", &window.text_with("welded"));
    window.click("Weld vertices");
    assert!(window.editor().session.charts().is_none() && window.is_proved(), "{}", window.verdict());
    let distance = window.editor().session.document().form.repair.weld_distance();
    assert_eq!(distance.map(WeldDistance::get), Some(0.4));
    assert_message("mend-window-welded", &window.text_with("Welded"));
    window.click("Do not weld");
    assert_eq!(window.editor().session.charts().map(|charts| charts.count()), Some(2));
}

#[test]
fn a_part_that_cannot_be_flattened_is_left_out_and_kept_again() {
    let mut mesh = tetrahedron();
    let (sheet, first) = (sheet(4, 0.3), mesh.vertex_count());
    mesh.positions.extend(sheet.positions.iter().map(|place| *place + DVec3::Z * 9.0));
    mesh.triangles.extend(sheet.triangles.iter().map(|face| face.map(|v| VertexId::from_index(v.index() + first))));
    let mut window = Window::with_faulty("two.obj", &mesh);
    window.click("Defects");
    assert!(!window.is_proved(), "{}", window.verdict());
    let clicked = |window: &mut Window, name: &str| {
        window.harness.get_by_role_and_label(Role::CheckBox, name).click();
        window.settle();
    };
    clicked(&mut window, "Keep the part of face 0");
    assert!(window.is_proved(), "{}", window.verdict());
    assert!(done(&window).contains(&(Repair::LeaveOutParts, 1)), "{:?}", done(&window));
    clicked(&mut window, "Keep the part of face 0");
    assert!(!window.is_proved(), "{}", window.verdict());
    window.click("Only the part of face 4");
    assert!(window.is_proved(), "{}", window.verdict());
    window.click("Keep all");
    assert!(!window.is_proved(), "{}", window.verdict());
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(window.is_proved(), "{}", window.verdict());
}
