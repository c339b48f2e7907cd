//! Messages over the panes: successes disappear after a few seconds, errors stay.

use eframe::egui;
use egui::Rect;
use egui_kittest::kittest::Queryable as _;
use freebound::session::{Action, Severity};
use freebound_core::mesh::VertexId;

use crate::dialogs::ask_where_to_save;
use crate::harness::{Window, sheet};

fn window() -> Window {
    Window::with_mesh("sheet.obj", &sheet(6, 0.3))
}

fn panes(window: &Window) -> [Rect; 2] {
    [window.mesh_view(), window.plane_view()]
}

/// Advances the window's clock by this many seconds.
fn pass(window: &mut Window, seconds: usize) {
    window.harness.remove_cursor();
    window.harness.run_steps(60 * seconds);
}

#[test]
fn what_was_written_is_said_for_four_seconds_and_moves_no_pane() {
    let mut window = window();
    let before = panes(&window);
    ask_where_to_save(&mut window);
    window.click("Save");
    assert!(window.shows("sheet-flat.obj") && window.has_button("Show in folder"), "{:?}", window.words());
    assert_eq!(panes(&window), before);
    pass(&mut window, 3);
    assert!(window.has_button("Show in folder"));
    pass(&mut window, 2);
    assert!(!window.has_button("Show in folder") && window.editor().session.messages().is_empty());
    assert_eq!(panes(&window), before);
}

#[test]
fn good_news_are_closed_by_hand_as_well() {
    let mut window = window();
    ask_where_to_save(&mut window);
    window.click("Save");
    window.click("Close");
    assert!(!window.has_button("Show in folder"));
}

#[test]
fn every_file_that_was_written_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = window();
    let picture = window.path("picture.png");
    image::RgbaImage::new(8, 8).save(&picture).expect("a picture");
    window.editor_mut().session.handle(Action::OpenPicture(picture));
    window.settle();
    let path = folder.path().join("out.obj");
    let request = freebound::session::SaveRequest {
        path,
        kind: freebound_io::OutputKind::Obj,
        fit: freebound_core::pipeline::Fit::Unit,
    };
    window.editor_mut().session.handle(Action::Save(request));
    window.settle();
    let written: Vec<String> = std::fs::read_dir(folder.path())
        .expect("a folder")
        .map(|file| file.expect("a file").file_name().to_string_lossy().into_owned())
        .collect();
    assert_eq!(written.len(), 3, "mesh, material, picture: {written:?}");
    let message = window.editor().session.messages()[0].clone();
    assert_eq!((message.severity, message.files.len()), (Severity::Note, 3));
    for name in written {
        assert!(message.text.contains(&name) && window.shows(&name), "{name}: {}", message.text);
    }
}

#[test]
fn bad_news_stay_and_move_no_pane() {
    let mut window = window();
    let before = panes(&window);
    let camera = window.editor().plane.pane.camera();
    std::fs::write(window.path("broken.obj"), "v 0 0\nf 1 2 3\n").unwrap();
    let file = window.path("broken.obj");
    window.open(&file);
    assert!(window.has_button("Dismiss"));
    assert_eq!((panes(&window), window.editor().plane.pane.camera()), (before, camera));
    pass(&mut window, 6);
    assert!(window.has_button("Dismiss"));
    window.click("Dismiss");
    assert_eq!(panes(&window), before);
}

#[test]
fn the_pointer_over_a_bar_picks_nothing_behind_it() {
    let mut window = window();
    let corner = VertexId::new(0);
    std::fs::write(window.path("broken.obj"), "v 0 0\nf 1 2 3\n").unwrap();
    let file = window.path("broken.obj");
    window.open(&file);
    let bar = window.rect(egui::accesskit::Role::Button, "Dismiss").center() + egui::vec2(60.0, 0.0);
    assert!(window.mesh_view().contains(bar));
    let camera = window.editor().mesh.pane.camera();
    window.drag(bar, bar + egui::vec2(30.0, 4.0), egui::Modifiers::NONE);
    assert_eq!(window.editor().mesh.pane.camera(), camera, "nor does a drag reach what is behind");
    assert!(!window.editor().selection.vertices().contains(&corner));
}

#[test]
fn news_stay_while_one_of_their_buttons_has_the_keyboard() {
    let mut window = window();
    ask_where_to_save(&mut window);
    window.click("Save");
    window.harness.get_by_label("Show in folder").focus();
    pass(&mut window, 6);
    assert!(window.has_button("Show in folder"));
    window.harness.get_by_label("File").focus();
    pass(&mut window, 5);
    assert!(!window.has_button("Show in folder"));
}
