//! Preparation of the mesh that the document wants, and the chart that it shows.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::background_jobs::{BackgroundJob, FORMING, RESHAPING};
use super::open_mesh::Near;
use super::reshaping::Reshaped;
use super::{Command, Document, MessagePlace, Session};
use freebound_core::mesh::{HoleTreatment, Preparation, WeldDistance, near_vertices};
use freebound_core::problem::{Control, Settings, Start};

/// Name of the job that counts vertices near each other.
const COUNTING: &str = "counting near vertices";

impl Session {
    /// Reverses the orientation of all faces. Vertices and charts keep their numbers.
    pub(super) fn turn_faces(&mut self) {
        if self.model().is_some() {
            let form = self.document.form.clone();
            self.mesh.turn_wanted();
            // Turned charts are mirror images, so they cannot lie where they were locked.
            let layout = Command::SetLayout(Box::new(self.document.layout.without_places()));
            let turned = Command::SetForm(Preparation { faces_turned: !form.faces_turned, ..form });
            self.edit(vec![layout, turned]);
        }
    }

    /// Replaces the set of parts that are left out, by their first faces.
    pub(super) fn leave_out(&mut self, first_faces: BTreeSet<u32>) {
        self.want_form(Preparation { left_out: Arc::new(first_faces), ..self.form_to_be().clone() });
    }

    /// Sets the treatment of holes. Cutting holes cuts the mesh.
    pub(super) fn set_holes(&mut self, holes: HoleTreatment) {
        let form = self.form_to_be().clone();
        if holes != form.holes {
            let cut = form.cut || holes == HoleTreatment::Cut;
            self.want_form(Preparation { holes, cut, ..form });
        }
    }

    /// Starts from the texture coordinates of the file and cuts the mesh along their seams, if there are any. Without
    /// pins this is one edit. With pins, which are moved to the cut mesh, the cut is a second edit that follows.
    pub(super) fn take_layout(&mut self) {
        let Some(model) = self.model() else { return };
        let is_torn = match model.source.has_texture_seams() {
            Ok(is_torn) => is_torn,
            Err(error) => return self.messages.fail(MessagePlace::Mesh, error.to_string(), None),
        };
        let form = self.form_to_be().clone();
        let form = Preparation { seams: form.seams.without_automatic(), ..form };
        if self.is_bare() {
            let commands = self.commands_to_take_layout(form, is_torn);
            return self.edit(commands);
        }
        self.choose(self.settings_from_layout());
        let mut seams = form.seams;
        seams.of_texture |= is_torn;
        self.set_seams(seams);
    }

    /// Welds vertices within a distance, or stops welding.
    pub(super) fn weld(&mut self, within: Option<WeldDistance>) {
        let form = self.form_to_be().clone();
        self.want_form(Preparation { repair: form.repair.welding(within), ..form });
    }

    /// Counts the vertices that welding within a distance would join. The count runs in the background, once for each
    /// distance and one distance at a time.
    pub(super) fn count_near(&mut self, distance: WeldDistance) {
        let Some(source) = self.model().map(|model| Arc::clone(&model.source)) else { return };
        let is_known = self.mesh.near().is_some_and(|near| near.distance == distance);
        if !is_known && !self.jobs.is_under_way(COUNTING) {
            self.mesh.take_near(Near { distance, count: None });
            let count = move || near_vertices(&source.polygons, distance).len();
            self.jobs.send(COUNTING, move |_| BackgroundJob::Near { distance, count: count() });
        }
    }

    /// Number of vertices that welding within a distance would join, if this distance was counted last.
    pub fn near_count(&self, distance: WeldDistance) -> Option<usize> {
        self.mesh.near().filter(|near| near.distance == distance)?.count
    }

    /// Brings the mesh to the preparation and chart of the document. If this takes time, a solve follows. Returns true
    /// if the mesh is ready now.
    pub(super) fn bring_form(&mut self) -> bool {
        if self.has_form_as_wanted() {
            return true;
        }
        let Some(model) = self.model().cloned() else { return true };
        let (form, chart) = (self.document.form.clone(), self.document.chart);
        let wanted =
            model.prepared.chart.as_ref().filter(|_| model.prepared.form == form).map(|of| of.charts.pick(chart));
        if let Some(other) = wanted.and_then(|number| self.charts.model(number)) {
            self.mesh.take_other(Arc::clone(other));
        }
        if wanted.is_none() {
            // The run in progress belongs to another preparation.
            self.solving.give_up_all();
        }
        if let Some(before) = self.mesh.change(&form, chart) {
            if let Some(number) = wanted {
                self.solving.forget_message(&mut self.messages);
                self.charts.exchange(&before, &mut self.solving, number);
                self.drag.end();
            } else {
                self.charts.forget();
                self.page.forget();
                self.forget_steps();
            }
            self.messages.forget_mesh();
            self.tell_faults();
            return true;
        }
        self.jobs.go_on();
        if !self.jobs.is_under_way(FORMING) {
            let formed = move |number: Option<usize>, control: Control<'_>| match number {
                Some(number) => model.of_chart(number),
                None => model.in_form(form).mapped(control).with_chart(chart),
            };
            self.jobs.send(FORMING, move |cancel| {
                BackgroundJob::Formed(Box::new(formed(wanted, Control::new(cancel, &|_| {}))))
            });
        }
        false
    }
}

/// Edits of the preparation.
impl Session {
    /// Preparation of the document, or the requested one that will replace it.
    pub(super) fn form_to_be(&self) -> &Preparation {
        self.mesh.wanted().unwrap_or(&self.document.form)
    }

    /// Requests another preparation of the mesh, as one edit.
    pub(super) fn want_form(&mut self, form: Preparation) {
        if self.model().is_none() || form == *self.form_to_be() {
            return;
        }
        if self.is_bare() {
            let settings = self.settings_for(&form);
            self.edit([Some(Command::SetForm(form)), settings].into_iter().flatten().collect());
        } else {
            self.mesh.want(Some(form).filter(|form| *form != self.document.form));
            self.follow_form();
        }
    }

    /// Settings that start from scratch, if the map starts from the layout of the file and a preparation cuts the mesh
    /// in another way.
    fn settings_for(&self, form: &Preparation) -> Option<Command> {
        let settings = &self.document.settings;
        let cuts_otherwise =
            form.seams.bound().is_some() || (self.document.form.seams.of_texture && !form.seams.of_texture);
        let is_from_file = settings.start == Start::File;
        (is_from_file && cuts_otherwise)
            .then(|| Command::SetSettings(Settings { start: Start::FromScratch, ..settings.clone() }))
    }

    /// True if nothing refers to vertices or charts, so that the mesh can change its preparation at once.
    pub(super) fn is_bare(&self) -> bool {
        let Document { targets, elsewhere, relaxed, chart, .. } = &self.document;
        let is_bare = targets.is_empty() && elsewhere.is_empty() && *relaxed == 0 && chart.is_none();
        is_bare && self.mesh.wanted().is_none()
    }

    /// Starts the requested preparation in the background, once the mesh has the preparation of the document.
    pub(super) fn follow_form(&mut self) {
        let is_free = self.has_form_as_wanted() && !self.jobs.is_under_way(RESHAPING);
        let wanted = self.mesh.wanted().filter(|_| is_free);
        if let (Some(form), Some(model)) = (wanted.cloned(), self.model().cloned()) {
            self.jobs.send(RESHAPING, move |cancel| {
                let control = Control::new(cancel, &|_| {});
                BackgroundJob::Reshaped(Box::new(Reshaped::new(model, form, control)))
            });
        }
    }

    /// Applies the requested preparation as an edit, if the result still matches the request.
    pub(super) fn take_reshaped(&mut self, reshaped: Reshaped) {
        let is_of_screen = self.model().is_some_and(|model| Arc::ptr_eq(model, reshaped.before()));
        let is_wanted = self.mesh.wanted() == Some(reshaped.form());
        if !(is_of_screen && is_wanted && self.has_form_as_wanted()) {
            return;
        }
        let settings = self.settings_for(reshaped.form());
        self.mesh.want(None);
        let shape = reshaped.shape(&self.document);
        self.mesh.take_other(Arc::new(reshaped.into_model()));
        self.edit([Some(Command::Reshape(Box::new(shape))), settings].into_iter().flatten().collect());
    }
}
