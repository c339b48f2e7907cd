//! The way from one step to the next, shown: vertices glide to their new places when another step of a run is put on the
//! screen. Connectivity never changes, so only positions are interpolated. Both panes draw from the same arrays.

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec2;

use super::Editor;
use super::scene::PlaneScene;

/// How long the way takes, seconds.
const SECONDS: f64 = 0.25;

/// What making the arrays of one frame may take. Where it takes longer, 60 frames a second are out of reach, and the mesh
/// is shown without a way between its steps.
const BUDGET: Duration = Duration::from_millis(6);

/// The ease between steps as the window has it.
#[derive(Debug)]
pub struct Ease {
    /// Whether there is one; off for those whom motion bothers.
    pub wanted: bool,
    under_way: Option<Way>,
    /// The mesh that is too large, by its revision.
    too_large: Option<u64>,
}

/// A way under way.
#[derive(Debug)]
struct Way {
    from: Vec<DVec2>,
    /// Seconds of the window's clock.
    began: f64,
    /// What is drawn in this frame.
    drawn: Arc<PlaneScene>,
}

impl Default for Ease {
    fn default() -> Self {
        Self { wanted: true, under_way: None, too_large: None }
    }
}

impl Editor {
    /// Whether vertices are on their way.
    pub fn is_easing(&self) -> bool {
        self.ease.under_way.is_some()
    }

    /// The embedding on the screen, or where vertices are on their way to it.
    pub fn result_plane(&self) -> Option<&Arc<PlaneScene>> {
        self.ease.under_way.as_ref().map(|way| &way.drawn).or(self.plane_scene.as_ref())
    }

    /// Puts another step on the screen: from where vertices are drawn now, if it is one of the same run.
    pub(super) fn take_plane_scene(&mut self, scene: PlaneScene) {
        let before = self.result_plane().cloned();
        self.plane_scene = Some(Arc::new(scene));
        self.ease.under_way = None;
        let (Some(before), Some(target)) = (before, self.plane_scene.clone()) else { return };
        let (from, to) = (&before.outcome, &target.outcome);
        let is_other_step = before.outcome_revision != target.outcome_revision;
        let is_same_run = from.settings == to.settings && from.pins == to.pins && from.step.index != to.step.index;
        let same_count = before.positions().len() == target.positions().len();
        let is_too_large = self.ease.too_large == Some(self.session.model_revision());
        if self.ease.wanted && is_other_step && is_same_run && same_count && !is_too_large {
            let began = self.context.input(|input| input.time);
            let from = before.positions().to_vec();
            self.ease.under_way = Some(Way { from, began, drawn: target });
        }
    }

    /// Moves vertices on. Call once per frame.
    pub(super) fn go_on_easing(&mut self) {
        let Some(way) = &mut self.ease.under_way else { return };
        let now = self.context.input(|input| input.time);
        let share = (now - way.began) / SECONDS;
        let (Some(target), Some(mesh)) = (&self.plane_scene, &self.mesh_scene) else {
            self.ease.under_way = None;
            return;
        };
        if !self.ease.wanted || !(0.0..1.0).contains(&share) {
            self.ease.under_way = None;
            return;
        }
        let start = Instant::now();
        // Slow at both ends.
        let eased = share * share * (3.0 - 2.0 * share);
        let positions = way.from.iter().zip(target.positions()).map(|(a, b)| a.lerp(*b, eased)).collect();
        way.drawn = Arc::new(target.with_positions(mesh.model.mesh(), positions));
        if start.elapsed() > BUDGET {
            self.ease.too_large = Some(mesh.model_revision);
            self.ease.under_way = None;
        }
        self.context.request_repaint();
    }
}
