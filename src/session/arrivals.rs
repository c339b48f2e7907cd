//! What errands bring for the document: pictures and constraints that were read, the mesh in another form.

use std::path::PathBuf;
use std::sync::Arc;

use super::edits::pin;
use super::errands::Errand;
use super::forming::FORMING;
use super::open_mesh::Near;
use super::reshaping::RESHAPING;
use super::{Command, Message, Place, Session};
use crate::io::{Constraints, ConstraintsError, PictureFile, Targets};

impl Session {
    /// Reads a picture.
    pub(super) fn open_picture(&mut self, path: PathBuf) {
        if self.model().is_none() {
            return self.complain("a picture needs a mesh: open one first", None);
        }
        self.errands.send("reading the picture", move |_| Errand::Picture(PictureFile::read(&path)));
    }

    /// Reads constraints.
    pub(super) fn import_constraints(&mut self, path: PathBuf) {
        if self.model().is_none() {
            return self.complain("constraints need a mesh: open one first", None);
        }
        let count = self.model().map_or(0, |model| model.vertex_count_in_file());
        self.errands.send("reading the constraints", move |_| {
            let read = Constraints::read(&path, count);
            Errand::Constraints { path, read }
        });
    }

    /// Takes in the errands that came back.
    pub(super) fn poll_errands(&mut self) {
        loop {
            let is_forming = !self.has_form_as_wanted() && self.errands.is_under_way(FORMING);
            match self.errands.poll(is_forming || self.history.is_in_gesture()) {
                None => break,
                Some((_, Ok(errand))) => self.take_errand(errand),
                Some((what, Err(failure))) => {
                    if what == RESHAPING {
                        self.mesh.want(None);
                    }
                    self.messages.fail_background(Place::Embedding, what, &failure);
                }
            }
        }
        self.follow_form();
    }

    fn take_errand(&mut self, errand: Errand) {
        match errand {
            Errand::Picture(Ok(picture)) => self.edit(vec![Command::SetPicture(Some(Arc::new(picture)))]),
            Errand::Picture(Err(error)) => self.complain(error.to_string(), Some("choose a PNG or JPEG file")),
            Errand::Constraints { path, read: Ok(constraints) } => {
                self.files.remember_constraints(path);
                self.take_constraints(constraints.targets);
            }
            Errand::Constraints { read: Err(error), .. } => self.tell_constraints(&error),
            Errand::Near { distance, count } => self.mesh.take_near(Near { distance, count: Some(count) }),
            Errand::Flat(flat) => self.take_flat(&flat),
            Errand::Seams(read) => self.take_seams(read),
            Errand::Reshaped(reshaped) => self.take_reshaped(*reshaped),
            Errand::Formed(model) => {
                self.mesh.take_other(Arc::from(model));
                if self.errands.is_stopped() {
                    self.bring_form();
                } else if !self.has_form_as_wanted() {
                    self.solve();
                }
            }
        }
    }

    /// Says why a constraint file is not used, and shows the vertices that it is about.
    fn tell_constraints(&mut self, error: &ConstraintsError) {
        let model = self.model();
        let of_chart = |vertex| model.and_then(|model| model.vertex_of_file(vertex));
        let vertices = error.vertices().into_iter().filter_map(of_chart).collect();
        let message = Message::error(Place::Embedding, error.to_string()).with_vertices(vertices);
        self.messages.say(message.with_remedy("mend the file and import it again: nothing of it was taken"));
    }

    fn take_constraints(&mut self, targets: Targets) {
        if targets.is_empty() {
            return self.complain("the file has no constraints", None);
        }
        let Some(model) = self.model().cloned() else { return };
        if !self.has_form_as_wanted() {
            let text = "the constraints were not taken: the mesh does not have its form yet";
            return self.complain(text, Some("solve, and import them again"));
        }
        if self.takes_pins() {
            let mut by_chart = model.by_chart(targets);
            let shown = model.chart.as_ref().map_or(0, |of| of.charts.pick(self.document.chart));
            let here = by_chart.remove(&shown).unwrap_or_default();
            let known = &self.document.targets;
            let fresh = here.into_iter().filter(|(vertex, target)| known.get(vertex) != Some(target));
            let elsewhere = by_chart.into_iter().map(|(chart, targets)| {
                let mut edits = self.document.elsewhere.get(&chart).cloned().unwrap_or_default();
                edits.targets.extend(targets);
                Command::SetElsewhere { chart, edits }
            });
            self.edit(fresh.map(|(vertex, target)| pin(vertex, target)).chain(elsewhere).collect());
        }
    }
}
