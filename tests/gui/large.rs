//! Files that may need more than half of the machine's memory: the question, its answers, and the consequences.

use eframe::egui::{Key, Modifiers};
use freebound::session::Action;

use crate::dialogs::dropped;
use crate::harness::{Window, sheet, write_obj};
use freebound_testkit::assert_message;

/// Window on a machine whose memory suffices for a small sheet, with a larger sheet in the folder.
fn window() -> Window {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    write_obj(&window.path("large.obj"), &sheet(12, 0.3));
    let length = std::fs::metadata(window.path("sheet.obj")).expect("written").len();
    window.editor_mut().session.heed_memory(length * 20);
    window
}

fn name(window: &Window) -> String {
    window.editor().session.model().expect("open").name.clone()
}

fn asks(window: &Window) -> bool {
    window.editor().session.large_file().is_some_and(|file| file.path.ends_with("large.obj"))
}

#[test]
fn a_large_file_is_asked_about_and_opened_at_a_click() {
    let mut window = window();
    let small = window.path("sheet.obj");
    window.open(&small);
    assert!(!asks(&window), "a small one opens");
    let large = window.path("large.obj");
    window.open(&large);
    assert!(asks(&window) && name(&window) == "sheet.obj");
    let shortage = window.editor().session.large_file().expect("it asks").shortage;
    assert!(window.shows(&shortage.to_string()), "{:?}", window.words());
    assert_message("large-window-question", &window.text_with("large.obj"));
    window.click("Open");
    assert!(!asks(&window) && name(&window) == "large.obj");
}

#[test]
fn a_large_file_that_is_left_changes_nothing() {
    let mut window = window();
    let large = window.path("large.obj");
    window.open(&large);
    window.click("Cancel");
    assert!(!asks(&window) && name(&window) == "sheet.obj");
    window.open(&large);
    window.press(Modifiers::COMMAND, Key::Q);
    assert!(!window.editor().gpu.is_quitting(), "other keys rest");
    window.key(Key::Escape);
    assert!(!asks(&window) && name(&window) == "sheet.obj", "Esc is Cancel");
    assert!(window.editor().session.recent().paths().iter().all(|path| *path != large));
}

#[test]
fn what_was_dropped_with_a_large_file_follows_it() {
    let mut window = window();
    std::fs::write(window.path("pins.txt"), "0 0 0\n4 1 0\n").expect("written");
    let files = ["large.obj", "pins.txt"].map(|name| dropped(window.path(name)));
    window.harness.input_mut().dropped_files.extend(files);
    window.settle();
    assert!(asks(&window) && window.editor().session.document().targets.is_empty());
    window.click("Open");
    assert_eq!((name(&window).as_str(), window.editor().session.document().targets.len()), ("large.obj", 2));
}

#[test]
fn a_project_of_a_large_mesh_asks_too() {
    let mut window = window();
    let large = window.path("large.obj");
    window.open(&large);
    window.click("Open");
    let project = window.path("large.freebound");
    window.editor_mut().session.handle(Action::SaveProject(project.clone()));
    window.settle();
    let small = window.path("sheet.obj");
    window.open(&small);
    window.open(&project);
    assert!(asks(&window) && name(&window) == "sheet.obj");
    window.click("Open");
    assert_eq!(name(&window), "large.obj");
    assert_eq!(window.editor().session.project_path(), Some(&project));
}
