//! The open mesh, in one form or another.

use std::sync::Arc;

use super::Model;
use freebound_core::mesh::{Preparation, WeldDistance};

/// How many vertices of the mesh lie within a distance of another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    pub(super) distance: WeldDistance,
    /// None while they are counted, and where the count was stopped or failed.
    pub(super) count: Option<usize>,
}

/// The open mesh.
#[derive(Debug, Default)]
pub(super) struct OpenMesh {
    model: Option<Arc<Model>>,
    /// The same mesh in the form that was wanted before, or is wanted next; or another chart of it.
    other: Option<Arc<Model>>,
    /// The form that a person asked for, while the mesh is brought into it for an edit.
    wanted: Option<Preparation>,
    /// The vertices near each other that were to be counted last.
    near: Option<Near>,
    /// Counts the meshes opened, and their changes of form.
    revision: u64,
}

impl OpenMesh {
    pub(super) fn open(&mut self, model: Model) {
        *self = Self { model: Some(Arc::new(model)), revision: self.revision + 1, ..Self::default() };
    }

    /// The form that a person asked for, while the mesh is brought into it for an edit.
    pub(super) fn wanted(&self) -> Option<&Preparation> {
        self.wanted.as_ref()
    }

    /// Notes the form that a person asks for; or that none is asked for any more.
    pub(super) fn want(&mut self, form: Option<Preparation>) {
        self.wanted = form;
    }

    /// Turns the faces around of the form that is asked for, where one is.
    pub(super) fn turn_wanted(&mut self) {
        if let Some(form) = &mut self.wanted {
            form.faces_turned = !form.faces_turned;
        }
    }

    pub(super) fn near(&self) -> Option<Near> {
        self.near
    }

    /// Notes what is counted, or was.
    pub(super) fn take_near(&mut self, near: Near) {
        self.near = Some(near);
    }

    /// Takes in the mesh in another form, for [`change`](Self::change).
    pub(super) fn take_other(&mut self, model: Arc<Model>) {
        self.other = Some(model);
    }

    /// Shows the mesh in another form, or another chart of it. Returns the one that was there before; none where the one
    /// wanted is not at hand.
    pub(super) fn change(&mut self, form: &Preparation, chart: Option<usize>) -> Option<Arc<Model>> {
        let other = self.other.take_if(|other| other.prepared.form == *form && other.is_chart(chart))?;
        self.other = self.model.replace(other);
        self.revision += 1;
        self.other.clone()
    }

    /// The open mesh.
    pub(super) fn model(&self) -> Option<&Arc<Model>> {
        self.model.as_ref()
    }

    /// The count of the meshes opened, and of their changes of form.
    pub(super) fn revision(&self) -> u64 {
        self.revision
    }
}
