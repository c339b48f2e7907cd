//! Camera of the embedding's pane: shift and scale, without rotation. y points up in the plane, down in the pane.

use glam::DVec2;

use super::{UnitPlane, nice_step_at_least};
use freebound_core::geom::Bounds;

/// Share of a pane that a framed box fills.
const FRAME_SHARE: f64 = 0.9;
/// Least and greatest scale, relative to the scale that frames the whole box. The precision of f64 limits zooming
/// in.
const ZOOM_LIMITS: [f64; 2] = [1e-3, 1e12];
/// Least distance between grid lines, points.
const GRID_SPACING: f64 = 18.0;

/// Part of the embedding plane that a pane shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneCamera {
    center: DVec2,
    points_per_unit: f64,
    scale_limits: [f64; 2],
}

/// Lines of the background grid, spaced by 1, 2 or 5 times a power of ten.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridLines {
    /// Distance of minor lines, embedding units.
    pub step: f64,
    /// Number of minor steps per major line; major lines are at multiples of a power of ten.
    pub steps_per_major: u32,
}

impl PlaneCamera {
    /// Camera that shows a whole box in a pane of this size, in points.
    pub fn framing(bounds: Bounds, pane_size: DVec2) -> Self {
        let scale = frame_scale(bounds, pane_size);
        Self { center: bounds.middle(), points_per_unit: scale, scale_limits: ZOOM_LIMITS.map(|limit| limit * scale) }
    }

    /// Shows a whole box. The zoom limits of the scene stay.
    pub fn frame(&mut self, bounds: Bounds, pane_size: DVec2) {
        self.center = bounds.middle();
        self.points_per_unit = frame_scale(bounds, pane_size).clamp(self.scale_limits[0], self.scale_limits[1]);
    }

    /// Camera translated by a vector of the plane.
    #[must_use]
    pub fn moved(&self, by: DVec2) -> Self {
        Self { center: self.center + by, ..*self }
    }

    /// Camera of a similar plane that shows the same view: `size` times as large, with `origin` as this plane's
    /// origin.
    #[must_use]
    pub fn over_similar(&self, origin: DVec2, size: f64) -> Self {
        Self {
            center: origin + size * self.center,
            points_per_unit: self.points_per_unit / size,
            scale_limits: self.scale_limits.map(|limit| limit / size),
        }
    }

    /// Moves the plane along with a drag in points.
    pub fn pan(&mut self, drag_in_points: DVec2) {
        self.center -= drag_in_points * DVec2::new(1.0, -1.0) / self.points_per_unit;
    }

    /// Zooms in (`factor` > 1) or out such that the point under the pointer stays there.
    pub fn zoom_at(&mut self, pointer: DVec2, factor: f64, pane_size: DVec2) {
        if !(factor.is_finite() && factor > 0.0) {
            return;
        }
        let fixed = self.embedding_from_pane(pointer, pane_size);
        let wanted = (self.points_per_unit * factor).clamp(self.scale_limits[0], self.scale_limits[1]);
        self.center = fixed + (self.center - fixed) * (self.points_per_unit / wanted);
        self.points_per_unit = wanted;
    }

    /// Centre x and y, and the height that a pane of this size shows, embedding units.
    pub fn numbers(&self, pane_size: DVec2) -> [f64; 3] {
        [self.center.x, self.center.y, self.visible(pane_size).size().y]
    }

    /// Returns the camera with these [`numbers`](Self::numbers) and this camera's limits; `None` if they are not
    /// valid.
    pub fn with_numbers(&self, numbers: &[f64], pane_size: DVec2) -> Option<Self> {
        let &[x, y, height]: &[f64; 3] = numbers.try_into().ok()?;
        if !(numbers.iter().all(|number| number.is_finite()) && height > 0.0) {
            return None;
        }
        let mut camera = *self;
        camera.zoom_at(pane_size / 2.0, pane_size.y / height / self.points_per_unit, pane_size);
        Some(Self { center: DVec2::new(x, y), ..camera })
    }

    /// Camera between this one (`share` 0) and another (`share` 1).
    #[must_use]
    pub fn toward(&self, goal: &Self, share: f64) -> Self {
        let ratio = (goal.points_per_unit / self.points_per_unit).powf(share);
        Self {
            center: self.center.lerp(goal.center, share),
            points_per_unit: self.points_per_unit * ratio,
            scale_limits: goal.scale_limits,
        }
    }

    /// Point of the plane in the middle of the pane.
    pub fn center(&self) -> DVec2 {
        self.center
    }

    /// Points per embedding unit.
    pub fn points_per_unit(&self) -> f64 {
        self.points_per_unit
    }

    /// Point of the plane at a point of the pane.
    pub fn embedding_from_pane(&self, point_in_pane: DVec2, pane_size: DVec2) -> DVec2 {
        self.center + (point_in_pane - pane_size / 2.0) * DVec2::new(1.0, -1.0) / self.points_per_unit
    }

    /// Point of the pane at a point of the plane. The result may lie outside the pane.
    pub fn pane_from_embedding(&self, point: DVec2, pane_size: DVec2) -> DVec2 {
        (point - self.center) * DVec2::new(1.0, -1.0) * self.points_per_unit + pane_size / 2.0
    }

    /// Middle of the pane in an embedding's unit space, and clip units per unit of that space.
    pub fn unit_view(&self, frame: UnitPlane, pane_size: DVec2) -> (DVec2, DVec2) {
        let scale = 2.0 * self.points_per_unit * frame.embedding_per_unit / pane_size.max(DVec2::ONE);
        (frame.unit_from_embedding(self.center), scale)
    }

    /// Part of the plane that the pane shows.
    pub fn visible(&self, pane_size: DVec2) -> Bounds {
        let half = pane_size / 2.0 / self.points_per_unit;
        Bounds { low: self.center - half, high: self.center + half }
    }

    /// Background grid for the current scale.
    pub fn grid(&self) -> GridLines {
        let step = nice_step_at_least(GRID_SPACING / self.points_per_unit);
        let leading = step / 10_f64.powf(step.log10().floor());
        let steps_per_major = match leading {
            ..1.5 => 10,
            1.5..3.0 => 5,
            _ => 2,
        };
        GridLines { step, steps_per_major }
    }
}

fn frame_scale(bounds: Bounds, pane_size: DVec2) -> f64 {
    let extent = bounds.extent();
    // A side without length does not limit the scale.
    let size = bounds.size().max(DVec2::splat(extent * 1e-9));
    (FRAME_SHARE * pane_size.max(DVec2::ONE) / size).min_element().max(f64::MIN_POSITIVE)
}
