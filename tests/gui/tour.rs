//! The welcome and the guided tour: the tour notices each action, and can be skipped.

use std::path::Path;

use eframe::App as _;
use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable as _;
use freebound::app::LaunchFile;
use freebound::examples::Example;
use freebound::session::RecentFiles;
use freebound::ui::{Tour, TourCard};

use crate::harness::{SIZE, Window, sheet};

/// Window without a file, with preferences at a path.
fn bare_start(preferences: &Path) -> Window {
    Window::start(SIZE, LaunchFile { preferences: Some(preferences.to_owned()), ..LaunchFile::default() })
}

fn card(window: &Window) -> Option<TourCard> {
    window.editor().layout.tour().map(Tour::card)
}

fn greets(window: &Window) -> bool {
    window.editor().layout.welcome.is_shown()
}

fn is_done(window: &Window) -> bool {
    window.editor().layout.tour().is_some_and(Tour::is_done)
}

#[test]
fn a_start_without_a_file_greets_and_the_photo_on_a_face_begins_the_tour() {
    let folder = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let path = folder.path("window.json");
    let mut first = bare_start(&path);
    assert!(greets(&first) && card(&first).is_none());
    first.click("A photo on a face");
    first.settle();
    assert!(!greets(&first));
    assert_eq!(card(&first), Some(TourCard::Look));
    first.click("Skip tour");
    assert_eq!(card(&first), None);
    first.menu(&["Help", "Guided tour"]);
    assert_eq!(card(&first), Some(TourCard::Look), "Help has it again");
    first.menu(&["Help", "Welcome"]);
    assert!(greets(&first));
    first.menu(&["Help", "Guided tour"]);
    assert!(!greets(&first) && card(&first) == Some(TourCard::Look), "the tour takes its place");
    // The welcome comes at every start, until the user turns it off.
    first.menu(&["Help", "Welcome"]);
    first.harness.get_by_role_and_label(Role::CheckBox, "Show at start").click();
    first.settle();
    first.key(Key::Escape);
    assert!(!greets(&first));
    first.harness.state_mut().on_exit();
    assert!(!greets(&bare_start(&path)));
}

#[test]
fn the_welcome_opens_the_cube_and_recent_files_and_closes_with_another_mesh() {
    let folder = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let (path, recent) = (folder.path("window.json"), folder.path("recent.json"));
    RecentFiles::load(recent.clone()).remember(&folder.path("sheet.obj"));
    let start =
        || LaunchFile { preferences: Some(path.clone()), recent_store: Some(recent.clone()), ..LaunchFile::default() };
    let name = |window: &Window| window.editor().session.model().map(|model| model.name.clone());
    let mut window = Window::start(SIZE, start());
    window.click("The paper's cube");
    window.settle();
    assert_eq!((greets(&window), name(&window).as_deref()), (false, Some(Example::Cube.title())));
    let mut window = Window::start(SIZE, start());
    window.click("Open sheet.obj");
    window.settle();
    assert_eq!((greets(&window), name(&window).as_deref()), (false, Some("sheet.obj")));
    let mut window = Window::start(SIZE, start());
    assert!(greets(&window));
    window.open(&folder.path("sheet.obj"));
    assert!(!greets(&window), "dropped, for instance");
}

#[test]
fn a_start_with_a_file_or_without_stored_preferences_does_not_greet() {
    let mesh = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    assert!(!greets(&mesh));
    let (file, preferences) = (Some(mesh.path("sheet.obj")), Some(mesh.path("window.json")));
    let mut window = Window::start(SIZE, LaunchFile { file, preferences, ..LaunchFile::default() });
    assert!(!greets(&window) && card(&window).is_none());
    window.harness.state_mut().on_exit();
    assert!(greets(&bare_start(&mesh.path("window.json"))));
}

#[test]
fn every_card_notices_its_action() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.menu(&["Help", "Guided tour"]);
    assert!(!is_done(&window), "nothing was done yet");
    let middle = window.mesh_view().center();
    window.drag(middle, middle + vec2(60.0, 10.0), Modifiers::NONE);
    window.settle();
    assert!(is_done(&window), "turned");

    window.click("Next");
    assert_eq!((card(&window), is_done(&window)), (Some(TourCard::Pin), false));
    window.key(Key::P);
    let vertex = window.vertex_in_the_middle();
    window.click_at(window.place_on_mesh(vertex), Modifiers::NONE);
    window.settle();
    assert!(is_done(&window), "pinned");

    window.click("Next");
    assert_eq!((card(&window), is_done(&window)), (Some(TourCard::Drag), false));
    let from = window.place_in_plane(window.embedding()[vertex.index()]);
    window.drag(from, from + vec2(25.0, 0.0), Modifiers::NONE);
    window.settle();
    assert!(is_done(&window), "dragged");

    window.click("Next");
    assert_eq!((card(&window), is_done(&window)), (Some(TourCard::Step), window.is_proved()));
    window.click("Next");
    assert_eq!((card(&window), is_done(&window)), (Some(TourCard::Landmark), false));
    window.click("Next");
    assert_eq!((card(&window), is_done(&window)), (Some(TourCard::Export), false));
    window.press(Modifiers::COMMAND, Key::E);
    assert!(is_done(&window), "the list of exports shows");
    window.key(Key::Escape);
    window.click("Finish");
    assert_eq!(card(&window), None);
}
