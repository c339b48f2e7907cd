//! Vertices, edges and faces: on a chart that is shown alone, and on the page of all charts.

use std::collections::BTreeSet;

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2};
use freebound::session::Action;
use freebound::ui::{PageRequest, Request, SelectBy, SelectionKind};
use freebound::view::{ElementKind, ElementSet, MeshElement};
use freebound_core::mesh::{EdgeId, FaceId, VertexId};
use freebound_testkit::assert_message;
use glam::DVec2;

use crate::charts::{until_laid_out, with_sheet_alone, with_sheets};
use crate::constrained;
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

/// Adjacent faces inside a chart: those at its first inner edge.
fn inner_faces(window: &Window, chart: usize) -> [FaceId; 2] {
    let page = window.editor().session.page().expect("a page");
    let (mesh, rim) = (page.charts[chart].mesh(), page.charts[chart].mesh().boundary_loop());
    let is_inner = |edge: &EdgeId| mesh.ends(*edge).iter().all(|end| !rim.contains(end));
    let edge = mesh.edges().find(is_inner).expect("an edge inside");
    let side = mesh.halfedge(edge);
    [side, mesh.twin(side)].map(|side| mesh.face_of(side).expect("faces on both sides"))
}

/// Selects faces of a chart of the page.
fn select_faces(window: &mut Window, chart: usize, faces: &[FaceId]) {
    window.press(CTRL, Key::Num3);
    let page = window.editor().session.page().expect("a page");
    let before: usize = page.charts[..chart].iter().map(|chart| chart.mesh().mesh().real_triangles().len()).sum();
    for face in faces {
        let element = MeshElement::Face(FaceId::from_index(before + face.index()));
        window.editor_mut().handle(Request::SelectElement { element, adds: true });
    }
    assert_eq!(of_page(window).faces().len(), faces.len());
}

#[test]
fn selected_faces_stay_faces_on_the_chart_that_enter_shows_and_are_cut_around() {
    for chart in 0..3 {
        let mut window = with_sheets();
        let faces = inner_faces(&window, chart);
        select_faces(&mut window, chart, &faces);
        window.key(Key::Enter);
        until(&mut window, |editor| !editor.selection.vertices().is_empty());
        let elements = window.editor().selection.elements();
        assert_eq!((elements.kind(), elements.faces().len(), elements.vertices().len()), (ElementKind::Faces, 2, 4));
        window.press(Modifiers::SHIFT, Key::X);
        until_laid_out(&mut window);
        assert_eq!(window.editor().session.seams().edges().len(), 4, "the sides of both, not the edge between them");
    }
}

#[test]
fn elements_return_with_the_cut_and_with_its_undo() {
    let mut window = with_sheets();
    let faces = inner_faces(&window, 1);
    select_faces(&mut window, 1, &faces);
    let before = of_page(&window);
    window.press(Modifiers::SHIFT, Key::X);
    until_proved(&mut window);
    let cut = of_page(&window);
    assert_eq!((cut.kind(), cut.faces().len(), charts(&window).len()), (ElementKind::Faces, 2, 1));
    window.press(CTRL, Key::Z);
    until_proved(&mut window);
    assert_eq!(of_page(&window), before);

    let mut alone = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    alone.press(CTRL, Key::Num3);
    let faces = [40, 41, 90].map(|face| MeshElement::Face(FaceId::new(face)));
    for element in faces {
        alone.editor_mut().handle(Request::SelectElement { element, adds: true });
    }
    let before = alone.editor().selection.elements().clone();
    alone.press(Modifiers::SHIFT, Key::X);
    until_proved(&mut alone);
    assert!(alone.editor().session.charts().is_some());
    alone.press(CTRL, Key::Z);
    alone.settle();
    assert_eq!(*alone.editor().selection.elements(), before, "also those on charts that were not shown");
}

#[test]
fn clicks_select_vertices_after_a_vertex_was_selected_by_its_number() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    for kind in [ElementKind::Edges, ElementKind::Faces] {
        window.editor_mut().handle(Request::SetSelectionKind(SelectionKind::Elements(kind)));
        window.editor_mut().handle(Request::GoToFileVertices(vec![VertexId::new(40)]));
        window.step();
        assert_eq!(window.editor().element_kind(), Some(ElementKind::Vertices));
        window.press(CTRL, Key::CloseBracket);
        assert!(window.editor().selection.vertices().len() > 4, "a vertex with its neighbours");
    }
}

#[test]
fn a_selected_face_stays_a_face_while_steps_arrive() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    window.choose("Method", "Mean-value iteration");
    window.press(CTRL, Key::Num3);
    for face in [3, 50, 80] {
        let element = MeshElement::Face(FaceId::new(face));
        window.editor_mut().handle(Request::Do(Action::Step));
        window.editor_mut().handle(Request::SelectElement { element, adds: false });
        window.settle();
        let elements = window.editor().selection.elements();
        assert_eq!(elements.faces().iter().copied().collect::<Vec<_>>(), [FaceId::new(face)]);
    }
}

#[test]
fn a_seam_follows_split_edges_but_not_the_inside_of_faces() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.4));
    constrained::place(&mut window, &constrained::TURNED);
    let outcome = window.outcome();
    let refinement = outcome.step.candidate.refinement.as_ref().expect("new vertices");
    let old = refinement.old_vertex_count();
    let mesh = refinement.disk().clone();
    let split = refinement.new_vertices()[0].edge;
    window.press(CTRL, Key::Num2);
    let select = |window: &mut Window, edge: [VertexId; 2]| {
        window.editor_mut().handle(Request::SelectElement { element: MeshElement::Edge(edge), adds: false });
        window.press(Modifiers::SHIFT, Key::X);
        window.settle();
    };
    // Both ends of an edge inside a face are new vertices of different edges, or one is none of its edge.
    let is_part_of = |v: VertexId, other: VertexId| {
        let edge = refinement.new_vertices()[v.index() - old].edge;
        edge.contains(&other) || (other.index() >= old && refinement.new_vertices()[other.index() - old].edge == edge)
    };
    let is_inner = |ends: &[VertexId; 2]| {
        let [a, b] = *ends;
        b.index() >= old && !is_part_of(b, a)
    };
    let all = mesh.edges().filter(|&edge| !mesh.is_virtual_edge(edge)).map(|edge| mesh.ends(edge));
    let inner = all.map(|[a, b]| [a.min(b), a.max(b)]).find(is_inner).expect("an edge inside a face");
    select(&mut window, inner);
    assert!(window.editor().session.seams().edges().is_empty());
    let message = window.editor().session.messages().last().expect("it is said");
    assert_message("elements-window-inner-edge", &message.text);
    let part = [split[0], VertexId::from_index(old)];
    select(&mut window, part);
    let seams: Vec<_> = window.editor().session.seams().edges().iter().copied().collect();
    assert_eq!(seams, [split], "the whole edge of the file");
}

#[test]
fn every_way_of_selecting_has_an_effect_on_a_single_element_of_every_kind() {
    for kind in [ElementKind::Vertices, ElementKind::Edges, ElementKind::Faces] {
        let mut window = with_sheets();
        window.editor_mut().handle(Request::SetSelectionKind(SelectionKind::Elements(kind)));
        let count = |window: &Window| {
            let elements = of_page(window);
            match kind {
                ElementKind::Vertices => elements.vertices().len(),
                ElementKind::Edges => elements.edges().len(),
                ElementKind::Faces => elements.faces().len(),
            }
        };
        let by = |window: &mut Window, by: SelectBy| {
            window.editor_mut().handle(Request::SelectBy(by));
            count(window)
        };
        let all = by(&mut window, SelectBy::All);
        let face = inner_faces(&window, 0)[0];
        let corners = window.editor().session.page().expect("a page").charts[0].mesh().face(face);
        let element = match kind {
            ElementKind::Vertices => MeshElement::Vertex(corners[0]),
            ElementKind::Edges => MeshElement::Edge([corners[0], corners[1]]),
            ElementKind::Faces => MeshElement::Face(face),
        };
        window.editor_mut().handle(Request::SelectElement { element, adds: false });
        assert_eq!(count(&window), 1, "{kind:?}");
        assert_eq!(by(&mut window, SelectBy::Invert), all - 1);
        assert_eq!(by(&mut window, SelectBy::Invert), 1);
        let grown = by(&mut window, SelectBy::Grow);
        assert!(grown > 3, "{kind:?}: {grown}");
        let shrunk = by(&mut window, SelectBy::Shrink);
        assert!((1..grown).contains(&shrunk), "{kind:?}: {shrunk} of {grown}");
        by(&mut window, SelectBy::Connected);
        assert_eq!(charts(&window), [0].into());
        let chart = count(&window);
        assert!(grown < chart && chart < all, "{kind:?}: {chart} of {all}");
        let boundary = by(&mut window, SelectBy::Boundary);
        assert_eq!(charts(&window), [0, 1, 2].into());
        assert!(chart < all && boundary < all, "{kind:?}: {boundary}");
        let worst = by(&mut window, SelectBy::Distorted);
        assert!((1..all / 2).contains(&worst), "{kind:?}: {worst}");
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
    let face = FaceId::from_index(face.expect("a face inside"));
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
        let embedding = window.embedding();
        let corners = [30, 31, 40].map(VertexId::new);
        let middle = |of: &[VertexId]| of.iter().map(|&v| embedding[v]).sum::<DVec2>() / of.len() as f64;
        let (at, expected) = match kind {
            ElementKind::Edges => (middle(&corners[..2]), corners[..2].to_vec()),
            _ => (middle(&corners), corners.to_vec()),
        };
        let at = window.place_in_plane(at);
        window.click_at(at, Modifiers::NONE);
        let picked: Vec<VertexId> = window.editor().selection.vertices().iter().copied().collect();
        assert_eq!(picked, expected, "{kind:?}");
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
