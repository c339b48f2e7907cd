//! The open mesh, its faces one way around or the other.

use std::sync::Arc;

use super::{Model, Session};
use crate::mesh::DiskMesh;

/// The open mesh.
#[derive(Debug, Default)]
pub(super) struct OpenMesh {
    model: Option<Arc<Model>>,
    /// The same mesh with its faces the other way around, once somebody turned them.
    other_side: Option<Arc<Model>>,
    /// Counts the meshes opened and turned around.
    revision: u64,
}

impl OpenMesh {
    pub(super) fn open(&mut self, model: Model) {
        *self = Self { model: Some(Arc::new(model)), other_side: None, revision: self.revision + 1 };
    }

    /// Takes in the mesh with its faces turned around, for [`turn_over`](Self::turn_over).
    pub(super) fn take_other_side(&mut self, model: Model) {
        self.other_side = Some(Arc::new(model));
    }

    /// Turns the faces around. Returns whether the other side was there to be shown.
    pub(super) fn turn_over(&mut self) -> bool {
        let Some(other_side) = self.other_side.take() else { return false };
        self.other_side = self.model.replace(other_side);
        self.revision += 1;
        true
    }
}

impl Session {
    /// The open mesh.
    pub fn model(&self) -> Option<&Arc<Model>> {
        self.mesh.model.as_ref()
    }

    /// Changes whenever another mesh is open, or the same one with its faces turned around.
    pub fn model_revision(&self) -> u64 {
        self.mesh.revision
    }

    /// The open mesh, where it is a disk.
    pub(super) fn disk(&self) -> Option<&Arc<DiskMesh>> {
        self.model()?.disk()
    }

    /// How many vertices the open mesh has; none where nothing is open.
    pub(super) fn vertex_count(&self) -> usize {
        self.model().map_or(0, |model| model.mesh().vertex_count())
    }

    /// Whether the mesh has its faces as the document wants them. Where nothing is open, there is nothing to turn.
    pub(super) fn has_faces_as_wanted(&self) -> bool {
        self.model().is_none_or(|model| model.faces_turned == self.document.faces_turned)
    }
}
