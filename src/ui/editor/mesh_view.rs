//! State of the mesh pane: its place, its camera, and the scene of the mesh as given.

use std::sync::Arc;

use super::async_scene::AsyncScene;
use super::scene::MeshScene;
use crate::session::{JobFailure, Session, Wake};
use crate::ui::state::PaneView;
use crate::view::{OrbitCamera, Sphere, UpAxis};

#[derive(Debug)]
pub struct MeshView {
    /// Place and camera of the pane.
    pub pane: PaneView<OrbitCamera>,
    scene: Option<Arc<MeshScene>>,
    /// Background job that makes the scene. Key: revision of the mesh.
    job: AsyncScene<u64, MeshScene>,
}

impl MeshView {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { pane: PaneView::default(), scene: None, job: AsyncScene::new("mesh scene", wake) }
    }

    /// Scene of the mesh as given.
    pub(in crate::ui) fn scene(&self) -> Option<&Arc<MeshScene>> {
        self.scene.as_ref()
    }

    pub(super) fn is_making_scene(&self) -> bool {
        self.job.is_busy()
    }

    /// Failure to make the scene, returned once.
    pub(super) fn take_failure(&mut self) -> Option<JobFailure> {
        self.job.take_failure()
    }

    /// Frames a ball.
    pub(super) fn frame(&mut self, ball: Sphere) {
        let size = self.pane.size();
        if let Some(camera) = self.pane.camera_mut() {
            camera.frame(ball, size);
        }
    }

    /// Shows a finished scene, and starts a job if the session has another mesh. Returns true if there is a new
    /// scene.
    pub(super) fn poll(&mut self, session: &Session) -> bool {
        // Discard the scene of a mesh that is no longer open.
        let made = self.job.poll().filter(|(key, _)| *key == session.model_revision()).map(|(_, scene)| scene);
        let is_new = made.is_some();
        if let Some(scene) = made {
            if !self.scene.as_ref().is_some_and(|before| scene.is_of_same_mesh(before)) {
                // Show another mesh, or a mesh turned inside out, from its outside.
                self.pane.set_camera(OrbitCamera::facing(scene.sphere, UpAxis::Y, scene.arrays.mean_normal));
                self.frame(scene.sphere);
            }
            self.scene = Some(Arc::new(scene));
        }
        let revision = session.model_revision();
        let is_shown = self.scene.as_ref().is_some_and(|scene| scene.model_revision == revision);
        if let Some(model) = session.model().filter(|_| !is_shown) {
            let model = Arc::clone(model);
            self.job.make(revision, move |_| MeshScene::new(model, revision));
        }
        is_new
    }
}
