//! The editor's scenes: made in the background whenever mesh or embedding change.

use std::sync::Arc;

use super::scene::{MeshScene, PlaneScene};
use crate::session::{Job, Poll};
use crate::ui::Editor;
use crate::view::{OrbitCamera, PlaneCamera, UpAxis};

impl Editor {
    pub(super) fn poll_mesh_scene(&mut self) {
        let revision = self.session.model_revision();
        if let Some(job) = &self.mesh_scene_job {
            match job.poll() {
                Poll::Running => return,
                Poll::Lost => self.mesh_scene_job = None,
                Poll::Done(scene) => {
                    self.mesh_scene_job = None;
                    self.take_mesh_scene(scene);
                }
            }
        }
        let shown = self.mesh_scene.as_ref().map(|scene| scene.model_revision);
        if let Some(model) = self.session.model().filter(|_| shown != Some(revision)) {
            let model = Arc::clone(model);
            let work = move |_: &_| MeshScene::new(model, revision);
            self.mesh_scene_job = Job::spawn("mesh scene", self.host.waker(), work).ok();
        }
    }

    fn take_mesh_scene(&mut self, scene: MeshScene) {
        // Also where the same mesh is turned around: it is then shown from its new outside.
        self.orbit = Some(OrbitCamera::facing(scene.sphere, UpAxis::Y, scene.arrays.mean_normal()));
        if let Some(orbit) = &mut self.orbit {
            orbit.frame(scene.sphere, self.mesh_pane_size);
        }
        self.plane_camera = None;
        self.plane_scene = None;
        self.plane_scene_job = None;
        self.look.forget_paint();
        if self.opened.put_on_screen(&self.session) {
            self.selection.clear();
            self.put_on_view();
        }
        self.pointer.set_vertex(None);
        self.selection.set_defect(None);
        self.tools.end_drag();
        self.tools.set_pair(None);
        self.preview = None;
        self.mesh_scene = Some(Arc::new(scene));
    }

    pub(super) fn poll_plane_scene(&mut self) {
        if let Some((_, job)) = &self.plane_scene_job {
            match job.poll() {
                Poll::Running => return,
                Poll::Lost => self.plane_scene_job = None,
                Poll::Done(scene) => {
                    self.plane_scene_job = None;
                    if self.plane_camera.is_none() {
                        let bounds = self.framed_box(scene.arrays.bounds());
                        self.set_framed(PlaneCamera::framing(bounds, self.plane_pane_size));
                        self.put_on_plane_camera();
                    }
                    self.take_plane_scene(scene);
                }
            }
        }
        let revision = self.session.outcome_revision();
        let shown = self.plane_scene.as_ref().map(|scene| scene.outcome_revision);
        let Some(mesh_scene) = &self.mesh_scene else { return };
        if mesh_scene.model_revision != self.session.model_revision() || shown == Some(revision) {
            return;
        }
        let Some(outcome) = self.session.outcome() else { return };
        let (given, outcome) = (Arc::clone(mesh_scene), Arc::clone(outcome));
        let before = self.plane_scene.as_ref().map(|scene| Arc::clone(&scene.mesh));
        let work = move |_: &_| {
            let mesh = MeshScene::of_step(&given, before, &outcome.step);
            PlaneScene::new(mesh, outcome, revision)
        };
        let job = Job::spawn("plane scene", self.host.waker(), work);
        self.plane_scene_job = job.ok().map(|job| (revision, job));
    }

    pub(super) fn refresh_paint(&mut self) {
        let Some(mesh_scene) = &self.mesh_scene else { return };
        let base = self.moved_from().cloned();
        self.look.refresh_paint(mesh_scene, self.plane_scene.as_deref(), base.as_deref());
    }
}
