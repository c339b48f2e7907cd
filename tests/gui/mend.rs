//! A mesh that is no disk, mended in the window.

use eframe::egui;
use egui::{Key, Modifiers};
use freebound::mesh::{TriMesh, VertexId};

use crate::harness::{Window, sheet};
use crate::makers::tetrahedron;

#[test]
fn a_mesh_that_can_be_mended_says_how_and_is_mended_by_one_click() {
    let mut window = Window::with_mesh("closed.obj", &tetrahedron());
    assert!(window.verdict().ends_with("fault"), "{}", window.verdict());
    assert!(window.shows("The mesh can be mended: 3 edges cut open"), "{:?}", window.words());
    window.click("Mend all");
    assert!(window.is_proved(), "{}", window.verdict());
    assert!(!window.has_button("Mend all") && !window.has_button("Dismiss"), "{:?}", window.words());
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
    window.click("Mend all faults");
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
    assert!(window.shows("Mesh: 1 vertex of no face"), "{:?}", window.words());
    assert!(window.words().iter().any(|words| words.starts_with("Mesh: faces without area")), "{:?}", window.words());
}
