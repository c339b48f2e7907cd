//! Turntable camera of the 3D pane. The camera circles a pivot, and up stays up.
//!
//! All computations are in f64 and world units, whatever the size of the mesh. The product with the unit frame is
//! rounded last.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DMat4, DVec2, DVec3, DVec4, Mat4};

use super::Sphere;

/// Field of view across the narrower side of the pane, radians: about 35°, like a portrait lens. A pane that becomes
/// narrower shows the same, smaller.
const FIELD_OF_VIEW: f64 = 0.61;
/// Margin around a framed sphere, as a factor of its distance.
const FRAME_MARGIN: f64 = 1.04;
/// Radians per point of an orbit drag: half a turn in about 450 points.
const ORBIT_RATE: f64 = 0.007;
/// Least and greatest distance to the pivot, in radii of the scene.
const DISTANCE_LIMITS: [f64; 2] = [1e-5, 1e3];
/// Distance of the near plane when the eye is inside the scene, relative to the distance to the pivot.
const NEAR_SHARE: f64 = 1e-3;
/// Yaw and pitch of the first view relative to a frontal one, radians, so that depth shows.
const FIRST_TURN: DVec2 = DVec2::new(0.35, 0.2);

/// Least length of the mean normal of a surface that faces a side. A head with an open neck has about 0.1.
const LEAST_FACING: f64 = 0.05;
/// Length of the mean normal above which a surface counts as flat rather than round: a hemisphere has 0.5.
const NEARLY_FLAT: f64 = 0.6;
/// Largest pitch of the first view of a flat surface, radians: a surface that faces straight up is seen at a slant.
const STEEPEST_FIRST_PITCH: f64 = 1.0;
/// Largest pitch of the first view of a round surface, radians: a bust that is open below is not seen from above.
const ROUND_FIRST_PITCH: f64 = 0.4;

/// World axis that points up on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UpAxis {
    /// Up in most models of characters and scans.
    #[default]
    Y,
    /// Up in terrain, engineering and Blender.
    Z,
}

/// Half-line in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start of the ray.
    pub origin: DVec3,
    /// Direction of length 1.
    pub direction: DVec3,
}

impl Ray {
    /// Returns the point at a distance from the origin.
    pub fn at(self, distance: f64) -> DVec3 {
        self.origin + distance * self.direction
    }
}

/// Turntable camera about a pivot. Sizes and pointers are in points of the pane, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitCamera {
    pivot: DVec3,
    distance: f64,
    yaw: f64,
    pitch: f64,
    up_axis: UpAxis,
    scene: Sphere,
}

impl OrbitCamera {
    /// Camera that shows the whole sphere from the front, turned a little.
    pub fn framing(scene: Sphere, up_axis: UpAxis) -> Self {
        let mut camera = Self {
            pivot: scene.center,
            distance: scene.radius,
            yaw: FIRST_TURN.x,
            pitch: FIRST_TURN.y,
            up_axis,
            scene,
        };
        camera.frame(scene);
        camera
    }

    /// Camera that shows the sphere from the side that the surface faces, turned a little, never from below.
    ///
    /// `mean_normal` is [`MeshArrays::mean_normal`](super::MeshArrays::mean_normal). If it is short, the surface
    /// faces no side and the view is frontal.
    pub fn facing(scene: Sphere, up_axis: UpAxis, mean_normal: DVec3) -> Self {
        let mut camera = Self::framing(scene, up_axis);
        let back = camera.turntable_from_world(mean_normal);
        if back.length() > LEAST_FACING {
            let across = back.x.hypot(back.z);
            // Near the pole the direction around it is undefined.
            if across > 0.1 {
                camera.yaw += back.x.atan2(back.z);
            }
            let steepest = if back.length() > NEARLY_FLAT { STEEPEST_FIRST_PITCH } else { ROUND_FIRST_PITCH };
            camera.pitch = (back.y.atan2(across) + FIRST_TURN.y).clamp(0.0, steepest);
        }
        camera
    }

    /// Orbits about the pivot by a drag in points.
    pub fn orbit(&mut self, drag_in_points: DVec2) {
        self.yaw = (self.yaw - ORBIT_RATE * drag_in_points.x).rem_euclid(TAU);
        self.pitch = (self.pitch + ORBIT_RATE * drag_in_points.y).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// Pans such that points at the pivot's depth follow a drag in points.
    pub fn pan(&mut self, drag_in_points: DVec2, pane_size: DVec2) {
        // World units per point.
        let scale = 2.0 * self.distance * half_height(pane_size) / pane_size.y.max(1.0);
        let [right, up, _] = self.axes();
        self.pivot += scale * (drag_in_points.y * up - drag_in_points.x * right);
    }

    /// Zooms in (`factor` < 1) or out such that `anchor` keeps its position on the screen.
    ///
    /// The best anchor is the surface point under the pointer, otherwise [`Self::point_at_pivot_depth`].
    pub fn zoom_about(&mut self, anchor: DVec3, factor: f64) {
        if !(factor.is_finite() && factor > 0.0) {
            return;
        }
        let wanted = self.within_limits(self.distance * factor);
        let factor = wanted / self.distance;
        self.pivot = anchor + factor * (self.pivot - anchor);
        self.distance = wanted;
    }

    /// Returns the point under the pointer at the depth of the pivot.
    pub fn point_at_pivot_depth(&self, pointer: DVec2, pane_size: DVec2) -> DVec3 {
        let ray = self.ray(pointer, pane_size);
        let [_, _, back] = self.axes();
        ray.at(self.distance / -ray.direction.dot(back))
    }

    /// Sets the pivot and moves it to the middle of the pane.
    pub fn set_pivot(&mut self, pivot: DVec3) {
        let [_, _, back] = self.axes();
        self.distance = self.within_limits((self.eye() - pivot).dot(back));
        self.pivot = pivot;
    }

    /// Shows a whole sphere in a pane of any size, keeping the viewing direction.
    pub fn frame(&mut self, ball: Sphere) {
        self.pivot = ball.center;
        self.distance = self.within_limits(FRAME_MARGIN * ball.radius / (FIELD_OF_VIEW / 2.0).sin());
    }

    /// Pivot x, y, z and distance, world units; yaw about the vertical y axis and pitch above the horizon, radians.
    pub fn numbers(&self) -> [f64; 6] {
        let view_from_world = self.view_from_world();
        let [right, up, back] = [0, 1, 2].map(|axis| view_from_world.row(axis));
        // Computed from the axes: the eye does not determine the yaw if it is right above the pivot.
        let (yaw, pitch) = ((-right.z).atan2(right.x), back.y.atan2(up.y));
        [self.pivot.x, self.pivot.y, self.pivot.z, self.distance, yaw, pitch]
    }

    /// Returns the camera with these [`numbers`](Self::numbers) on the same scene; `None` if they are not valid.
    pub fn with_numbers(&self, numbers: &[f64]) -> Option<Self> {
        let &[x, y, z, distance, yaw, pitch]: &[f64; 6] = numbers.try_into().ok()?;
        if !(numbers.iter().all(|number| number.is_finite()) && distance > 0.0) {
            return None;
        }
        let (yaw, pitch) = (yaw.rem_euclid(TAU), pitch.clamp(-FRAC_PI_2, FRAC_PI_2));
        let mut camera = Self { yaw, pitch, ..*self };
        let pivot = DVec3::new(x, y, z);
        camera.set_pivot(pivot);
        camera.zoom_about(pivot, distance / camera.distance);
        camera.eye().is_finite().then_some(camera)
    }

    /// Position of the eye.
    pub fn eye(&self) -> DVec3 {
        let [_, _, back] = self.axes();
        self.pivot + self.distance * back
    }

    /// Point that the camera orbits.
    pub fn pivot(&self) -> DVec3 {
        self.pivot
    }

    /// Distance between eye and pivot, world units.
    pub fn distance(&self) -> f64 {
        self.distance
    }

    /// Transform from the world to clip space, in f64.
    pub fn clip_from_world(&self, pane_size: DVec2) -> DMat4 {
        let [near, far] = self.depth_range();
        let field_of_view = 2.0 * half_height(pane_size).atan();
        let clip_from_view =
            glam::dcamera::rh::proj::directx::perspective(field_of_view, aspect_ratio(pane_size), near, far);
        clip_from_view * self.view_from_world()
    }

    /// Transform from unit space to clip space, in f32 for the GPU.
    pub fn clip_from_unit(&self, frame: Sphere, pane_size: DVec2) -> Mat4 {
        (self.clip_from_world(pane_size) * frame.world_from_unit()).as_mat4()
    }

    /// Transform from the world to view space: x right, y up, z towards the eye.
    pub fn view_from_world(&self) -> DMat4 {
        let [right, up, back] = self.axes();
        let rotation = DMat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), DVec4::W).transpose();
        rotation * DMat4::from_translation(-self.eye())
    }

    /// Ray from the eye through a point of the pane.
    pub fn ray(&self, pointer: DVec2, pane_size: DVec2) -> Ray {
        let [right, up, back] = self.axes();
        let across = half_height(pane_size);
        let clip = clip_from_pane(pointer, pane_size);
        let direction = across * (clip.x * aspect_ratio(pane_size) * right + clip.y * up) - back;
        Ray { origin: self.eye(), direction: direction / direction.length() }
    }

    /// Projects a world point into the pane; `None` behind the eye. The result may lie outside the pane.
    pub fn pane_from_world(&self, position_in_world: DVec3, pane_size: DVec2) -> Option<DVec2> {
        pane_from_clip(self.clip_from_world(pane_size) * position_in_world.extend(1.0), pane_size)
    }

    fn within_limits(&self, distance: f64) -> f64 {
        let [nearest, farthest] = DISTANCE_LIMITS.map(|limit| limit * self.scene.radius);
        distance.clamp(nearest, farthest)
    }

    /// Axes right, up and back (from the pivot to the eye), each of length 1.
    fn axes(&self) -> [DVec3; 3] {
        let (sin_yaw, cos_yaw) = self.yaw.sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch.sin_cos();
        let back = DVec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch);
        let right = DVec3::new(cos_yaw, 0.0, -sin_yaw);
        [right, back.cross(right), back].map(|axis| self.world_from_turntable(axis))
    }

    fn world_from_turntable(&self, v: DVec3) -> DVec3 {
        match self.up_axis {
            UpAxis::Y => v,
            UpAxis::Z => DVec3::new(v.x, -v.z, v.y),
        }
    }

    fn turntable_from_world(&self, v: DVec3) -> DVec3 {
        match self.up_axis {
            UpAxis::Y => v,
            UpAxis::Z => DVec3::new(v.x, v.z, -v.y),
        }
    }

    /// Distances of the near and far plane, tight around the scene.
    fn depth_range(&self) -> [f64; 2] {
        let to_center = self.eye().distance(self.scene.center);
        let reach = 1.01 * self.scene.radius;
        let far = to_center + reach;
        [(to_center - reach).max(NEAR_SHARE * self.distance), far.max(2.0 * self.distance)]
    }
}

/// Width over height; 1 for a pane without area.
fn aspect_ratio(pane_size: DVec2) -> f64 {
    let aspect = pane_size.x / pane_size.y;
    if aspect.is_finite() && aspect > 0.0 { aspect } else { 1.0 }
}

/// Half of the height that a pane shows at distance 1.
fn half_height(pane_size: DVec2) -> f64 {
    (FIELD_OF_VIEW / 2.0).tan() / aspect_ratio(pane_size).min(1.0)
}

fn clip_from_pane(point: DVec2, pane_size: DVec2) -> DVec2 {
    let share = point / pane_size.max(DVec2::ONE);
    DVec2::new(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y)
}

/// Point of the pane at a point in clip space; `None` behind the eye.
pub(super) fn pane_from_clip(clip: DVec4, pane_size: DVec2) -> Option<DVec2> {
    (clip.w > 0.0).then(|| DVec2::new(1.0 + clip.x / clip.w, 1.0 - clip.y / clip.w) / 2.0 * pane_size.max(DVec2::ONE))
}
