//! State of the window kept between runs.

use std::path::Path;

use eframe::App as _;
use freebound::app::LaunchFile;
use freebound::ui::{Request, ShadingMode};

use crate::harness::{SIZE, Window, sheet};

/// Window with the sheet of another window, and the preferences of a file.
pub(crate) fn start(mesh: &Window, preferences: &Path) -> Window {
    let start = LaunchFile {
        file: Some(mesh.path("sheet.obj")),
        preferences: Some(preferences.to_owned()),
        dialogs_inside: true,
        ..LaunchFile::default()
    };
    Window::start(SIZE, start)
}

#[test]
fn theme_wireframe_shading_and_the_panels_width_come_back() {
    let mesh = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let path = mesh.path("state/window.json");
    let mut first = start(&mesh, &path);
    first.menu(&["View", "Theme", "Dark"]);
    first.editor_mut().handle(Request::ToggleWireframe);
    first.shade(ShadingMode::Angle);
    let edge = first.plane_view().right_center() + eframe::egui::vec2(0.5, 0.0);
    first.drag(edge, edge - eframe::egui::vec2(60.0, 0.0), eframe::egui::Modifiers::NONE);
    let width = first.editor().layout.panel_width();
    assert!((width - 340.0).abs() < 4.0, "{width}");
    first.harness.state_mut().on_exit();
    let second = start(&mesh, &path);
    assert!(second.harness.ctx.global_style().visuals.dark_mode);
    assert_eq!((second.editor().pane_shading.wireframe, second.shadings()), (true, [ShadingMode::Angle; 2]));
    assert!((second.editor().layout.panel_width() - width).abs() < 0.5);
    assert_eq!(second.plane_view().right().round(), first.plane_view().right().round());
}

#[test]
fn a_broken_file_is_the_first_start() {
    let mesh = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let path = mesh.path("window.json");
    std::fs::write(&path, "{\"wireframe\": 7").expect("written");
    let mut window = start(&mesh, &path);
    assert!(!window.editor().pane_shading.wireframe);
    assert!((window.editor().layout.panel_width() - 280.0).abs() < 0.5);
    window.harness.state_mut().on_exit();
    assert!(std::fs::read_to_string(&path).expect("read").ends_with('}'), "written anew");
}

#[test]
fn shadings_of_a_project_are_not_kept_as_the_person_s_own() {
    let mesh = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let [project, path] = ["sheet.freebound", "window.json"].map(|name| mesh.path(name));
    let mut first = Window::with_file(&mesh.path("sheet.obj"));
    first.shade(ShadingMode::Stretch);
    first.press(eframe::egui::Modifiers::COMMAND, eframe::egui::Key::S);
    first.click("Save");
    assert!(project.exists());
    for own in [None, Some(ShadingMode::Area)] {
        let mut second = start(&mesh, &path);
        if let Some(own) = own {
            second.shade(own);
        }
        second.open(&project);
        assert_eq!(second.shadings(), [ShadingMode::Stretch; 2], "the project's show");
        second.harness.state_mut().on_exit();
        let third = start(&mesh, &path);
        assert_eq!(third.shadings(), [own.unwrap_or_default(); 2], "and the person's come back");
    }
}
