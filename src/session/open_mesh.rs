//! The open mesh, in one form or another.

use std::sync::Arc;

use super::{Model, Session};
use crate::mesh::{DiskMesh, Form};

/// The open mesh.
#[derive(Debug, Default)]
pub(super) struct OpenMesh {
    model: Option<Arc<Model>>,
    /// The same mesh in the form that was wanted before, or is wanted next.
    other: Option<Arc<Model>>,
    /// Counts the meshes opened, and their changes of form.
    revision: u64,
}

impl OpenMesh {
    pub(super) fn open(&mut self, model: Model) {
        *self = Self { model: Some(Arc::new(model)), other: None, revision: self.revision + 1 };
    }

    /// Takes in the mesh in another form, for [`change_form`](Self::change_form).
    pub(super) fn take_other(&mut self, model: Model) {
        self.other = Some(Arc::new(model));
    }

    /// Shows the mesh in another form. Returns whether it was there to be shown.
    pub(super) fn change_form(&mut self, form: Form) -> bool {
        let Some(other) = self.other.take_if(|other| other.form == form) else { return false };
        self.other = self.model.replace(other);
        self.revision += 1;
        true
    }
}

impl Session {
    /// The open mesh.
    pub fn model(&self) -> Option<&Arc<Model>> {
        self.mesh.model.as_ref()
    }

    /// Changes whenever another mesh is open, or the same one in another form.
    pub fn model_revision(&self) -> u64 {
        self.mesh.revision
    }

    /// The open mesh, where it is a disk.
    pub(super) fn disk(&self) -> Option<&Arc<DiskMesh>> {
        self.model()?.disk()
    }

    /// How many vertices the open mesh has; none where nothing is open.
    pub(super) fn vertex_count(&self) -> usize {
        self.model().map_or(0, |model| model.vertex_count())
    }

    /// Whether the mesh has the form that the document wants. Where nothing is open, there is none.
    pub(super) fn has_form_as_wanted(&self) -> bool {
        self.model().is_none_or(|model| model.form == self.document.form)
    }
}
