//! A few pixels of the whole window, drawn by a software driver: properties that no accessibility tree contains.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Color32, Pos2, Rect, Theme};
use freebound::ui::{HullStage, Request, ShadingMode, theme};
use freebound::view::Srgb;
use freebound_core::mesh::{FaceId, VertexId};
use freebound_core::problem::{Method, Settings};
use glam::DVec2;
use image::RgbaImage;

use crate::defects::fold;
use crate::harness::{Window, sheet};

/// Largest difference of a channel between a theme's colour and its pixels, since edges are smoothed and lines
/// hatched.
const NEAR: u8 = 24;

const THEMES: [(Theme, &theme::Theme); 2] = [(Theme::Light, &theme::LIGHT), (Theme::Dark, &theme::DARK)];

fn drawn(theme: Theme) -> Window {
    let file = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    Window::drawn(theme, &file.path("sheet.obj"))
}

fn picture(window: &mut Window) -> RgbaImage {
    window.harness.remove_cursor();
    window.settle();
    window.harness.render().expect("a driver")
}

/// Pixels of a part of the window.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "places in the picture")]
fn pixels(picture: &RgbaImage, part: Rect) -> Vec<[u8; 3]> {
    let [left, top, right, bottom] = [part.left(), part.top(), part.right(), part.bottom()].map(|x| x as u32);
    let places = (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y)));
    places.map(|(x, y)| picture.get_pixel(x, y).0).map(|[r, g, b, _]| [r, g, b]).collect()
}

/// Number of pixels of a part with a colour.
fn count_of(picture: &RgbaImage, part: Rect, colour: Color32) -> usize {
    let wanted = [colour.r(), colour.g(), colour.b()];
    let near = |pixel: &[u8; 3]| pixel.iter().zip(wanted).all(|(&a, b)| a.abs_diff(b) <= NEAR);
    pixels(picture, part).iter().filter(|pixel| near(pixel)).count()
}

/// Bounding box of a face in the embedding's pane.
fn box_of(window: &Window, face: FaceId) -> Rect {
    let embedding = window.embedding();
    let corners = window.editor().session.model().expect("open").mesh().triangles[face.index()];
    let places = corners.map(|corner| window.place_in_plane(embedding[corner]));
    Rect::from_points(&places)
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn a_flipped_face_is_red_in_the_embedding_and_the_verdict_too() {
    for (name, theme) in THEMES {
        let mut window = drawn(name);
        let pill = |window: &Window| window.rect(Role::Button, &format!("Verdict: {}", window.verdict()));
        let planar = picture(&mut window);
        assert!(count_of(&planar, pill(&window), theme.planar) > 20, "{name:?}: green");
        assert_eq!(
            count_of(&planar, window.plane_view(), colour_of(theme.palette.flipped)),
            0,
            "{name:?}: nothing is flipped yet"
        );
        fold(&mut window);
        let folded = picture(&mut window);
        assert!(count_of(&folded, pill(&window), theme.flipped) > 20, "{name:?}: red");
        for &face in &window.outcome().step.verdict.flipped_faces {
            let part = box_of(&window, face);
            let least = (part.area() / 12.0).min(60.0);
            let count = count_of(&folded, part, colour_of(theme.palette.flipped)) as f32;
            assert!(count >= least, "{name:?}: {count} red pixels in {part:?}");
        }
        assert!(
            count_of(&folded, window.mesh_view(), colour_of(theme.palette.flipped)) > 20,
            "{name:?}: and on the mesh"
        );
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn both_panes_are_filled_and_their_corners_are_background() {
    for (name, theme) in THEMES {
        let mut window = drawn(name);
        let picture = picture(&mut window);
        for view in [window.mesh_view(), window.plane_view()] {
            let all = pixels(&picture, view).len();
            let empty = count_of(&picture, view, theme.background);
            assert!(empty > all / 20 && empty < all * 9 / 10, "{name:?}: {empty} of {all} in {view:?}");
            let corner = Rect::from_min_size(view.min + egui::Vec2::splat(4.0), egui::Vec2::splat(8.0));
            // A line of the grid may pass through the corner.
            let empty = count_of(&picture, corner, theme.background);
            assert!(empty >= 48, "{name:?}: {empty} of 64 in {corner:?}");
        }
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn the_checker_shows_both_its_colours_in_both_panes() {
    for (name, theme) in THEMES {
        let mut window = drawn(name);
        let picture = picture(&mut window);
        let [light, dark] = theme.palette.checker.map(|colour| {
            let [r, g, b, _] = colour.0;
            theme::rgb([r, g, b])
        });
        for colour in [light, dark] {
            assert!(count_of(&picture, window.plane_view(), colour) > 2000, "{name:?}: {colour:?}");
        }
        let shades: std::collections::BTreeSet<_> = pixels(&picture, window.mesh_view()).into_iter().collect();
        assert!(shades.len() > 50, "{name:?}: the mesh is lit");
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn the_legend_shows_with_shadings_by_numbers_only() {
    for (name, _) in THEMES {
        let mut window = drawn(name);
        let view = window.mesh_view();
        let corner = Rect::from_min_max(
            view.left_bottom() + egui::vec2(12.0, -90.0),
            view.left_bottom() + egui::vec2(196.0, -12.0),
        );
        window.shade(ShadingMode::Plain);
        let plain = picture(&mut window);
        window.shade(ShadingMode::Angle);
        let angle = picture(&mut window);
        let changed = pixels(&plain, corner).iter().zip(pixels(&angle, corner)).filter(|(a, b)| *a != b).count();
        assert!(changed > 5000, "{name:?}: {changed} pixels");
        let (plain, angle) = (pixels(&plain, window.plane_view()), pixels(&angle, window.plane_view()));
        assert_ne!(plain, angle, "{name:?}: the faces have other colours");
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn a_pin_is_drawn_where_it_lies_in_both_panes() {
    for (name, theme) in THEMES {
        let mut window = drawn(name);
        let vertex = VertexId::new(24);
        window.editor_mut().session.handle(freebound::session::Action::Fix(vec![vertex]));
        let picture = picture(&mut window);
        let target: DVec2 = window.embedding()[24];
        let around = |at: Pos2| Rect::from_center_size(at, egui::Vec2::splat(9.0));
        for at in [window.place_in_plane(target), window.place_on_mesh(vertex)] {
            assert!(count_of(&picture, around(at), theme.pin) > 40, "{name:?} at {at}");
        }
    }
}

/// The built-in face with a virtual boundary.
fn bent(theme: Theme) -> Window {
    let file = Window::with_mesh("face.obj", &freebound::examples::Example::Face.mesh());
    let mut window = Window::drawn(theme, &file.path("face.obj"));
    let settings = Settings { method: Method::VirtualBoundary, ..Settings::default() };
    window.editor_mut().session.handle(freebound::session::Action::SetSettings(settings));
    window.settle();
    window
}

fn colour_of(colour: Srgb) -> Color32 {
    let [r, g, b, _] = colour.0;
    theme::rgb([r, g, b])
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn the_hull_is_red_until_it_is_peeled_off() {
    for (name, theme) in THEMES {
        let mut window = bent(name);
        let bare = picture(&mut window);
        window.editor_mut().handle(Request::ToggleHull);
        let pockets = picture(&mut window);
        window.editor_mut().handle(Request::SetStage(HullStage::Before));
        let before = picture(&mut window);
        window.editor_mut().handle(Request::SetStage(HullStage::Peeled));
        let peeled = picture(&mut window);
        let hull = |picture: &RgbaImage| count_of(picture, window.plane_view(), colour_of(theme.hull));
        assert!(hull(&bare) < 10 && hull(&pockets) > 500 && hull(&before) > 500, "{name:?}: {}", hull(&pockets));
        assert!(hull(&peeled) < 10, "{name:?}: {}", hull(&peeled));
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn a_pocket_is_filled_with_a_quarter_of_its_green() {
    for (name, theme) in THEMES {
        let mut window = bent(name);
        window.editor_mut().handle(Request::ToggleHull);
        window.settle();
        let stages = window.outcome().step.candidate.virtual_boundary.clone().expect("the face bends");
        let plane = window.editor().plane.drawn().expect("solved").clone();
        let corners = |t: &[VertexId; 3]| t.map(|v| plane.positions()[v.index()]);
        let area = |t: &[VertexId; 3]| {
            let [a, b, c] = corners(t);
            (b - a).perp_dot(c - a)
        };
        let widest = stages.pockets.iter().max_by(|s, t| area(s).total_cmp(&area(t))).expect("a pocket");
        let (corners, size) = (corners(widest), window.editor().plane.pane.size());
        let bounds = freebound::view::bounds_of(&corners);
        window.editor_mut().plane.pane.camera_mut().expect("framed").frame(bounds, size);
        let picture = picture(&mut window);
        let middle = window.place_in_plane(corners.iter().sum::<DVec2>() / 3.0);
        let mix = |a: u8, b: u8| u8::try_from((3 * u16::from(a) + u16::from(b)) / 4).expect("a mean of bytes");
        let (ground, pocket) = (theme.background, colour_of(theme.pocket));
        let mixed = [mix(ground.r(), pocket.r()), mix(ground.g(), pocket.g()), mix(ground.b(), pocket.b())];
        let part = Rect::from_center_size(middle, egui::Vec2::splat(4.0));
        let count = count_of(&picture, part, theme::rgb(mixed));
        assert!(count >= 12, "{name:?}: {count} of 16 pixels, {:?} for {mixed:?}", pixels(&picture, part));
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn the_magnifier_shows_its_flipped_face_hatched() {
    for (name, theme) in THEMES {
        let mut window = drawn(name);
        fold(&mut window);
        // Zoomed out, hardly a pixel of the layout is red.
        let camera = window.editor_mut().plane.pane.camera_mut().expect("framed");
        camera.zoom_at(DVec2::splat(150.0), 0.02, DVec2::splat(400.0));
        let picture = picture(&mut window);
        let inset = window.controls().into_iter().find(|(_, name, _)| name.starts_with("Magnifier: "));
        let (.., part) = inset.expect("it shows");
        let (red, all) = (count_of(&picture, part, colour_of(theme.palette.flipped)), pixels(&picture, part).len());
        assert!(red > all / 20, "{name:?}: {red} of {all}");
        let elsewhere = count_of(&picture, window.plane_view(), colour_of(theme.palette.flipped)) - red;
        assert!(elsewhere < 100, "{name:?}: {elsewhere}");
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn the_compared_step_is_an_outline_in_its_own_colour() {
    for (name, theme) in THEMES {
        let mut window = bent(name);
        let ghost =
            |picture: &RgbaImage, window: &Window| count_of(picture, window.plane_view(), colour_of(theme.ghost));
        let alone = picture(&mut window);
        window.editor_mut().session.handle(freebound::session::Action::Compare(Some(0)));
        let compared = picture(&mut window);
        let count = ghost(&compared, &window).saturating_sub(ghost(&alone, &window));
        assert!(count > 300, "{name:?}: {count} pixels");
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn moves_are_coloured_in_both_panes() {
    for (name, _) in THEMES {
        let mut window = bent(name);
        window.shade(ShadingMode::Plain);
        let plain = picture(&mut window);
        window.shade(ShadingMode::Move);
        let moved = picture(&mut window);
        for view in [window.mesh_view(), window.plane_view()] {
            let changed = pixels(&plain, view).iter().zip(pixels(&moved, view)).filter(|(a, b)| *a != b).count();
            assert!(changed > 20_000, "{name:?}: {changed} pixels");
        }
    }
}

#[test]
fn the_graphics_card_draws_in_the_theme_s_colours() {
    for (_, theme) in THEMES {
        let bytes = |colour: egui::Color32| colour.to_array();
        assert_eq!(theme.palette.background.0, bytes(theme.background));
        // Words are darker or lighter than faces, and as red.
        for [r, g, b, _] in [theme.palette.flipped.0, bytes(theme.flipped)] {
            assert!(r > 170 && g < 130 && b < 140, "{r} {g} {b}");
        }
    }
}
