//! Shading of faces in each pane: set separately, and by the constrain tool over a picture.

use eframe::egui;
use egui::Key;
use egui::accesskit::Role;
use freebound::examples::Example;
use freebound::session::Action;
use freebound::ui::{Pane, ShadingMode};

use crate::harness::{MESH_VIEW, PLANE_VIEW, Window, sheet};
use crate::pictures::open_picture;

const PICTURED: [ShadingMode; 2] = [ShadingMode::Picture; 2];

/// The face with its portrait.
fn face() -> Window {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    window.menu(&["File", "Examples", Example::Face.title()]);
    assert_eq!(window.shadings(), PICTURED);
    window
}

fn hover(window: &mut Window, view: &str) {
    let at = window.rect(Role::Image, view).center();
    window.harness.hover_at(at);
    window.settle();
}

#[test]
fn each_pane_has_a_shading_of_its_own_in_its_bar() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    window.choose("Shading of the mesh", "Angle distortion");
    window.choose("Shading of the embedding", "Area distortion");
    assert_eq!(window.shadings(), [ShadingMode::Angle, ShadingMode::Area]);
    let scale =
        |pane| window.editor().pane_shading.paint(pane).expect("painted").legend.as_ref().expect("a legend").scale;
    assert_ne!(scale(Pane::Mesh), scale(Pane::Plane));
    let titles = |title: &str| window.words().iter().filter(|words| *words == title).count();
    // Once in the menu of the pane's bar, and once over the legend in the pane.
    assert_eq!([ShadingMode::Angle, ShadingMode::Area].map(|shading| titles(shading.title())), [2, 2]);
}

#[test]
fn panes_that_are_coloured_alike_share_colours_and_one_legend() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    window.shade(ShadingMode::Area);
    window.settle();
    let faces = |window: &Window, pane| {
        std::sync::Arc::as_ptr(&window.editor().pane_shading.paint(pane).expect("painted").faces)
    };
    assert_eq!(faces(&window, Pane::Mesh), faces(&window, Pane::Plane));
    let title = ShadingMode::Area.title();
    assert_eq!(window.words().iter().filter(|words| *words == title).count(), 3, "two menus, one legend");
    window.choose("Shading of the mesh", "Plain");
    window.choose("Shading of the embedding", "Checker");
    assert_eq!(faces(&window, Pane::Mesh), faces(&window, Pane::Plane), "neither has a number for each face");
}

#[test]
fn number_keys_shade_the_pane_under_the_pointer_or_both() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    hover(&mut window, MESH_VIEW);
    window.key(Key::Num1);
    assert_eq!(window.shadings(), [ShadingMode::Plain, ShadingMode::Checker]);
    hover(&mut window, PLANE_VIEW);
    window.key(Key::Num4);
    assert_eq!(window.shadings(), [ShadingMode::Plain, ShadingMode::Angle]);
    window.harness.remove_cursor();
    window.settle();
    window.key(Key::Num6);
    assert_eq!(window.shadings(), [ShadingMode::Stretch, ShadingMode::Stretch]);
    window.key(Key::Num8);
    assert_eq!(window.shadings(), [ShadingMode::Stretch, ShadingMode::SeeThrough], "nothing lies behind the mesh");
}

#[test]
fn constraining_over_a_picture_shows_clay_and_a_thin_sheet_until_the_tool_is_left() {
    let mut window = face();
    for leave in [Key::V, Key::Escape] {
        window.key(Key::C);
        assert_eq!(window.shadings(), [ShadingMode::Plain, ShadingMode::SeeThrough]);
        assert!(window.editor().appearance().opacity > 0.9, "the picture is what the tool aims at");
        window.key(leave);
        assert_eq!(window.shadings(), PICTURED, "{leave:?}");
    }
}

#[test]
fn what_is_chosen_for_the_constrain_tool_comes_back_with_it() {
    let mut window = face();
    window.key(Key::C);
    window.choose("Shading of the mesh", "Checker");
    window.key(Key::V);
    assert_eq!(window.shadings(), PICTURED);
    window.key(Key::C);
    assert_eq!(window.shadings(), [ShadingMode::Checker, ShadingMode::SeeThrough]);
    window.editor_mut().session.handle(Action::RemovePicture);
    window.settle();
    assert_eq!(window.shadings(), [ShadingMode::Checker; 2], "without a picture the tool has no look of its own");
}

#[test]
fn a_project_keeps_both_shadings() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.0));
    open_picture(&mut window);
    window.choose("Shading of the mesh", "Plain");
    window.choose("Shading of the embedding", "Stretch");
    window.key(Key::C);
    window.press(egui::Modifiers::COMMAND, Key::S);
    window.click("Save");
    let path = window.path("sheet.freebound");
    assert!(path.exists());
    let mut other = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    other.open(&path);
    assert_eq!(other.shadings(), [ShadingMode::Plain, ShadingMode::SeeThrough], "the tool is saved as well");
    other.key(Key::V);
    assert_eq!(other.shadings(), [ShadingMode::Plain, ShadingMode::Stretch]);
}

/// Mean squared difference per channel between two pictures of a part of the window.
fn difference(window: &mut Window, part: egui::Rect, other: &image::RgbaImage) -> f64 {
    let now = window.harness.render().expect("a driver");
    let mut sum = 0.0;
    let mut count = 0.0;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "places in the picture")]
    let [left, top, right, bottom] = [part.left(), part.top(), part.right(), part.bottom()].map(|x| x as u32);
    for (x, y) in (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y))) {
        for channel in 0..3 {
            let difference = f64::from(now.get_pixel(x, y).0[channel]) - f64::from(other.get_pixel(x, y).0[channel]);
            sum += difference * difference;
            count += 1.0;
        }
    }
    sum / count
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn a_see_through_sheet_lets_the_picture_through() {
    let file = Window::with_mesh("sheet.obj", &sheet(6, 0.0));
    let mut window = Window::drawn(egui::Theme::Light, &file.path("sheet.obj"));
    window.editor_mut().session.handle(Action::OpenExample(Example::Face));
    window.settle();
    window.harness.remove_cursor();
    window.shade(ShadingMode::SeeThrough);
    window.editor_mut().pane_shading.magnifier = false;
    let middle = egui::Rect::from_center_size(window.plane_view().center(), egui::Vec2::splat(120.0));
    let mut picture_at = |opacity: f32| {
        window.editor_mut().appearance_mut().opacity = opacity;
        window.settle();
        window.harness.render().expect("a driver")
    };
    let [with, without] = [1.0, 0.0].map(&mut picture_at);
    let through = difference(&mut window, middle, &with);
    window.shade(ShadingMode::Plain);
    window.settle();
    let opaque = difference(&mut window, middle, &without);
    assert!(through > 100.0, "the picture behind the sheet makes a difference: {through}");
    assert!(opaque > 10.0, "the sheet is not see-through any more: {opaque}");
    let still = {
        window.editor_mut().appearance_mut().opacity = 1.0;
        window.settle();
        let shown = window.harness.render().expect("a driver");
        window.editor_mut().appearance_mut().opacity = 0.0;
        window.settle();
        difference(&mut window, middle, &shown)
    };
    assert!(still < 1.0, "behind an opaque sheet nothing shows: {still}");
}
