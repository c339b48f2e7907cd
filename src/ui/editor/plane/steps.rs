//! Transition from one step to the next, and outline of the compared step over the step on the screen.
//!
//! A transition moves vertices gradually to their new positions. It runs when another step of a run is put on the
//! screen, or when a dragged pin is dropped. Connectivity never changes, so only positions are interpolated. Both
//! panes draw from one set of arrays. The next step waits for the end of the transition.
//!
//! The camera follows an embedding that would leave the pane or become small in it, unless the user has moved the
//! camera since it was framed. While a pin is dragged, the camera stays fixed.

use std::sync::Arc;

use glam::DVec2;

use super::{PlaneView, Surroundings};
use crate::render::{GhostLayer, LineLayer};
use crate::session::Session;
use crate::ui::editor::scene::PlaneScene;
use crate::ui::theme::Theme;
use crate::view::{EdgeList, FacePaint, PlaneArrays, PlaneCamera};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Outcome;
use freebound_core::problem::Embedding;

/// Duration of a transition, seconds, unless steps are played faster.
pub(in crate::ui::editor) const SECONDS: f64 = 0.25;

/// Least number of frames of a transition. Fewer frames would stutter, so the embedding jumps instead.
const LEAST_FRAMES: f64 = 5.0;

/// An embedding is small in its pane if it could be shown larger by this factor.
const SMALL: f64 = 2.0;

/// Transition to another step. The step before stays the step on the screen until the end.
#[derive(Debug)]
pub(super) struct Way {
    from: Embedding,
    target: Arc<PlaneScene>,
    /// Start of the transition, seconds of the window's clock.
    began: f64,
    /// Duration of the transition, seconds.
    seconds: f64,
    /// Scene drawn in this frame.
    pub(super) drawn: Arc<PlaneScene>,
    /// Face colours, if the transition starts from a preview.
    pub(super) faces: Option<Arc<FacePaint>>,
    /// Cameras at the start and at the end.
    cameras: Option<[PlaneCamera; 2]>,
}

/// Boundary of the compared step, prepared for drawing over the step on the screen.
#[derive(Debug)]
pub(super) struct Ghost {
    /// Revision of the outcome on the screen, and index of the compared step.
    key: (u64, usize),
    /// Boundary vertices alone, in the unit space of the outcome on the screen.
    arrays: Arc<PlaneArrays>,
    edges: Arc<EdgeList>,
}

impl PlaneView {
    pub fn is_easing(&self) -> bool {
        self.way.is_some()
    }

    /// True if the drawn embedding is not the session's step, or a transition or dropped preview has not ended.
    pub fn is_moving(&self, session: &Session) -> bool {
        self.way.is_some() || self.is_behind(session) || (self.preview.is_some() && session.preview().is_none())
    }

    /// True if the session's step is not on this pane yet.
    pub(super) fn is_behind(&self, session: &Session) -> bool {
        let drawn = self.scene.as_ref().map(|scene| scene.outcome_revision);
        let wanted = session.outcome_revision();
        session.outcome().is_some() && drawn != Some(wanted) && !self.job.has_failed(&wanted)
    }

    /// Puts a step on the screen. Starts a transition from the drawn positions if the step belongs to the current
    /// run, or if a drag preview ends.
    pub(super) fn take(&mut self, target: Arc<PlaneScene>, around: Surroundings) {
        let before = self.result().cloned();
        // A preview of a pin that is still dragged stays.
        let left = if around.session.preview().is_some() { None } else { self.preview.take() };
        self.way = None;
        let Some(before) = before.filter(|_| self.preview.is_none()) else {
            self.scene = Some(target);
            return;
        };
        let (from, to) = (&before.outcome, &target.outcome);
        let has_same_targets = from.problem.targets == to.problem.targets;
        let is_other_step = before.outcome_revision != target.outcome_revision;
        let is_next = is_other_step
            && from.problem.settings == to.problem.settings
            && has_same_targets
            && from.step.index != to.step.index;
        let cameras = self.camera_along(&target, around).filter(|_| is_other_step && has_same_targets);
        let seconds = self.glide_to(&target, &before, around).filter(|_| is_next || left.is_some());
        if let Some(seconds) = seconds {
            let faces = left.map(|preview| preview.faces);
            let (from, drawn, began) = (before.positions().clone(), before, around.gpu.now());
            self.way = Some(Way { from, target, began, seconds, drawn, faces, cameras });
        } else {
            self.arrive(target, cameras);
        }
    }

    /// Duration of a transition between two scenes; `None` if there is none, as during a drag.
    fn glide_to(&self, target: &PlaneScene, before: &PlaneScene, around: Surroundings) -> Option<f64> {
        let is_same_mesh = Arc::ptr_eq(&before.mesh, &target.mesh);
        let shows_stage = self.hull_scene().is_some_and(|hull| hull.plane().is_some());
        let is_smooth = |seconds: &f64| around.gpu.frame_seconds() * LEAST_FRAMES <= *seconds;
        let follows_pin = around.session.preview().is_some();
        around.glide.filter(is_smooth).filter(|_| is_same_mesh && !shows_stage && !follows_pin)
    }

    /// Shows a step without transition, or at its end.
    fn arrive(&mut self, target: Arc<PlaneScene>, cameras: Option<[PlaneCamera; 2]>) {
        self.scene = Some(target);
        if let Some([_, goal]) = cameras.filter(|_| self.is_framed()) {
            self.set_framed(goal);
        }
    }

    /// Current camera, and the camera that frames an embedding, if a change is wanted.
    fn camera_along(&self, target: &PlaneScene, around: Surroundings) -> Option<[PlaneCamera; 2]> {
        let stays = self.hull_shown() || around.is_dragging;
        let now = self.pane.camera().filter(|_| self.is_framed() && !stays)?;
        let bounds = around.framed_box(target.arrays.bounds);
        let mut goal = now;
        goal.frame(bounds, self.pane.size());
        let is_small = goal.points_per_unit() > SMALL * now.points_per_unit();
        (!self.shows(now, bounds) || is_small).then_some([now, goal])
    }

    /// Advances the transition. Call once per frame.
    pub(super) fn go_on_easing(&mut self, around: Surroundings) {
        let Some(way) = &mut self.way else { return };
        let share = (around.gpu.now() - way.began) / way.seconds;
        let is_smooth = around.gpu.frame_seconds() * LEAST_FRAMES <= way.seconds;
        if around.glide.is_none() || !is_smooth || !(0.0..1.0).contains(&share) || around.session.preview().is_some() {
            self.finish_ease();
            return;
        }
        // Ease in and out.
        let eased = share * share * (3.0 - 2.0 * share);
        let positions =
            way.from.iter().zip(way.target.positions()).map(|(a, b)| a.lerp(*b, eased)).collect::<Embedding>();
        way.drawn = Arc::new(way.target.with_positions(&way.target.mesh, Arc::new(positions)));
        if way.cameras.is_some() && self.pane.camera() != self.framed {
            // The user has moved the camera.
            way.cameras = None;
        }
        if let Some([from, to]) = &way.cameras {
            let camera = from.toward(to, eased);
            self.pane.set_camera(camera);
            self.framed = Some(camera);
        }
        around.gpu.context().request_repaint();
    }

    /// Ends the transition at its target.
    fn finish_ease(&mut self) {
        if let Some(Way { target, cameras, .. }) = self.way.take() {
            self.arrive(target, cameras);
        }
    }

    /// Layer that draws the outline of the compared step.
    pub(in crate::ui) fn ghost_layer(&self, theme: &Theme) -> Option<GhostLayer> {
        let ghost = self.ghost.as_ref()?;
        let line = LineLayer { edges: Arc::clone(&ghost.edges), colour: theme.ghost, width_in_points: 2.0 };
        Some(GhostLayer { plane: Arc::clone(&ghost.arrays), line })
    }

    /// Index of the step whose outline shows.
    pub fn ghost_step(&self) -> Option<usize> {
        self.ghost.as_ref().map(|ghost| ghost.key.1)
    }

    /// Step that moves are measured from: the compared step, or else the step before, if it is kept.
    pub fn moved_from<'a>(&self, session: &'a Session) -> Option<&'a Arc<Outcome>> {
        let timeline = session.timeline();
        let shown = timeline.index_of(&self.scene.as_ref()?.outcome)?;
        let compared = timeline.compared().filter(|&compared| compared != shown);
        timeline.outcome(compared.or_else(|| shown.checked_sub(1))?)
    }

    /// Makes the outline of the compared step if it has changed. Call once per frame.
    pub(super) fn refresh_ghost(&mut self, session: &Session) {
        let before = self.ghost.take();
        let (Some(plane), Some(step)) = (&self.scene, session.timeline().compared()) else { return };
        let key = (plane.outcome_revision, step);
        self.ghost = before.filter(|ghost| ghost.key == key).or_else(|| {
            let other = session.compared().filter(|_| step != plane.outcome.step.index)?;
            let embedding = &other.step.candidate.solution.embedding;
            let loop_of_other = other.step.candidate.mesh(plane.mesh.model.disk()?).boundary_loop();
            let position_of = |v: &VertexId| embedding.get(v.index()).copied().unwrap_or(DVec2::NAN);
            let boundary: Vec<DVec2> = loop_of_other.iter().map(position_of).collect();
            let vertices: Vec<VertexId> = (0..boundary.len()).map(VertexId::from_index).collect();
            let arrays = Arc::new(PlaneArrays::in_frame(&boundary, &[], plane.arrays.frame));
            Some(Ghost { key, arrays, edges: Arc::new(EdgeList::closed_loop(&vertices)) })
        });
    }
}
