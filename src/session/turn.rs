//! Turning the mesh's faces around. The document says which side is the outside; the mesh follows in the background.

use std::sync::Arc;

use super::errands::{Errand, Purpose};
use super::{Command, Model, Session};

impl Session {
    /// Turns the faces around, as an edit.
    pub(super) fn turn_faces(&mut self) {
        if self.model.is_some() {
            self.edit(vec![Command::SetFacesTurned(!self.document.faces_turned)]);
        }
    }

    /// Whether the mesh has its faces as the document wants them.
    pub(super) fn has_faces_as_wanted(&self) -> bool {
        self.model.as_ref().is_none_or(|model| model.faces_turned == self.document.faces_turned)
    }

    /// Brings the mesh's faces to where the document wants them. Where that takes time, a solve follows by itself.
    /// Returns whether they are there now.
    pub(super) fn bring_faces(&mut self) -> bool {
        if self.has_faces_as_wanted() {
            return true;
        }
        // What goes on is of no use any more.
        (self.running, self.resting, self.solve_again) = (None, None, false);
        if let Some(other_side) = self.other_side.take() {
            self.show_side(other_side);
            return true;
        }
        if let Some(model) = self.model.clone()
            && !self.errands.is_under_way(Purpose::Turn)
        {
            self.send(Purpose::Turn, move |_| Errand::Turned(Box::new(model.turned())));
        }
        false
    }

    /// Takes in the mesh with its faces turned around.
    pub(super) fn take_turned(&mut self, model: Arc<Model>) {
        self.other_side = Some(model);
        if !self.has_faces_as_wanted() {
            self.solve();
        }
    }

    fn show_side(&mut self, model: Arc<Model>) {
        self.other_side = self.model.replace(model);
        self.forget_steps();
    }
}
