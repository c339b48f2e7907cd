//! Picture in the window: opening, removal, flipping, drawing, and snapping.

use std::path::PathBuf;

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2, Vec2};
use freebound::session::Action;
use freebound::ui::{Half, ShadingMode};
use freebound_core::geom::{Picture, VAxis};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Target, Targets};
use glam::DVec2;

use crate::harness::{Window, sheet};

/// Colours of the picture's quarters: upper left, upper right, lower left, lower right.
const QUARTERS: [[u8; 3]; 4] = [[250, 20, 20], [20, 250, 20], [20, 20, 250], [250, 250, 20]];

/// Size of a picture twice as wide as high.
const SIZE: [u32; 2] = [40, 20];

fn write_picture(window: &Window) -> PathBuf {
    let [width, height] = SIZE;
    let colour = |x: u32, y: u32| {
        let [r, g, b] = QUARTERS[usize::from(x >= width / 2) + 2 * usize::from(y >= height / 2)];
        [r, g, b, 255]
    };
    let pixels = (0..height).flat_map(|y| (0..width).flat_map(move |x| colour(x, y))).collect();
    let path = window.path("quarters.png");
    let file = std::fs::File::create(&path).expect("a folder for files");
    freebound_io::raster::write_png(&Picture { width, height, pixels }, file).expect("written");
    path
}

pub(crate) fn open_picture(window: &mut Window) {
    let path = write_picture(window);
    window.editor_mut().session.handle(Action::OpenPicture(path));
    window.settle();
}

fn pins(window: &Window) -> Targets {
    window.editor().session.document().targets.clone()
}

fn window() -> Window {
    Window::with_mesh("sheet.obj", &sheet(6, 0.0))
}

#[test]
fn a_picture_is_opened_through_the_dialog_and_put_on_the_mesh() {
    let mut window = window();
    write_picture(&window);
    window.menu(&["File", "Open picture…"]);
    assert!(!window.has_button("sheet.obj"), "only pictures are listed");
    window.click("quarters.png");
    window.click("Open");
    assert!(window.editor().has_picture());
    assert_eq!(window.shadings(), [ShadingMode::Picture; 2]);
    window.click("Pins");
    assert!(window.shows("quarters.png, 40 × 20"));
    window.click("Remove");
    assert!(!window.editor().has_picture());
    assert_eq!(window.shadings(), [ShadingMode::Checker; 2]);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.shadings(), [ShadingMode::Picture; 2], "undo brings it back");
}

#[test]
fn the_picture_is_framed_with_the_embedding() {
    let mut window = window();
    open_picture(&mut window);
    let [low, high] = window.editor().session.document().frame().corners();
    assert_eq!([low, high], [DVec2::ZERO, DVec2::new(2.0, 1.0)]);
    let view = window.plane_view();
    for corner in [low, high] {
        assert!(view.contains(window.place_in_plane(corner)), "{corner}");
    }
}

#[test]
fn a_file_dropped_on_the_window_goes_where_its_name_says() {
    let mut window = window();
    let path = write_picture(&window);
    window.harness.input_mut().dropped_files.push(crate::dialogs::dropped(path));
    window.settle();
    assert!(window.editor().has_picture());
    let path = window.path("landmarks.txt");
    std::fs::write(&path, "0 0.25 0.5\n48 0.75 0.5 2\n").expect("written");
    window.harness.input_mut().dropped_files.push(crate::dialogs::dropped(path));
    window.settle();
    let expected = [(0, Target::hard(DVec2::new(0.25, 0.5))), (48, Target::weighted(DVec2::new(0.75, 0.5), 2.0))];
    assert_eq!(pins(&window), expected.map(|(v, pin)| (VertexId::new(v), pin)).into());
}

#[test]
fn constraints_go_to_a_file_and_come_back() {
    let mut window = window();
    open_picture(&mut window);
    for (vertex, pin) in [(0, Target::hard(DVec2::new(0.1, 0.3))), (24, Target::weighted(DVec2::new(0.5, 0.5), 3.0))] {
        window.editor_mut().session.handle(Action::Place { vertex: VertexId::new(vertex), target: pin });
    }
    window.settle();
    let before = pins(&window);
    window.click("Pins 2");
    window.click("Export…");
    window.click("Export");
    window.click("Free all");
    window.click("Import…");
    window.click("sheet-constraints.txt");
    window.click_last("Import");
    assert_eq!(pins(&window), before);
}

#[test]
fn v_runs_down_where_the_panel_says_so() {
    let mut window = window();
    open_picture(&mut window);
    window.click("Pins");
    window.click("v down");
    assert_eq!(window.editor().session.document().v_axis, VAxis::Down);
    let target = DVec2::new(0.25, 0.25);
    let pin = Target::hard(target);
    window.editor_mut().session.handle(Action::Place { vertex: VertexId::new(24), target: pin });
    window.settle();
    window.key(Key::F);
    // A quarter from the left and from the top.
    let [low, high] = window.editor().session.document().frame().corners();
    let [left_bottom, right_top] = [low, high].map(|z| window.place_in_plane(z));
    let expected =
        Pos2::new(egui::lerp(left_bottom.x..=right_top.x, 0.25), egui::lerp(right_top.y..=left_bottom.y, 0.25));
    let at = window.rect(Role::Button, "Constraint v24").center();
    assert!(at.distance(expected) < 1.0, "{at} {expected}");
    window.harness.hover_at(at);
    window.settle();
    assert!(window.shows("u 0.25") && window.shows("v 0.25"), "{:?}", window.words());
}

#[test]
fn a_nudge_is_one_pixel_of_the_picture_upwards_on_the_screen() {
    for (axis, sign) in [("v up", 1.0), ("v down", -1.0)] {
        let mut window = window();
        open_picture(&mut window);
        window.click("Pins");
        window.click(axis);
        let target = DVec2::new(0.5, 0.5);
        let pin = Target::hard(target);
        window.editor_mut().session.handle(Action::Place { vertex: VertexId::new(24), target: pin });
        window.settle();
        window.editor_mut().selection.select([VertexId::new(24)]);
        window.key(Key::ArrowUp);
        window.key(Key::ArrowRight);
        let moved = pins(&window)[&VertexId::new(24)].uv - target;
        let pixel = DVec2::new(1.0 / 40.0, sign / 20.0);
        assert!(moved.distance(pixel) < 1e-12, "{axis}: {moved}");
    }
}

#[test]
fn a_place_snaps_to_pixels_that_are_large_on_the_screen() {
    let mut window = window();
    open_picture(&mut window);
    window.key(Key::C);
    let near_middle =
        |window: &Window| window.place_in_plane(DVec2::new(20.5 / 20.0, 10.5 / 20.0)) + Vec2::new(2.0, -1.0);
    window.editor_mut().tools.set_pair(Some(Half::Vertex(VertexId::new(24))));
    window.click_at(near_middle(&window), Modifiers::NONE);
    assert_eq!(pins(&window)[&VertexId::new(24)].uv, DVec2::new(20.5, 10.5) / DVec2::new(40.0, 20.0));
    window.editor_mut().tools.set_pair(Some(Half::Vertex(VertexId::new(10))));
    window.click_at(near_middle(&window) + Vec2::new(0.0, 1.0), Modifiers::ALT);
    let free = pins(&window)[&VertexId::new(10)].uv;
    assert!(free.distance(DVec2::new(20.5, 10.5) / DVec2::new(40.0, 20.0)) > 1e-4, "Alt leaves it where it is: {free}");
}

#[test]
fn over_a_picture_a_click_means_a_place_and_with_shift_the_vertex() {
    let mut window = window();
    open_picture(&mut window);
    window.key(Key::C);
    let at = window.place_in_plane(window.embedding()[24]);
    window.click_at(at, Modifiers::NONE);
    assert!(matches!(window.editor().tools.pair(), Some(Half::Target(_))), "{:?}", window.editor().tools.pair());
    window.key(Key::Escape);
    window.click_at(at, Modifiers::SHIFT);
    assert_eq!(window.editor().tools.pair(), Some(Half::Vertex(VertexId::new(24))));
}

/// Colours shown in the picture's quarters: behind a flat mesh in its middle, and on the mesh.
fn quarters_shown(window: &mut Window) -> [[u8; 3]; 4] {
    let [low, high] = window.editor().session.document().frame().corners();
    let inside = [(0.2, 0.75), (0.7, 0.75), (0.2, 0.25), (0.7, 0.25)];
    let places = inside.map(|(x, y)| window.place_in_plane(low + (high - low) * DVec2::new(x, y)));
    window.harness.remove_cursor();
    window.settle();
    let image = window.harness.render().expect("a driver");
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "places in the picture")]
    places.map(|at| {
        let [r, g, b, _] = image.get_pixel(at.x as u32, at.y as u32).0;
        [r, g, b]
    })
}

fn assert_upright(shown: [[u8; 3]; 4], state: &str) {
    for (shown, wanted) in shown.into_iter().zip(QUARTERS) {
        let is_near = shown.iter().zip(wanted).all(|(&a, b)| a.abs_diff(b) < 30);
        assert!(is_near, "{state}: {shown:?} where {wanted:?} belongs");
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn the_picture_stands_upright_behind_the_embedding_and_on_it_whichever_way_v_runs() {
    let file = window();
    let mut window = Window::drawn(egui::Theme::Light, &file.path("sheet.obj"));
    open_picture(&mut window);
    window.editor_mut().appearance_mut().opacity = 1.0;
    for (v_axis, top) in [(VAxis::Up, 1.0), (VAxis::Down, 0.0)] {
        window.editor_mut().session.handle(Action::SetVAxis(v_axis));
        window.settle();
        assert_upright(quarters_shown(&mut window), "behind and on the embedding as it comes");
        // The sheet's corners are on those of the picture, so all of it is seen through the mesh.
        for (vertex, u, is_top) in [(0, 0.0, false), (6, 1.0, false), (42, 0.0, true), (48, 1.0, true)] {
            let pin = Target::hard(DVec2::new(u, if is_top { top } else { 1.0 - top }));
            window.editor_mut().session.handle(Action::Place { vertex: VertexId::new(vertex), target: pin });
        }
        window.settle();
        window.key(Key::F);
        window.editor_mut().appearance_mut().opacity = 0.0;
        assert_upright(quarters_shown(&mut window), "through the mesh in the plane");
        window.editor_mut().appearance_mut().opacity = 1.0;
        // The sheet faces the camera with its x to the right and its y up.
        let at = |window: &Window, vertex: u32| window.place_on_mesh(VertexId::new(vertex));
        let middle = at(&window, 24);
        let places = [36, 40, 8, 12].map(|vertex| middle + (at(&window, vertex) - middle) * 0.9);
        window.harness.remove_cursor();
        window.settle();
        let image = window.harness.render().expect("a driver");
        for (place, wanted) in places.into_iter().zip(QUARTERS) {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "places in the picture")]
            let [r, g, b, _] = image.get_pixel(place.x as u32, place.y as u32).0;
            let strongest = |[r, g, b]: [u8; 3]| [r > 128, g > 128, b > 128];
            assert_eq!(strongest([r, g, b]), strongest(wanted), "{v_axis:?}: on the mesh at {place}");
        }
        window.editor_mut().session.handle(Action::UnpinAll);
        window.settle();
    }
}

#[test]
fn a_picture_opened_like_a_mesh_is_the_picture_of_the_document() {
    let mut window = window();
    let path = write_picture(&window);
    window.shade(ShadingMode::Angle);
    let mesh = window.editor().session.model().expect("a mesh").name.clone();
    window.press(Modifiers::COMMAND, Key::O);
    window.click("quarters.png");
    window.click("Open");
    assert!(window.editor().has_picture() && window.editor().session.messages().is_empty());
    assert_eq!(window.shadings(), [ShadingMode::Picture; 2]);
    assert_eq!(window.editor().session.model().expect("a mesh").name, mesh);
    // A dropped one replaces it.
    window.shade(ShadingMode::Stretch);
    let other = window.path("other.png");
    std::fs::copy(&path, &other).expect("copied");
    window.harness.input_mut().dropped_files.push(crate::dialogs::dropped(other));
    window.settle();
    assert_eq!(window.shadings(), [ShadingMode::Picture; 2]);
}

#[test]
fn a_picture_of_the_command_line_is_shown_on_the_built_in_face() {
    let files = window();
    let start = freebound::app::LaunchFile { file: Some(write_picture(&files)), ..Default::default() };
    let window = Window::start(crate::harness::SIZE, start);
    let editor = window.editor();
    assert_eq!(editor.session.model().expect("a mesh").name, freebound::examples::Example::Face.title());
    let picture = editor.session.document().picture.as_ref().expect("a picture");
    assert_eq!((picture.pixels.width, picture.pixels.height), (40, 20));
    assert_eq!(window.shadings(), [ShadingMode::Picture; 2]);
    assert!(editor.session.messages().is_empty());
}

#[test]
fn a_picture_that_no_mesh_waits_for_is_shown_on_the_built_in_face() {
    let files = window();
    let start = freebound::app::LaunchFile { file: Some(files.path("gone.obj")), ..Default::default() };
    let mut window = Window::start(crate::harness::SIZE, start);
    assert!(window.editor().session.model().is_none());
    window.harness.input_mut().dropped_files.push(crate::dialogs::dropped(write_picture(&files)));
    window.settle();
    assert!(window.editor().has_picture() && window.editor().session.model().is_some());
}

#[test]
fn a_picture_of_an_unknown_kind_is_refused_as_a_picture() {
    let mut window = window();
    let path = window.path("scan.tif");
    std::fs::write(&path, "II*").expect("written");
    window.harness.input_mut().dropped_files.push(crate::dialogs::dropped(path.clone()));
    window.settle();
    let message = &window.editor().session.messages()[0];
    assert_eq!(message.about.as_deref(), Some(&*path));
    assert!(message.remedy.as_ref().expect("a remedy").contains("PNG"), "{message:?}");
}
