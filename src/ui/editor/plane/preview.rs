//! What follows a pin that is dragged: the first solve's embedding, drawn at once. It is not repaired, and what is wrong
//! with it shows only once a verdict on this very embedding is there.

use std::sync::Arc;

use super::{PlaneView, Surroundings};
use crate::solver::{Embedding, Verdict};
use crate::ui::editor::scene::PlaneScene;
use crate::view::FacePaint;

/// The embedding that follows a drag, ready to be drawn.
#[derive(Debug)]
pub(super) struct PreviewScene {
    /// The mesh, and the session's count of moves.
    key: (u64, u64),
    scene: Arc<PlaneScene>,
    /// The faces with those flipped that the verdict names; none where there is none yet.
    faces: Arc<FacePaint>,
    verdict: Option<Arc<Verdict>>,
}

impl PreviewScene {
    pub(super) fn scene(&self) -> &Arc<PlaneScene> {
        &self.scene
    }

    /// The verdict on this very embedding, once it is there.
    pub(super) fn verdict(&self) -> Option<&Verdict> {
        self.verdict.as_deref()
    }
}

impl PlaneView {
    pub(in crate::ui) fn shows_preview(&self) -> bool {
        self.preview.is_some()
    }

    /// The faces' flags on what follows a dragged pin.
    pub(in crate::ui) fn preview_paint(&self) -> Option<&Arc<FacePaint>> {
        self.preview.as_ref().map(|preview| &preview.faces)
    }

    /// Makes what is drawn where the session's preview has moved on. Call once per frame.
    pub(super) fn refresh_preview(&mut self, around: Surroundings) {
        let before = self.preview.take();
        let (Some(preview), Some(base), Some(mesh)) = (around.session.preview(), &self.scene, around.mesh) else {
            return;
        };
        // What follows the pointer is of the mesh as given, whatever the step on the screen is of.
        let triangles = mesh.mesh();
        if preview.embedding.len() != triangles.vertex_count() {
            return;
        }
        let key = (mesh.model_revision, preview.revision);
        let verdict = preview.verdict().cloned();
        let before = before.filter(|before| before.key.0 == key.0);
        let scene = match &before {
            Some(before) if before.key == key => Arc::clone(&before.scene),
            Some(before) if before.scene.outcome_revision == base.outcome_revision => {
                Arc::new(before.scene.with_positions(mesh, Embedding::clone(&preview.embedding)))
            }
            _ => Arc::new(base.with_positions(mesh, Embedding::clone(&preview.embedding))),
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
