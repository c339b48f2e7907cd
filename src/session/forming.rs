//! The form that the mesh is to have, and the chart of it that is to be on the screen.

use std::sync::Arc;

use super::errands::Errand;
use super::{Command, Session};
use crate::mesh::{Form, Seams};

/// The errand that brings the mesh into another form, or takes a chart out of it.
const FORMING: &str = "turning or mending the faces";

impl Session {
    /// Turns the faces around.
    pub(super) fn turn_faces(&mut self) {
        if self.model().is_some() {
            let form = self.document.form.clone();
            self.edit(vec![Command::SetForm(Form { faces_turned: !form.faces_turned, ..form })]);
        }
    }

    /// Mends the mesh as far as that can be done, and cuts it open.
    pub(super) fn mend(&mut self) {
        if self.model().is_some_and(|model| model.remedy.is_some()) {
            self.edit(vec![Command::SetForm(self.document.form.mended())]);
        }
    }

    /// Cuts the mesh along these seams, and no others.
    pub(super) fn set_seams(&mut self, seams: Seams) {
        if self.model().is_some() && seams != self.document.form.seams {
            self.edit(vec![Command::SetForm(Form { seams, ..self.document.form.clone() })]);
        }
    }

    /// The seams that the mesh is to be cut along.
    pub fn seams(&self) -> &Seams {
        &self.document.form.seams
    }

    /// Brings the mesh into the form, and to the chart, that the document wants. Where that takes time, a solve follows by
    /// itself. Returns whether it is there now.
    pub(super) fn bring_form(&mut self) -> bool {
        if self.has_form_as_wanted() {
            return true;
        }
        let Some(model) = self.model().cloned() else { return true };
        let (form, chart) = (self.document.form.clone(), self.document.chart);
        let wanted = model.chart.as_ref().filter(|_| model.form == form).map(|of| of.charts.pick(chart));
        if let Some(other) = wanted.and_then(|number| self.charts.model(number)) {
            self.mesh.take_other(Arc::clone(other));
        }
        if wanted.is_none() {
            // What goes on is of no use any more.
            self.solving.give_up_all();
        }
        if let Some(before) = self.mesh.change(&form, chart) {
            if let Some(number) = wanted {
                self.solving.forget_message(&mut self.messages);
                self.charts.exchange(&before, &mut self.solving, number);
                self.drag.end();
            } else {
                self.charts.forget();
                self.forget_steps();
            }
            self.messages.forget_mesh();
            self.tell_faults();
            return true;
        }
        if !self.errands.is_under_way(FORMING) {
            let formed = move |number: Option<usize>| match number {
                Some(number) => model.of_chart(number),
                None => model.in_form(form).with_chart(chart),
            };
            self.errands.send(FORMING, move |_| Errand::Formed(Box::new(formed(wanted))));
        }
        false
    }
}
