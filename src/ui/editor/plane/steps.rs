//! Two steps: the way from one to the next, and the outline of the compared one over the one on the screen.
//!
//! The way is shown: vertices glide to their new places when another step of a run is put on the
//! screen. Connectivity never changes, so only positions are interpolated. Both panes draw from the same arrays.
//!
//! Where nobody has moved the camera since the window framed the embedding, it goes along with an embedding that would
//! leave the pane, or become small in it. A pin that is dragged has the plane stand still under it.

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec2;

use super::{PlaneView, Surroundings};
use crate::mesh::VertexId;
use crate::render::{GhostLayer, LineLayer};
use crate::session::{Outcome, Session};
use crate::solver::Embedding;
use crate::ui::Theme;
use crate::ui::editor::scene::PlaneScene;
use crate::view::{EdgeList, PlaneArrays, PlaneCamera};

/// How long the way takes, seconds.
const SECONDS: f64 = 0.25;

/// What making the arrays of one frame may take. Where it takes longer, 60 frames a second are out of reach, and the mesh
/// is shown without a way between its steps.
const BUDGET: Duration = Duration::from_millis(6);

/// An embedding that could be shown so many times as large is small in its pane.
const SMALL: f64 = 2.0;

/// The way between two steps, while it is shown.
#[derive(Debug)]
pub(super) struct Way {
    from: Embedding,
    /// Seconds of the window's clock.
    began: f64,
    /// What is drawn in this frame.
    pub(super) drawn: Arc<PlaneScene>,
    /// From where and to where the camera goes.
    cameras: Option<[PlaneCamera; 2]>,
}

/// The boundary of the compared step, ready to be drawn over the one on the screen.
#[derive(Debug)]
pub(super) struct Ghost {
    /// The revision of the outcome on the screen, and the compared step.
    key: (u64, usize),
    /// The boundary's vertices only, in the unit space of the outcome on the screen.
    arrays: Arc<PlaneArrays>,
    edges: Arc<EdgeList>,
}

impl PlaneView {
    pub fn is_easing(&self) -> bool {
        self.way.is_some()
    }

    /// Puts another step on the screen: from where vertices are drawn now, if it is one of the same run.
    pub(super) fn take(&mut self, target: Arc<PlaneScene>, around: Surroundings) {
        let before = self.result().cloned();
        self.scene = Some(Arc::clone(&target));
        self.way = None;
        let Some(before) = before else { return };
        let (from, to) = (&before.outcome, &target.outcome);
        let is_other_step = before.outcome_revision != target.outcome_revision;
        let is_same_run = from.problem.settings == to.problem.settings
            && from.problem.targets == to.problem.targets
            && from.step.index != to.step.index;
        let is_same_mesh = Arc::ptr_eq(&before.mesh, &target.mesh);
        let is_too_large = self.too_large == Some(target.mesh.model_revision);
        let cameras = self.camera_along(&target, around);
        if around.glides && is_other_step && is_same_run && is_same_mesh && !is_too_large {
            let from = before.positions().clone();
            self.way = Some(Way { from, began: around.host.now(), drawn: target, cameras });
        } else if let Some([_, goal]) = cameras.filter(|_| is_other_step && from.problem.targets == to.problem.targets)
        {
            self.set_framed(goal);
        }
    }

    /// The camera now, and the one that shows all of an embedding: where that is wanted.
    fn camera_along(&self, target: &PlaneScene, around: Surroundings) -> Option<[PlaneCamera; 2]> {
        let stays = self.hull_shown() || around.is_dragging;
        let now = self.pane.camera().filter(|_| self.is_framed() && !stays)?;
        let bounds = around.framed_box(target.arrays.bounds);
        let mut goal = now;
        goal.frame(bounds, self.pane.size());
        let is_small = goal.points_per_unit() > SMALL * now.points_per_unit();
        (!self.shows(now, bounds) || is_small).then_some([now, goal])
    }

    /// Moves vertices on. Call once per frame.
    pub(super) fn go_on_easing(&mut self, around: Surroundings) {
        let Some(way) = &mut self.way else { return };
        let share = (around.host.now() - way.began) / SECONDS;
        let Some(target) = &self.scene else {
            self.way = None;
            return;
        };
        if !around.glides || !(0.0..1.0).contains(&share) {
            self.finish_ease();
            return;
        }
        let start = Instant::now();
        // Slow at both ends.
        let eased = share * share * (3.0 - 2.0 * share);
        let positions = way.from.iter().zip(target.positions()).map(|(a, b)| a.lerp(*b, eased)).collect();
        way.drawn = Arc::new(target.with_positions(&target.mesh, positions));
        if way.cameras.is_some() && self.pane.camera() != self.framed {
            // Somebody has taken the camera.
            way.cameras = None;
        }
        if let Some([from, to]) = &way.cameras {
            let camera = from.toward(to, eased);
            self.pane.set_camera(camera);
            self.framed = Some(camera);
        }
        if start.elapsed() > BUDGET {
            self.too_large = Some(target.mesh.model_revision);
            self.finish_ease();
        }
        around.host.context().request_repaint();
    }

    /// Puts everything where it was going.
    fn finish_ease(&mut self) {
        let way = self.way.take();
        if let Some([_, goal]) = way.and_then(|way| way.cameras).filter(|_| self.is_framed()) {
            self.set_framed(goal);
        }
    }

    /// The outline, as the pane draws it.
    pub(in crate::ui) fn ghost_layer(&self, theme: &Theme) -> Option<GhostLayer> {
        let ghost = self.ghost.as_ref()?;
        let line = LineLayer { edges: Arc::clone(&ghost.edges), colour: theme.ghost, width_in_points: 2.0 };
        Some(GhostLayer { plane: Arc::clone(&ghost.arrays), line })
    }

    /// The step whose outline shows.
    pub fn ghost_step(&self) -> Option<usize> {
        self.ghost.as_ref().map(|ghost| ghost.key.1)
    }

    /// The step that moves are measured from: the compared one, or else the one before, as far as it is kept.
    pub fn moved_from<'a>(&self, session: &'a Session) -> Option<&'a Arc<Outcome>> {
        let timeline = session.timeline();
        let shown = self.scene.as_ref()?.outcome.step.index;
        let compared = timeline.compared().filter(|&compared| compared != shown);
        timeline.outcome(compared.or_else(|| shown.checked_sub(1))?)
    }

    /// Makes the outline of the compared step where another one is wanted. Call once per frame.
    pub(super) fn refresh_ghost(&mut self, session: &Session) {
        let before = self.ghost.take();
        let (Some(plane), Some(step)) = (&self.scene, session.timeline().compared()) else { return };
        let key = (plane.outcome_revision, step);
        self.ghost = before.filter(|ghost| ghost.key == key).or_else(|| {
            let other = session.compared().filter(|_| step != plane.outcome.step.index)?;
            let embedding = &other.step.solution.embedding;
            let loop_of_other = other.step.mesh(plane.mesh.model.disk()?).boundary_loop();
            let position_of = |v: &VertexId| embedding.get(v.index()).copied().unwrap_or(DVec2::NAN);
            let boundary: Vec<DVec2> = loop_of_other.iter().map(position_of).collect();
            let vertices: Vec<VertexId> = (0..boundary.len()).map(VertexId::from_index).collect();
            let arrays = Arc::new(PlaneArrays::in_frame(&boundary, &[], plane.arrays.frame));
            Some(Ghost { key, arrays, edges: Arc::new(EdgeList::closed_loop(&vertices)) })
        });
    }
}
