//! Opening and saving: between files and the parts of the session.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;

use super::action::{BakeRequest, UndoGroup};
use super::exports::Export;
use super::in_use::Role;
use super::landmarks::has_landmarks;
use super::opened::{Opened, Origin};
use super::stop::Goal;
use super::{History, Message, MessagePlace, Model, Session, StopConditions, Written};
use freebound_core::pipeline::Surface;
use freebound_core::problem::Control;
use freebound_io::{EXTENSIONS, ProjectPins, WriteError, write_atomically, write_constraints, write_durably};

/// Maximum number of faults that are reported separately if all of them can be repaired.
const FAULTS_TOLD: usize = 2;

impl Session {
    /// Replaces the open document, including its history.
    pub(super) fn take_opened(&mut self, opened: Opened) {
        let is_mesh = matches!(opened.origin, Origin::Mesh);
        self.files.put_on_table(&opened);
        let Opened { model, document, remarks, restored, .. } = opened;
        // An example only takes its first step, so that the user can watch the others.
        let waits = model.built_in.is_some() && is_mesh;
        let warnings: Vec<String> = model.source.warnings.iter().map(ToString::to_string).collect();
        let touching = model.prepared.touching_vertices;
        self.document = document;
        self.history = History::default();
        self.solving.set_stop(StopConditions::default());
        self.jobs.forget();
        self.close_landmarks();
        self.mesh.open(model);
        self.charts.forget();
        self.page.forget();
        self.atlas_views.forget();
        self.forget_steps();
        self.messages.clear();
        self.unwrapping.cancel();
        self.layout_check.end_wait();
        self.give_up_exports();
        let follows = is_mesh && !waits && self.begin_first_map();
        if !follows {
            self.tell_faults();
        }
        for warning in warnings {
            self.messages.say(Message::caution(MessagePlace::Mesh, warning));
        }
        if touching > 0 {
            let words = if touching == 1 { "1 vertex touches" } else { &format!("{touching} vertices touch") };
            let note = Message::caution(MessagePlace::Mesh, format!("{words} other parts without being joined"));
            self.messages.say(note.with_remedy("weld within 0 if the parts are one surface"));
        }
        let file = self.files.project().cloned().or_else(|| self.model()?.path.clone());
        for remark in remarks {
            self.messages.say(remark.of_file(file.as_deref()));
        }
        let together = self.files.take_together();
        self.take_restored(restored);
        if waits {
            self.begin(Goal::Steps(1));
        } else if !self.is_current() && !follows {
            self.solve();
        }
        if let Some(together) = together {
            self.open_beside(together);
        }
    }

    /// Opens the picture and the constraints of the opened mesh, and reports files that are not opened.
    fn open_beside(&mut self, UndoGroup { picture, constraints, left, .. }: UndoGroup) {
        if let Some(path) = picture {
            self.open_picture(path);
        }
        for path in constraints {
            self.import_constraints(path);
        }
        if !left.is_empty() {
            let name = |path: &PathBuf| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let names: Vec<String> = left.iter().map(name).collect();
            let text = format!("only one mesh and one picture can be open at a time; not opened: {}", names.join(", "));
            self.messages.say(Message::error(MessagePlace::Mesh, text).with_remedy("drop it by itself to open it"));
        }
    }

    pub(super) fn tell_faults(&mut self) {
        let Some(model) = self.model().cloned() else { return };
        let Surface::Faulty(_, diagnosis) = &model.prepared.surface else { return };
        // More messages would hide the mesh. The list of defects names all of them, and one click repairs them.
        if model.prepared.remedy.is_some() && diagnosis.faults.len() > FAULTS_TOLD {
            return;
        }
        for fault in &diagnosis.faults {
            let message = Message::error(MessagePlace::Mesh, fault.message()).with_remedy(fault.remedy());
            let vertices = fault.vertices_of(0, model.mesh());
            let numbers = vertices.into_iter().map(|vertex| model.vertex_in_file(vertex)).collect();
            let message = message.with_vertices(numbers);
            self.messages.say(message.of_file(Some(model.path.as_deref().unwrap_or(Path::new(&model.name)))));
        }
    }

    /// Writes the embedding on the screen.
    pub(super) fn save(&mut self, request: Export) {
        let (Some(model), Some(outcome)) = (self.model().cloned(), self.outcome().cloned()) else {
            return self.complain("there is nothing to save yet: open a mesh first", None);
        };
        if !self.is_current() {
            let text = "the embedding on the screen does not match the settings and pins yet";
            return self.complain(text, Some("save again when it is solved"));
        }
        if self.refuses_to_replace(request.path(), None) {
            return;
        }
        if model.prepared.chart.is_some() {
            return self.save_atlas(model, request);
        }
        let records = self.timeline().records()[..=outcome.step.index].to_vec();
        let picture = self.document.picture.clone();
        self.files.write_until(move |cancel| {
            let mut output = model.finished(&outcome, records, request.fit());
            output.picture = picture.as_deref();
            request.write(output, &model, Control::new(cancel, &|_| {}))
        });
    }

    /// True if the picture can be drawn for another layout: the file has a layout that it belongs to.
    pub fn can_bake(&self) -> bool {
        self.document.picture.is_some() && self.model().is_some_and(|model| model.source.texture.is_some())
    }

    /// Writes the picture of the file's layout, drawn for the layout on the screen.
    pub(super) fn save_baked(&mut self, request: BakeRequest) {
        if self.can_bake() {
            self.save(Export::Baked(request));
        } else {
            let text = "no picture was drawn: the file needs texture coordinates, and a picture that fits them";
            self.complain(text, Some("open a mesh with texture coordinates, then its picture"));
        }
    }

    /// Writes the layout of all charts.
    fn save_atlas(&mut self, model: Arc<Model>, request: Export) {
        let solved = match self.solved_atlas() {
            Ok(solved) => solved,
            Err(_) if self.failed_chart().is_none() => {
                self.messages.forget_notes();
                let note = "the file is written once all charts are solved";
                self.messages.say(Message::caution(MessagePlace::Embedding, note));
                return self.files.wait_to_save(request);
            }
            Err(missing) => {
                let charts = if missing == 1 { "1 chart has" } else { &format!("{missing} charts have") };
                let text = format!("{charts} no embedding for the current settings and pins yet");
                return self.complain(&text, Some("save again when they are solved; the list of charts shows them"));
            }
        };
        let picture = self.document.picture.clone();
        self.files.write_until(move |cancel| {
            let mut output = solved.output();
            output.picture = picture.as_deref();
            output.svg_fit = request.fit();
            request.write(output, &model, Control::new(cancel, &|_| {}))
        });
    }

    /// Writes the layouts that were asked for while charts were being solved, once all charts are solved. Gives them up if
    /// a chart has failed or the mesh has other charts now. Call once per frame.
    pub(super) fn save_awaited(&mut self) {
        if !self.files.is_awaiting() {
            return;
        }
        let is_idle = self.is_current() || (!self.is_running() && !self.history.is_in_gesture());
        let is_lost = self.charts().is_none() || !self.has_form_as_wanted() || self.failed_chart().is_some();
        if self.is_current() && !is_lost && self.solved_atlas().is_ok() {
            for request in self.files.take_awaited() {
                self.save(request);
            }
        } else if is_lost || (is_idle && !self.is_current()) {
            self.give_up_exports();
        }
    }

    /// Drops the exports that wait until all charts are solved, and says so.
    pub(super) fn give_up_exports(&mut self) {
        for request in self.files.take_awaited() {
            let text = format!("{} was not written: its charts were not solved", request.path().display());
            self.complain(text, Some("export again once all charts are solved"));
        }
    }

    /// Saves the project.
    pub(super) fn save_project(&mut self, path: PathBuf) {
        if self.refuses_to_replace(&path, Some(Role::Project)) {
            return;
        }
        if self.refuses_formless() {
            return;
        }
        match self.model().and_then(|model| self.project(model)) {
            Some(project) => self.files.save_project(path, project, &self.document),
            None => self.complain("there is nothing to save yet: open a mesh first", None),
        }
    }

    /// Writes the targets to a constraint file, or the named pins as landmarks of the picture.
    pub(super) fn export_constraints(&mut self, path: PathBuf) {
        if self.refuses_formless() {
            return;
        }
        if has_landmarks(&path) {
            return self.export_landmarks(path);
        }
        let pins = self.model().map(|model| self.document.all_pins(model)).unwrap_or_default();
        let ProjectPins { targets, notes } = pins;
        if targets.is_empty() {
            return self.complain("there are no constraints to write: pin a vertex first", None);
        }
        if self.refuses_to_replace(&path, Some(Role::Constraints)) {
            return;
        }
        self.files.write(move || {
            write_durably(&path, |out| write_constraints(out, &targets, &notes))?;
            let words = if targets.len() == 1 { "constraint" } else { "constraints" };
            Ok(Written { about: Some(format!("{} {words}", targets.len())), ..Written::file(path) })
        });
    }

    /// True if the mesh does not have the preparation of the document yet, so that the vertices of its pins are
    /// unknown. Reports this.
    fn refuses_formless(&mut self) -> bool {
        let is_formless = !self.has_numbers_as_wanted();
        if is_formless {
            let text = "nothing was written: the mesh is still being prepared";
            self.complain(text, Some("try again in a moment"));
        }
        is_formless
    }

    /// Writes a file in the background. `write` writes its content.
    pub fn write_file(&mut self, path: PathBuf, write: impl FnOnce(&mut dyn Write) -> io::Result<()> + Send + 'static) {
        if self.refuses_to_replace(&path, None) {
            return;
        }
        self.files.write(move || {
            write_atomically(&path, |out| write(out))?;
            Ok(Written::file(path))
        });
    }

    /// Writes several files in the background. `write` writes the content of the file at a place in the list; `about`
    /// summarises them.
    pub fn write_files(
        &mut self,
        paths: Vec<PathBuf>,
        about: String,
        write: impl Fn(usize, &mut dyn Write) -> io::Result<()> + Send + 'static,
    ) {
        if paths.is_empty() || paths.iter().any(|path| self.refuses_to_replace(path, None)) {
            return;
        }
        self.files.write_until(move |cancel| {
            for (place, path) in paths.iter().enumerate() {
                if cancel.load(Ordering::Relaxed) {
                    return Err(WriteError::cancelled(path));
                }
                write_atomically(path, |out| write(place, out))?;
            }
            Ok(Written { files: paths.into_iter().take(1).collect(), about: Some(about) })
        });
    }

    /// Reports a file name whose extension selects no kind of output.
    pub(super) fn refuse_name(&mut self, path: &Path) {
        let text = format!("{} has no known file extension", path.display());
        self.complain(text, Some(&format!("use a name that ends in {EXTENSIONS}")));
    }
}
