//! Queries to the session that its parts answer.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::files::PATIENCE;
use super::{
    JobFailure, LargeFile, LoggedMessage, Message, MessagePlace, MissingFile, Model, RecentFiles, Recoverable, RunStop,
    Session, StopConditions, Timeline,
};
use freebound_core::mesh::{DiskMesh, FaceId, VertexId};
use freebound_core::pipeline::Outcome;
use freebound_core::problem::Pins;
use freebound_core::verify::Conflict;
use freebound_io::{PinName, ProjectSource, ProjectView};

/// Queries of the open mesh.
impl Session {
    /// The open mesh.
    pub fn model(&self) -> Option<&Arc<Model>> {
        self.mesh.model()
    }

    /// Number of changes of the open mesh and of its preparation.
    pub fn model_revision(&self) -> u64 {
        self.mesh.revision()
    }

    /// Open mesh, if it is a disk.
    pub(super) fn disk(&self) -> Option<&Arc<DiskMesh>> {
        self.model()?.disk()
    }

    /// Number of vertices of the open mesh; zero if nothing is open.
    pub(super) fn vertex_count(&self) -> usize {
        self.model().map_or(0, |model| model.vertex_count())
    }

    /// Number in files of a vertex of the open mesh or chart. Texts show this number.
    pub fn number_of(&self, vertex: VertexId) -> VertexId {
        self.model().map_or(vertex, |model| model.vertex_in_file(vertex))
    }

    /// True if the open mesh has a vertex of this number in files, on any chart.
    pub fn has_number(&self, number: VertexId) -> bool {
        let Some(model) = self.model() else { return false };
        match &model.prepared.chart {
            Some(of) => of.charts.chart_of_vertex(number).is_some(),
            None => model.vertex_of_file(number).is_some(),
        }
    }

    /// True if the shown chart is the one that the document wants, or nothing is open.
    pub(super) fn has_chart_as_wanted(&self) -> bool {
        self.model().is_none_or(|model| model.is_chart(self.document.chart))
    }

    /// True if preparation and chart of the mesh are those that the document wants, or nothing is open.
    pub(super) fn has_form_as_wanted(&self) -> bool {
        self.has_numbers_as_wanted() && self.has_chart_as_wanted()
    }

    /// True if the preparation of the mesh is the one that the document wants, or nothing is open. Then vertices and
    /// charts have the document's numbers, whichever chart is shown.
    pub(super) fn has_numbers_as_wanted(&self) -> bool {
        self.model().is_none_or(|model| model.prepared.form == self.document.form)
    }
}

/// Queries of files.
impl Session {
    /// Number of openings. Unlike [`model_revision`](Self::model_revision) it ignores changes of the preparation, when
    /// the camera has to stay.
    pub fn opening_revision(&self) -> u64 {
        self.files.opening()
    }

    /// Recently opened files.
    pub fn recent(&self) -> &RecentFiles {
        self.files.recent()
    }

    /// Project that the document is saved to.
    pub fn project_path(&self) -> Option<&PathBuf> {
        self.files.project()
    }

    /// Name of the open document, if one is open.
    pub fn project_name(&self) -> Option<String> {
        self.files.name(self.model().map(AsRef::as_ref))
    }

    /// True if the session has unsaved work.
    pub fn has_unsaved_work(&self) -> bool {
        self.model().is_some() && !self.files.has_saved(&self.document)
    }

    /// True if a project is being written.
    pub fn is_saving_project(&self) -> bool {
        self.files.is_saving_project()
    }

    /// View that was saved with the document. The screen adopts it when [`opening_revision`](Self::opening_revision)
    /// changes.
    pub fn view(&self) -> &ProjectView {
        self.files.view()
    }

    /// Sets the view to be saved with the project. A changed view alone is no unsaved work.
    pub fn set_view(&mut self, view: ProjectView) {
        self.files.set_view(view);
    }

    /// Waits until all requested files are written or a time limit is reached. Call it at the end of the program, which
    /// would interrupt the writing.
    pub fn finish_writing(&mut self) {
        let begun = Instant::now();
        while self.files.is_awaiting() && begun.elapsed() < PATIENCE {
            std::thread::sleep(Duration::from_millis(1));
            self.poll();
        }
        self.files.finish_writing(&mut self.messages);
    }

    /// Sets the machine's memory, bytes. Files that may take more than half of it need a confirmation.
    pub fn heed_memory(&mut self, bytes: u64) {
        self.files.set_memory(bytes);
    }

    /// File that waits for [`Action::OpenLarge`](super::Action::OpenLarge) or
    /// [`Action::LeaveLarge`](super::Action::LeaveLarge).
    pub fn large_file(&self) -> Option<&LargeFile> {
        self.files.large()
    }

    /// File that a message reports as missing, if the user can locate it.
    pub fn missing_file(&self, message: &Message) -> Option<MissingFile> {
        if self.files.missing_mesh() == Some(message.id) {
            return Some(MissingFile::Mesh);
        }
        let picture = self.files.missing_picture().filter(|_| self.document().picture.is_none());
        let is_about =
            matches!(picture, Some(ProjectSource::File { path, .. }) if message.about.as_ref() == Some(path));
        is_about.then_some(MissingFile::Picture)
    }

    /// Sets the folder for recovery copies and lists the copies found there.
    pub fn keep_copies_in(&mut self, folder: PathBuf) {
        self.files.autosave_mut().keep_in(folder);
    }

    /// Unsaved work of earlier sessions, newest first.
    pub fn recoverable(&self) -> &[Recoverable] {
        self.files.autosave().found()
    }

    /// Ends the session at the user's request: deletes its recovery copy and makes no further one. A session that is
    /// merely dropped keeps its copy.
    pub fn close(&mut self) {
        self.files.autosave_mut().close();
    }
}

/// Messages to the user.
impl Session {
    /// Messages that were not dismissed, oldest first.
    pub fn messages(&self) -> &[Message] {
        self.messages.list()
    }

    /// Newest messages of the run, dismissed or not, oldest first.
    pub fn message_log(&self) -> impl DoubleEndedIterator<Item = &LoggedMessage> + ExactSizeIterator + Clone {
        self.messages.log()
    }

    /// Reports a background job without an outcome. `work` is a noun, such as "drawing".
    pub fn tell_failure(&mut self, place: MessagePlace, work: &str, failure: &JobFailure) {
        self.messages.fail_background(place, work, failure);
    }

    /// Reports a success.
    pub fn tell_note(&mut self, text: impl Into<String>) {
        self.messages.say(Message::note(MessagePlace::Embedding, text));
    }

    /// Reports a fault of a file that the window reads, with its remedy.
    pub fn tell_fault(&mut self, place: MessagePlace, text: impl Into<String>, remedy: &str) {
        self.messages.fail(place, text, Some(remedy));
    }

    /// Reports a face of the file that is not on the screen, because the mesh does not have it.
    pub fn tell_left_out(&mut self, face: FaceId) {
        let text = format!("face {} of the file is left out of the mesh", face.number());
        self.messages.say(Message::caution(MessagePlace::Mesh, text));
    }

    /// Reports that a command finds no edges.
    pub fn tell_no_edge(&mut self, text: &str) {
        self.messages.say(Message::caution(MessagePlace::Embedding, text));
    }

    /// Reports a failure in the embedding pane, with its remedy.
    pub(super) fn complain(&mut self, text: impl Into<String>, remedy: Option<&str>) {
        self.messages.fail(MessagePlace::Embedding, text, remedy);
    }
}

/// Queries of steps.
impl Session {
    /// Steps of the run, and the shown one.
    pub fn timeline(&self) -> &Timeline {
        self.solving.timeline()
    }

    /// The step on the screen.
    pub fn outcome(&self) -> Option<&Arc<Outcome>> {
        self.timeline().outcome(self.timeline().shown()?)
    }

    /// Step that the shown one is compared with.
    pub fn compared(&self) -> Option<&Arc<Outcome>> {
        self.timeline().outcome(self.timeline().compared()?)
    }

    /// Number of changes of the shown step.
    pub fn outcome_revision(&self) -> u64 {
        self.solving.outcome_revision()
    }

    /// Stop conditions of runs.
    pub fn stop_conditions(&self) -> StopConditions {
        self.solving.stop_conditions()
    }

    /// True if a run takes steps in the background.
    pub fn is_running(&self) -> bool {
        self.solving.is_running()
    }

    /// Reason for the stop of the run, unless the user stopped it.
    pub fn stopped(&self) -> Option<RunStop> {
        self.solving.stopped()
    }
}

/// Checks of targets.
impl Session {
    /// Updates the checks of targets. Call once per frame.
    pub(super) fn refresh_target_checks(&mut self) {
        if !self.has_form_as_wanted() {
            return;
        }
        let settings = self.document.settings.clone();
        let pins = if settings.method.uses_pins() { settings.held(&self.document.pins()) } else { Pins::default() };
        let (revision, disk) = (self.model_revision(), self.disk().cloned());
        self.target_checks.find_conflicts(revision, disk.as_deref(), pins);
        self.target_checks.flatten(revision, disk, self.document.targets.len());
    }

    /// Conflicts among the constraints of the document on the current mesh.
    pub fn conflicts(&self) -> &[Conflict] {
        self.target_checks.conflicts()
    }

    /// Name of a pin of the mesh or chart.
    pub fn pin_name(&self, vertex: VertexId) -> Option<&PinName> {
        self.document.notes.get(&vertex)?.name.as_ref()
    }

    /// Names of the pins of all charts, by their [keys](PinName::key).
    pub fn taken_names(&self) -> BTreeSet<String> {
        let elsewhere = self.document.elsewhere.values().flat_map(|edits| edits.notes.values());
        let notes = self.document.notes.values().chain(elsewhere);
        notes.filter_map(|note| note.name.as_ref()).map(PinName::key).collect()
    }

    /// Number of a vertex in files, with the name of its pin if it has one.
    pub fn pin_words(&self, vertex: VertexId) -> String {
        let number = self.number_of(vertex);
        self.pin_name(vertex).map_or_else(|| number.to_string(), |name| format!("{number} ({name})"))
    }

    /// Description of a conflict in one line, with the names of its pins.
    pub fn conflict_words(&self, conflict: &Conflict) -> String {
        conflict.words_with(|vertex| self.pin_words(vertex))
    }

    /// First conflict that involves a pin.
    pub fn conflict_of(&self, vertex: VertexId) -> Option<&Conflict> {
        self.conflicts().iter().find(|conflict| conflict.vertices().contains(&vertex))
    }

    /// True if the targets of the document look mirrored. Known some time after there are enough targets.
    pub fn targets_look_mirrored(&self) -> bool {
        let uses_pins = self.document.settings.method.uses_pins();
        uses_pins && self.target_checks.look_mirrored(self.model_revision(), &self.document.pins())
    }
}
