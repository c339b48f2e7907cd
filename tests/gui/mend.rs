//! Repair of a mesh that is not a disk, in the window.

use eframe::egui;
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;
use freebound_core::mesh::{TriMesh, VertexId};
use glam::DVec3;

use crate::harness::{Window, sheet};
use freebound_testkit::tetrahedron;

#[test]
fn a_mesh_that_can_be_mended_says_how_and_is_mended_by_one_click() {
    let mut window = Window::with_mesh("closed.obj", &tetrahedron());
    assert!(window.verdict().ends_with("fault"), "{}", window.verdict());
    assert!(window.shows("The mesh can be repaired: 3 edges cut open"), "{:?}", window.words());
    window.click("Repair all");
    assert!(window.is_proved(), "{}", window.verdict());
    assert!(!window.has_button("Repair all") && !window.has_button("Dismiss"), "{:?}", window.words());
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(window.verdict().ends_with("fault"), "{}", window.verdict());
    window.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert!(window.is_proved(), "{}", window.verdict());
}

#[test]
fn the_panel_of_defects_leads_from_each_element_of_a_fault_to_the_next() {
    let mut mesh = sheet(6, 0.3);
    for face in [10, 20, 30] {
        mesh.triangles[face].reverse();
    }
    let mut window = Window::with_mesh("turned.obj", &mesh);
    window.click("Defects");
    assert!(window.shows("Turn these faces over"), "{:?}", window.words());
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
    window.click("Repair all faults");
    assert!(window.is_proved(), "{}", window.verdict());
    assert!(window.shows("Mesh: 3 faces turned over"), "{:?}", window.words());
}

#[test]
fn what_is_harmless_is_told_beside_the_verdict() {
    let mut mesh = sheet(6, 0.3);
    mesh.positions[23] = mesh.positions[24];
    let positions = [&mesh.positions[..], &[glam::DVec3::splat(9.0)]].concat();
    let mut window = Window::with_mesh("odd.obj", &TriMesh { positions, ..mesh });
    assert!(window.is_proved(), "{}", window.verdict());
    window.click("Defects");
    assert!(window.shows("Mesh: 1 unreferenced vertex"), "{:?}", window.words());
    assert!(window.words().iter().any(|words| words.starts_with("Mesh: zero-area faces")), "{:?}", window.words());
}

#[test]
fn each_fault_has_a_remedy_of_its_own_and_what_is_left_is_told() {
    let mut mesh = tetrahedron();
    mesh.triangles[2].swap(0, 1);
    let mut window = Window::with_mesh("odd.obj", &mesh);
    window.click("Defects");
    assert!(window.has_button("Turn faces over") && window.has_button("Cut open"), "{:?}", window.words());
    window.click("Turn faces over");
    assert!(window.shows("Mesh: 1 face turned over"), "{:?}", window.words());
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
    assert!(window.shows("No vertices lie within this distance"), "{:?}", window.words());
    assert!(!window.is_enabled("Weld vertices"));
    window.fill_in(Role::SpinButton, field, "0.4");
    window.settle();
    assert!(window.words().iter().any(|words| words.ends_with("vertices will be welded")), "{:?}", window.words());
    window.click("Weld vertices");
    assert!(window.editor().session.charts().is_none() && window.is_proved(), "{}", window.verdict());
    assert!(window.shows("Welded within 0.4"), "{:?}", window.words());
    window.click("Do not weld");
    assert_eq!(window.editor().session.charts().map(|charts| charts.count()), Some(2));
}

#[test]
fn a_part_that_cannot_be_flattened_is_left_out_and_kept_again() {
    let mut mesh = tetrahedron();
    let (sheet, first) = (sheet(4, 0.3), mesh.vertex_count());
    mesh.positions.extend(sheet.positions.iter().map(|place| *place + DVec3::Z * 9.0));
    mesh.triangles.extend(sheet.triangles.iter().map(|face| face.map(|v| VertexId::from_index(v.index() + first))));
    let mut window = Window::with_mesh("two.obj", &mesh);
    window.click("Defects");
    assert!(!window.is_proved(), "{}", window.verdict());
    let clicked = |window: &mut Window, name: &str| {
        window.harness.get_by_role_and_label(Role::CheckBox, name).click();
        window.settle();
    };
    clicked(&mut window, "Keep the part of face 0");
    assert!(window.is_proved(), "{}", window.verdict());
    assert!(window.shows("Mesh: 1 part left out"), "{:?}", window.words());
    clicked(&mut window, "Keep the part of face 0");
    assert!(!window.is_proved(), "{}", window.verdict());
    window.click("Only the part of face 4");
    assert!(window.is_proved(), "{}", window.verdict());
    window.click("Keep all");
    assert!(!window.is_proved(), "{}", window.verdict());
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(window.is_proved(), "{}", window.verdict());
}
