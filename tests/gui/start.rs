//! Texture coordinates of a file in the window: its charts, the map that starts from it, and the treatment of holes.

use std::fmt::Write as _;

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use freebound::session::{Action, MapOrigin};
use freebound_core::geom::VAxis;
use freebound_core::mesh::{HoleTreatment, Repair, TriMesh};
use freebound_core::problem::{Embedding, Stage, Start};
use glam::DVec2;

use crate::harness::{Window, sheet};

/// Sheet with sheared texture coordinates in its file; the half beyond `torn` is detached.
fn laid_out(window: &Window, name: &str, torn: f64) -> Embedding {
    let mesh = sheet(6, 0.3);
    let place = |v: usize, is_apart: bool| {
        let p = mesh.positions[v];
        DVec2::new(0.1 * p.x + 0.05 * p.y, 0.04 * p.y) + DVec2::X * if is_apart { 2.0 } else { 0.0 }
    };
    let count = mesh.positions.len();
    let mut text = String::new();
    for p in &mesh.positions {
        writeln!(text, "v {:?} {:?} {:?}", p.x, p.y, p.z).expect("memory");
    }
    for k in 0..2 * count {
        let uv = place(k % count, k >= count);
        writeln!(text, "vt {:?} {:?}", uv.x, uv.y).expect("memory");
    }
    for corners in &mesh.triangles {
        let middle = corners.iter().map(|v| mesh.positions[v.index()].x).sum::<f64>() / 3.0;
        let of = |v: usize| 1 + v + if middle > torn { count } else { 0 };
        let words: Vec<String> = corners.iter().map(|v| format!("{}/{}", v.index() + 1, of(v.index()))).collect();
        writeln!(text, "f {}", words.join(" ")).expect("memory");
    }
    std::fs::write(window.path(name), text).expect("the folder is there");
    (0..count).map(|v| place(v, false)).collect()
}

fn opened(torn: f64) -> (Window, Embedding) {
    let mut window = Window::with_mesh("plain.obj", &sheet(5, 0.3));
    let layout = laid_out(&window, "laid.obj", torn);
    let path = window.path("laid.obj");
    window.open(&path);
    window.click("Method");
    (window, layout)
}

fn start(window: &Window) -> Start {
    window.editor().session.document().settings.start
}

fn list_is_disabled(window: &Window, name: &str) -> bool {
    window.harness.get_by_role_and_label(Role::ComboBox, name).accesskit_node().is_disabled()
}

#[test]
fn a_planar_layout_of_a_file_opens_as_it_is_and_relax_goes_on_from_it() {
    let (mut window, layout) = opened(f64::INFINITY);
    assert_eq!((start(&window), window.outcome().step.candidate.stage.clone()), (Start::File, Stage::Given));
    assert_eq!(window.embedding(), layout);
    assert!(!window.editor().session.has_unsaved_work() && !window.editor().session.history().can_redo());
    assert_eq!(window.editor().session.map_origin(), Some(MapOrigin::FileLayout));
    // An edit as any other: undo and redo lead to the mesh without the layout and back.
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!((start(&window), window.outcome().step.candidate.stage.clone()), (Start::FromScratch, Stage::Natural));
    window.choose("Start", "File's layout");
    assert_eq!((start(&window), window.embedding()), (Start::File, layout.clone()));
    assert!(window.is_proved(), "{}", window.verdict());
    let before = window.outcome().distortion.summary.symmetric_dirichlet.mean;
    window.click("Relax");
    let after = window.outcome();
    assert!(window.is_proved() && after.step.candidate.stage == Stage::Relax);
    assert!(after.distortion.summary.symmetric_dirichlet.mean < 0.9 * before);
    for _ in 0..2 {
        window.press(Modifiers::COMMAND, Key::Z);
    }
    assert_eq!((start(&window), window.outcome().step.candidate.stage.clone()), (Start::FromScratch, Stage::Natural));
    window.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(window.embedding(), layout);
}

#[test]
fn a_layout_with_seams_cuts_the_mesh_along_them_in_the_same_edit() {
    let (mut window, _) = opened(0.5);
    let charts = |window: &Window| window.editor().session.charts().map(|charts| charts.count());
    assert_eq!(charts(&window), Some(2), "as in the file");
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(charts(&window), None);
    window.choose("Start", "File's layout");
    assert_eq!(charts(&window), Some(2));
    assert!(window.outcome().step.candidate.stage == Stage::Given && window.is_proved());
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!((charts(&window), start(&window)), (None, Start::FromScratch));
    window.click("Charts");
    window.choose("Definition of charts", "File's texture seams");
    assert_eq!((charts(&window), start(&window)), (Some(2), Start::FromScratch));
    assert_eq!(window.outcome().step.candidate.stage, Stage::Natural);
}

#[test]
fn one_click_unwraps_a_mesh_again_and_another_returns_to_the_layout_of_its_file() {
    let (mut window, layout) = opened(0.5);
    let embedding = window.embedding();
    window.click("Change the map");
    window.click("Unwrap again");
    window.settle();
    let session = &window.editor().session;
    assert_eq!(session.map_origin(), Some(MapOrigin::AutomaticSeams(0)), "a flat sheet needs no seam");
    assert!(session.charts().is_none() && session.document().settings.start == Start::FromScratch);
    assert!(window.outcome().distortion.summary.symmetric_dirichlet.mean < 4.1, "the layout is sheared");
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!((start(&window), window.embedding()), (Start::File, embedding.clone()), "one undo returns");
    window.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    window.click("Change the map");
    window.click("Layout of the file");
    window.settle();
    assert_eq!((start(&window), window.embedding()), (Start::File, embedding));
    assert_eq!(layout.len(), 49);
}

#[test]
fn a_layout_that_is_not_one_to_one_stays_in_its_file_and_the_mesh_is_solved() {
    let mut window = Window::with_mesh("plain.obj", &sheet(5, 0.3));
    let path = window.path("folded.obj");
    let folded =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0.9 0.1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
    std::fs::write(&path, folded).expect("the folder is there");
    window.open(&path);
    assert_eq!(window.editor().session.map_origin(), Some(MapOrigin::Plain));
    assert!(window.is_proved() && !window.editor().session.has_unsaved_work());
    window.click("Change the map");
    window.click("Layout of the file");
    window.settle();
    let first = &window.editor().session.timeline().records()[0];
    assert!(start(&window) == Start::File && !first.planar, "as a person asked");
    // The line can be closed, until another file is opened.
    window.click("Close the line on the map");
    assert!(!window.has_button("Change the map"));
    window.open(&path);
    assert!(window.has_button("Change the map"));
}

#[test]
fn an_edit_of_the_picture_during_the_check_does_not_replace_the_layout() {
    let (mut window, layout) = opened(f64::INFINITY);
    let path = window.path("laid.obj");
    window.editor_mut().session.handle(Action::Open(path));
    while window.editor().session.first_map_work().is_none() {
        window.step();
    }
    window.editor_mut().session.handle(Action::SetVAxis(VAxis::Down));
    window.settle();
    assert_eq!((start(&window), window.embedding().len()), (Start::File, layout.len()));
    assert_eq!(window.editor().session.map_origin(), Some(MapOrigin::FileLayout));
}

#[test]
fn a_relaxed_layout_is_no_longer_that_of_the_file() {
    let (mut window, _) = opened(f64::INFINITY);
    window.click("Relax");
    assert_eq!(window.editor().session.map_origin(), Some(MapOrigin::FromLayout));
}

#[test]
fn a_project_keeps_that_a_map_starts_from_its_file() {
    let (mut window, layout) = opened(f64::INFINITY);
    let project = window.path("laid.freebound");
    window.editor_mut().session.handle(Action::SaveProject(project.clone()));
    window.settle();
    let other = window.path("plain.obj");
    window.open(&other);
    assert_eq!(start(&window), Start::FromScratch);
    window.open(&project);
    assert_eq!((start(&window), window.embedding()), (Start::File, layout));
}

#[test]
fn a_file_without_texture_coordinates_has_no_layout_to_start_from() {
    let mut window = Window::with_mesh("plain.obj", &sheet(5, 0.3));
    window.click("Method");
    assert!(list_is_disabled(&window, "Start"));
    assert!(window.harness.query_by_role_and_label(Role::ComboBox, "Definition of charts").is_none());
    let (mut window, _) = opened(0.5);
    assert!(!list_is_disabled(&window, "Start"));
    // A linear method depends on the surface alone.
    window.choose("Method", "Least-squares conformal");
    assert!(window.harness.query_by_role_and_label(Role::ComboBox, "Start").is_none());
}

#[test]
fn holes_are_filled_or_cut_as_a_person_chooses() {
    let mut mesh = sheet(6, 0.3);
    mesh.triangles.retain(|corners| !corners.iter().any(|v| v.index() == 24));
    let mut window = Window::with_mesh("hole.obj", &TriMesh { polygon_of: None, ..mesh });
    window.click("Method");
    let done = |window: &Window| {
        let model = window.editor().session.model().expect("open").clone();
        model
            .prepared
            .repaired
            .iter()
            .flat_map(|repaired| repaired.done())
            .map(|done| done.repair)
            .collect::<Vec<Repair>>()
    };
    assert!(done(&window) == [Repair::Cut] && window.is_proved(), "a large hole opens with a seam to the outside");
    window.click("Change the map");
    window.click("As few seams as possible");
    window.settle();
    assert_eq!(window.editor().session.map_origin(), Some(MapOrigin::Plain));
    assert!(done(&window) == [Repair::FillHoles] && window.is_proved());
    window.choose("Treatment of holes", "Cut to the outside");
    assert_eq!(window.editor().session.document().form.holes, HoleTreatment::Cut);
    assert!(done(&window) == [Repair::Cut] && window.is_proved(), "{}", window.verdict());
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(done(&window) == [Repair::FillHoles] && window.is_proved());
    // Without holes there is no question.
    let path = window.path("plain.obj");
    crate::harness::write_obj(&path, &sheet(5, 0.3));
    window.open(&path);
    assert!(window.harness.query_by_role_and_label(Role::ComboBox, "Treatment of holes").is_none());
}
