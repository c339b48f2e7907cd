//! A mesh that is no disk, mended in the window.

use eframe::egui;
use egui::{Key, Modifiers};

use crate::harness::Window;
use crate::makers::band;

#[test]
fn a_mesh_that_can_be_mended_says_how_and_is_mended_by_one_click() {
    let mut window = Window::with_mesh("ring.obj", &band(9, 0));
    assert!(window.verdict().ends_with("fault"), "{}", window.verdict());
    assert!(window.shows("The mesh can be mended: 1 edge cut open"), "{:?}", window.words());
    window.click("Mend all");
    assert!(window.is_proved(), "{}", window.verdict());
    assert!(!window.has_button("Mend all") && !window.has_button("Dismiss"), "{:?}", window.words());
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(window.verdict().ends_with("fault"), "{}", window.verdict());
    window.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert!(window.is_proved(), "{}", window.verdict());
}
