//! The session itself: one place where requests are carried out.

use std::path::PathBuf;
use std::sync::Arc;

use super::{Action, Command, Document, History, Job, Message, Model, Outcome, Place, Poll, RecentFiles, Severity};
use crate::io::{ReadError, StepReport, WriteError};
use crate::mesh::VertexId;
use crate::solver::{Control, Phase, Prepared, Run, Settings, SolveError, Verdict};

/// Asks the screen to look again; called from background threads.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

pub(super) type LoadJob = Job<(), Result<Model, ReadError>>;
type SolveJob = Job<Phase, Result<Solved, SolveError>>;
pub(super) type SaveJob = Job<(), Result<(PathBuf, Verdict), WriteError>>;

/// What goes on in the background.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Busy {
    /// Reading and diagnosing a mesh.
    Loading,
    /// Solving; the phase where it is known.
    Solving(Option<Phase>),
    /// Writing a file.
    Saving,
}

/// What a finished run leaves.
struct Solved {
    outcome: Outcome,
    records: Vec<StepReport>,
    prepared: Option<Arc<Prepared>>,
}

/// A solve that runs, and what it was asked for.
pub(super) struct Solving {
    job: SolveJob,
    settings: Settings,
    pinned: Vec<VertexId>,
    phase: Option<Phase>,
}

/// One open document and the work on it.
pub struct Session {
    pub(super) wake: Wake,
    pub(super) model: Option<Arc<Model>>,
    /// Counts the meshes opened, so that a screen can tell when to draw anew.
    pub(super) model_revision: u64,
    pub(super) document: Document,
    pub(super) history: History,
    pub(super) outcome: Option<Arc<Outcome>>,
    pub(super) records: Vec<StepReport>,
    /// Counts the outcomes, for the same reason.
    pub(super) outcome_revision: u64,
    /// Kept from solves that succeeded, to be used again while a pin is dragged.
    pub(super) prepared: Option<Arc<Prepared>>,
    pub(super) loading: Option<LoadJob>,
    /// The file that is being loaded, to be remembered once it is open.
    pub(super) loading_path: Option<PathBuf>,
    pub(super) solving: Option<Solving>,
    /// Whether the document changed since the running solve began.
    pub(super) solve_again: bool,
    /// Files being written, in the order they were asked for.
    pub(super) saving: Vec<SaveJob>,
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
            model_revision: 0,
            document: Document::default(),
            history: History::default(),
            outcome: None,
            records: Vec::new(),
            outcome_revision: 0,
            prepared: None,
            loading: None,
            loading_path: None,
            solving: None,
            solve_again: false,
            saving: Vec::new(),
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

    /// Changes whenever another mesh is open.
    pub fn model_revision(&self) -> u64 {
        self.model_revision
    }

    /// What the user edits.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Undo and redo.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// The newest finished solve.
    pub fn outcome(&self) -> Option<&Arc<Outcome>> {
        self.outcome.as_ref()
    }

    /// Changes whenever there is another outcome, or none any more.
    pub fn outcome_revision(&self) -> u64 {
        self.outcome_revision
    }

    /// Whether the outcome on the screen belongs to the document as it is now.
    pub fn is_current(&self) -> bool {
        self.outcome.as_ref().is_some_and(|outcome| {
            outcome.settings == self.document.settings
                && (!self.document.settings.method.uses_pins() || outcome.pins == self.document.pins)
        })
    }

    /// What goes on in the background.
    pub fn busy(&self) -> Option<Busy> {
        if self.loading.is_some() {
            return Some(Busy::Loading);
        }
        if let Some(solving) = &self.solving {
            return Some(Busy::Solving(solving.phase));
        }
        self.saving.first().map(|_| Busy::Saving)
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
            Action::Open(path) => self.open(Some(path.clone()), move || Model::read(&path)),
            Action::OpenExample(example) => self.open(None, move || Ok(Model::example(example))),
            Action::ClearRecent => self.recent.clear(),
            Action::Fix(vertices) => self.fix(&vertices),
            Action::MovePin { vertex, target } => self.move_pin(vertex, target),
            Action::EndGesture => self.history.end_gesture(),
            Action::GiveUpGesture => {
                if self.history.give_up_gesture(&mut self.document) {
                    self.solve();
                }
            }
            Action::Unpin(vertices) => self.unpin(&vertices),
            Action::UnpinAll => self.unpin(&self.document.pins.keys().copied().collect::<Vec<_>>()),
            Action::SetSettings(settings) => {
                if settings != self.document.settings {
                    self.history.apply(Command::SetSettings(settings), &mut self.document);
                    self.solve();
                }
            }
            Action::SlideSettings(settings) => {
                if settings != self.document.settings {
                    self.history.apply_in_gesture(Command::SetSettings(settings), &mut self.document);
                    self.solve();
                }
            }
            Action::Undo => {
                if self.history.undo(&mut self.document) {
                    self.solve();
                }
            }
            Action::Redo => {
                if self.history.redo(&mut self.document) {
                    self.solve();
                }
            }
            Action::Solve => self.solve(),
            Action::Cancel => self.cancel(),
            Action::Save(request) => self.save(request),
            Action::RefuseName(path) => {
                let text = format!("{} does not say what to write", path.display());
                self.fail(Place::Embedding, text, Some("end the name in .svg, .png, .json or .obj"));
            }
            Action::Dismiss(id) => self.messages.retain(|message| message.id != id),
        }
    }

    /// Takes in what the background has finished. Call once per frame.
    pub fn poll(&mut self) {
        self.poll_loading();
        self.poll_solving();
        self.poll_saving();
    }

    fn fix(&mut self, vertices: &[VertexId]) {
        let Some(outcome) = self.outcome.clone() else { return };
        if !self.document.settings.method.uses_pins() {
            let text = "a convex boundary takes no pins: every boundary vertex has its place".to_owned();
            return self.fail(Place::Embedding, text, Some("choose another method to pin vertices"));
        }
        let fresh = vertices.iter().filter(|v| !self.document.pins.contains_key(v));
        let pin = |&vertex: &VertexId| Command::SetPin {
            vertex,
            target: outcome.step.solution.embedding.get(vertex.index()).copied(),
        };
        let commands: Vec<Command> = fresh.map(pin).collect();
        if !commands.is_empty() {
            self.history.apply(Command::Together(commands), &mut self.document);
            self.solve();
        }
    }

    fn move_pin(&mut self, vertex: VertexId, target: glam::DVec2) {
        if !self.document.pins.contains_key(&vertex) {
            // A gauge pin: from here on all of them are the user's, each where it lies.
            let Some(outcome) = &self.outcome else { return };
            let adopt = |(&vertex, &target)| Command::SetPin { vertex, target: Some(target) };
            let adopted: Vec<Command> = outcome.step.solution.pins.iter().map(adopt).collect();
            self.history.apply_in_gesture(Command::Together(adopted), &mut self.document);
        }
        self.history.apply_in_gesture(Command::SetPin { vertex, target: Some(target) }, &mut self.document);
        self.solve();
    }

    fn unpin(&mut self, vertices: &[VertexId]) {
        let pinned = vertices.iter().filter(|v| self.document.pins.contains_key(v));
        let commands: Vec<Command> = pinned.map(|&vertex| Command::SetPin { vertex, target: None }).collect();
        if !commands.is_empty() {
            self.history.apply(Command::Together(commands), &mut self.document);
            self.solve();
        }
    }

    /// Starts a solve, or lets the running one finish first where it only has other targets: then a pin that is
    /// dragged is followed at the pace of the solver. Any other running solve is replaced.
    pub(super) fn solve(&mut self) {
        let Some(disk) = self.model.as_ref().and_then(|model| model.disk()).map(Arc::clone) else { return };
        let pinned: Vec<VertexId> = self.document.pins.keys().copied().collect();
        if let Some(running) = &self.solving
            && running.settings == self.document.settings
            && running.pinned == pinned
        {
            self.solve_again = true;
            return;
        }
        self.solve_again = false;
        let Document { pins, settings } = self.document.clone();
        let prepared = self.prepared.clone();
        let work = move |context: &super::JobContext<Phase>| {
            let report = |phase| context.report(phase);
            let control = Control::new(context.cancel_flag(), &report);
            let mut run = Run::new(settings, pins).with_prepared(prepared);
            let (mut steps, mut records, mut prepared) = (None, Vec::new(), None);
            run.finish(&disk, control, |step| {
                records.push(StepReport::of(&step));
                prepared = prepared.take().or(step.prepared.clone());
                steps = Some(step);
            })?;
            let outcome = Outcome::new(&disk, &run, steps.expect("a run has a first step"));
            Ok(Solved { outcome, records, prepared })
        };
        match Job::spawn("solve", self.waker(), work) {
            Ok(job) => self.solving = Some(Solving { job, settings, pinned, phase: None }),
            Err(error) => self.fail(Place::Embedding, format!("no thread to solve with: {error}"), None),
        }
    }

    fn poll_solving(&mut self) {
        let Some(solving) = &mut self.solving else { return };
        solving.phase = solving.job.latest_progress().or(solving.phase);
        let solved = match solving.job.poll() {
            Poll::Running => return,
            Poll::Done(solved) => solved,
            Poll::Lost => {
                self.solving = None;
                return self.fail(Place::Embedding, lost("solving"), Some(REPORT_IT));
            }
        };
        self.solving = None;
        match solved {
            Ok(Solved { outcome, records, prepared }) => {
                self.forget_solve_message();
                self.prepared = prepared;
                self.records = records;
                self.outcome = Some(Arc::new(outcome));
                self.outcome_revision += 1;
            }
            Err(SolveError::Cancelled) => {}
            Err(error) => {
                self.forget_solve_message();
                self.fail(Place::Embedding, error.to_string(), None);
                self.solve_message = Some(self.next_message);
            }
        }
        if std::mem::take(&mut self.solve_again) {
            self.solve();
        }
    }

    /// Takes away what a solve before said, and that a file was written which no longer shows what is on the screen.
    fn forget_solve_message(&mut self) {
        let stale = self.solve_message.take();
        self.messages.retain(|message| Some(message.id) != stale && message.severity != Severity::Note);
    }

    fn cancel(&mut self) {
        self.loading = None;
        // Dropping the job raises its flag; whatever it still computes is not looked at.
        self.solving = None;
        self.solve_again = false;
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
