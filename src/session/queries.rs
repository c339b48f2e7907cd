//! Questions to the session that its parts answer.

use std::path::PathBuf;
use std::sync::Arc;

use super::{
    JobFailure, LargeFile, Message, MessagePlace, Model, RecentFiles, Recoverable, RunStop, Session, StopConditions,
    Timeline,
};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::Outcome;
use freebound_core::problem::Pins;
use freebound_core::verify::Conflict;
use freebound_io::ProjectView;

/// The open mesh.
impl Session {
    /// The open mesh.
    pub fn model(&self) -> Option<&Arc<Model>> {
        self.mesh.model()
    }

    /// Changes whenever another mesh is open, or the same one in another form.
    pub fn model_revision(&self) -> u64 {
        self.mesh.revision()
    }

    /// The open mesh, where it is a disk.
    pub(super) fn disk(&self) -> Option<&Arc<DiskMesh>> {
        self.model()?.disk()
    }

    /// Number of vertices of the open mesh; zero if nothing is open.
    pub(super) fn vertex_count(&self) -> usize {
        self.model().map_or(0, |model| model.vertex_count())
    }

    /// True if the chart on the screen is the one that the document wants.
    pub(super) fn has_chart_as_wanted(&self) -> bool {
        self.model().is_none_or(|model| model.is_chart(self.document.chart))
    }

    /// True if the mesh has the form that the document wants, and is the chart that it wants. Where nothing is open,
    /// there is none.
    pub(super) fn has_form_as_wanted(&self) -> bool {
        self.has_numbers_as_wanted() && self.has_chart_as_wanted()
    }

    /// True if the mesh has the form that the document wants, so that vertices and charts have the numbers that the document has
    /// for them, whichever chart is on the screen.
    pub(super) fn has_numbers_as_wanted(&self) -> bool {
        self.model().is_none_or(|model| model.prepared.form == self.document.form)
    }
}

/// Files.
impl Session {
    /// Changes whenever something was opened. Unlike [`model_revision`](Self::model_revision) it stays where the same
    /// mesh is turned around, when no camera is to move.
    pub fn opening_revision(&self) -> u64 {
        self.files.opening()
    }

    /// The files opened last.
    pub fn recent(&self) -> &RecentFiles {
        self.files.recent()
    }

    /// The project that the document is saved to.
    pub fn project_path(&self) -> Option<&PathBuf> {
        self.files.project()
    }

    /// Name of the open document, if one is open.
    pub fn project_name(&self) -> Option<String> {
        self.files.name(self.model().map(AsRef::as_ref))
    }

    /// True if something would be lost if the session ended now.
    pub fn has_unsaved_work(&self) -> bool {
        self.model().is_some() && !self.files.has_saved(&self.document)
    }

    /// True if a project is being written.
    pub fn is_saving_project(&self) -> bool {
        self.files.is_saving_project()
    }

    /// View that was saved with the document, for the screen to take over when
    /// [`opening_revision`](Self::opening_revision) changes.
    pub fn view(&self) -> &ProjectView {
        self.files.view()
    }

    /// Says how the person looks at it, to be saved with the project. A view alone is no unsaved work.
    pub fn set_view(&mut self, view: ProjectView) {
        self.files.set_view(view);
    }

    /// Waits until all files are written that were asked for, or the disk hangs. For the end of the program, which
    /// would break them off.
    pub fn finish_writing(&mut self) {
        self.files.finish_writing(&mut self.messages);
    }

    /// Asks before it opens what may take more than half of this memory, bytes.
    pub fn heed_memory(&mut self, bytes: u64) {
        self.files.set_memory(bytes);
    }

    /// The file that waits for [`Action::OpenLarge`](super::Action::OpenLarge) or
    /// [`Action::LeaveLarge`](super::Action::LeaveLarge).
    pub fn large_file(&self) -> Option<&LargeFile> {
        self.files.large()
    }

    /// Makes copies for recovery in a folder from now on, and looks at what is there.
    pub fn keep_copies_in(&mut self, folder: PathBuf) {
        self.files.autosave_mut().keep_in(folder);
    }

    /// Work that sessions before have left unsaved, newest first.
    pub fn recoverable(&self) -> &[Recoverable] {
        self.files.autosave().found()
    }

    /// Ends the session as a person wishes: what is not saved is not wanted, so the copy is deleted, and no further one
    /// made. A session that is merely dropped leaves its copy behind.
    pub fn close(&mut self) {
        self.files.autosave_mut().close();
    }
}

/// Messages.
impl Session {
    /// Messages that were not dismissed, oldest first.
    pub fn messages(&self) -> &[Message] {
        self.messages.list()
    }

    /// Says that work in the background gave no outcome. `work` is a noun, such as "drawing".
    pub fn tell_failure(&mut self, place: MessagePlace, work: &str, failure: &JobFailure) {
        self.messages.fail_background(place, work, failure);
    }

    /// Says beside the embedding that something did not work, and what to do about it.
    pub(super) fn complain(&mut self, text: impl Into<String>, remedy: Option<&str>) {
        self.messages.fail(MessagePlace::Embedding, text, remedy);
    }
}

/// Steps.
impl Session {
    /// The steps that there are, and which of them is on the screen.
    pub fn timeline(&self) -> &Timeline {
        self.solving.timeline()
    }

    /// The step on the screen.
    pub fn outcome(&self) -> Option<&Arc<Outcome>> {
        self.timeline().outcome(self.timeline().shown()?)
    }

    /// The step that the one on the screen is compared with.
    pub fn compared(&self) -> Option<&Arc<Outcome>> {
        self.timeline().outcome(self.timeline().compared()?)
    }

    /// Changes whenever another step is on the screen, or none any more.
    pub fn outcome_revision(&self) -> u64 {
        self.solving.outcome_revision()
    }

    /// When a run that goes on by itself comes to rest.
    pub fn stop_conditions(&self) -> StopConditions {
        self.solving.stop_conditions()
    }

    /// True if a run takes steps in the background.
    pub fn is_running(&self) -> bool {
        self.solving.is_running()
    }

    /// Reason why the run stopped, unless a person stopped it.
    pub fn stopped(&self) -> Option<RunStop> {
        self.solving.stopped()
    }
}

/// Targets.
impl Session {
    /// Brings what is known of the targets up to date. Call once per frame.
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

    /// Constraints of the document that contradict each other on the mesh as it is.
    pub fn conflicts(&self) -> &[Conflict] {
        self.target_checks.conflicts()
    }

    /// The first conflict that a pin takes part in.
    pub fn conflict_of(&self, vertex: VertexId) -> Option<&Conflict> {
        self.conflicts().iter().find(|conflict| conflict.vertices().contains(&vertex))
    }

    /// True if the targets of the document look mirrored: known only some time after there are enough of them.
    pub fn targets_look_mirrored(&self) -> bool {
        let uses_pins = self.document.settings.method.uses_pins();
        uses_pins && self.target_checks.look_mirrored(self.model_revision(), &self.document.pins())
    }
}
