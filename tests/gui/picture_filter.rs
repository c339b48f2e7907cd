//! Minified pictures, alone and with faces. All tests need a driver.

use std::sync::Arc;

use freebound::render::{FaceShading, PictureLayer, PlaneFrame, Sampling, plane_pane};
use freebound::view::PictureQuad;
use freebound_core::geom;
use freebound_core::geom::Bounds;
use glam::DVec2;
use image::RgbaImage;

use crate::render::{PANE, RECT, Window, plane_frame};

/// Side of the picture, pixels: seven per pixel of the screen.
const SIDE: u32 = 1024;

/// Picture prepared for the graphics card.
pub(crate) fn ready(width: u32, height: u32, pixels: Vec<u8>) -> Arc<PictureQuad> {
    Arc::new(PictureQuad::new(Arc::new(geom::Picture { width, height, pixels })).expect("as many pixels"))
}

/// Alternating black and white pixels.
fn finest_checker() -> Arc<PictureQuad> {
    let colour = |i: u32| if (i % SIDE + i / SIDE).is_multiple_of(2) { [255; 4] } else { [0, 0, 0, 255] };
    ready(SIDE, SIDE, (0..SIDE * SIDE).flat_map(colour).collect())
}

fn drawn(frame: &PlaneFrame) -> RgbaImage {
    let frame = frame.clone();
    Window::new(move || plane_pane(PANE, RECT, frame.clone())).picture()
}

/// Least and greatest red of a square of pixels about a point of the plane.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place in a small picture")]
fn reds(picture: &RgbaImage, frame: &PlaneFrame, point: DVec2) -> [u8; 2] {
    let size = DVec2::new(RECT.width().into(), RECT.height().into());
    let middle = frame.camera.pane_from_embedding(point, size);
    let [x, y] = [middle.x + f64::from(RECT.min.x), middle.y + f64::from(RECT.min.y)].map(|place| place as u32);
    let around = (x - 12..x + 12).flat_map(|x| (y - 12..y + 12).map(move |y| (x, y)));
    let reds: Vec<u8> = around.map(|(x, y)| picture.get_pixel(x, y).0[0]).collect();
    [*reds.iter().min().unwrap(), *reds.iter().max().unwrap()]
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn a_picture_far_smaller_on_the_screen_shows_its_mean() {
    let bounds = Bounds { low: DVec2::NEG_ONE, high: DVec2::ONE };
    for sampling in [Sampling::Smooth, Sampling::Sharp] {
        let mut frame = plane_frame(DVec2::new(1.0, -1.0), &[]);
        frame.picture = Some(PictureLayer { picture: finest_checker(), bounds, opacity: 1.0, sampling });
        frame.style.shading = FaceShading::Picture;
        let mut behind = frame.clone();
        behind.plane = None;
        for (what, frame) in [("on faces", frame), ("behind them", behind)] {
            let [least, most] = reds(&drawn(&frame), &frame, DVec2::new(0.31, 0.33));
            assert!(least > 100 && most < 155, "{what}, {sampling:?}: {least} to {most}");
        }
    }
}

#[test]
#[ignore = "needs a Vulkan driver: apt install mesa-vulkan-drivers"]
fn faces_beside_the_picture_are_hatched() {
    let mut frame = plane_frame(DVec2::new(1.0, -1.0), &[]);
    let picture = ready(1, 1, vec![0, 0, 255, 255]);
    let spread = |frame: &PlaneFrame, point: DVec2| {
        let [least, most] = reds(&drawn(frame), frame, point);
        most - least
    };
    let beside = DVec2::new(-0.5, -0.35);
    assert_eq!(spread(&frame, beside), 0, "without a picture there is no outside");
    frame.picture = Some(PictureLayer { picture, bounds: Bounds::UNIT, opacity: 1.0, sampling: Sampling::Smooth });
    assert!(spread(&frame, beside) > 60);
    assert_eq!(spread(&frame, DVec2::new(0.5, 0.35)), 0, "on the picture");
}
