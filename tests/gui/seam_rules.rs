//! Seams by rules: messages, and the moment of cutting.

use std::time::Duration;

use eframe::egui;
use egui::{Key, Modifiers};
use freebound::session::Action;
use freebound::ui::{Request, SeamRule, Tool, sentence};
use freebound_core::problem::{Family, Settings};
use freebound_io::LabelError;

use crate::harness::{Window, sheet, write_obj};
use crate::seams::{cube, seams};
use freebound_testkit::assert_message;

fn with_box() -> Window {
    Window::with_mesh("box.obj", &cube())
}

/// Result of a rule by materials for a file without any.
fn no_materials() -> String {
    sentence(&LabelError::NoMaterials.to_string())
}

#[test]
fn the_menu_says_where_a_file_has_no_materials_whatever_tool_is_in_hand() {
    let mut window = with_box();
    window.menu(&["Edit", "Seams", "Cut along borders of materials"]);
    assert!(seams(&window).is_empty() && window.shows(&no_materials()), "{:?}", window.words());
}

#[test]
fn what_came_of_a_rule_is_forgotten_with_the_tool_the_file_and_other_seams() {
    let mut window = with_box();
    let cut = |window: &mut Window| {
        window.editor_mut().handle(Request::CutByRule(SeamRule::Materials));
        window.settle();
        assert!(window.shows(&no_materials()), "{:?}", window.words());
    };
    window.key(Key::X);
    cut(&mut window);
    window.key(Key::V);
    window.key(Key::X);
    assert!(!window.shows(&no_materials()), "another tool was selected");
    cut(&mut window);
    let other = window.path("other.obj");
    write_obj(&other, &sheet(4, 0.0));
    window.open(&other);
    assert_eq!(window.editor().tools.tool(), Tool::Seam);
    assert!(!window.shows(&no_materials()), "another file is open");
    let mut window = with_box();
    window.key(Key::X);
    window.editor_mut().handle(Request::CutByRule(SeamRule::Sharp(60.0)));
    window.settle();
    assert_message("seam-rules-window-edges-of-a-rule", &window.text_with("12 edges"));
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(!window.shows("12 edges"), "they are gone");
}

#[test]
fn a_rule_does_not_cut_in_the_middle_of_a_sliders_drag() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.8));
    let slide = |window: &mut Window, share: f64| {
        let before = window.editor().session.document().settings.clone();
        let settings = Settings { family: Some(Family::Power(share)), ..before };
        window.editor_mut().handle(Action::SlideSettings(settings).into());
    };
    slide(&mut window, 0.3);
    window.editor_mut().handle(Request::CutByRule(SeamRule::Sharp(0.0)));
    for _ in 0..20 {
        std::thread::sleep(Duration::from_millis(5));
        window.step();
    }
    assert!(seams(&window).is_empty(), "the drag goes on");
    slide(&mut window, 0.4);
    window.editor_mut().handle(Action::EndGesture.into());
    window.settle();
    assert!(!seams(&window).is_empty());
    let settings = window.editor().session.document().settings.clone();
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(seams(&window).is_empty());
    assert_eq!(window.editor().session.document().settings, settings, "the drag is an edit of its own");
}
