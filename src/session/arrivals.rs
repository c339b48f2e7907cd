//! Results of background jobs for the document: pictures, constraints, seams, and the mesh in another preparation.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::background_jobs::{BackgroundJob, FORMING, RESHAPING};
use super::edits::pin;
use super::landmarks::has_landmarks;
use super::open_mesh::Near;
use super::opened::is_project;
use super::{Command, Message, MessagePlace, Session};
use crate::examples::Example;
use freebound_io::{Constraints, ConstraintsError, PictureFile};

impl Session {
    /// Reads a picture in the background. It belongs to the mesh that is being opened, else to the open one. Default:
    /// the built-in face.
    pub(super) fn open_picture(&mut self, path: PathBuf) {
        if self.model().is_none() && !self.files.is_loading() {
            self.files.open_example(Example::Face);
        }
        if self.files.is_loading() {
            return self.files.open_picture_after(path);
        }
        self.jobs.send("reading the picture", move |_| {
            let read = PictureFile::read(&path);
            BackgroundJob::Picture { path, read }
        });
    }

    /// Reads constraints, landmarks of the picture, or the constraints of a project, in the background. They belong to
    /// the mesh that is being opened, else to the open one.
    pub(super) fn import_constraints(&mut self, path: PathBuf) {
        if self.files.is_loading() {
            return self.files.import_after(path);
        }
        if has_landmarks(&path) {
            return self.import_landmarks(path);
        }
        if self.model().is_none() {
            return self.complain("constraints need a mesh: open one first", None);
        }
        if is_project(&path) {
            return self.carry_constraints(path);
        }
        let count = self.model().map_or(0, |model| model.vertex_count_in_file());
        self.jobs.send("reading the constraints", move |_| {
            let read = Constraints::read(&path, count);
            BackgroundJob::Constraints { path, read }
        });
    }

    /// Applies the results of finished jobs.
    pub(super) fn poll_jobs(&mut self) {
        loop {
            let is_forming = !self.has_form_as_wanted() && self.jobs.is_under_way(FORMING);
            match self.jobs.poll(is_forming || self.history.is_in_gesture()) {
                None => break,
                Some((_, Ok(job))) => self.take_job(job),
                Some((what, Err(failure))) => {
                    if what == RESHAPING {
                        self.mesh.want(None);
                    }
                    self.messages.fail_background(MessagePlace::Embedding, what, &failure);
                }
            }
        }
        self.follow_form();
    }

    fn take_job(&mut self, job: BackgroundJob) {
        match job {
            BackgroundJob::Picture { read: Ok(picture), .. } => self.set_picture(Some(Arc::new(picture))),
            BackgroundJob::Picture { path, read: Err(error) } => {
                let message = Message::error(MessagePlace::Embedding, error.to_string()).of_file(Some(&path));
                self.messages.say(message.with_remedy("choose a PNG or JPEG file, or a glTF file with a picture"));
            }
            BackgroundJob::Constraints { path, read: Ok(constraints) } => {
                self.files.remember_constraints(path);
                self.take_constraints(constraints);
            }
            BackgroundJob::Constraints { path, read: Err(error) } => self.tell_constraints(&path, &error),
            BackgroundJob::Carried { path, mesh, read } => self.take_carried(&path, &mesh, read),
            BackgroundJob::Landmarks { path, read } => self.take_landmarks(&path, read),
            BackgroundJob::Near { distance, count } => self.mesh.take_near(Near { distance, count: Some(count) }),
            BackgroundJob::Flat(flat) => self.take_flat(&flat),
            BackgroundJob::Seams(read) => self.take_seams(read),
            BackgroundJob::LayoutOfOther { path, read } => self.take_layout_of_other(&path, read),
            BackgroundJob::Reshaped(reshaped) => self.take_reshaped(*reshaped),
            BackgroundJob::Formed(model) => {
                self.mesh.take_other(Arc::from(model));
                if self.jobs.is_stopped() {
                    self.bring_form();
                } else if !self.has_form_as_wanted() {
                    self.solve();
                }
            }
        }
    }

    /// Reports the reason why a constraint file is rejected, and shows the vertices concerned.
    fn tell_constraints(&mut self, path: &Path, error: &ConstraintsError) {
        let vertices = error.vertices().into_iter().filter(|&number| self.has_number(number)).collect();
        let message =
            Message::error(MessagePlace::Embedding, error.to_string()).with_vertices(vertices).of_file(Some(path));
        self.messages.say(message.with_remedy("nothing was imported: repair the file and import it again"));
    }

    /// Makes constraints an edit. Returns false if that is refused, which a message says.
    pub(super) fn take_constraints(&mut self, Constraints { targets, notes, .. }: Constraints) -> bool {
        if targets.is_empty() {
            self.complain("the file has no constraints", None);
            return false;
        }
        let Some(model) = self.model().cloned() else { return false };
        if !self.has_form_as_wanted() {
            let text = "the constraints were not imported: the mesh is not prepared yet";
            self.complain(text, Some("solve, then import them again"));
            return false;
        }
        let takes_pins = self.takes_pins();
        if takes_pins {
            let (mut by_chart, mut notes) = (model.by_chart(targets), model.by_chart(notes));
            let shown = model.prepared.chart.as_ref().map_or(0, |of| of.charts.pick(self.document.chart));
            let here = by_chart.remove(&shown).unwrap_or_default();
            let known = &self.document.targets;
            let fresh = here.into_iter().filter(|(vertex, target)| known.get(vertex) != Some(target));
            let names = notes.remove(&shown).unwrap_or_default().into_iter();
            let names = names.map(|(vertex, note)| Command::SetNote { vertex, note });
            let elsewhere = by_chart.into_iter().map(|(chart, targets)| {
                let mut edits = self.document.elsewhere.get(&chart).cloned().unwrap_or_default();
                edits.targets.extend(targets);
                edits.notes.extend(notes.remove(&chart).unwrap_or_default());
                Command::SetElsewhere { chart, edits }
            });
            self.edit(fresh.map(|(vertex, target)| pin(vertex, target)).chain(names).chain(elsewhere).collect());
        }
        takes_pins
    }
}
