//! The session itself: one place where requests are carried out by its parts.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use super::drag::Drag;
use super::errands::Errands;
use super::files::Files;
use super::open_mesh::OpenMesh;
use super::solving::Solving;
use super::target_checks::TargetChecks;
use super::{
    Action, Command, Document, History, Message, Messages, Model, Outcome, Preview, RecentFiles, Recoverable, Stop,
    StopConditions, Timeline, Wake,
};
use crate::io::ProjectView;

/// One open document and the work on it.
pub struct Session {
    pub(super) mesh: OpenMesh,
    pub(super) document: Document,
    pub(super) history: History,
    /// The steps of the document's run.
    pub(super) solving: Solving,
    pub(super) drag: Drag,
    pub(super) errands: Errands,
    pub(super) target_checks: TargetChecks,
    pub(super) files: Files,
    pub(super) messages: Messages,
}

impl std::fmt::Debug for Session {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Session").field("document", &self.document).field("busy", &self.busy()).finish_non_exhaustive()
    }
}

/// What is asked.
impl Session {
    /// An empty session. `wake` is called from background threads when there is something to [`poll`](Self::poll).
    pub fn new(wake: Wake, recent: RecentFiles) -> Self {
        Self {
            mesh: OpenMesh::default(),
            document: Document::default(),
            history: History::default(),
            drag: Drag::new(&wake),
            errands: Errands::new(&wake),
            target_checks: TargetChecks::new(&wake),
            files: Files::new(&wake, recent),
            messages: Messages::default(),
            solving: Solving::new(wake),
        }
    }

    /// The open mesh.
    pub fn model(&self) -> Option<&Arc<Model>> {
        self.mesh.model()
    }

    /// Changes whenever another mesh is open, or the same one with its faces turned around.
    pub fn model_revision(&self) -> u64 {
        self.mesh.revision()
    }

    /// Changes whenever something was opened. Unlike [`model_revision`](Self::model_revision) it stays where the same
    /// mesh is turned around, when no camera is to move.
    pub fn opening_revision(&self) -> u64 {
        self.files.opening()
    }

    /// What the user edits.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Undo and redo.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// The steps that there are, and which of them is on the screen.
    pub fn timeline(&self) -> &Timeline {
        self.solving.timeline()
    }

    /// When a run that goes on by itself comes to rest.
    pub fn stop_conditions(&self) -> StopConditions {
        self.solving.stop_conditions()
    }

    /// Why the run is at rest, where that is not because of a person's wish.
    pub fn stopped(&self) -> Option<Stop> {
        self.solving.stopped()
    }

    /// The step on the screen.
    pub fn outcome(&self) -> Option<&Arc<Outcome>> {
        self.solving.outcome()
    }

    /// The step that the one on the screen is compared with.
    pub fn compared(&self) -> Option<&Arc<Outcome>> {
        self.timeline().outcome(self.timeline().compared()?)
    }

    /// Changes whenever another step is on the screen, or none any more.
    pub fn outcome_revision(&self) -> u64 {
        self.solving.outcome_revision()
    }

    /// What the screen shows while pins are dragged.
    pub fn preview(&self) -> Option<&Preview> {
        self.drag.preview()
    }

    /// Whether a run that goes on by itself would take a step.
    pub fn can_run(&self) -> bool {
        self.mesh.disk().is_some() && !(self.is_current() && self.solving.stopped_for_good().is_some())
    }

    /// Whether the newest step is planar, its constraints met, and its run waits to be taken on.
    pub fn can_relax(&self) -> bool {
        self.is_current() && self.solving.can_relax(&self.document.problem())
    }

    /// What has been said and not dismissed.
    pub fn messages(&self) -> &[Message] {
        self.messages.list()
    }

    /// The files opened last.
    pub fn recent(&self) -> &RecentFiles {
        self.files.recent()
    }

    /// The project that the document is saved to.
    pub fn project_path(&self) -> Option<&PathBuf> {
        self.files.project()
    }

    /// What to call what is open.
    pub fn project_name(&self) -> Option<String> {
        self.files.name(self.model().map(AsRef::as_ref))
    }

    /// Whether something would be lost if the session ended now.
    pub fn has_unsaved_work(&self) -> bool {
        self.model().is_some() && !self.files.has_saved(&self.document)
    }

    /// Whether a project is being written.
    pub fn is_saving_project(&self) -> bool {
        self.files.is_saving_project()
    }

    /// How the person looked at it when it was saved: for the screen to take over when
    /// [`opening_revision`](Self::opening_revision) changes.
    pub fn view(&self) -> &ProjectView {
        self.files.view()
    }

    /// Work that sessions before have left unsaved, newest first.
    pub fn recoverable(&self) -> &[Recoverable] {
        self.files.recoverable()
    }
}

/// What is done.
impl Session {
    /// Carries out a request. Work that takes time goes on in the background.
    pub fn handle(&mut self, action: Action) {
        match action {
            Action::Open(path) => self.files.open(path),
            Action::OpenExample(example) => self.files.open_example(example),
            Action::Recover(path) => self.files.recover(path, &mut self.messages),
            Action::DiscardRecovery(path) => self.files.discard_recovery(&path),
            Action::ClearRecent => self.files.clear_recent(),
            Action::Save(request) => self.save(request),
            Action::SaveProject(path) => self.save_project(path),
            Action::ExportConstraints(path) => self.export_constraints(path),
            Action::RefuseName(path) => self.refuse_name(&path),
            Action::Dismiss(id) => self.messages.dismiss(id),
            Action::Solve => self.solve(),
            Action::Step => self.step(),
            Action::Run => self.run_on(),
            Action::Relax => self.relax(),
            Action::Rest => self.rest(),
            Action::EndGesture => self.end_gesture(),
            Action::Cancel => self.cancel(),
            Action::ShowStep(index) => self.solving.show(index),
            Action::Compare(index) => self.solving.compare(index),
            Action::SetStop(stop) => self.solving.set_stop(stop),
            Action::GiveUpGesture => self.travel(History::give_up_gesture),
            Action::Undo => self.travel(History::undo),
            Action::Redo => self.travel(History::redo),
            Action::Fix(vertices) => self.fix(&vertices),
            Action::OpenPicture(path) => self.open_picture(path),
            Action::RemovePicture => self.edit(vec![Command::SetPicture(None)]),
            Action::SetVAxis(v_axis) => self.edit(vec![Command::SetVAxis(v_axis)]),
            Action::TurnFaces => self.turn_faces(),
            Action::MirrorTargets => self.mirror_targets(),
            Action::FitTargets => self.fit_targets(),
            Action::ImportConstraints(path) => self.import_constraints(path),
            Action::Place { vertex, target } => self.place(vertex, target),
            Action::MovePin { vertex, target } => self.move_pins(&[(vertex, target)]),
            Action::MovePins(moves) => self.move_pins(&moves),
            Action::SetHold { vertices, hold } => self.set_hold(&vertices, hold),
            Action::SlideHold { vertices, hold } => self.slide_hold(&vertices, hold),
            Action::Unpin(vertices) => self.unpin(&vertices),
            Action::UnpinAll => self.unpin(&self.document.targets.keys().copied().collect::<Vec<_>>()),
            Action::SetSettings(settings) => self.edit(vec![Command::SetSettings(settings)]),
            Action::SlideSettings(settings) => self.slide_settings(settings),
        }
    }

    /// Takes in what the background has finished. Call once per frame.
    pub fn poll(&mut self) {
        self.poll_at(Instant::now());
    }

    /// As [`poll`](Self::poll), at a time of the caller's: copies for recovery are made every few seconds.
    pub fn poll_at(&mut self, now: Instant) {
        if let Some(opened) = self.files.poll_loading(&mut self.messages) {
            self.take_opened(opened);
        }
        self.poll_errands();
        self.poll_solving();
        self.poll_drag();
        self.target_checks.refresh(&self.mesh, &self.document);
        self.files.poll_saving(&mut self.messages);
        self.files.poll_copies(now, self.mesh.model().map(AsRef::as_ref), &self.document, &mut self.messages);
    }

    /// Goes to another state of the document, and solves where there is one.
    fn travel(&mut self, to: impl FnOnce(&mut History, &mut Document) -> bool) {
        if to(&mut self.history, &mut self.document) {
            self.solve();
        }
    }

    fn cancel(&mut self) {
        self.files.cancel_loading();
        self.drag.stop_following();
        self.errands.forget();
        self.solving.pause();
    }

    /// Says how the person looks at it, to be saved with the project. A view alone is no unsaved work.
    pub fn set_view(&mut self, view: ProjectView) {
        self.files.set_view(view);
    }

    /// Makes copies for recovery in a folder from now on, and looks at what is there.
    pub fn keep_copies_in(&mut self, folder: PathBuf) {
        self.files.keep_copies_in(folder);
    }

    /// Waits until all files are written that were asked for, or the disk hangs. For the end of the program, which
    /// would break them off.
    pub fn finish_writing(&mut self) {
        self.files.finish_writing(&mut self.messages);
    }

    /// Ends the session as a person wishes: what is not saved is not wanted. A session that is merely dropped leaves
    /// its copy behind.
    pub fn close(&mut self) {
        self.files.close();
    }
}
