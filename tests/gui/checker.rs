//! Squares of the checker: their style, their number, and the wire over them.

use std::sync::Arc;

use eframe::App as _;
use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;
use freebound::render::{FaceShading, MeshFrame, PlaneFrame, mesh_pane, plane_pane};
use freebound::session::Severity;
use freebound::ui::{CheckerStyle, Pane, theme};
use freebound::view::{PictureQuad, Srgb};
use freebound_io::figure::chessboard;
use glam::{DVec2, DVec3};
use image::RgbaImage;

use crate::harness::{Window, sheet};
use crate::preferences::start;
use crate::render;

const LIST: &str = "Shading of the embedding";

fn style(window: &Window) -> (CheckerStyle, u32) {
    (window.editor().pane_shading.checker.style(), window.editor().squares_shown())
}

#[test]
fn the_menu_of_a_pane_sets_style_and_number_of_squares_and_stays_open() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let before = window.editor().pane_shading.checker.check_size();
    assert_eq!(style(&window), (CheckerStyle::Plain, 40));
    window.open_list(LIST);
    window.click("Letters and numbers");
    assert_eq!(style(&window), (CheckerStyle::Lettered, 16));
    window.click("More squares along the page");
    assert_eq!(style(&window), (CheckerStyle::Lettered, 32));
    let fine = window.editor().pane_shading.checker.check_size();
    assert!((before * 40.0 / 32.0 / fine - 1.0).abs() < 1e-9, "{before} {fine}");
    for _ in 0..5 {
        if window.is_enabled("Fewer squares along the page") {
            window.click("Fewer squares along the page");
        }
    }
    assert_eq!(style(&window), (CheckerStyle::Lettered, 4));
    window.fill_in(Role::SpinButton, "Squares along the page", "100");
    window.key(eframe::egui::Key::Enter);
    assert_eq!(style(&window), (CheckerStyle::Lettered, 128), "the nearest power of two");
    window.click("Automatic squares");
    assert_eq!(style(&window), (CheckerStyle::Lettered, 16));
    window.click("Plain squares");
    assert_eq!(style(&window), (CheckerStyle::Plain, 40));
    let now = window.editor().pane_shading.checker.check_size();
    assert!((now - before).abs() < 1e-12 * before, "{now} {before}");
}

#[test]
fn commands_of_the_view_menu_do_the_same() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.menu(&["View", "Checker and pixels", "Letters and numbers"]);
    window.menu(&["View", "Checker and pixels", "More squares"]);
    assert_eq!(style(&window), (CheckerStyle::Lettered, 32));
    window.menu(&["View", "Checker and pixels", "Fewer squares"]);
    window.menu(&["View", "Checker and pixels", "Automatic squares"]);
    assert_eq!(style(&window), (CheckerStyle::Lettered, 16));
}

#[test]
fn style_picture_and_number_come_back_in_the_next_run() {
    let mesh = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    image::RgbaImage::from_pixel(2, 2, image::Rgba([9, 8, 7, 255])).save(mesh.path("tile.png")).unwrap();
    let path = mesh.path("state/window.json");
    let mut first = start(&mesh, &path);
    first.menu(&["View", "Checker and pixels", "Own picture…"]);
    first.click("tile.png");
    first.click("Open");
    assert_eq!(style(&first), (CheckerStyle::Picture, 16));
    first.menu(&["View", "Checker and pixels", "More squares"]);
    first.harness.state_mut().on_exit();
    let mut second = start(&mesh, &path);
    assert_eq!(style(&second), (CheckerStyle::Picture, 32));
    second.harness.state_mut().on_exit();
    std::fs::remove_file(mesh.path("tile.png")).unwrap();
    let third = start(&mesh, &path);
    assert_eq!(style(&third).0, CheckerStyle::Plain, "the picture is gone");
    let messages = third.editor().session.messages();
    let message = messages.iter().find(|message| message.severity == Severity::Error).expect("a message");
    assert!(message.text.contains("tile.png") && message.remedy.is_some(), "{}", message.text);
}

/// Frames of a sheet in both panes with a chessboard whose squares are half a unit wide.
fn lettered() -> (MeshFrame, PlaneFrame) {
    let mut plane = render::plane_frame(DVec2::new(1.0, -1.0), &[]);
    plane.style.shading = FaceShading::Pattern;
    plane.style.check_size = 0.5;
    plane.pattern = PictureQuad::new(Arc::new(chessboard(64))).map(Arc::new);
    let mut mesh = render::mesh_frame();
    (mesh.plane, mesh.style, mesh.pattern) = (plane.plane.clone(), plane.style, plane.pattern.clone());
    (mesh, plane)
}

fn pictures(mesh: MeshFrame, plane: PlaneFrame) -> [RgbaImage; 2] {
    let on_mesh = render::Window::new(move || mesh_pane(render::PANE, render::RECT, mesh.clone())).picture();
    let in_plane = render::Window::new(move || plane_pane(render::PANE, render::RECT, plane.clone())).picture();
    [on_mesh, in_plane]
}

const PANE_SIZE: DVec2 = DVec2::splat(160.0);

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn a1_begins_at_the_origin_and_the_board_repeats_after_eight_squares_in_both_panes() {
    let (mesh, plane) = lettered();
    let board = chessboard(64);
    // Ground of a square, off its letters.
    let ground = |[column, row]: [u32; 2]| {
        let [r, g, b, _] = board.pixel(64 * column + 3, 64 * (7 - row) + 3).expect("inside");
        [r, g, b]
    };
    let [on_mesh, in_plane] = pictures(mesh.clone(), plane.clone());
    for (place, square) in [([0, 0], [0, 0]), ([1, 0], [1, 0]), ([1, 1], [1, 1]), ([-1, 0], [7, 0]), ([0, -2], [0, 6])]
    {
        let corner = DVec2::new(f64::from(place[0]), f64::from(place[1])) * 0.5 + 0.06;
        let at = plane.camera.pane_from_embedding(corner, PANE_SIZE);
        let found = render::pixel(&in_plane, at.x, at.y);
        let is_near = found.iter().zip(ground(square)).all(|(a, b)| a.abs_diff(b) < 12);
        assert!(is_near, "plane, {place:?}: {found:?} for {:?}", ground(square));
        // Light changes the brightness: compare the order of the channels.
        let at = mesh.camera.pane_from_world(DVec3::new(corner.x, corner.y, 0.0), PANE_SIZE).expect("before the eye");
        let [r, g, b] = render::pixel(&on_mesh, at.x, at.y).map(i32::from);
        let [r2, g2, b2] = ground(square).map(i32::from);
        let has_hue = |a: i32, b: i32, a2: i32, b2: i32| (a2 - b2).abs() < 30 || (a - b).signum() == (a2 - b2).signum();
        assert!(has_hue(r, g, r2, g2) && has_hue(g, b, g2, b2), "mesh, {place:?}: {r} {g} {b} for {r2} {g2} {b2}");
    }
}

/// Relative luminance of a pixel, WCAG 2.2.
fn luminance([r, g, b]: [u8; 3]) -> f64 {
    let [r, g, b, _] = Srgb([r, g, b, 255]).to_linear().map(f64::from);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

fn contrast(a: [u8; 3], b: [u8; 3]) -> f64 {
    let [a, b] = [luminance(a), luminance(b)];
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn the_wire_stands_out_from_both_checks_in_both_themes_and_panes() {
    for theme in [theme::LIGHT, theme::DARK] {
        for shading in [FaceShading::Checker, FaceShading::Pattern] {
            let (mut mesh, mut plane) = lettered();
            (mesh.palette, plane.palette) = (theme.palette, theme.palette);
            for style in [&mut mesh.style, &mut plane.style] {
                (style.shading, style.wire_in_points) = (shading, shading.wire_in_points());
            }
            let [on_mesh, in_plane] = pictures(mesh.clone(), plane.clone());
            // Middles of the pieces of the edge from (0, 0) to (1, 0) and of the one below, and points beside them.
            for middle in [0.13, 0.63, -0.37, -0.87] {
                for pane in [Pane::Mesh, Pane::Plane] {
                    let at = |y: f64| match pane {
                        Pane::Plane => plane.camera.pane_from_embedding(DVec2::new(middle, y), PANE_SIZE),
                        Pane::Mesh => {
                            mesh.camera.pane_from_world(DVec3::new(middle, y, 0.0), PANE_SIZE).expect("before the eye")
                        }
                    };
                    let picture = if pane == Pane::Plane { &in_plane } else { &on_mesh };
                    let beside = render::pixel(picture, at(0.06).x, at(0.06).y);
                    let across = (-2..=2).map(|k| render::pixel(picture, at(0.0).x, at(0.0).y + f64::from(k)));
                    let found = across.map(|pixel| contrast(pixel, beside)).fold(0.0, f64::max);
                    assert!(found >= 3.0, "{pane:?} {shading:?} at {middle}: {found:.2} over {beside:?}");
                }
            }
        }
    }
}

#[test]
fn the_page_has_the_chosen_number_of_squares_too() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.menu(&["View", "Checker and pixels", "Letters and numbers"]);
    assert!(window.harness.query_by_label("Letters and numbers").is_none(), "the menu is closed");
    window.editor_mut().handle(freebound::ui::CheckerRequest::SetSquares(Some(8)).into());
    window.settle();
    let extent = window.editor().plane.scene().expect("drawn").arrays.bounds.extent();
    let side = window.editor().pane_shading.checker.check_size();
    assert!((extent / side - 8.0).abs() < 1e-9, "{}", extent / side);
}
