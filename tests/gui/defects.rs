//! List of defects, and jumping to them and to other elements.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use freebound::examples::Example;
use freebound::session::Action;
use freebound::ui::Defect;
use freebound_core::mesh::VertexId;
use freebound_core::problem::{Family, Method, Settings};
use glam::DVec2;

use crate::harness::{Pill, Window, sheet};
use freebound_testkit::{assert_message, corpus, corpus_test};

/// Window with a folded embedding.
fn folded() -> Window {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    fold(&mut window);
    window
}

/// Swaps two inner vertices of a sheet of 6 × 6 squares with pinned corners. The method does not repair folds.
pub(crate) fn fold(window: &mut Window) {
    exchange(window, [0, 6, 42, 48], [16, 32]);
}

/// Pins the corners in place, and two inner vertices at each other's position.
fn exchange(window: &mut Window, corners: [u32; 4], inner: [u32; 2]) {
    // The automatic strategy would remove the folds.
    let natural = Settings::new(Method::Natural, Family::Conformal);
    window.editor_mut().session.handle(Action::SetSettings(natural));
    window.settle();
    let embedding = window.embedding();
    let [a, b] = inner.map(VertexId::new);
    let session = &mut window.editor_mut().session;
    session.handle(Action::Fix(corners.map(VertexId::new).into_iter().chain([a, b]).collect()));
    session.handle(Action::MovePin { vertex: a, target: embedding[b] });
    session.handle(Action::MovePin { vertex: b, target: embedding[a] });
    session.handle(Action::EndGesture);
    window.settle();
    assert!(!window.outcome().step.verdict.flipped_faces.is_empty(), "it folds");
}

/// Swaps two inner vertices of a sheet of 4 × 4 squares.
pub(crate) fn fold_any(window: &mut Window) {
    exchange(window, [0, 4, 20, 24], [6, 18]);
}

#[test]
fn the_list_of_defects_jumps_to_a_face_in_both_panes() {
    let mut window = folded();
    window.click(&format!("Defects {}", window.editor().defect_count()));
    let Defect::Flipped(face) = window.editor().defects()[1] else { panic!("flipped faces come first") };
    let before = (window.editor().mesh.pane.camera(), window.editor().plane.pane.camera());
    window.click(&format!("flipped face {face}"));
    let corners = window.editor().session.model().expect("open").mesh().triangles[face.index()];
    assert_eq!(*window.editor().selection.vertices(), corners.into_iter().collect());
    assert_eq!(window.editor().selection.defect(), Some(1));
    assert_ne!((window.editor().mesh.pane.camera(), window.editor().plane.pane.camera()), before);
    let embedding = window.embedding();
    for corner in corners {
        assert!(window.plane_view().contains(window.place_in_plane(embedding[corner])));
        assert!(window.mesh_view().contains(window.place_on_mesh(corner)));
    }
}

#[test]
fn from_the_cube_s_first_fold_to_the_equation_of_a_vertex_at_fault_it_is_three_actions() {
    let mut window = Window::with_example(Example::Cube);
    let disk = window.editor().session.model().and_then(|model| model.disk()).cloned().expect("a disk");
    let rim = disk.boundary_loop();
    let corners = [0, 1, 2, 3].map(|quarter| rim[quarter * rim.len() / 4].number());
    let inside: Vec<u32> =
        disk.vertices().filter(|&v| disk.boundary_place(v).is_none()).map(VertexId::number).collect();
    exchange(&mut window, corners, [inside[0], inside[inside.len() - 1]]);
    window.key(Key::D);
    let Some(Defect::Flipped(face)) = window.editor().defects().first().copied() else { panic!("it folds") };
    let corner = disk.face(face)[0];
    window.click_at(window.place_in_plane(window.embedding()[corner]), Modifiers::NONE);
    assert_eq!(*window.editor().selection.vertices(), [corner].into());
    window.click("Vertex");
    assert!(window.shows(&corner.to_string()) && window.shows("eq. "), "{:?}", window.words());
}

#[test]
fn a_concave_polygon_is_listed_and_shown_with_all_its_corners() {
    let folder = tempfile::tempdir().expect("a folder for files");
    let path = folder.path().join("quad.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n").expect("a folder for files");
    let mut window = Window::with_file(&path);
    window.editor_mut().session.handle(Action::SetSettings(Settings::new(Method::Natural, Family::Conformal)));
    let corners = [0, 1, 2, 3].map(VertexId::new);
    window.editor_mut().session.handle(Action::Fix(corners.to_vec()));
    // Both triangles stay positive, but the other diagonal lies outside.
    for (vertex, [x, y]) in corners.into_iter().zip([[0.7, 0.7], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]) {
        window.editor_mut().session.handle(Action::MovePin { vertex, target: DVec2::new(x, y) });
    }
    window.editor_mut().session.handle(Action::EndGesture);
    window.settle();
    let [Defect::Concave(face)] = window.editor().defects()[..] else { panic!("{:?}", window.editor().defects()) };
    window.click("Defects 1");
    window.click(&format!("concave polygon at {face}"));
    assert_eq!(*window.editor().selection.vertices(), corners.into_iter().collect());
}

#[test]
fn defects_are_stepped_through_by_key_button_and_verdict() {
    let mut window = folded();
    let count = window.editor().defect_count();
    window.key(Key::D);
    assert_eq!(window.editor().selection.defect(), Some(0));
    window.press(Modifiers::SHIFT, Key::D);
    assert_eq!(window.editor().selection.defect(), Some(count - 1), "around the end");
    window.key(Key::D);
    window.key(Key::D);
    assert_eq!(window.editor().selection.defect(), Some(1 % count));
    let pill = format!("Verdict: {}", window.verdict());
    window.click(&pill);
    assert_eq!(window.editor().selection.defect(), Some(2 % count));
    window.click(&format!("Defects {count}"));
    window.click("Next");
    window.click("Previous");
    assert_eq!(window.editor().selection.defect(), Some(2 % count));
}

#[test]
fn a_defect_that_is_gone_is_not_gone_to() {
    let mut window = folded();
    for _ in 0..3 {
        window.key(Key::D);
    }
    window.menu(&["Edit", "Free all pins"]);
    assert!(window.is_proved(), "{}", window.verdict());
    window.key(Key::D);
    window.click("Defects");
    assert_message("defects-window-planar", &window.text_with("one-to-one"));
    assert!(!window.shows(" of 0"), "{:?}", window.words());
}

corpus_test! {
    fn the_crossings_of_the_cow_are_listed_and_shown() {
        let mut window = Window::with_file(&corpus().join("cow_seamster.obj"));
        let natural = Settings::new(Method::Natural, Family::Conformal);
        window.editor_mut().session.handle(Action::SetSettings(natural));
        window.settle();
        let outcome = window.outcome();
        assert!(!outcome.step.verdict.planar && !outcome.step.verdict.boundary_crossings.is_empty());
        assert_eq!(window.pill(), Pill::Bad, "{}", window.verdict());
        let [a, b] = outcome.step.verdict.boundary_crossings[0];
        let flipped = outcome.step.verdict.flipped_faces.len();
        window.click(&format!("Defects {}", window.editor().defect_count()));
        for _ in 0..=flipped {
            window.key(Key::D);
        }
        assert_eq!(
            window.editor().defects()[window.editor().selection.defect().expect("one")],
            Defect::Crossing([a, b])
        );
        let disk = window.editor().session.model().and_then(|model| model.disk()).cloned().expect("a disk");
        let ends = [a, b].into_iter().flat_map(|edge| disk.ends(edge)).collect();
        assert_eq!(*window.editor().selection.vertices(), ends);
    }
}

#[test]
fn go_to_finds_vertices_edges_and_faces_by_number() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let triangles = window.editor().session.model().expect("open").mesh().triangles.clone();
    for (text, expected) in [("24", vec![24]), ("v7", vec![7]), ("f3", triangles[3].map(VertexId::number).to_vec())] {
        window.key(Key::G);
        window.type_text(text);
        window.key(Key::Enter);
        let mut selected: Vec<u32> = window.editor().selection.vertices().iter().map(|v| v.number()).collect();
        let mut expected = expected;
        selected.sort_unstable();
        expected.sort_unstable();
        assert_eq!(selected, expected, "{text}");
        assert!(window.editor().layout.go_to.is_none(), "it closes");
    }
    window.menu(&["View", "Go to…"]);
    window.type_text("e0");
    window.click("Go");
    assert_eq!(window.editor().selection.vertices().len(), 2);
}

#[test]
fn go_to_says_so_where_there_is_no_such_element() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.key(Key::G);
    assert!(!window.shows("such"), "not before anything is typed");
    window.type_text("49");
    assert_message("defects-window-no-such-element", &window.text_with("such"));
    assert!(!window.is_enabled("Go"));
    window.key(Key::Enter);
    assert!(window.editor().selection.vertices().is_empty());
    assert!(window.editor().layout.go_to.is_some(), "it stays for a better number");
    window.key(Key::Escape);
    assert!(window.editor().layout.go_to.is_none());
}

#[test]
fn the_counts_of_defects_say_what_they_are_and_go_to_the_next_of_their_kind() {
    let mut window = folded();
    let defects = window.editor().defects();
    let flipped = defects.iter().filter(|defect| matches!(defect, Defect::Flipped(_))).count();
    assert!(flipped >= 2, "{defects:?}");
    window.click(&format!("Defects {}", defects.len()));
    let name = window.name_of(Role::Button, &format!("{flipped} flipped "));
    for expected in (0..flipped).chain([0]) {
        window.click(&name);
        assert_eq!(window.editor().selection.defect(), Some(expected));
    }
    let is_none =
        |(role, name, _): &(Role, String, egui::Rect)| *role == Role::Button && name.starts_with("0 overwound");
    assert!(!window.controls().iter().any(is_none) && window.shows("0 overwound"));
}

#[test]
fn go_to_takes_the_keyboard_when_it_opens_and_not_again() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.key(Key::G);
    window.type_text("24");
    window.harness.get_by_role_and_label(Role::Button, "Go").focus();
    window.harness.run_steps(5);
    assert!(window.harness.get_by_role_and_label(Role::Button, "Go").is_focused(), "it is left to the button");
    window.key(Key::Space);
    assert!(window.editor().selection.vertices().contains(&VertexId::new(24)));
    assert!(window.editor().layout.go_to.is_none());
}

#[test]
fn vertices_outside_their_hulls_are_counted_marked_and_gone_through_in_the_tab_of_defects() {
    let mut window = folded();
    let outside = window.outcome().step.outside_hull.clone();
    assert!(outside.len() > 1, "it folds, and its boundary turns once: {outside:?}");
    let defects = window.editor().defect_count();
    window.click(&format!("Defects {defects}"));
    let title = format!("{} vertices outside their hulls", outside.len());
    assert!(!window.has_button("Next vertex outside"), "folded away at first");
    window.harness.get_by_label(&title).click();
    window.settle();
    for &vertex in outside.iter().chain(&outside[..1]) {
        window.click("Next vertex outside");
        assert_eq!(*window.editor().selection.vertices(), [vertex].into());
    }
    window.click("Previous vertex outside");
    assert_eq!(*window.editor().selection.vertices(), [outside[outside.len() - 1]].into());
    assert!(window.shows(&format!("{0} of {0}", outside.len())));
    assert!(!window.editor().selection.marks_outside_hull, "nothing is marked by itself");
    window.harness.get_by_label("Mark them in both panes").click();
    window.settle();
    assert!(window.editor().selection.marks_outside_hull);
    window.harness.get_by_label("Mark them in both panes").click();
    window.settle();
    assert!(!window.editor().selection.marks_outside_hull);
    assert_eq!(window.editor().defect_count(), defects, "they are no defects of the verdict");
}

/// Value in the row of numbers whose name begins with `name`.
fn value_of(window: &Window, name: &str) -> String {
    let labels = window.harness.query_all_by_role(Role::Label);
    let mut rows = labels.filter_map(|label| label.accesskit_node().value());
    let row = rows.find_map(|row| row.split_once(": ").filter(|_| row.starts_with(name)).map(|(_, of)| of.to_owned()));
    row.unwrap_or_else(|| panic!("no row is called {name:?}: {:?}", window.words()))
}

#[test]
fn where_an_embedding_is_planar_nothing_is_said_of_hulls_but_of_the_vertex_that_is_selected() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    assert!(window.is_proved());
    window.click("Defects");
    assert!(!window.shows("hull"), "{:?}", window.words());
    let rows = |window: &mut Window, vertex: u32| {
        window.editor_mut().selection.select([VertexId::new(vertex)]);
        window.click("Vertex");
        window.settle();
    };
    rows(&mut window, 24);
    assert_eq!([value_of(&window, "Hull"), value_of(&window, "Index")], ["inside", "0"]);
    rows(&mut window, 0);
    assert_message("defects-window-hull-of-a-corner", &value_of(&window, "Hull"));
    fold(&mut window);
    let outside = window.outcome().step.outside_hull[0];
    rows(&mut window, outside.number());
    assert!(value_of(&window, "Hull").starts_with("outside"), "{:?}", window.words());
    let index = value_of(&window, "Index");
    assert!(index.split_once(" to ").is_some_and(|(_, greatest)| greatest == "1"), "{index}");
}
