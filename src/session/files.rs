//! Files of the session: what is open and what is saved of it, what is being read, what is being written.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::action::Together;
use super::large::{LargeFile, Wanted};
use super::opened::{OpenError, Opened, Origin};
use super::recovery::Autosave;
use super::saving::{ProjectSaves, Request, picture_source, source_of};
use super::{Background, Document, Messages, Model, Place, RecentFiles, Session, Wake, Written};
use crate::examples::Example;
use crate::io::{ProjectFile, ProjectSource, ProjectView, RecoveryNote, WriteError};
use crate::mesh::Form;

/// How long the end of a session waits for files that a person asked for, which may be large.
const PATIENCE: Duration = Duration::from_mins(1);

/// What is open, apart from what is edited: what an edit is compared with.
#[derive(Debug, Default)]
struct OnTable {
    /// Counts what was opened.
    opening: u64,
    /// What to call work that no project and no mesh names.
    name: Option<String>,
    /// The project that it is saved to.
    project: Option<PathBuf>,
    /// The document as it was opened or saved; none where it is nowhere but here.
    saved: Option<Document>,
    /// The file of constraints that was imported last.
    constraints: Option<PathBuf>,
    /// The project's picture, where it could not be read: it stays in the project until there is another.
    missing_picture: Option<ProjectSource>,
    /// How the person looks at it, to be saved with it.
    view: ProjectView,
}

/// What is open, read and written.
pub(super) struct Files {
    table: OnTable,
    /// What is being opened.
    loading: Background<Wanted, Result<Opened, OpenError>>,
    /// The machine's memory, bytes: what may take more than half of it is opened once a person has said so.
    pub(super) memory: Option<u64>,
    /// What waits for that.
    pub(super) large: Option<LargeFile>,
    /// What follows once that is open.
    together: Option<Together>,
    /// Results being written.
    outputs: Background<(), Result<Written, WriteError>>,
    projects: ProjectSaves,
    /// The file whose folder is being shown.
    pub(super) shown: Background<PathBuf, Result<(), String>>,
    pub(super) autosave: Autosave,
    pub(super) recent: RecentFiles,
}

impl Files {
    pub(super) fn new(wake: &Wake, recent: RecentFiles) -> Self {
        Self {
            table: OnTable::default(),
            loading: Background::new("load", wake),
            memory: None,
            large: None,
            together: None,
            outputs: Background::new("save", wake),
            projects: ProjectSaves::new(wake),
            shown: Background::new("folder", wake),
            autosave: Autosave::new(wake),
            recent,
        }
    }

    /// What to call what is open.
    fn name(&self, model: Option<&Model>) -> Option<String> {
        let stem = self.table.project.as_ref().and_then(|path| path.file_stem());
        let stem = stem.map(|stem| stem.to_string_lossy().into_owned());
        stem.or_else(|| self.table.name.clone()).or_else(|| model.map(|model| model.name.clone()))
    }

    fn has_saved(&self, document: &Document) -> bool {
        self.table.saved.as_ref() == Some(document)
    }

    pub(super) fn is_loading(&self) -> bool {
        self.loading.is_busy()
    }

    /// Whether a file is being written that a person asked for.
    pub(super) fn is_saving(&self) -> bool {
        self.outputs.is_busy() || self.projects.is_busy()
    }

    /// The file of constraints that was imported last.
    pub(super) fn constraints(&self) -> Option<&PathBuf> {
        self.table.constraints.as_ref()
    }

    /// Remembers where constraints were imported from.
    pub(super) fn remember_constraints(&mut self, path: PathBuf) {
        self.table.constraints = Some(path);
    }

    /// The document as a project file holds it.
    pub(super) fn project_file(&self, model: &Model, document: &Document) -> Option<ProjectFile> {
        let mut project = ProjectFile::new(source_of(model)?, &document.settings);
        let Form { faces_turned, repair, holes, cut, seams, left_out } = document.form.clone();
        project.left_out_parts = left_out.iter().copied().collect();
        (project.faces_turned, project.repair, project.cut, project.seams) = (faces_turned, repair, cut, seams);
        project.weld_distance = repair.weld_distance();
        project.holes = Some(holes);
        project.relaxed = document.relaxed;
        project.picture = match &document.picture {
            Some(picture) => picture_source(picture, model),
            None => self.table.missing_picture.clone(),
        };
        project.v_axis = document.v_axis;
        project.targets = model.all_targets(document);
        project.chart = document.chart;
        project.packing = document.packing;
        project.sizes = document.sizes.iter().map(|(face, &size)| (face.number(), size)).collect();
        let relaxed = document.elsewhere.iter().filter(|(_, edits)| edits.relaxed > 0);
        project.relaxed_elsewhere = relaxed.map(|(&chart, edits)| (chart, edits.relaxed)).collect();
        project.view.clone_from(&self.table.view);
        Some(project)
    }
}

/// Reading.
impl Files {
    /// Opens a mesh file or a project.
    pub(super) fn open(&mut self, path: PathBuf) {
        self.begin(Wanted::File(path));
    }

    /// Opens something, with nothing that follows, and nothing else.
    fn begin(&mut self, wanted: Wanted) {
        self.together = None;
        self.load(wanted, self.memory);
    }

    pub(super) fn load(&mut self, wanted: Wanted, memory: Option<u64>) {
        self.large = None;
        self.loading.start(wanted.clone(), move |_| wanted.open(memory));
    }

    /// Nothing came of what was to be opened.
    pub(super) fn end_opening(&mut self) {
        self.together = None;
        self.autosave.give_up_claim();
    }

    /// Opens a mesh or a project; what belongs to it follows.
    pub(super) fn open_together(&mut self, files: Together) {
        self.open(files.mesh.clone());
        self.together = Some(files);
    }

    /// Opens a built-in mesh.
    pub(super) fn open_example(&mut self, example: Example) {
        self.begin(Wanted::Example(example));
    }

    /// Opens what a session before has left. It belongs to this session from now on.
    pub(super) fn recover(&mut self, path: PathBuf, messages: &mut Messages) {
        if self.autosave.claim(&path) {
            self.begin(Wanted::Recovery(path));
        } else {
            let text = format!("another session works with it already, or it is gone: {}", path.display());
            messages.fail(Place::Mesh, text, None);
        }
    }

    /// Opens nothing, whatever was asked for.
    pub(super) fn cancel_loading(&mut self) {
        self.loading.cancel();
        self.large = None;
        self.end_opening();
    }

    /// What has been read.
    pub(super) fn poll_loading(&mut self, messages: &mut Messages) -> Option<Opened> {
        let (wanted, loaded) = self.loading.poll()?;
        match loaded {
            Ok(Ok(opened)) => {
                if let Wanted::File(path) = wanted {
                    self.recent.remember(&path);
                }
                return Some(opened);
            }
            Ok(Err(OpenError::Memory { path, source })) => {
                self.large = Some(LargeFile { wanted, path, shortage: source });
                return None;
            }
            Ok(Err(error)) => messages.fail(Place::Mesh, error.to_string(), Some(error.remedy())),
            Err(failure) => messages.fail_background(Place::Mesh, "loading", &failure),
        }
        self.end_opening();
        None
    }

    /// What is to follow what was opened.
    pub(super) fn take_together(&mut self) -> Option<Together> {
        self.together.take()
    }

    /// Puts what was opened on the table, in the place of what was there.
    pub(super) fn put_on_table(&mut self, opened: &Opened) {
        let Opened { document, view, origin, missing_picture, is_partial, .. } = opened;
        let is_recovered = matches!(origin, Origin::Recovery(_));
        self.autosave.begin_anew(Some(document).filter(|_| is_recovered));
        let (name, project) = match origin {
            Origin::Mesh => (None, None),
            Origin::Project(path) => (None, Some(path.clone())),
            Origin::Recovery(note) => (Some(note.name.clone()), note.project.clone()),
        };
        self.table = OnTable {
            opening: self.table.opening + 1,
            name,
            // What is left out, the file keeps: saving asks for another place.
            project: project.filter(|_| !is_partial),
            saved: Some(document.clone()).filter(|_| !is_recovered),
            constraints: None,
            missing_picture: missing_picture.clone(),
            view: view.clone(),
        };
    }
}

/// Writing.
impl Files {
    /// Writes files that a person asked for.
    pub(super) fn write(&mut self, work: impl FnOnce() -> Result<Written, WriteError> + Send + 'static) {
        self.outputs.add((), move |_| work());
    }

    /// Saves the project, after those that were asked for before.
    pub(super) fn save_project(&mut self, path: PathBuf, project: ProjectFile, document: &Document) {
        let request = Request { path, document: document.clone(), opening: self.table.opening };
        self.projects.start(request, project);
    }

    /// Takes in what was written.
    pub(super) fn poll_saving(&mut self, messages: &mut Messages) {
        while let Some(((), written)) = self.outputs.poll() {
            match written {
                Ok(Ok(written)) => messages.note("wrote", written),
                Ok(Err(error)) => messages.fail(Place::Embedding, error.to_string(), None),
                Err(failure) => messages.fail_background(Place::Embedding, "saving", &failure),
            }
        }
        self.poll_folder(messages);
        while let Some(Request { path, document, opening }) = self.projects.poll(messages) {
            self.recent.remember(&path);
            messages.note("saved", Written::file(path.clone()));
            // Something else may have been opened meanwhile.
            if opening == self.table.opening {
                (self.table.project, self.table.saved) = (Some(path), Some(document));
            }
        }
    }

    /// Makes a copy of the document where one is due. Nothing is open without a model.
    pub(super) fn poll_copies(
        &mut self,
        now: Instant,
        model: Option<&Model>,
        document: &Document,
        messages: &mut Messages,
    ) {
        self.autosave.poll(messages);
        let Some(model) = model.filter(|_| !self.has_saved(document)) else { return self.autosave.leave_slot() };
        if self.autosave.is_due(now, document)
            && let Some(mut project) = self.project_file(model, document)
        {
            let name = self.name(Some(model)).unwrap_or_default();
            let at = self.table.project.as_ref().map(|path| std::path::absolute(path).unwrap_or_else(|_| path.clone()));
            project.recovery = Some(RecoveryNote { name, project: at });
            self.autosave.begin_copy(now, project, document, messages);
        }
    }
}

impl Session {
    /// Changes whenever something was opened. Unlike [`model_revision`](Self::model_revision) it stays where the same
    /// mesh is turned around, when no camera is to move.
    pub fn opening_revision(&self) -> u64 {
        self.files.table.opening
    }

    /// The files opened last.
    pub fn recent(&self) -> &RecentFiles {
        &self.files.recent
    }

    /// The project that the document is saved to.
    pub fn project_path(&self) -> Option<&PathBuf> {
        self.files.table.project.as_ref()
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
        self.files.projects.is_busy()
    }

    /// How the person looked at it when it was saved: for the screen to take over when
    /// [`opening_revision`](Self::opening_revision) changes.
    pub fn view(&self) -> &ProjectView {
        &self.files.table.view
    }

    /// Says how the person looks at it, to be saved with the project. A view alone is no unsaved work.
    pub fn set_view(&mut self, view: ProjectView) {
        self.files.table.view = view;
    }

    /// Waits until all files are written that were asked for, or the disk hangs. For the end of the program, which
    /// would break them off.
    pub fn finish_writing(&mut self) {
        let begun = Instant::now();
        while self.files.is_saving() && begun.elapsed() < PATIENCE {
            std::thread::sleep(Duration::from_millis(1));
            self.files.poll_saving(&mut self.messages);
        }
    }
}
