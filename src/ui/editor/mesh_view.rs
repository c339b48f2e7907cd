//! State of the mesh pane: its place, its camera, and the scene of the mesh as given.

use std::sync::Arc;

use super::async_scene::AsyncScene;
use super::scene::MeshScene;
use crate::session::{JobFailure, Session, Wake};
use crate::ui::state::PaneView;
use crate::view::{EdgeList, OrbitCamera, Sphere, UpAxis};
use freebound_core::mesh::VertexId;

#[derive(Debug)]
pub struct MeshView {
    /// Place and camera of the pane.
    pub pane: PaneView<OrbitCamera>,
    scene: Option<Arc<MeshScene>>,
    /// Seams that the mesh is not cut along yet.
    seams_to_be: Option<FileEdges>,
    /// Edges that automatic seams avoid.
    kept_whole: Option<FileEdges>,
    /// Background job that makes the scene. Key: revision of the mesh.
    job: AsyncScene<u64, MeshScene>,
}

/// Edges of the file on the screen.
#[derive(Debug)]
struct FileEdges {
    /// Revision of the mesh on the screen.
    revision: u64,
    in_file: Vec<[VertexId; 2]>,
    on_screen: Arc<EdgeList>,
}

impl FileEdges {
    /// Updates `kept` to edges of the file, on a scene. Without one of them there is nothing to show.
    fn refresh(kept: &mut Option<Self>, scene: Option<&Arc<MeshScene>>, in_file: Option<Vec<[VertexId; 2]>>) {
        let Some((scene, in_file)) = scene.zip(in_file) else { return *kept = None };
        let revision = scene.model_revision;
        if kept.as_ref().is_some_and(|kept| kept.revision == revision && kept.in_file == in_file) {
            return;
        }
        let on_screen = |vertex: VertexId| scene.in_file.copies(vertex).next();
        let ends = in_file.iter().filter_map(|&[a, b]| Some([on_screen(a)?, on_screen(b)?]));
        let on_screen = Arc::new(EdgeList::new(ends.collect()));
        *kept = Some(Self { revision, in_file, on_screen });
    }
}

impl MeshView {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            pane: PaneView::default(),
            scene: None,
            seams_to_be: None,
            kept_whole: None,
            job: AsyncScene::new("mesh scene", wake),
        }
    }

    /// Scene of the mesh as given.
    pub(in crate::ui) fn scene(&self) -> Option<&Arc<MeshScene>> {
        self.scene.as_ref()
    }

    /// Seams that the mesh is not cut along yet, as edges of the scene.
    pub(in crate::ui) fn seams_to_be(&self) -> Option<&Arc<EdgeList>> {
        self.seams_to_be.as_ref().map(|edges| &edges.on_screen)
    }

    /// Edges of the scene that automatic seams avoid.
    pub(in crate::ui) fn kept_whole(&self) -> Option<&Arc<EdgeList>> {
        self.kept_whole.as_ref().map(|edges| &edges.on_screen)
    }

    /// Updates the lines over the mesh of the session.
    fn refresh_lines(&mut self, session: &Session) {
        let scene = self.scene.as_ref().filter(|scene| scene.model_revision == session.model_revision());
        let seams = session.with_paint();
        let avoided = seams.costs().iter().filter(|(_, cost)| **cost > 1.0);
        let avoided = Some(avoided.map(|(edge, _)| *edge).collect()).filter(|edges: &Vec<_>| !edges.is_empty());
        FileEdges::refresh(&mut self.seams_to_be, scene, session.seams_to_be());
        FileEdges::refresh(&mut self.kept_whole, scene, avoided);
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
        if let Some(camera) = self.pane.camera_mut() {
            camera.frame(ball);
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
        self.refresh_lines(session);
        let revision = session.model_revision();
        let is_shown = self.scene.as_ref().is_some_and(|scene| scene.model_revision == revision);
        if let Some(model) = session.model().filter(|_| !is_shown) {
            let model = Arc::clone(model);
            self.job.make(revision, move |_| MeshScene::new(model, revision));
        }
        is_new
    }
}
