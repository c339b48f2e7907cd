//! Open mesh in its preparations.

use std::sync::Arc;

use super::Model;
use freebound_core::mesh::{Preparation, WeldDistance};

/// Number of vertices of the mesh within a distance of another vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    pub(super) distance: WeldDistance,
    /// `None` during the count, and if the count was stopped or failed.
    pub(super) count: Option<usize>,
}

/// Open mesh.
#[derive(Debug, Default)]
pub(super) struct OpenMesh {
    model: Option<Arc<Model>>,
    /// Mesh in the preparation before, or in the one wanted next; or another chart of it.
    other: Option<Arc<Model>>,
    /// Preparation that the user requested, while the mesh is prepared for the edit.
    wanted: Option<Preparation>,
    /// Last count of vertices near each other.
    near: Option<Near>,
    /// Number of meshes opened and of changes of their preparation.
    revision: u64,
}

impl OpenMesh {
    pub(super) fn open(&mut self, model: Model) {
        *self = Self { model: Some(Arc::new(model)), revision: self.revision + 1, ..Self::default() };
    }

    /// Preparation that the user requested, while the mesh is prepared for the edit.
    pub(super) fn wanted(&self) -> Option<&Preparation> {
        self.wanted.as_ref()
    }

    /// Sets or drops the requested preparation.
    pub(super) fn want(&mut self, form: Option<Preparation>) {
        self.wanted = form;
    }

    /// Reverses the faces of the requested preparation, if there is one.
    pub(super) fn turn_wanted(&mut self) {
        if let Some(form) = &mut self.wanted {
            form.faces_turned = !form.faces_turned;
        }
    }

    pub(super) fn near(&self) -> Option<Near> {
        self.near
    }

    /// Stores a count or its beginning.
    pub(super) fn take_near(&mut self, near: Near) {
        self.near = Some(near);
    }

    /// Stores the mesh in another preparation, for [`change`](Self::change).
    pub(super) fn take_other(&mut self, model: Arc<Model>) {
        self.other = Some(model);
    }

    /// Switches to the stored mesh with this preparation and chart. Returns the mesh before, or `None` if no such mesh
    /// is stored.
    pub(super) fn change(&mut self, form: &Preparation, chart: Option<usize>) -> Option<Arc<Model>> {
        let other = self.other.take_if(|other| other.prepared.form == *form && other.is_chart(chart))?;
        self.other = self.model.replace(other);
        self.revision += 1;
        self.other.clone()
    }

    /// Replaces the open mesh by one that knows more about it.
    pub(super) fn learn(&mut self, model: Arc<Model>) {
        self.model = Some(model);
    }

    /// The open mesh.
    pub(super) fn model(&self) -> Option<&Arc<Model>> {
        self.model.as_ref()
    }

    /// Number of meshes opened and of changes of their preparation.
    pub(super) fn revision(&self) -> u64 {
        self.revision
    }
}
