//! The way from one step to the next, shown: vertices glide to their new places when another step of a run is put on the
//! screen. Connectivity never changes, so only positions are interpolated. Both panes draw from the same arrays.
//!
//! Where nobody has moved the camera since the window framed the embedding, it goes along with an embedding that would
//! leave the pane, or become small in it. A pin that is dragged has the plane stand still under it.

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec2;

use super::scene::PlaneScene;
use crate::ui::Editor;
use crate::view::PlaneCamera;

/// How long the way takes, seconds.
const SECONDS: f64 = 0.25;

/// What making the arrays of one frame may take. Where it takes longer, 60 frames a second are out of reach, and the mesh
/// is shown without a way between its steps.
const BUDGET: Duration = Duration::from_millis(6);

/// An embedding that could be shown so many times as large is small in its pane.
const SMALL: f64 = 2.0;

/// The ease between steps as the window has it.
#[derive(Debug)]
pub struct Ease {
    /// Whether there is one; off for those whom motion bothers.
    pub wanted: bool,
    under_way: Option<Way>,
    /// The mesh that is too large, by its revision.
    too_large: Option<u64>,
    /// The camera as the window chose it by itself.
    framed: Option<PlaneCamera>,
}

/// A way under way.
#[derive(Debug)]
struct Way {
    from: Vec<DVec2>,
    /// Seconds of the window's clock.
    began: f64,
    /// What is drawn in this frame.
    drawn: Arc<PlaneScene>,
    /// From where and to where the camera goes.
    cameras: Option<[PlaneCamera; 2]>,
}

impl Default for Ease {
    fn default() -> Self {
        Self { wanted: true, under_way: None, too_large: None, framed: None }
    }
}

impl Editor {
    /// Whether vertices are on their way.
    pub fn is_easing(&self) -> bool {
        self.ease.under_way.is_some()
    }

    /// The embedding on the screen, or where vertices are on their way to it.
    pub fn result_plane(&self) -> Option<&Arc<PlaneScene>> {
        let easing = self.ease.under_way.as_ref().map(|way| &way.drawn);
        self.preview_plane().or(easing).or(self.plane_scene.as_ref())
    }

    /// Puts another step on the screen: from where vertices are drawn now, if it is one of the same run.
    pub(super) fn take_plane_scene(&mut self, scene: PlaneScene) {
        let before = self.result_plane().cloned();
        let count = scene.mesh.mesh().vertex_count();
        self.selection.keep_below(count);
        self.plane_scene = Some(Arc::new(scene));
        self.ease.under_way = None;
        let (Some(before), Some(target)) = (before, self.plane_scene.clone()) else { return };
        let (from, to) = (&before.outcome, &target.outcome);
        let is_other_step = before.outcome_revision != target.outcome_revision;
        let is_same_run = from.problem.settings == to.problem.settings
            && from.problem.targets == to.problem.targets
            && from.step.index != to.step.index;
        let is_same_mesh = Arc::ptr_eq(&before.mesh, &target.mesh);
        let is_too_large = self.ease.too_large == Some(self.session.model_revision());
        if self.ease.wanted && is_other_step && is_same_run && is_same_mesh && !is_too_large {
            let began = self.host.now();
            let from = before.positions().to_vec();
            let cameras = self.camera_along(&target);
            self.ease.under_way = Some(Way { from, began, drawn: target, cameras });
        } else if let Some([_, goal]) =
            self.camera_along(&target).filter(|_| is_other_step && from.problem.targets == to.problem.targets)
        {
            self.set_framed(goal);
        }
    }

    /// Takes a camera that the window chose by itself.
    pub(super) fn set_framed(&mut self, camera: PlaneCamera) {
        self.plane_camera = Some(camera);
        self.ease.framed = Some(camera);
    }

    /// Keeps the whole embedding in a pane whose size changes, where nobody chose another camera.
    pub(in crate::ui) fn keep_framed(&mut self) {
        let Some(plane) = self.drawn_plane().filter(|_| self.is_framed()) else { return };
        let bounds = self.framed_box(plane.arrays.bounds());
        if let Some(mut camera) = self.plane_camera {
            camera.frame(bounds, self.plane_pane_size);
            self.set_framed(camera);
        }
    }

    /// Whether nobody has moved the camera since the window chose it.
    pub(super) fn is_framed(&self) -> bool {
        self.plane_camera.is_some() && self.plane_camera == self.ease.framed
    }

    /// The camera now, and the one that shows all of an embedding: where that is wanted.
    fn camera_along(&self, target: &PlaneScene) -> Option<[PlaneCamera; 2]> {
        let now =
            self.plane_camera.filter(|_| self.is_framed() && !self.hull.shown && self.tools.dragged().is_none())?;
        let (bounds, seen) = (self.framed_box(target.arrays.bounds()), now.visible(self.plane_pane_size));
        let is_seen = seen.min.cmple(bounds.min).all() && seen.max.cmpge(bounds.max).all();
        let mut goal = now;
        goal.frame(bounds, self.plane_pane_size);
        let is_small = goal.points_per_unit() > SMALL * now.points_per_unit();
        (!is_seen || is_small).then_some([now, goal])
    }

    /// Moves vertices on. Call once per frame.
    pub(super) fn go_on_easing(&mut self) {
        let Some(way) = &mut self.ease.under_way else { return };
        let now = self.host.now();
        let share = (now - way.began) / SECONDS;
        let Some(target) = &self.plane_scene else {
            self.ease.under_way = None;
            return;
        };
        if !self.ease.wanted || !(0.0..1.0).contains(&share) {
            self.finish_ease();
            return;
        }
        let start = Instant::now();
        // Slow at both ends.
        let eased = share * share * (3.0 - 2.0 * share);
        let positions = way.from.iter().zip(target.positions()).map(|(a, b)| a.lerp(*b, eased)).collect();
        way.drawn = Arc::new(target.with_positions(&target.mesh, positions));
        if way.cameras.is_some() && self.plane_camera != self.ease.framed {
            // Somebody has taken the camera.
            way.cameras = None;
        }
        if let Some([from, to]) = &way.cameras {
            let camera = from.toward(to, eased);
            (self.plane_camera, self.ease.framed) = (Some(camera), Some(camera));
        }
        if start.elapsed() > BUDGET {
            self.ease.too_large = Some(target.mesh.model_revision);
            self.finish_ease();
        }
        self.host.context().request_repaint();
    }

    /// Puts everything where it was going.
    fn finish_ease(&mut self) {
        let way = self.ease.under_way.take();
        if let Some([_, goal]) = way.and_then(|way| way.cameras).filter(|_| self.is_framed()) {
            self.set_framed(goal);
        }
    }
}
