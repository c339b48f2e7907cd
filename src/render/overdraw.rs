//! Overdraw of an embedding: pixels that its faces cover together. If many faces lie over each other in the pane, the
//! pane is drawn with fewer pixels, so that a folded embedding never blocks the window.

use eframe::wgpu;
use glam::DVec2;

use super::frame::PlaneFrame;
use super::uniforms::PaneSize;
use crate::view::PlaneArrays;
use freebound_core::geom::{Bounds, clip_polygon};

/// Most pixels that the faces of a pane may cover together at full resolution, beside twice those of the pane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MostCovered(f64);

impl MostCovered {
    /// A software renderer on two cores draws ten million pixels in a second.
    pub(super) fn of(device: wgpu::DeviceType) -> Self {
        Self(if device == wgpu::DeviceType::Cpu { 5e6 } else { 5e8 })
    }
}

/// Greatest factor by which the resolution is lowered.
const MOST_LOWERED: u32 = 32;

/// Most faces whose pixels are counted. Of larger embeddings, every so many faces stand for all.
const MOST_COUNTED: usize = 1 << 16;

/// Size of the picture of a pane, lowered if its faces cover too many pixels.
pub(super) fn affordable(frame: &PlaneFrame, size: PaneSize, MostCovered(most): MostCovered) -> PaneSize {
    let [width, height] = size.in_pixels.map(f64::from);
    let most = most + 2.0 * width * height;
    let scale = f64::from(size.pixels_per_point);
    let covered = |plane: &PlaneArrays| covered_pixels(plane, frame, DVec2::new(width, height), [scale, most]);
    let covered = frame.plane.as_ref().map_or(0.0, |plane| covered(plane));
    let mut factor = 1;
    while factor < MOST_LOWERED && covered > most * f64::from(factor * factor) {
        factor *= 2;
    }
    PaneSize {
        in_pixels: size.in_pixels.map(|side| side.div_ceil(factor)),
        #[expect(clippy::cast_precision_loss, reason = "at most 32")]
        pixels_per_point: size.pixels_per_point / factor as f32,
    }
}

/// Pixels of the pane that the faces cover, each pixel as often as faces lie over it. 0 if they are fewer than `most`
/// wherever the faces lie. `scale` is in pixels per point.
fn covered_pixels(plane: &PlaneArrays, frame: &PlaneFrame, size: DVec2, [scale, most]: [f64; 2]) -> f64 {
    let on_screen =
        |unit: DVec2| frame.camera.pane_from_embedding(plane.frame.embedding_from_unit(unit), size / scale) * scale;
    let origin = on_screen(DVec2::ZERO);
    let axes = [DVec2::X, DVec2::Y].map(|axis| on_screen(axis) - origin);
    if plane.area * axes[0].perp_dot(axes[1]).abs() <= most {
        return 0.0;
    }
    let point = |[x, y, low_x, low_y]: [f32; 4]| {
        let [x, y] = [f64::from(x) + f64::from(low_x), f64::from(y) + f64::from(low_y)];
        origin + axes[0] * x + axes[1] * y
    };
    let (faces, _) = plane.corners.as_chunks::<3>();
    let stride = faces.len().div_ceil(MOST_COUNTED).max(1);
    let counted: f64 = faces.iter().step_by(stride).map(|corners| area_inside(corners.map(point), size)).sum();
    counted * stride as f64
}

/// Area of a triangle inside a pane.
fn area_inside(corners: [DVec2; 3], size: DVec2) -> f64 {
    let [a, b, c] = corners;
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let is_apart = high.cmple(DVec2::ZERO).any() || low.cmpge(size).any() || !(low + high).is_finite();
    if is_apart {
        return 0.0;
    }
    if low.cmpge(DVec2::ZERO).all() && high.cmple(size).all() {
        return 0.5 * (b - a).perp_dot(c - a).abs();
    }
    let polygon = clip_polygon(&corners, Bounds { low: DVec2::ZERO, high: size });
    let Some(&first) = polygon.first() else { return 0.0 };
    0.5 * polygon.windows(2).map(|side| (side[0] - first).perp_dot(side[1] - first)).sum::<f64>().abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_part_of_a_triangle_inside_a_pane_counts() {
        let size = DVec2::new(8.0, 4.0);
        let area = |corners: [[f64; 2]; 3]| area_inside(corners.map(DVec2::from), size);
        let cases = [
            ([[1.0, 1.0], [3.0, 1.0], [1.0, 3.0]], 2.0),
            ([[-100.0, -100.0], [300.0, -100.0], [-100.0, 300.0]], 32.0),
            ([[-4.0, 0.0], [4.0, 0.0], [-4.0, 8.0]], 8.0),
            ([[9.0, 0.0], [12.0, 0.0], [9.0, 3.0]], 0.0),
            ([[f64::NAN, 0.0], [12.0, 0.0], [9.0, 3.0]], 0.0),
        ];
        for (corners, expected) in cases {
            assert!((area(corners) - expected).abs() < 1e-9, "{corners:?}: {} for {expected}", area(corners));
            let [a, b, c] = corners;
            assert!((area([a, c, b]) - expected).abs() < 1e-9, "either way round");
        }
    }
}
