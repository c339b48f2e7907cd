//! Selection of vertices and charts by the mesh, the map and the present selection.

use eframe::egui::{Key, Modifiers, Vec2};
use freebound::examples::Example;
use freebound::session::Action;
use freebound::ui::{PageRequest, Request, SelectBy};
use freebound_core::mesh::VertexId;
use freebound_testkit::shaped;
use glam::DVec3;

use crate::charts::{until_laid_out, with_sheets};
use crate::harness::{Window, sheet};

fn selected(window: &Window) -> usize {
    window.editor().selection.vertices().len()
}

#[test]
fn the_menu_selects_by_the_mesh_and_by_the_map() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    window.menu(&["Edit", "Select", "Select the boundary"]);
    assert_eq!(selected(&window), 32);
    window.menu(&["Edit", "Select", "Grow the selection"]);
    assert_eq!(selected(&window), 56);
    window.menu(&["Edit", "Select", "Shrink the selection"]);
    assert_eq!(selected(&window), 34, "two corners of the second ring have no neighbour in the third");
    window.menu(&["Edit", "Select", "Invert the selection"]);
    assert_eq!(selected(&window), 47);
    window.menu(&["Edit", "Select", "Select all"]);
    assert_eq!(selected(&window), 81);
    window.menu(&["Edit", "Select", "Select the most distorted"]);
    assert!((3..60).contains(&selected(&window)), "{}", selected(&window));
    window.editor_mut().session.handle(Action::Fix(vec![VertexId::new(3), VertexId::new(70)]));
    window.settle();
    window.menu(&["Edit", "Select", "Select the pins"]);
    assert_eq!(selected(&window), 2);
}

#[test]
fn a_side_of_a_roof_is_selected_up_to_its_ridge() {
    let roof = shaped(8, 4, |x, y| DVec3::new(x, y, -(x - 4.0).abs()));
    let mut window = Window::with_mesh("roof.obj", &roof);
    window.editor_mut().selection.select([VertexId::new(20)]);
    window.menu(&["Edit", "Select", "Select up to sharp edges"]);
    assert_eq!(selected(&window), 25);
}

#[test]
fn edge_loops_and_rings_of_quadrilaterals_cross_the_sheet() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("squares.obj");
    let corner = |x: u32, y: u32| 7 * y + x + 1;
    let vertex = |i: u32| format!("v {} {} 0", i % 7, i / 7);
    let face = |i: u32| {
        let (x, y) = (i % 6, i / 6);
        format!("f {} {} {} {}", corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1))
    };
    let lines: Vec<String> = (0..49).map(vertex).chain((0..36).map(face)).collect();
    std::fs::write(&path, lines.join("\n")).expect("the folder can be written to");
    let mut window = Window::with_file(&path);
    let edge = [VertexId::new(24), VertexId::new(25)];
    window.editor_mut().selection.select(edge);
    window.menu(&["Edit", "Select", "Select edge loops"]);
    assert_eq!(*window.editor().selection.vertices(), (21..28).map(VertexId::new).collect());
    window.editor_mut().selection.select(edge);
    window.menu(&["Edit", "Select", "Select edge rings"]);
    let ring = (0..7).flat_map(|y| [7 * y + 3, 7 * y + 4]).map(VertexId::new).collect();
    assert_eq!(*window.editor().selection.vertices(), ring);
    // Opposite corners of a quadrilateral have no edge between them, though its triangles may have one.
    for diagonal in [[24, 32], [25, 31]] {
        window.editor_mut().selection.select(diagonal.map(VertexId::new));
        assert!(!window.editor().can_select_by(SelectBy::Loops) && !window.editor().can_select_by(SelectBy::Rings));
    }
}

#[test]
fn a_box_through_the_mesh_selects_what_the_mesh_hides() {
    let mut window = Window::with_example(Example::BumpyCap);
    let view = window.mesh_view();
    let all = window.embedding().len();
    let around = |window: &mut Window| {
        window.editor_mut().selection.select([]);
        window.drag(view.min + Vec2::splat(2.0), view.max - Vec2::splat(2.0), Modifiers::COMMAND);
        selected(window)
    };
    let seen = around(&mut window);
    assert!(seen > 0 && seen < all, "{seen} of {all}");
    window.menu(&["Edit", "Select", "Through the mesh (X-ray)"]);
    assert_eq!(around(&mut window), all);
    window.press(Modifiers::ALT, Key::Z);
    assert_eq!(around(&mut window), seen);
}

#[test]
fn charts_of_the_page_are_selected_by_their_pins_and_their_distortion() {
    let mut window = with_sheets();
    let of_page = |window: &Window| window.editor().plane.page.selected().len();
    window.menu(&["Edit", "Select", "Select all"]);
    let count = of_page(&window);
    assert!(count > 1, "{count}");
    // No chart has pins, none is distorted, and vertices cannot grow on the page.
    for by in [SelectBy::Pins, SelectBy::Distorted, SelectBy::Grow] {
        assert!(!window.editor().can_select_by(by), "{by:?}");
        window.editor_mut().handle(Request::SelectBy(by));
        assert_eq!(of_page(&window), count, "{by:?}");
    }
    window.editor_mut().session.handle(Action::ShowChart(1));
    window.settle();
    window.editor_mut().session.handle(Action::Fix(vec![VertexId::new(0), VertexId::new(5)]));
    until_laid_out(&mut window);
    window.editor_mut().handle(PageRequest::Show(true).into());
    until_laid_out(&mut window);
    window.menu(&["Edit", "Select", "Select the pins"]);
    assert_eq!(window.editor().plane.page.selected().iter().copied().collect::<Vec<_>>(), [1]);
}

#[test]
fn ways_that_need_a_selection_say_so() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    window.editor_mut().handle(Request::SelectBy(SelectBy::Grow));
    window.editor_mut().handle(Request::SelectBy(SelectBy::SharpEdges));
    window.settle();
    assert_eq!(selected(&window), 0);
    assert!(!window.editor().can_select_by(SelectBy::Grow) && window.editor().can_select_by(SelectBy::All));
}
