//! The guided tour: it comes at the first start, notices each action, and can be skipped.

use std::path::Path;

use eframe::App as _;
use eframe::egui::{Key, Modifiers, vec2};
use freebound::app::LaunchFile;
use freebound::ui::{Tour, TourCard};

use crate::harness::{SIZE, Window, sheet};

/// Window without a file, with preferences at a path.
fn bare_start(preferences: &Path) -> Window {
    Window::start(SIZE, LaunchFile { preferences: Some(preferences.to_owned()), ..LaunchFile::default() })
}

fn card(window: &Window) -> Option<TourCard> {
    window.editor().layout.tour().map(Tour::card)
}

fn is_done(window: &Window) -> bool {
    window.editor().layout.tour().is_some_and(Tour::is_done)
}

#[test]
fn the_first_start_without_a_file_begins_the_tour_and_later_starts_do_not() {
    let folder = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let path = folder.path("window.json");
    let mut first = bare_start(&path);
    assert_eq!(card(&first), Some(TourCard::Look));
    first.click("Skip tour");
    assert_eq!(card(&first), None);
    first.harness.state_mut().on_exit();
    let mut second = bare_start(&path);
    assert_eq!(card(&second), None, "seen before");
    second.menu(&["Help", "Guided tour"]);
    assert_eq!(card(&second), Some(TourCard::Look), "Help has it again");
}

#[test]
fn a_start_with_a_file_or_without_stored_preferences_begins_no_tour() {
    let mesh = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    assert_eq!(card(&mesh), None);
    let (file, preferences) = (Some(mesh.path("sheet.obj")), Some(mesh.path("window.json")));
    let mut window = Window::start(SIZE, LaunchFile { file, preferences, ..LaunchFile::default() });
    assert_eq!(card(&window), None);
    window.harness.state_mut().on_exit();
    assert_eq!(card(&bare_start(&mesh.path("window.json"))), Some(TourCard::Look), "not seen yet");
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
