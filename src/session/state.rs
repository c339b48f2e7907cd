//! The session itself: one place where requests are carried out.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use super::autosave::Autosave;
use super::conflicts::Conflicts;
use super::errands::Errands;
use super::files::SaveJob;
use super::mirrored::Undistorted;
use super::open::OnTable;
use super::opened::{OpenError, Opened};
use super::preview::{Follow, FollowJob, VerdictJob};
use super::project::ProjectSaves;
use super::run::Running;
use super::{
    Action, Command, Document, History, Job, Message, Model, Outcome, Place, Preview, RecentFiles, Severity,
    StopConditions, Timeline, Wake,
};
use crate::io::ProjectView;
use crate::mesh::VertexId;
use crate::solver::{Ending, Kept, Ladder, Phase, Settings};

pub(super) type LoadJob = Job<(), Result<Opened, OpenError>>;

/// What goes on in the background.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Busy {
    /// Reading and diagnosing a mesh, or reading something for it.
    Loading,
    /// Solving; the phase where it is known.
    Solving(Option<Phase>),
    /// Writing a file.
    Saving,
}

/// One open document and the work on it.
pub struct Session {
    pub(super) wake: Wake,
    pub(super) model: Option<Arc<Model>>,
    /// The mesh with its faces the other way around, once somebody turned them.
    pub(super) other_side: Option<Arc<Model>>,
    /// What is open, and what is saved of it.
    pub(super) on_table: OnTable,
    /// How the person looks at it, to be saved with it.
    pub(super) view: ProjectView,
    /// Counts the meshes opened and turned around, so that a screen can tell when to draw anew.
    pub(super) model_revision: u64,
    pub(super) document: Document,
    pub(super) history: History,
    /// The steps on the screen: those of the document's run, once it has any.
    pub(super) timeline: Timeline,
    /// Changes with the step on the screen, for the same reason.
    pub(super) outcome_revision: u64,
    /// What the run says after the newest step.
    pub(super) ending: Option<Ending>,
    pub(super) stop: StopConditions,
    /// What the screen shows while a pin is dragged.
    pub(super) preview: Option<Preview>,
    /// Counts previews.
    pub(super) preview_revision: u64,
    /// What a drag was solved for, and what is being solved for it.
    pub(super) follow: Option<Follow>,
    pub(super) follow_job: Option<(Document, Vec<VertexId>, FollowJob)>,
    /// The verdict on a preview that is under way, by its revision.
    pub(super) verdict_job: Option<(u64, VerdictJob)>,
    /// Kept from ladders on this mesh, for the next one and while a pin is dragged.
    pub(super) kept: Kept,
    pub(super) loading: Option<LoadJob>,
    /// The file that is being loaded, to be remembered once it is open.
    pub(super) loading_path: Option<PathBuf>,
    /// The run that takes steps in the background.
    pub(super) running: Option<Running>,
    /// The run that waits to be taken on.
    pub(super) resting: Option<Ladder>,
    /// Whether the document changed since the step under way began.
    pub(super) solve_again: bool,
    /// What is known to be amiss with the constraints before they are solved for.
    pub(super) conflicts: Conflicts,
    /// What the targets are compared with.
    pub(super) undistorted: Undistorted,
    pub(super) errands: Errands,
    /// Files being written, in the order they were asked for.
    pub(super) saving: Vec<SaveJob>,
    pub(super) project_saves: ProjectSaves,
    pub(super) autosave: Autosave,
    pub(super) messages: Vec<Message>,
    /// The message of the last solve, where it failed: the next one that succeeds takes it away.
    pub(super) solve_message: Option<u64>,
    pub(super) next_message: u64,
    pub(super) recent: RecentFiles,
}

impl std::fmt::Debug for Session {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Session").field("document", &self.document).field("busy", &self.busy()).finish_non_exhaustive()
    }
}

impl Session {
    /// An empty session. `wake` is called from background threads when there is something to [`poll`](Self::poll).
    pub fn new(wake: Wake, recent: RecentFiles) -> Self {
        Self {
            wake,
            model: None,
            other_side: None,
            on_table: OnTable::default(),
            view: ProjectView::default(),
            model_revision: 0,
            document: Document::default(),
            history: History::default(),
            timeline: Timeline::default(),
            outcome_revision: 0,
            ending: None,
            stop: StopConditions::default(),
            preview: None,
            preview_revision: 0,
            follow: None,
            follow_job: None,
            verdict_job: None,
            kept: Kept::default(),
            loading: None,
            loading_path: None,
            running: None,
            resting: None,
            solve_again: false,
            conflicts: Conflicts::default(),
            undistorted: Undistorted::default(),
            errands: Errands::default(),
            saving: Vec::new(),
            project_saves: ProjectSaves::default(),
            autosave: Autosave::default(),
            messages: Vec::new(),
            solve_message: None,
            next_message: 0,
            recent,
        }
    }

    /// The open mesh.
    pub fn model(&self) -> Option<&Arc<Model>> {
        self.model.as_ref()
    }

    /// Changes whenever another mesh is open, or the same one with its faces turned around.
    pub fn model_revision(&self) -> u64 {
        self.model_revision
    }

    /// Changes whenever something was opened. Unlike [`model_revision`](Self::model_revision) it stays where the same
    /// mesh is turned around, when no camera is to move.
    pub fn opening_revision(&self) -> u64 {
        self.on_table.opening
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
        &self.timeline
    }

    /// When a run that goes on by itself comes to rest.
    pub fn stop_conditions(&self) -> StopConditions {
        self.stop
    }

    /// The step on the screen.
    pub fn outcome(&self) -> Option<&Arc<Outcome>> {
        self.timeline.outcome(self.timeline.shown()?)
    }

    /// The step that the one on the screen is compared with.
    pub fn compared(&self) -> Option<&Arc<Outcome>> {
        self.timeline.outcome(self.timeline.compared()?)
    }

    /// Changes whenever another step is on the screen, or none any more.
    pub fn outcome_revision(&self) -> u64 {
        self.outcome_revision
    }

    /// Whether the outcome on the screen belongs to the document as it is now.
    pub fn is_current(&self) -> bool {
        self.has_faces_as_wanted() && self.outcome().is_some_and(|outcome| self.document.is_solved_in(outcome))
    }

    /// Whether the screen shows the first solve alone, because a gesture goes on or its run has only begun.
    pub fn is_preview(&self) -> bool {
        self.preview.is_some() || (self.history.is_in_gesture() && self.is_at_first_step())
    }

    /// Whether a run waits after its first step for a person to take the others.
    pub fn is_held(&self) -> bool {
        let is_at_rest = self.running.is_none() && !self.history.is_in_gesture();
        is_at_rest && self.is_current() && self.is_at_first_step()
    }

    fn is_at_first_step(&self) -> bool {
        self.timeline.records().len() == 1 && self.ending.is_none()
    }

    /// What goes on in the background.
    pub fn busy(&self) -> Option<Busy> {
        if self.loading.is_some() || self.errands.is_busy() {
            return Some(Busy::Loading);
        }
        if let Some(running) = &self.running {
            return Some(Busy::Solving(running.phase()));
        }
        (!self.saving.is_empty() || self.project_saves.is_busy()).then_some(Busy::Saving)
    }

    /// Whether what a drag needs is being computed: its column, or the verdict on its preview. That is no work to wait
    /// for: it goes on as long as the drag.
    pub fn is_following(&self) -> bool {
        self.follow_job.is_some() || self.verdict_job.is_some()
    }

    /// Whether a run takes steps in the background.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// What has been said and not dismissed.
    pub fn messages(&self) -> &[Message] {
        &self.messages
    }

    /// The files opened last.
    pub fn recent(&self) -> &RecentFiles {
        &self.recent
    }

    /// Carries out a request. Work that takes time goes on in the background.
    pub fn handle(&mut self, action: Action) {
        match action {
            Action::Open(path) => self.open(path),
            Action::OpenExample(example) => self.open_example(example),
            Action::ClearRecent => self.recent.clear(),
            Action::Fix(vertices) => self.fix(&vertices),
            Action::OpenPicture(path) => self.open_picture(path),
            Action::TurnFaces => self.turn_faces(),
            Action::MirrorTargets => self.mirror_targets(),
            Action::FitTargets => self.fit_targets(),
            Action::ImportConstraints(path) => self.import_constraints(path),
            Action::ExportConstraints(path) => self.export_constraints(path),
            Action::SaveProject(path) => self.save_project(path),
            Action::Recover(path) => self.recover(path),
            Action::DiscardRecovery(path) => self.discard_recovery(&path),
            Action::Rest => self.rest(),
            Action::RemovePicture => self.edit(vec![Command::SetPicture(None)]),
            Action::SetVAxis(v_axis) => self.edit(vec![Command::SetVAxis(v_axis)]),
            Action::Place { vertex, target } => self.place(vertex, target),
            Action::MovePin { vertex, target } => self.move_pins(&[(vertex, target)]),
            Action::MovePins(moves) => self.move_pins(&moves),
            Action::SetHold { vertices, hold } => self.set_hold(&vertices, hold),
            Action::SlideHold { vertices, hold } => self.slide_hold(&vertices, hold),
            Action::EndGesture => self.end_gesture(),
            Action::Unpin(vertices) => self.unpin(&vertices),
            Action::UnpinAll => self.unpin(&self.document.targets.keys().copied().collect::<Vec<_>>()),
            Action::SetSettings(settings) => self.edit(vec![Command::SetSettings(settings)]),
            Action::SlideSettings(settings) => self.slide_settings(settings),
            Action::GiveUpGesture => self.travel(History::give_up_gesture),
            Action::Undo => self.travel(History::undo),
            Action::Redo => self.travel(History::redo),
            Action::Solve => self.solve(),
            Action::Step => self.step(),
            Action::Run => self.run_on(),
            Action::Relax => self.relax(),
            Action::ShowStep(index) => {
                if self.timeline.show(index) {
                    self.outcome_revision += 1;
                }
            }
            Action::Compare(index) => self.timeline.compare(index),
            Action::SetStop(stop) => self.set_stop(stop),
            Action::Cancel => self.cancel(),
            Action::Save(request) => self.save(request),
            Action::RefuseName(path) => {
                let text = format!("{} does not say what to write", path.display());
                self.fail(Place::Embedding, text, Some("end the name in .svg, .png, .json or .obj"));
            }
            Action::Dismiss(id) => self.messages.retain(|message| message.id != id),
        }
    }

    fn slide_settings(&mut self, settings: Settings) {
        if settings != self.document.settings {
            self.history.apply_in_gesture(Command::SetSettings(settings), &mut self.document);
            self.solve();
        }
    }

    /// Goes to another state of the document, and solves where there is one.
    fn travel(&mut self, to: impl FnOnce(&mut History, &mut Document) -> bool) {
        if to(&mut self.history, &mut self.document) {
            self.solve();
        }
    }

    /// Takes in what the background has finished. Call once per frame.
    pub fn poll(&mut self) {
        self.poll_at(Instant::now());
    }

    /// As [`poll`](Self::poll), at a time of the caller's: copies for recovery are made every few seconds.
    pub fn poll_at(&mut self, now: Instant) {
        self.poll_loading();
        self.poll_errands();
        self.poll_running();
        self.poll_following();
        self.refresh_conflicts();
        self.poll_undistorted();
        self.poll_saving();
        self.poll_project_saves();
        self.poll_autosave(now);
    }

    fn cancel(&mut self) {
        // Dropping the job raises its flag; whatever it still computes is not looked at.
        (self.loading, self.follow_job) = (None, None);
        self.autosave.give_up_claim();
        self.forget_errands();
        self.pause();
    }

    pub(super) fn fail(&mut self, place: Place, text: String, remedy: Option<&str>) {
        let id = self.next_id();
        let remedy = remedy.map(str::to_owned);
        self.messages.push(Message { id, severity: Severity::Error, place, text, remedy, vertices: Vec::new() });
    }

    pub(super) fn next_id(&mut self) -> u64 {
        self.next_message += 1;
        self.next_message
    }

    pub(super) fn waker(&self) -> impl FnOnce() + Send + 'static {
        let wake = Arc::clone(&self.wake);
        move || wake()
    }
}

/// What to do about a panic.
pub(super) const REPORT_IT: &str = "this is a bug in Freebound: please report it with the mesh";

pub(super) fn lost(what: &str) -> String {
    format!("{what} stopped unexpectedly")
}
