//! The open mesh, in one form or another.

use std::sync::Arc;

use super::{Model, Session};
use crate::mesh::{DiskMesh, Form, WeldDistance};

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
    wanted: Option<Form>,
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
    pub(super) fn wanted(&self) -> Option<&Form> {
        self.wanted.as_ref()
    }

    /// Notes the form that a person asks for; or that none is asked for any more.
    pub(super) fn want(&mut self, form: Option<Form>) {
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
    pub(super) fn change(&mut self, form: &Form, chart: Option<usize>) -> Option<Arc<Model>> {
        let other = self.other.take_if(|other| other.form == *form && other.is_chart(chart))?;
        self.other = self.model.replace(other);
        self.revision += 1;
        self.other.clone()
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

    /// Whether the chart on the screen is the one that the document wants.
    pub(super) fn has_chart_as_wanted(&self) -> bool {
        self.model().is_none_or(|model| model.is_chart(self.document.chart))
    }

    /// Whether the mesh has the form that the document wants, and is the chart that it wants. Where nothing is open,
    /// there is none.
    pub(super) fn has_form_as_wanted(&self) -> bool {
        self.has_numbers_as_wanted() && self.has_chart_as_wanted()
    }

    /// Whether the mesh has the form that the document wants, so that vertices and charts have the numbers that the document has
    /// for them, whichever chart is on the screen.
    pub(super) fn has_numbers_as_wanted(&self) -> bool {
        self.model().is_none_or(|model| model.form == self.document.form)
    }
}
