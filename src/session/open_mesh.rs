//! The open mesh, its faces one way around or the other.

use std::sync::Arc;

use super::Model;
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
    /// The mesh.
    pub(super) fn model(&self) -> Option<&Arc<Model>> {
        self.model.as_ref()
    }

    /// The disk, where it is one.
    pub(super) fn disk(&self) -> Option<&Arc<DiskMesh>> {
        self.model.as_ref()?.disk()
    }

    /// How many vertices it has; none where nothing is open.
    pub(super) fn vertex_count(&self) -> usize {
        self.model.as_ref().map_or(0, |model| model.mesh().vertex_count())
    }

    /// Changes whenever another mesh is open, or the same one with its faces turned around.
    pub(super) fn revision(&self) -> u64 {
        self.revision
    }

    /// Opens another mesh.
    pub(super) fn open(&mut self, model: Model) {
        *self = Self { model: Some(Arc::new(model)), other_side: None, revision: self.revision + 1 };
    }

    /// Whether its faces are turned around, or not, as is wanted. Where nothing is open, there is nothing to turn.
    pub(super) fn has_faces(&self, turned: bool) -> bool {
        self.model.as_ref().is_none_or(|model| model.faces_turned == turned)
    }

    /// Takes in the mesh with its faces turned around, for [`turn_over`](Self::turn_over).
    pub(super) fn take_other_side(&mut self, model: Arc<Model>) {
        self.other_side = Some(model);
    }

    /// Turns the faces around. Returns whether the other side was there to be shown.
    pub(super) fn turn_over(&mut self) -> bool {
        let Some(other_side) = self.other_side.take() else { return false };
        self.other_side = self.model.replace(other_side);
        self.revision += 1;
        true
    }
}
