//! State of the embedding pane: its place, its camera, and its drawn data.
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | camera, scene of the step on the screen, preview of a dragged pin |
//! | `steps.rs` | transition between two steps, outline of the compared step |
//! | `hull.rs` | hull and pockets of the virtual boundary |

mod hull;
mod steps;
#[cfg(test)]
mod tests;

use std::sync::Arc;

pub(in crate::ui) use hull::HullScene;
pub(super) use steps::SECONDS;

use eframe::egui;
use glam::DVec2;

use super::async_scene::AsyncScene;
use super::comparison::ComparisonView;
use super::gpu::Gpu;
use super::page::PageView;
use super::picture_box::picture_box;
use super::scene::{MeshScene, PlaneScene};
use crate::session::{JobFailure, Session, Wake};
use crate::ui::state::PaneView;
use crate::view::{FacePaint, PlaneCamera};
use freebound_core::geom::Bounds;
use freebound_core::problem::Embedding;
use freebound_core::verify::Verdict;
use hull::HullView;
use steps::{Ghost, Way};

#[derive(Debug)]
pub struct PlaneView {
    /// Place and camera of the pane.
    pub pane: PaneView<PlaneCamera>,
    /// Last camera that the window chose, not the user.
    framed: Option<PlaneCamera>,
    /// Camera saved with the document, until there is an embedding to show.
    saved: Option<Vec<f64>>,
    scene: Option<Arc<PlaneScene>>,
    /// Background job that makes the scene. Key: revision of the step.
    job: AsyncScene<u64, PlaneScene>,
    way: Option<Way>,
    preview: Option<PreviewScene>,
    hull: HullView,
    ghost: Option<Ghost>,
    /// All charts on the page, in place of the chart on the screen.
    pub page: PageView,
    /// Method comparison, which replaces all other contents of the pane.
    pub comparison: ComparisonView,
}

/// Preview of a dragged pin: the embedding of the first solve, drawn at once. The preview is not repaired. Its
/// defects show only once a verdict on this very embedding exists.
#[derive(Debug)]
struct PreviewScene {
    /// Revision of the mesh, and the session's count of moves.
    key: (u64, u64),
    scene: Arc<PlaneScene>,
    /// Embedding at the start of the drag, if the scene owns its vertices and moves them in place.
    begin: Option<Arc<Embedding>>,
    /// Face colours, with the flipped faces of the verdict marked; none before there is a verdict.
    faces: Arc<FacePaint>,
    verdict: Option<Arc<Verdict>>,
}

/// Greatest extent of a first map relative to its picture at which the window frames all of it.
const MOST_BEYOND_PICTURE: f64 = 1.6;

/// Inputs that the pane needs from the rest of the window, in each frame.
#[derive(Clone, Copy)]
pub(super) struct Surroundings<'a> {
    pub(super) session: &'a Session,
    pub(super) gpu: &'a Gpu,
    /// Scene of the mesh as given.
    pub(super) mesh: Option<&'a Arc<MeshScene>>,
    /// Duration of a transition between steps, seconds; `None` if transitions are off.
    pub(super) glide: Option<f64>,
    pub(super) is_dragging: bool,
}

impl Surroundings<'_> {
    /// Box that the window frames by default: the picture if there is one, else the embedding. Thus a picture stays
    /// in place while the embedding changes.
    fn framed_box(&self, embedding: Bounds) -> Bounds {
        let document = self.session.document();
        if document.picture.is_some() { picture_box(document) } else { embedding }
    }

    /// Box that the window frames at first and after a change of size: all of the map, unless it is much larger than
    /// its picture.
    fn first_box(&self, embedding: Bounds) -> Bounds {
        let framed = self.framed_box(embedding);
        let all = framed.union(embedding);
        if all.extent() <= MOST_BEYOND_PICTURE * framed.extent() { all } else { framed }
    }
}

impl PlaneView {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            pane: PaneView::default(),
            framed: None,
            saved: None,
            scene: None,
            job: AsyncScene::new("plane scene", wake),
            way: None,
            preview: None,
            hull: HullView::new(wake),
            ghost: None,
            page: PageView::new(wake),
            comparison: ComparisonView::new(wake),
        }
    }

    /// Place of the pane in the window, with one chart or with the page. `None` if the pane is hidden.
    pub(in crate::ui) fn rect(&self) -> Option<egui::Rect> {
        self.pane.rect().or(self.page.pane.rect())
    }

    /// Sets a camera that the window chose.
    pub(super) fn set_framed(&mut self, camera: PlaneCamera) {
        self.pane.set_camera(camera);
        self.framed = Some(camera);
    }

    /// True if the user has not moved the camera since the window chose it.
    pub(super) fn is_framed(&self) -> bool {
        self.framed.is_some() && self.pane.camera() == self.framed
    }

    /// True if a camera shows all of a box.
    fn shows(&self, camera: PlaneCamera, bounds: Bounds) -> bool {
        let seen = camera.visible(self.pane.size());
        seen.low.cmple(bounds.low).all() && seen.high.cmpge(bounds.high).all()
    }

    /// Frames a box.
    pub(super) fn frame(&mut self, bounds: Bounds) {
        let size = self.pane.size();
        if let Some(camera) = self.pane.camera_mut() {
            camera.frame(bounds, size);
        }
    }

    /// Moves the cameras along with a move of the whole content.
    pub(super) fn go_along(&mut self, by: DVec2) {
        let moved = |camera: PlaneCamera| camera.moved(by);
        self.framed = self.framed.map(moved);
        if let Some(camera) = self.pane.camera_mut() {
            *camera = moved(*camera);
        }
    }

    /// Numbers of the camera, or the saved ones while there is no embedding to show. `None` if the window chose the
    /// camera, because it will choose the camera again.
    pub(super) fn camera_numbers(&self) -> Option<Vec<f64>> {
        let chosen = || Some(self.pane.camera().filter(|_| !self.is_framed())?.numbers(self.pane.size()).to_vec());
        self.saved.clone().or_else(chosen)
    }

    pub(super) fn set_saved_camera(&mut self, numbers: Option<Vec<f64>>) {
        self.saved = numbers;
    }

    /// Scene of the step on the screen. During a transition, the step before it.
    pub fn scene(&self) -> Option<&Arc<PlaneScene>> {
        self.scene.as_ref()
    }

    /// Embedding on the screen: the preview, the transition, or the step.
    pub fn result(&self) -> Option<&Arc<PlaneScene>> {
        let preview = self.preview.as_ref().map(|preview| &preview.scene);
        preview.or(self.way.as_ref().map(|way| &way.drawn)).or(self.scene.as_ref())
    }

    /// Scene for drawing and picking: the embedding on the screen, or a stage of its virtual boundary.
    pub fn drawn(&self) -> Option<&Arc<PlaneScene>> {
        self.hull_scene().and_then(HullScene::plane).or(self.result())
    }

    /// Verdict on the drawn embedding, if there is one.
    pub(in crate::ui) fn verdict(&self) -> Option<&Verdict> {
        match (&self.preview, &self.way) {
            (Some(preview), _) => preview.verdict.as_deref(),
            (None, Some(_)) => None,
            (None, None) => self.scene.as_ref().map(|scene| &scene.outcome.step.verdict),
        }
    }
}

impl PlaneView {
    /// Drops the embedding of a mesh that no longer exists.
    pub(super) fn forget(&mut self) {
        (self.scene, self.way, self.preview) = (None, None, None);
        self.pane.forget_camera();
        self.job.cancel();
    }

    pub(super) fn is_making_scene(&self) -> bool {
        self.job.is_busy() || self.hull.is_making_scene() || self.comparison.is_making()
    }

    /// Failure to make drawn data, returned once.
    pub(super) fn take_failure(&mut self) -> Option<JobFailure> {
        self.job.take_failure().or_else(|| self.hull.take_failure()).or_else(|| self.comparison.take_failure())
    }

    /// Adopts finished background jobs, and starts jobs for missing data. Returns the scene if it is new on the
    /// screen. Call once per frame.
    pub(super) fn refresh(&mut self, around: Surroundings) -> Option<Arc<PlaneScene>> {
        let before = self.scene.clone();
        // First, so that a step that waited for the end of a transition continues in the same frame.
        self.go_on_easing(around);
        self.poll_scene(around);
        self.refresh_preview(around);
        self.poll_hull();
        self.refresh_ghost(around.session);
        self.comparison.refresh(around.session, around.mesh);
        let is_new = |scene: &Arc<PlaneScene>| before.as_ref().is_none_or(|before| !Arc::ptr_eq(before, scene));
        self.scene.clone().filter(is_new)
    }

    /// Puts the session's step on the screen, after the end of a running transition.
    fn poll_scene(&mut self, around: Surroundings) {
        if self.way.is_some() {
            return;
        }
        if let Some((_, scene)) = self.job.poll() {
            if self.pane.camera().is_none() {
                self.frame_first(&scene, around);
            }
            self.take(Arc::new(scene), around);
        }
        if self.job.is_busy() || self.way.is_some() {
            return;
        }
        let Surroundings { session, mesh, .. } = around;
        let revision = session.outcome_revision();
        let is_shown = self.scene.as_ref().is_some_and(|scene| scene.outcome_revision == revision);
        let given = mesh.filter(|mesh| mesh.model_revision == session.model_revision() && !is_shown);
        if let Some((given, outcome)) = given.zip(session.outcome()) {
            let (given, outcome) = (Arc::clone(given), Arc::clone(outcome));
            let before = self.scene.as_ref().map(|scene| Arc::clone(&scene.mesh));
            self.job.make(revision, move |_| {
                let mesh = MeshScene::of_step(&given, before, &outcome.step);
                PlaneScene::new(mesh, outcome, revision)
            });
        }
    }

    /// Frames the first embedding, or restores the camera saved with the document.
    fn frame_first(&mut self, scene: &PlaneScene, around: Surroundings) {
        let camera = PlaneCamera::framing(around.first_box(scene.arrays.bounds), self.pane.size());
        self.set_framed(camera);
        if let Some(saved) = self.saved.take().and_then(|numbers| camera.with_numbers(&numbers, self.pane.size())) {
            self.pane.set_camera(saved);
        }
    }

    /// Resizes the pane. Keeps the whole embedding in view, unless the user has moved the camera.
    pub(super) fn set_rect(&mut self, rect: egui::Rect, around: Surroundings) {
        if !self.pane.set_rect(rect) {
            return;
        }
        let plane = self.drawn().filter(|_| self.is_framed());
        let bounds = plane.map(|plane| around.first_box(plane.arrays.bounds));
        if let (Some(bounds), Some(mut camera)) = (bounds, self.pane.camera()) {
            camera.frame(bounds, self.pane.size());
            self.set_framed(camera);
        }
    }
}

impl PlaneView {
    /// True if the drawn embedding is a drag preview, or glides from one to its step.
    pub(in crate::ui) fn shows_preview(&self) -> bool {
        self.preview_paint().is_some()
    }

    /// Face colours of the drag preview, also while it glides to its step.
    pub(in crate::ui) fn preview_paint(&self) -> Option<&Arc<FacePaint>> {
        let left = || self.way.as_ref().and_then(|way| way.faces.as_ref());
        self.preview.as_ref().map(|preview| &preview.faces).or_else(left)
    }

    /// Ends the preview after its pin is dropped. The preview stays until the next step can be drawn. If no step
    /// follows, the step before returns.
    fn leave_preview(&mut self, around: Surroundings) {
        if self.preview.is_none() || self.is_behind(around.session) {
            return;
        }
        match self.scene.clone() {
            Some(scene) => self.take(scene, around),
            None => self.preview = None,
        }
    }

    /// Updates the preview to the session's preview. Call once per frame.
    fn refresh_preview(&mut self, around: Surroundings) {
        let Some(preview) = around.session.preview() else { return self.leave_preview(around) };
        let before = self.preview.take();
        let (Some(base), Some(mesh)) = (&self.scene, around.mesh) else { return };
        // A preview is of the mesh as given, even if the step on the screen has new vertices.
        let triangles = mesh.mesh();
        if preview.embedding.len() != triangles.vertex_count() {
            return;
        }
        let key = (mesh.model_revision, preview.revision);
        let verdict = preview.verdict().cloned();
        let mut before = before.filter(|before| before.key.0 == key.0);
        let begin = preview.moved().map(|moved| Arc::clone(moved.begin()));
        // A frame of a drag changes the session's embedding in place, so the scene needs a copy.
        let positions = || match begin {
            Some(_) => Arc::new(Embedding::clone(&preview.embedding)),
            None => Arc::clone(&preview.embedding),
        };
        let scene = match &mut before {
            Some(before) if before.key == key => Arc::clone(&before.scene),
            Some(before) if before.scene.outcome_revision == base.outcome_revision => {
                let is_of_drag =
                    |begin: &Arc<Embedding>| before.begin.as_ref().is_some_and(|own| Arc::ptr_eq(own, begin));
                match preview.moved().filter(|moved| is_of_drag(moved.begin())) {
                    Some(moved) => {
                        Arc::make_mut(&mut before.scene).move_vertices(moved.vertices(), &preview.embedding);
                        Arc::clone(&before.scene)
                    }
                    None => Arc::new(before.scene.with_positions(mesh, positions())),
                }
            }
            _ => Arc::new(base.with_positions(mesh, positions())),
        };
        let known = verdict.as_ref().map(Arc::as_ptr);
        let same = before.filter(|before| before.verdict.as_ref().map(Arc::as_ptr) == known);
        let anew = || {
            let flipped = verdict.as_ref().map_or(&[] as &[_], |verdict| &verdict.flipped_faces);
            Arc::new(FacePaint::plain(triangles.real_face_count(), flipped))
        };
        let faces = same.map_or_else(anew, |before| before.faces);
        self.preview = Some(PreviewScene { key, scene, begin, faces, verdict });
    }
}
