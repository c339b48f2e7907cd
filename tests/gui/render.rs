//! Pictures of the panes, checked at a few pixels.
//!
//! Both panes show a sheet of two by two squares in the z = 0 plane, split into triangles; a corner of its embedding
//! folds.

use std::sync::Arc;

use eframe::egui;
use eframe::egui_wgpu::{RenderState, RendererOptions};
use egui_kittest::Harness;
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state, default_wgpu_setup};
use freebound::render::{
    FaceShading, FillLayer, LineLayer, MeshFrame, Normals, PaneId, PictureLayer, PlaneFrame, Sampling, Style, install,
    mesh_pane, plane_pane,
};
use freebound::view::{
    DrawnFaces, EdgeList, FacePaint, MeshArrays, OrbitCamera, Palette, PlaneArrays, PlaneCamera, Sphere, Srgb, UpAxis,
};
use freebound_core::geom::Bounds;
use freebound_core::mesh::{FaceId, VertexId};
use freebound_core::problem::Embedding;
use glam::{DVec2, DVec3};
use image::RgbaImage;

use crate::picture_filter::ready;

pub(crate) const PANE: PaneId = PaneId("test");
/// Size of the window and bounds of the pane, points.
pub(crate) const WINDOW: f32 = 200.0;
pub(crate) const RECT: egui::Rect = egui::Rect { min: egui::pos2(20.0, 30.0), max: egui::pos2(180.0, 190.0) };
const PANE_SIZE: DVec2 = DVec2::splat(160.0);

/// Easily distinguished colours.
const PALETTE: Palette = Palette {
    background: Srgb([250, 250, 250, 255]),
    grid: Srgb([250, 250, 250, 255]),
    unit_square: Srgb([250, 250, 250, 255]),
    clay: Srgb([200, 200, 200, 255]),
    clay_back: Srgb([40, 60, 200, 255]),
    plane_face: Srgb([0, 200, 0, 255]),
    overlap: Srgb([0, 0, 0, 255]),
    checker: [Srgb([255, 255, 255, 255]), Srgb([0, 0, 0, 255])],
    wire: Srgb([0, 0, 0, 255]),
    wire_light: Srgb([255, 255, 255, 255]),
    flipped: Srgb([255, 0, 0, 255]),
};

fn id(v: u32) -> VertexId {
    VertexId::new(v)
}

/// Vertices 0 1 2 / 3 4 5 / 6 7 8 at the integer points from (−1, −1) to (1, 1), eight counter-clockwise faces.
fn sheet() -> (Vec<DVec3>, Vec<[VertexId; 3]>) {
    let positions = (0..9).map(|k| DVec3::new(f64::from(k % 3) - 1.0, f64::from(k / 3) - 1.0, 0.0)).collect();
    let squares = [0, 1, 3, 4];
    let triangles =
        squares.iter().flat_map(|&s| [[id(s), id(s + 1), id(s + 4)], [id(s), id(s + 4), id(s + 3)]]).collect();
    (positions, triangles)
}

/// Device, and a window with one pane whose callback `paint` creates every frame.
pub(crate) struct Window {
    pub(crate) state: RenderState,
    harness: Harness<'static>,
}

impl Window {
    pub(crate) fn new(paint: impl Fn() -> egui::PaintCallback + 'static) -> Self {
        let state = create_render_state(default_wgpu_setup(), RendererOptions::PREDICTABLE);
        install(&state);
        let harness = Harness::builder()
            .with_size(egui::Vec2::splat(WINDOW))
            .with_pixels_per_point(1.0)
            .renderer(WgpuTestRenderer::from_render_state(state.clone()))
            .build_ui(move |ui| {
                ui.painter().add(paint());
            });
        Self { state, harness }
    }

    pub(crate) fn picture(&mut self) -> RgbaImage {
        self.harness.step();
        self.harness.render().expect("the driver draws")
    }
}

pub(crate) fn camera_in_front() -> OrbitCamera {
    let (positions, _) = sheet();
    let mut camera = OrbitCamera::framing(Sphere::around(&positions), UpAxis::Y);
    // Reverts the turn of the first view: 0.35 and 0.2 rad at 0.007 rad per point.
    camera.orbit(DVec2::new(50.0, -0.2 / 0.007));
    camera
}

pub(crate) fn mesh_frame() -> MeshFrame {
    let (positions, triangles) = sheet();
    MeshFrame {
        around_lines: Vec::new(),
        around: None,
        mesh: Arc::new(MeshArrays::new(&positions, &triangles)),
        plane: None,
        paint: None,
        lines: Vec::new(),
        picture: None,
        pattern: None,
        camera: camera_in_front(),
        style: Style::default(),
        palette: PALETTE,
    }
}

/// Frame with the sheet's x and y as its embedding, and its lower right corner, vertex 2, moved to `corner`.
pub(crate) fn plane_frame(corner: DVec2, flipped: &[FaceId]) -> PlaneFrame {
    let (positions, triangles) = sheet();
    let mut embedding: Embedding = positions.iter().map(|p| p.truncate()).collect();
    embedding[2] = corner;
    let box_of_sheet = Bounds { low: DVec2::NEG_ONE, high: DVec2::ONE };
    PlaneFrame {
        plane: Some(Arc::new(PlaneArrays::new(&embedding, &triangles))),
        paint: Some(Arc::new(FacePaint::plain(triangles.len(), flipped))),
        fills: Vec::new(),
        ghost: None,
        lines: Vec::new(),
        picture: None,
        pattern: None,
        outlined: Bounds::UNIT,
        camera: PlaneCamera::framing(box_of_sheet, PANE_SIZE),
        style: Style { flipped_outline_in_points: 0.0, ..Style::default() },
        palette: PALETTE,
        mesh: Arc::new(MeshArrays::new(&positions, &triangles)),
    }
}

fn mesh_picture(frame: MeshFrame) -> RgbaImage {
    Window::new(move || mesh_pane(PANE, RECT, frame.clone())).picture()
}

fn plane_picture(frame: PlaneFrame) -> RgbaImage {
    Window::new(move || plane_pane(PANE, RECT, frame.clone())).picture()
}

/// Pixel at a point of the embedding.
fn plane_pixel(picture: &RgbaImage, frame: &PlaneFrame, point: DVec2) -> [u8; 3] {
    let in_pane = frame.camera.pane_from_embedding(point, PANE_SIZE);
    pixel(picture, in_pane.x, in_pane.y)
}

/// Pixel at a point of the pane, from its upper left corner.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place in a small picture")]
pub(crate) fn pixel(picture: &RgbaImage, x: f64, y: f64) -> [u8; 3] {
    let in_window = [x + f64::from(RECT.min.x), y + f64::from(RECT.min.y)].map(|place| place as u32);
    let [rgb @ .., _] = picture.get_pixel(in_window[0], in_window[1]).0;
    rgb
}

/// Mean colour of a square of seven pixels, which averages out hatching.
fn mean_about(picture: &RgbaImage, frame: &PlaneFrame, point: DVec2) -> [f64; 3] {
    let middle = frame.camera.pane_from_embedding(point, PANE_SIZE);
    let mut sum = [0.0; 3];
    for k in 0..49 {
        let rgb = pixel(picture, middle.x + f64::from(k % 7) - 3.0, middle.y + f64::from(k / 7) - 3.0);
        sum = std::array::from_fn(|c| sum[c] + f64::from(rgb[c]) / 49.0);
    }
    sum
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn a_pane_fills_its_rectangle_and_nothing_else() {
    let mut frame = plane_frame(DVec2::new(1.0, -1.0), &[]);
    frame.palette.background = Srgb([10, 120, 240, 255]);
    frame.palette.grid = frame.palette.background;
    frame.palette.unit_square = frame.palette.background;
    let picture = plane_picture(frame);
    // sRGB colours reach the window unchanged, within the rounding of a byte.
    for (x, y) in [(0.0, 0.0), (159.0, 0.0), (0.0, 159.0), (159.0, 159.0)] {
        let [r, g, b] = pixel(&picture, x, y);
        assert!(r.abs_diff(10) <= 1 && g.abs_diff(120) <= 1 && b.abs_diff(240) <= 1, "{x} {y}: {r} {g} {b}");
    }
    for (x, y) in [(-1.0, 80.0), (160.0, 80.0), (80.0, -1.0), (80.0, 160.0)] {
        assert_ne!(pixel(&picture, x, y)[2], 240, "{x} {y} is outside");
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn a_flipped_face_is_red_in_the_plane_and_lies_on_top() {
    // Faces 2 and 3 form the square between 1, 2, 5 and 4. With 2 at (−0.5, 0.5), face 2 (1, 2 and 5) is flipped.
    let frame = plane_frame(DVec2::new(-0.5, 0.5), &[FaceId::new(2)]);
    let picture = plane_picture(frame.clone());
    let [r, g, _] = mean_about(&picture, &frame, DVec2::new(0.1, -0.05));
    assert!(r > 200.0 && g < 150.0, "flipped, over others: {r} {g}");
    let [r, g, _] = mean_about(&picture, &frame, DVec2::new(-0.5, -0.5));
    assert!(r < 20.0 && g > 180.0, "not flipped: {r} {g}");
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn a_thin_flipped_face_shows_by_its_outline() {
    // Flipped by a hundred thousandth of a pixel.
    let mut frame = plane_frame(DVec2::new(0.5 - 1e-7, -0.5 + 1e-7), &[FaceId::new(2)]);
    frame.style.flipped_outline_in_points = 2.0;
    let picture = plane_picture(frame.clone());
    let [r, g, b] = plane_pixel(&picture, &frame, DVec2::new(0.25, -0.75));
    assert!(r > 200 && g < 100 && b < 100, "{r} {g} {b}");
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn overlapping_faces_are_darker_than_single_ones() {
    let frame = plane_frame(DVec2::new(-0.5, 0.5), &[FaceId::new(2)]);
    let picture = plane_picture(frame.clone());
    // Face 3 is not flipped but covers its neighbours, up to vertex 2.
    let [_, single, _] = mean_about(&picture, &frame, DVec2::new(-0.6, -0.7));
    let folded = plane_frame(DVec2::new(-0.5, 0.5), &[]);
    let picture = plane_picture(folded.clone());
    let [_, double, _] = mean_about(&picture, &folded, DVec2::new(0.1, -0.05));
    assert!(double < single - 40.0, "{double} against {single}");
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn the_back_of_the_mesh_has_its_own_colour() {
    let front = mesh_frame();
    let mut back = front.clone();
    // Half a turn at 0.007 rad per point.
    back.camera.orbit(DVec2::new(std::f64::consts::PI / 0.007, 0.0));
    let [r, _, b] = pixel(&mesh_picture(front), 80.0, 80.0);
    assert!(r > 120 && r.abs_diff(b) < 20, "clay in front: {r} {b}");
    let [r, _, b] = pixel(&mesh_picture(back), 80.0, 80.0);
    assert!(b > 100 && r < b / 2, "blue behind: {r} {b}");
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn flipped_faces_are_red_on_the_mesh_in_every_shading() {
    for shading in [FaceShading::Plain, FaceShading::Checker, FaceShading::Paint, FaceShading::Picture] {
        let mut frame = mesh_frame();
        let plane = plane_frame(DVec2::new(1.0, -1.0), &(0..8).map(FaceId::new).collect::<Vec<_>>());
        frame.style = Style { shading, normals: Normals::Flat, ..plane.style };
        (frame.plane, frame.paint) = (plane.plane, plane.paint);
        let [r, g, b] = pixel(&mesh_picture(frame), 60.0, 70.0);
        assert!(r > 120 && g < r / 3 && b < r / 3, "{shading:?}: {r} {g} {b}");
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn the_checker_is_anchored_at_the_origin_in_both_panes() {
    let mut plane = plane_frame(DVec2::new(1.0, -1.0), &[]);
    plane.style.shading = FaceShading::Checker;
    plane.style.check_size = 0.5;
    let mut mesh = mesh_frame();
    (mesh.plane, mesh.style) = (plane.plane.clone(), plane.style);
    let flat = plane_picture(plane.clone());
    let lit = mesh_picture(mesh.clone());
    // Middles of checks around the origin.
    for (x, y, is_light) in [(0.25, 0.25, true), (-0.25, 0.25, false), (-0.25, -0.25, true), (0.75, 0.25, false)] {
        let [r, ..] = plane_pixel(&flat, &plane, DVec2::new(x, y));
        assert_eq!(r > 128, is_light, "plane, {x} {y}: {r}");
        let in_pane = mesh.camera.pane_from_world(DVec3::new(x, y, 0.0), PANE_SIZE).expect("before the eye");
        let [r, ..] = pixel(&lit, in_pane.x, in_pane.y);
        assert_eq!(r > 80, is_light, "mesh, {x} {y}: {r}");
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn lines_lie_where_their_vertices_lie() {
    let edges = Arc::new(EdgeList::new(vec![[id(3), id(4)]]));
    let layer = LineLayer { edges, colour: Srgb([0, 0, 255, 255]), width_in_points: 4.0 };
    let mut plane = plane_frame(DVec2::new(1.0, -1.0), &[]);
    plane.lines.push(layer.clone());
    let picture = plane_picture(plane.clone());
    let [r, _, b] = plane_pixel(&picture, &plane, DVec2::new(-0.5, 0.0));
    assert!(b > 240 && r < 10, "on the line: {r} {b}");
    let [.., b] = plane_pixel(&picture, &plane, DVec2::new(-0.5, 0.1));
    assert!(b < 10, "beside it: {b}");
    let mut mesh = mesh_frame();
    mesh.lines.push(layer);
    let in_pane = mesh.camera.pane_from_world(DVec3::new(-0.5, 0.0, 0.0), PANE_SIZE).expect("before the eye");
    let [r, _, b] = pixel(&mesh_picture(mesh), in_pane.x, in_pane.y);
    assert!(b > 240 && r < 10, "on the mesh: {r} {b}");
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn a_sharp_zigzag_ends_round_at_its_corners() {
    // Lines from 3 to 5 and back to 2, which lies near 3: the angle at 5 is 3°.
    let mut plane = plane_frame(DVec2::new(-0.8, 0.1), &[]);
    let edges = Arc::new(EdgeList::new(vec![[id(3), id(5)], [id(5), id(2)]]));
    plane.lines.push(LineLayer { edges, colour: Srgb([0, 0, 255, 255]), width_in_points: 8.0 });
    let picture = plane_picture(plane.clone());
    let corner = plane.camera.pane_from_embedding(DVec2::new(1.0, 0.0), PANE_SIZE);
    let is_line = |x: f64, y: f64| {
        let [r, g, b] = pixel(&picture, corner.x + x, corner.y + y);
        b > 200 && r < 60 && g < 60
    };
    assert!(is_line(2.5, 0.0) && is_line(1.5, 1.5) && is_line(1.5, -1.5), "no gap");
    assert!(!is_line(6.0, 0.0) && !is_line(4.5, 4.5) && !is_line(4.5, -4.5), "no spike");
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn filled_faces_show_beside_the_mesh_and_under_it_mixed_with_what_is_behind() {
    // The sheet with its lower right corner moved to the middle, and two faces: one over the gap, one over the mesh.
    let mut frame = plane_frame(DVec2::new(0.0, -1.0) + 1e-3, &[]);
    let mut positions: Vec<DVec2> = sheet().0.iter().map(|p| p.truncate()).collect();
    positions[2] = DVec2::new(0.0, -1.0) + 1e-3;
    positions.push(DVec2::new(1.0, -1.0));
    frame.plane = Some(Arc::new(PlaneArrays::new(&positions, &frame.mesh.triangles)));
    let faces = Arc::new(DrawnFaces::new(vec![[id(1), id(9), id(5)], [id(3), id(4), id(7)]]));
    frame.fills.push(FillLayer { faces, colour: Srgb([0, 0, 255, 128]) });
    let picture = plane_picture(frame.clone());
    let [r, g, b] = plane_pixel(&picture, &frame, DVec2::new(0.7, -0.7));
    assert!(b > 240 && (120..220).contains(&r) && r.abs_diff(g) < 3, "half over the background: {r} {g} {b}");
    let [r, g, b] = plane_pixel(&picture, &frame, DVec2::new(-0.3, 0.2));
    assert!(g > 180 && r < 10 && b < 10, "hidden by the mesh: {r} {g} {b}");
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn the_picture_lies_in_its_box_upper_row_up() {
    let pixels = [[255, 0, 0, 255], [0, 0, 255, 255]].concat();
    let picture = ready(1, 2, pixels);
    let bounds = Bounds { low: DVec2::NEG_ONE, high: DVec2::ONE };
    let mut frame = plane_frame(DVec2::new(1.0, -1.0), &[]);
    frame.picture = Some(PictureLayer { picture, bounds, opacity: 1.0, sampling: Sampling::Smooth });
    frame.style.shading = FaceShading::Picture;
    let mut behind = frame.clone();
    behind.plane = None;
    for (what, frame) in [("faces", frame), ("background", behind)] {
        let picture = plane_picture(frame.clone());
        let upper = plane_pixel(&picture, &frame, DVec2::new(0.2, 0.8));
        let lower = plane_pixel(&picture, &frame, DVec2::new(0.2, -0.8));
        assert!(upper[0] > 240 && upper[2] < 20, "{what}, above: {upper:?}");
        assert!(lower[2] > 240 && lower[0] < 20, "{what}, below: {lower:?}");
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn a_picture_larger_than_the_card_takes_shows_all_the_same() {
    // Cards and drivers accept 8192 to 32768 pixels per side.
    let rows = 40_000_usize;
    let pixels = [[255_u8, 0, 0, 255].repeat(rows / 2), [0, 0, 255, 255].repeat(rows / 2)].concat();
    let picture = ready(1, 40_000, pixels);
    let bounds = Bounds { low: DVec2::NEG_ONE, high: DVec2::ONE };
    let mut frame = plane_frame(DVec2::new(1.0, -1.0), &[]);
    frame.picture = Some(PictureLayer { picture, bounds, opacity: 1.0, sampling: Sampling::Smooth });
    frame.style.shading = FaceShading::Picture;
    let picture = plane_picture(frame.clone());
    let [r, _, b] = plane_pixel(&picture, &frame, DVec2::new(0.2, 0.1));
    assert!(r > 240 && b < 20, "above: {r} {b}");
    let [r, _, b] = plane_pixel(&picture, &frame, DVec2::new(0.2, -0.1));
    assert!(b > 240 && r < 20, "below: {r} {b}");
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn a_detail_of_a_billionth_still_has_a_shape() {
    // The lower right corner moves within 2e-9 of vertex 5 at (1, 0), and the camera zooms there. A single f32 would
    // merge both points and draw the boundary as the straight line y = x − 1.
    let near = 2e-9;
    let mut frame = plane_frame(DVec2::new(1.0, -near), &[]);
    let corner = Bounds { low: DVec2::new(1.0 - near, -2.0 * near), high: DVec2::new(1.0 + near, 0.0) };
    frame.camera.frame(corner, PANE_SIZE);
    let picture = plane_picture(frame.clone());
    let [r, g, _] = plane_pixel(&picture, &frame, DVec2::new(1.0 - 0.25 * near, -0.75 * near));
    assert!(r < 10 && g > 180, "below that line, above the true boundary: {r} {g}");
    let [r, ..] = plane_pixel(&picture, &frame, DVec2::new(1.0 - 0.25 * near, -1.5 * near));
    assert!(r > 240, "outside: {r}");
}
