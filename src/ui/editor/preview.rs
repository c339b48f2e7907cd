//! What follows a pin that is dragged: the first solve's embedding, drawn at once. It is not repaired, and what is wrong
//! with it shows only once a verdict on this very embedding is there.

use std::sync::Arc;

use super::scene::PlaneScene;
use crate::solver::Verdict;
use crate::ui::Editor;
use crate::view::FacePaint;

/// The embedding that follows a drag, ready to be drawn.
#[derive(Debug)]
pub(in crate::ui) struct PreviewScene {
    /// The mesh, and the session's count of moves.
    key: (u64, u64),
    scene: Arc<PlaneScene>,
    /// The faces with those flipped that the verdict names; none where there is none yet.
    faces: Arc<FacePaint>,
    verdict: Option<Arc<Verdict>>,
}

impl Editor {
    /// What follows the pin that is dragged.
    pub(in crate::ui) fn preview_plane(&self) -> Option<&Arc<PlaneScene>> {
        self.preview.as_ref().map(|preview| &preview.scene)
    }

    /// The faces' flags on it.
    pub(in crate::ui) fn preview_paint(&self) -> Option<&Arc<FacePaint>> {
        self.preview.as_ref().map(|preview| &preview.faces)
    }

    /// The verdict on what is on the screen, where there is one.
    pub(in crate::ui) fn shown_verdict(&self) -> Option<&Verdict> {
        match &self.preview {
            Some(preview) => preview.verdict.as_deref(),
            None => self.plane_scene.as_ref().map(|scene| &scene.outcome.step.verdict),
        }
    }

    /// Makes what is drawn where the session's preview has moved on. Call once per frame.
    pub(super) fn refresh_preview(&mut self) {
        let (Some(preview), Some(base), Some(mesh)) = (self.session.preview(), &self.plane_scene, &self.mesh_scene)
        else {
            self.preview = None;
            return;
        };
        // What follows the pointer is of the mesh as given, whatever the step on the screen is of.
        let triangles = mesh.mesh();
        if preview.embedding.len() != triangles.vertex_count() {
            self.preview = None;
            return;
        }
        let key = (mesh.model_revision, preview.revision);
        let verdict = preview.verdict().cloned();
        let before = self.preview.take().filter(|before| before.key.0 == key.0);
        let scene = match &before {
            Some(before) if before.key == key => Arc::clone(&before.scene),
            Some(before) if before.scene.outcome_revision == base.outcome_revision => {
                Arc::new(before.scene.with_positions(mesh, preview.embedding.to_vec()))
            }
            _ => Arc::new(base.with_positions(mesh, preview.embedding.to_vec())),
        };
        let same_faces = |before: &&PreviewScene| match (&before.verdict, &verdict) {
            (None, None) => true,
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            _ => false,
        };
        let faces = before.as_ref().filter(same_faces).map_or_else(
            || {
                let flipped = verdict.as_ref().map_or(&[] as &[_], |verdict| &verdict.flipped_faces);
                Arc::new(FacePaint::plain(triangles.face_count(), flipped))
            },
            |before| Arc::clone(&before.faces),
        );
        self.preview = Some(PreviewScene { key, scene, faces, verdict });
    }
}
