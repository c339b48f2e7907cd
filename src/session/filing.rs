//! What a person opens and writes: from files to the parts of the session, and back.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::action::UndoGroup;
use super::in_use::Role;
use super::opened::{Opened, Origin};
use super::stop::Goal;
use super::{History, Message, MessagePlace, SaveRequest, Session, Written};
use freebound_core::pipeline::{Fit, Surface};
use freebound_core::problem::{Settings, Start};
use freebound_io::{EXTENSIONS, OutputKind, Precision, write_atomically, write_constraints, write_durably};

/// The most faults with a bar each, where all can be mended.
const FAULTS_TOLD: usize = 2;

impl Session {
    /// Puts something on the table. The document before it is gone, its history with it.
    pub(super) fn take_opened(&mut self, mut opened: Opened) {
        let is_mesh = matches!(opened.origin, Origin::Mesh);
        if is_mesh {
            // A layout to start from was one of the mesh before.
            opened.document.settings = Settings { start: Start::FromScratch, ..self.document.settings.clone() };
        }
        self.files.put_on_table(&opened);
        let Opened { model, document, remarks, .. } = opened;
        // An example is there to be watched: it waits for the person to take the steps.
        let waits = model.example.is_some() && is_mesh;
        self.document = document;
        self.history = History::default();
        self.jobs.forget();
        self.mesh.open(model);
        self.charts.forget();
        self.forget_steps();
        self.messages.clear();
        self.tell_faults();
        for remark in remarks {
            self.messages.say(remark);
        }
        let together = self.files.take_together();
        if waits {
            self.begin(Goal::Steps(1));
        } else {
            self.solve();
        }
        if let Some(together) = together {
            self.open_beside(together);
        }
    }

    /// Opens what belongs to the mesh that was opened, and says what is not opened.
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
            let text = format!("one mesh is open at a time, with one picture; not opened: {}", names.join(", "));
            self.messages.say(Message::error(MessagePlace::Mesh, text).with_remedy("drop it by itself to open it"));
        }
    }

    pub(super) fn tell_faults(&mut self) {
        let Some(model) = self.model().cloned() else { return };
        let Surface::Faulty(_, diagnosis) = &model.prepared.surface else { return };
        // More of them would hide the mesh behind bars; the tab of defects lists them all, and one click mends them.
        if model.prepared.remedy.is_some() && diagnosis.faults.len() > FAULTS_TOLD {
            return;
        }
        for fault in &diagnosis.faults {
            let message = Message::error(MessagePlace::Mesh, fault.message()).with_remedy(fault.remedy());
            self.messages.say(message.with_vertices(fault.vertices_of(0, model.mesh())));
        }
    }

    /// Writes the embedding on the screen.
    pub(super) fn save(&mut self, request: SaveRequest) {
        let (Some(model), Some(outcome)) = (self.model().cloned(), self.outcome().cloned()) else {
            return self.complain("there is nothing to save yet: open a mesh first", None);
        };
        if !self.is_current() {
            let text = "the embedding on the screen does not belong to these settings and pins yet";
            return self.complain(text, Some("save again when it is solved"));
        }
        if self.refuses_to_replace(&request.path, None) {
            return;
        }
        if model.prepared.chart.is_some() {
            return self.save_atlas(request);
        }
        let records = self.timeline().records()[..=outcome.step.index].to_vec();
        let picture = self.document.picture.clone();
        self.files.write(move || {
            let mut output = model.finished(&outcome, records, request.fit);
            output.picture = picture.as_deref();
            output.round_to(Precision::default(), request.kind);
            let files = output.write(request.kind, &request.path)?;
            Ok(Written { files, about: Some(output.summary()) })
        });
    }

    /// Writes the layout of all charts.
    fn save_atlas(&mut self, SaveRequest { path, kind, fit }: SaveRequest) {
        if kind == OutputKind::Svg && fit == Fit::True {
            let text = "several charts are drawn as they are packed: none at true scale";
            return self.complain(text, Some("export the layout in the unit square"));
        }
        let solved = match self.solved_atlas() {
            Ok(solved) => solved,
            Err(missing) => {
                let charts = if missing == 1 { "1 chart has" } else { &format!("{missing} charts have") };
                let text = format!("{charts} no embedding for these settings and pins yet");
                return self.complain(&text, Some("the list of charts tells which: save again when they are solved"));
            }
        };
        let picture = self.document.picture.clone();
        self.files.write(move || {
            let mut output = solved.output();
            output.picture = picture.as_deref();
            output.round_to(Precision::default(), kind);
            let files = output.write(kind, &path)?;
            Ok(Written { files, about: Some(output.summary()) })
        });
    }

    /// Saves the project.
    pub(super) fn save_project(&mut self, path: PathBuf) {
        if self.refuses_to_replace(&path, Some(Role::Project)) {
            return;
        }
        if self.refuses_formless() {
            return;
        }
        match self.model().and_then(|model| self.files.project_file(model, &self.document)) {
            Some(project) => self.files.save_project(path, project, &self.document),
            None => self.complain("there is nothing to save yet: open a mesh first", None),
        }
    }

    /// Writes the targets as a constraint file.
    pub(super) fn export_constraints(&mut self, path: PathBuf) {
        if self.refuses_formless() {
            return;
        }
        let targets = self.model().map(|model| model.all_targets(&self.document)).unwrap_or_default();
        if targets.is_empty() {
            return self.complain("there are no constraints to write: pin a vertex first", None);
        }
        if self.refuses_to_replace(&path, Some(Role::Constraints)) {
            return;
        }
        self.files.write(move || {
            write_durably(&path, |out| write_constraints(out, &targets))?;
            let words = if targets.len() == 1 { "constraint" } else { "constraints" };
            Ok(Written { about: Some(format!("{} {words}", targets.len())), ..Written::file(path) })
        });
    }

    /// Whether the mesh does not have the form of the document yet, so that nobody can say which vertices its pins are; then
    /// says so.
    fn refuses_formless(&mut self) -> bool {
        let is_formless = !self.has_numbers_as_wanted();
        if is_formless {
            let text = "nothing was written: the mesh is still being brought into its form";
            self.complain(text, Some("write it again in a moment"));
        }
        is_formless
    }

    /// Writes a file in the background, made there by `write`.
    pub fn write_file(&mut self, path: PathBuf, write: impl FnOnce(&mut dyn Write) -> io::Result<()> + Send + 'static) {
        if self.refuses_to_replace(&path, None) {
            return;
        }
        self.files.write(move || {
            write_atomically(&path, |out| write(out))?;
            Ok(Written::file(path))
        });
    }

    /// Says that a name does not tell what kind of file to write.
    pub(super) fn refuse_name(&mut self, path: &Path) {
        let text = format!("{} does not say what to write", path.display());
        self.complain(text, Some(&format!("end the name in {EXTENSIONS}")));
    }
}
