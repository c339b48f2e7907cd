//! Vertices, edges and faces: on a chart that is shown alone, and on the page of all charts.

use std::collections::BTreeSet;

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2};
use freebound::session::Action;
use freebound::ui::{PageRequest, Request, SelectBy, SelectionKind};
use freebound::view::{ElementKind, ElementSet, MeshElement};
use freebound_core::mesh::VertexId;
use glam::DVec2;

use crate::charts::{until_laid_out, with_sheet_alone, with_sheets};
use crate::harness::{Window, sheet};
use crate::page::{spot, until, until_proved};

const CTRL: Modifiers = Modifiers::COMMAND;

/// Selected elements of the page.
fn of_page(window: &Window) -> ElementSet {
    window.editor().plane.page.elements().clone()
}

/// Place of a vertex of a chart on the window.
fn place(window: &Window, chart: usize, vertex: usize) -> Pos2 {
    let page = window.editor().session.page().expect("a page");
    spot(window, page.charts[chart].coordinates[vertex] * DVec2::new(page.aspect, 1.0))
}

fn middle(window: &Window, chart: usize, vertices: &[usize]) -> Pos2 {
    let all: Vec<Pos2> = vertices.iter().map(|&vertex| place(window, chart, vertex)).collect();
    let sum = all.iter().fold(egui::Vec2::ZERO, |sum, at| sum + at.to_vec2());
    (sum / all.len() as f32).to_pos2()
}

/// Corners of the first triangle of a chart.
fn first_triangle(window: &Window, chart: usize) -> [usize; 3] {
    let page = window.editor().session.page().expect("a page");
    page.charts[chart].mesh().mesh().real_triangles()[0].map(VertexId::index)
}

/// Charts that have selected elements.
fn charts(window: &Window) -> BTreeSet<usize> {
    let page = window.editor().session.page().expect("a page");
    let ends: Vec<usize> = page
        .charts
        .iter()
        .scan(0, |end, chart| {
            *end += chart.mesh().vertex_count();
            Some(*end)
        })
        .collect();
    of_page(window).vertices().iter().map(|v| ends.partition_point(|end| *end <= v.index())).collect()
}

#[test]
fn vertices_of_several_charts_are_selected_on_the_page() {
    let mut window = with_sheets();
    window.press(CTRL, Key::Num1);
    assert_eq!(window.editor().element_kind(), Some(ElementKind::Vertices));
    let first = place(&window, 0, 0);
    window.click_at(first, Modifiers::NONE);
    assert_eq!((of_page(&window).vertices().len(), charts(&window)), (1, [0].into()));
    let other = place(&window, 2, 3);
    window.click_at(other, Modifiers::SHIFT);
    assert_eq!((of_page(&window).vertices().len(), charts(&window)), (2, [0, 2].into()));
    assert!(window.editor().plane.page.selected().is_empty(), "no chart is selected");
    window.menu(&["Edit", "Select", "Select all connected"]);
    let all = |chart: usize| window.editor().session.page().expect("a page").charts[chart].mesh().vertex_count();
    assert_eq!(of_page(&window).vertices().len(), all(0) + all(2));
    window.menu(&["Edit", "Select", "Invert the selection"]);
    assert_eq!(charts(&window), [1].into());
    let before = window.editor().plane.page.pane.camera().expect("shown");
    window.key(Key::F);
    let after = window.editor().plane.page.pane.camera().expect("shown");
    assert!(after.points_per_unit() > before.points_per_unit(), "one chart is smaller than the page");
    assert_eq!(window.editor().session.history().depth(), 1, "a selection is no edit");
    window.key(Key::Escape);
    assert!(of_page(&window).is_empty());
}

#[test]
fn edges_and_faces_are_selected_on_the_page_by_clicks_boxes_and_strokes() {
    let mut window = with_sheets();
    window.open_list("What clicks select");
    window.click("Edges");
    let [a, b, c] = first_triangle(&window, 1);
    let at = middle(&window, 1, &[a, b]);
    window.click_at(at, Modifiers::NONE);
    assert_eq!((of_page(&window).edges().len(), charts(&window)), (1, [1].into()));
    // A second click with Shift takes the edge away.
    window.click_at(at, Modifiers::SHIFT);
    assert!(of_page(&window).is_empty());
    window.press(CTRL, Key::Num3);
    let at = middle(&window, 1, &[a, b, c]);
    window.click_at(at, Modifiers::NONE);
    assert_eq!(of_page(&window).kind(), ElementKind::Faces);
    assert_eq!(of_page(&window).vertices().len(), 3);
    let view = window.plane_view();
    window.drag(view.min + egui::Vec2::splat(2.0), view.max - egui::Vec2::splat(2.0), CTRL);
    let page = window.editor().session.page().expect("a page");
    let all: usize = page.charts.iter().map(|chart| chart.mesh().mesh().real_triangles().len()).sum();
    assert_eq!(of_page(&window).faces().len(), all, "a box around everything");
    window.key(Key::Escape);
    let (from, to) = (middle(&window, 0, &first_triangle(&window, 0)), middle(&window, 2, &first_triangle(&window, 2)));
    window.drag(from, to, CTRL | Modifiers::SHIFT);
    assert!(charts(&window).is_superset(&[0, 2].into()), "{:?}", charts(&window));
    assert!(of_page(&window).faces().len() < all);
}

#[test]
fn selected_charts_become_their_elements_and_elements_become_their_charts() {
    let mut window = with_sheets();
    window.editor_mut().handle(PageRequest::Pick { chart: Some(1), adds: false }.into());
    window.press(CTRL, Key::Num2);
    assert_eq!((of_page(&window).kind(), charts(&window)), (ElementKind::Edges, [1].into()));
    assert!(window.editor().plane.page.selected().is_empty());
    window.press(CTRL, Key::Num4);
    assert!(of_page(&window).is_empty());
    assert_eq!(*window.editor().plane.page.selected(), [1].into());
    // A chart of the list is selected as a chart, whatever clicks select.
    window.press(CTRL, Key::Num1);
    window.editor_mut().handle(PageRequest::Pick { chart: Some(0), adds: false }.into());
    assert_eq!(window.editor().element_kind(), None);
    assert_eq!((*window.editor().plane.page.selected()).clone(), [0].into());
}

#[test]
fn enter_shows_the_chart_of_the_selected_elements_alone_with_these() {
    for chart in 0..3 {
        let mut window = with_sheets();
        window.press(CTRL, Key::Num1);
        let at = place(&window, chart, 5);
        window.click_at(at, Modifiers::NONE);
        let on_chart = |window: &Window| window.editor().session.chart_on_screen();
        window.key(Key::Enter);
        until(&mut window, |editor| !editor.selection.vertices().is_empty());
        assert_eq!((window.editor().shows_page(), on_chart(&window)), (false, Some(chart)));
        assert!(window.editor().selection.vertices().contains(&VertexId::new(5)));
    }
}

#[test]
fn every_way_of_selecting_applies_to_every_kind_on_the_page_and_alone() {
    for alone in [false, true] {
        let mut window = if alone { with_sheet_alone() } else { with_sheets() };
        for kind in [ElementKind::Vertices, ElementKind::Edges, ElementKind::Faces] {
            window.editor_mut().handle(Request::SetSelectionKind(SelectionKind::Elements(kind)));
            for by in SelectBy::ALL {
                window.editor_mut().handle(Request::SelectBy(SelectBy::All));
                let is_for = window.editor().can_select_by(by);
                assert_eq!(
                    is_for,
                    by != SelectBy::Pins && (by, kind) != (SelectBy::Rings, ElementKind::Faces),
                    "{by:?} {kind:?}"
                );
                window.editor_mut().handle(Request::SelectBy(by));
                assert_eq!(window.editor().selected_elements().kind(), kind, "{by:?}");
                let is_empty = window.editor().selected_elements().is_empty();
                assert_eq!(is_empty, by == SelectBy::Invert, "{by:?} {kind:?}");
            }
            window.step();
        }
    }
}

#[test]
fn the_mesh_is_cut_around_selected_faces_and_joined_again() {
    let mut window = with_sheets();
    let count = |window: &Window| window.editor().session.charts().map_or(0, |charts| charts.count());
    let before = count(&window);
    window.press(CTRL, Key::Num3);
    let inner = window.editor().session.page().expect("a page").charts[0].mesh().boundary_loop().to_vec();
    let mesh = window.editor().session.page().expect("a page").charts[0].mesh().clone();
    let face = mesh.mesh().real_triangles().iter().position(|corners| corners.iter().all(|v| !inner.contains(v)));
    let face = freebound_core::mesh::FaceId::from_index(face.expect("a face inside"));
    window.editor_mut().handle(Request::SelectElement { element: MeshElement::Face(face), adds: false });
    window.settle();
    window.press(Modifiers::SHIFT, Key::X);
    until_laid_out(&mut window);
    assert_eq!(window.editor().session.seams().edges().len(), 3, "the three sides of the face");
    window.menu(&["Edit", "Undo"]);
    until_laid_out(&mut window);
    assert_eq!(count(&window), before);
    // Nothing to cut: the boundary is open already.
    window.editor_mut().handle(Request::SelectBy(SelectBy::All));
    window.menu(&["Edit", "Seams", "Cut along the selection"]);
    assert!(window.editor().session.seams().edges().is_empty());
    window.menu(&["Edit", "Seams", "Join along the selection"]);
    assert!(window.editor().session.seams().edges().is_empty());
}

#[test]
fn a_cut_along_an_edge_loop_makes_two_charts_and_joining_it_makes_one() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    window.press(CTRL, Key::Num2);
    let edge = MeshElement::Edge([VertexId::new(38), VertexId::new(39)]);
    window.editor_mut().handle(Request::SelectElement { element: edge, adds: false });
    window.menu(&["Edit", "Select", "Select edge loops"]);
    assert_eq!(window.editor().selection.elements().edges().len(), 8, "from side to side");
    window.menu(&["Edit", "Seams", "Cut along the selection"]);
    until_proved(&mut window);
    assert_eq!(window.editor().session.charts().map(|charts| charts.count()), Some(2));
    window.press(CTRL, Key::Num2);
    window.editor_mut().handle(Request::SelectBy(SelectBy::All));
    window.menu(&["Edit", "Seams", "Join along the selection"]);
    window.settle();
    assert!(window.editor().session.charts().is_none() && window.editor().session.seams().edges().is_empty());
}

#[test]
fn edges_and_faces_of_a_chart_alone_are_picked_in_both_panes() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    for (key, kind) in [(Key::Num2, ElementKind::Edges), (Key::Num3, ElementKind::Faces)] {
        window.press(CTRL, key);
        let in_plane = window.plane_view().center();
        let on_mesh = window.mesh_view().center();
        for at in [in_plane, on_mesh] {
            window.editor_mut().handle(Request::SelectNothing);
            // An edge is within reach of one of these places.
            for dx in [0.0, 4.0, 8.0, 12.0, 16.0] {
                window.click_at(at + egui::vec2(dx, 0.0), Modifiers::NONE);
                if !window.editor().selection.elements().is_empty() {
                    break;
                }
            }
            let elements = window.editor().selection.elements();
            assert_eq!((elements.kind(), elements.is_empty()), (kind, false), "{at:?}");
        }
        // A press beside the mesh selects nothing.
        let corner = window.plane_view().min + egui::Vec2::splat(3.0);
        window.click_at(corner, Modifiers::NONE);
        assert!(window.editor().selection.elements().is_empty());
    }
    assert!(window.rect(Role::ComboBox, "What clicks select").width() > 20.0);
}

#[test]
fn a_cut_along_all_edges_gives_each_face_a_chart_of_its_own() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.4));
    window.press(CTRL, Key::Num2);
    window.press(CTRL, Key::A);
    window.press(Modifiers::SHIFT, Key::X);
    until_proved(&mut window);
    assert_eq!(window.editor().session.charts().map(|charts| charts.count()), Some(32));
    window.press(CTRL, Key::Z);
    window.settle();
    assert!(window.editor().session.charts().is_none() && window.is_proved());
}

#[test]
fn elements_of_the_page_stay_selected_while_a_chart_is_solved_again() {
    let mut window = with_sheets();
    window.press(CTRL, Key::Num3);
    let at = middle(&window, 0, &first_triangle(&window, 0));
    window.click_at(at, Modifiers::NONE);
    let before = of_page(&window);
    assert!(!before.is_empty());
    window.editor_mut().session.handle(Action::Fix(vec![VertexId::new(0), VertexId::new(5)]));
    until_laid_out(&mut window);
    assert_eq!(of_page(&window), before);
    // An element that a mesh does not have is not selected.
    for beyond in [MeshElement::Vertex(VertexId::new(9999)), MeshElement::Edge([VertexId::new(1), VertexId::new(9999)])]
    {
        window.editor_mut().handle(Request::SelectElement { element: beyond, adds: false });
        assert!(of_page(&window).is_empty(), "{beyond:?}");
    }
}
