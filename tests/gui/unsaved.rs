//! Unsaved work: the question, the window's title, projects saved and opened, bars at the start.

use eframe::egui;
use egui::{Key, Modifiers};
use freebound::app::LaunchFile;
use freebound::examples::Example;
use freebound::session::Action;
use freebound::ui::ShadingMode;
use freebound_core::mesh::{TriMesh, VertexId};
use glam::DVec2;

use crate::harness::{SIZE, Window, sheet, write_obj};
use freebound_testkit::assert_message;

fn window() -> Window {
    Window::with_mesh("sheet.obj", &sheet(6, 0.3))
}

fn edit(window: &mut Window) {
    window.editor_mut().session.handle(Action::Fix([0, 24, 48].map(VertexId::new).to_vec()));
    window.settle();
}

#[test]
fn quitting_with_unsaved_work_asks_and_cancel_stays() {
    let mut window = window();
    edit(&mut window);
    window.press(Modifiers::COMMAND, Key::Q);
    assert!(!window.editor().gpu.is_quitting());
    assert!(window.editor().files.unsaved.is_asked());
    assert_message("unsaved-window-question", &window.text_with("sheet.obj?"));
    window.click("Cancel");
    assert!(!window.editor().gpu.is_quitting() && !window.editor().files.unsaved.is_asked());
    window.press(Modifiers::COMMAND, Key::Q);
    window.key(Key::Escape);
    assert!(!window.editor().gpu.is_quitting() && !window.editor().files.unsaved.is_asked(), "Esc is Cancel");
    window.press(Modifiers::COMMAND, Key::Q);
    window.click("Don't save");
    assert!(window.editor().gpu.is_quitting());
}

#[test]
fn saving_from_the_question_quits_once_it_is_saved() {
    let mut window = window();
    edit(&mut window);
    window.press(Modifiers::COMMAND, Key::Q);
    window.click("Save");
    assert!(!window.editor().gpu.is_quitting(), "it asks where first");
    window.click("Save");
    window.settle();
    assert!(window.path("sheet.freebound").exists());
    assert!(window.editor().gpu.is_quitting());
}

#[test]
fn a_dialog_that_is_left_keeps_the_window_open() {
    let mut window = window();
    edit(&mut window);
    window.press(Modifiers::COMMAND, Key::Q);
    window.click("Save");
    window.click("Cancel");
    window.settle();
    assert!(!window.editor().gpu.is_quitting() && !window.editor().files.unsaved.is_asked());
    assert!(window.editor().session.has_unsaved_work());
}

#[test]
fn keys_rest_while_the_question_is_asked() {
    let mut window = window();
    edit(&mut window);
    window.press(Modifiers::COMMAND, Key::Q);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.editor().session.document().targets.len(), 3);
    assert!(window.editor().files.unsaved.is_asked());
}

#[test]
fn opening_something_else_asks_too() {
    let mut window = window();
    edit(&mut window);
    write_obj(&window.path("other.obj"), &sheet(4, 0.0));
    let name = |window: &Window| window.editor().session.model().expect("open").name.clone();
    window.menu(&["File", "Examples", Example::Dome.title()]);
    assert!(window.editor().files.unsaved.is_asked() && name(&window) == "sheet.obj");
    window.click("Cancel");
    let path = window.path("other.obj");
    window.harness.input_mut().dropped_files.push(crate::dialogs::dropped(path));
    window.settle();
    assert!(window.editor().files.unsaved.is_asked() && name(&window) == "sheet.obj");
    window.click("Don't save");
    assert_eq!(name(&window), "other.obj");
}

#[test]
fn a_project_is_saved_and_opened_again() {
    let mut window = window();
    edit(&mut window);
    let before = window.editor().session.document().clone();
    assert!(window.shows("• sheet"), "{:?}", window.words());
    window.press(Modifiers::COMMAND, Key::S);
    window.click("Save");
    assert!(!window.editor().session.has_unsaved_work() && !window.shows("• sheet"));
    window.menu(&["File", "Examples", Example::Dome.title()]);
    let path = window.path("sheet.freebound");
    window.open(&path);
    assert_eq!(*window.editor().session.document(), before);
    window.editor_mut().session.handle(Action::UnpinAll);
    window.settle();
    window.press(Modifiers::COMMAND, Key::S);
    assert!(!window.editor().files.dialogs.is_open(), "it knows where");
    assert!(!window.editor().session.has_unsaved_work());
}

#[test]
fn a_project_opens_with_the_cameras_that_it_was_saved_with() {
    let mut window = window();
    edit(&mut window);
    let size = window.editor().plane.pane.size();
    let editor = window.editor_mut();
    let (orbit, plane) =
        (editor.mesh.pane.camera_mut().expect("a mesh"), editor.plane.pane.camera_mut().expect("an embedding"));
    orbit.orbit(DVec2::new(70.0, -30.0));
    orbit.pan(DVec2::new(20.0, 10.0), size);
    plane.zoom_at(DVec2::splat(100.0), 5.0, size);
    let (orbit, plane) = (*orbit, *plane);
    window.settle();
    window.press(Modifiers::COMMAND, Key::S);
    window.click("Save");
    window.menu(&["File", "Examples", Example::Dome.title()]);
    assert_ne!(window.editor().mesh.pane.camera(), Some(orbit));
    let path = window.path("sheet.freebound");
    window.open(&path);
    let (again, plane_again) =
        (window.editor().mesh.pane.camera().expect("a mesh"), window.editor().plane.pane.camera().expect("solved"));
    assert!(again.eye().distance(orbit.eye()) < 1e-9 && again.pivot().distance(orbit.pivot()) < 1e-9, "{again:?}");
    assert!(plane_again.center().distance(plane.center()) < 1e-9, "{plane_again:?}");
    // The view of the pane is kept, and the pane has its size again.
    let larger = plane_again.points_per_unit() / plane.points_per_unit();
    assert!((0.7..1.4).contains(&larger), "{larger}");
}

#[test]
fn what_a_session_left_is_offered_and_recovered() {
    let left = tempfile::tempdir().expect("a folder");
    let mesh = window();
    let start = || LaunchFile {
        file: Some(mesh.path("sheet.obj")),
        recovery_folder: Some(left.path().to_owned()),
        dialogs_inside: true,
        ..LaunchFile::default()
    };
    let mut first = Window::start(SIZE, start());
    assert!(!first.has_button("Recover"));
    edit(&mut first);
    let document = first.editor().session.document().clone();
    let later = std::time::Instant::now() + std::time::Duration::from_mins(1);
    first.editor_mut().session.poll_at(later);
    let is_copy = |path: &std::path::Path| path.extension().is_some_and(|extension| extension == "freebound");
    let files = || std::fs::read_dir(left.path()).expect("a folder").map(|file| file.expect("a file").path());
    let is_there = || files().any(|path| is_copy(&path));
    let begun = std::time::Instant::now();
    while !is_there() && begun.elapsed().as_secs() < 20 {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    first.settle();
    // Dropped without closing, as if the session had crashed.
    drop(first);
    let mut second = Window::start(SIZE, start());
    assert_eq!(second.editor().session.recoverable().len(), 1);
    // The age of the copy follows.
    let words = second.text_with("ended");
    assert_message("unsaved-window-recovery", words.split(". ").next().unwrap_or_default());
    second.click("Recover");
    assert_eq!(*second.editor().session.document(), document);
    assert!(second.editor().session.has_unsaved_work());
    assert!(!second.has_button("Recover"));
}

/// Dome with inward-facing faces.
fn hollow() -> TriMesh {
    let dome = Example::Dome.mesh();
    let turned = |triangle: &[VertexId; 3]| [triangle[0], triangle[2], triangle[1]].map(VertexId::number);
    let triangles: Vec<[u32; 3]> = dome.triangles.iter().map(turned).collect();
    TriMesh::new(dome.positions, &triangles)
}

#[test]
fn faces_that_point_inward_are_said_and_turned_by_a_click() {
    let mut window = Window::with_mesh("hollow.obj", &hollow());
    let asks = |window: &Window| window.has_button("Reverse them");
    assert!(asks(&window) && window.editor().session.model().expect("open").prepared.faces_point_inward);
    assert_message("unsaved-window-faces-point-inward", &window.text_with("inward"));
    let before = window.editor().session.model().expect("open").mesh().triangles[0];
    window.click("Reverse them");
    assert!(!asks(&window));
    assert_ne!(window.editor().session.model().expect("open").mesh().triangles[0], before);
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(asks(&window));
    window.click("Leave them");
    assert!(!asks(&window));
}

#[test]
fn only_what_a_person_changed_asks_to_be_saved() {
    let asks = |window: &mut Window| {
        window.press(Modifiers::COMMAND, Key::Q);
        let asks = window.editor().files.unsaved.is_asked();
        assert_ne!(asks, window.editor().gpu.is_quitting());
        window.key(Key::Escape);
        asks
    };
    let look = |window: &mut Window| {
        window.key(Key::Space);
        window.key(Key::ArrowLeft);
        window.shade(ShadingMode::Angle);
        window.click("Vertex");
        let at = window.plane_view().center();
        window.click_at(at, Modifiers::NONE);
        window.key(Key::F);
    };
    // One disk, and a closed surface, which is unwrapped on opening.
    for mesh in [sheet(6, 0.3), freebound_testkit::bumpy_ball().triangulate()] {
        let mut window = Window::with_mesh("mesh.obj", &mesh);
        look(&mut window);
        assert!(!asks(&mut window));
        let mut window = Window::with_mesh("mesh.obj", &mesh);
        look(&mut window);
        window.editor_mut().session.handle(Action::Fix(vec![VertexId::new(1)]));
        window.settle();
        assert!(asks(&mut window), "a pin is a change");
        window.press(Modifiers::COMMAND, Key::Z);
        assert!(!asks(&mut window), "undo takes the change back");
    }
}
