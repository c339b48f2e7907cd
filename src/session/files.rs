//! Files of the session: files that are open, being read and being written.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use super::action::UndoGroup;
use super::exports::Export;
use super::folder::FolderViewer;
use super::large::{LargeFile, LocatedFile, MissingMesh, OpenRequest};
use super::open_project::OpenProject;
use super::opened::{OpenError, Opened, Origin};
use super::recovery::Autosave;
use super::saving::{ProjectSaves, Request, project_of};
use super::{Background, Document, Message, MessagePlace, Messages, Model, RecentFiles, Wake, Written};
use crate::examples::Example;
use freebound_io::{ProjectFile, ProjectSource, ProjectView, RecoveryNote, WriteError};

/// Maximum time that the end of a session waits for files that the user writes, which may be large.
pub(super) const PATIENCE: Duration = Duration::from_mins(1);

/// State of open files, of reading and of writing.
pub(super) struct Files {
    table: OpenProject,
    /// Job that opens a file.
    loading: Background<OpenRequest, Result<Opened, OpenError>>,
    /// Memory of the machine, bytes. Files that may take more than half of it need a confirmation.
    memory: Option<u64>,
    /// File that waits for a confirmation.
    large: Option<LargeFile>,
    /// Project that was not opened because its mesh does not exist.
    missing_mesh: Option<MissingMesh>,
    /// Files that are opened after the mesh.
    together: Option<UndoGroup>,
    /// Jobs that write results.
    outputs: Background<(), Result<Written, WriteError>>,
    projects: ProjectSaves,
    /// Exports that wait until all charts are solved.
    awaited: Vec<Export>,
    folder: FolderViewer,
    autosave: Autosave,
    recent: RecentFiles,
}

impl Files {
    pub(super) fn new(wake: &Wake, recent: RecentFiles) -> Self {
        Self {
            table: OpenProject::default(),
            loading: Background::new("load", wake),
            memory: None,
            large: None,
            missing_mesh: None,
            together: None,
            outputs: Background::new("save", wake),
            projects: ProjectSaves::new(wake),
            awaited: Vec::new(),
            folder: FolderViewer::new(wake),
            autosave: Autosave::new(wake),
            recent,
        }
    }

    /// Name of the open document.
    pub(super) fn name(&self, model: Option<&Model>) -> Option<String> {
        let stem = self.table.project.as_ref().and_then(|path| path.file_stem());
        let stem = stem.map(|stem| stem.to_string_lossy().into_owned());
        stem.or_else(|| self.table.name.clone()).or_else(|| model.map(|model| model.name.clone()))
    }

    pub(super) fn has_saved(&self, document: &Document) -> bool {
        self.table.saved.as_ref() == Some(document)
    }

    /// Notes that a document differs from its saved state by nothing that the user did.
    pub(super) fn note_unchanged(&mut self, document: &Document) {
        self.table.saved = Some(document.clone());
    }

    pub(super) fn is_loading(&self) -> bool {
        self.loading.is_busy()
    }

    /// True while a file that the user requested is being written.
    pub(super) fn is_saving(&self) -> bool {
        self.outputs.is_busy() || self.projects.is_busy()
    }

    /// True if exports wait until all charts are solved.
    pub(super) fn is_awaiting(&self) -> bool {
        !self.awaited.is_empty()
    }

    /// Lets an export wait until all charts are solved.
    pub(super) fn wait_to_save(&mut self, request: Export) {
        self.awaited.push(request);
    }

    /// Removes the exports that wait.
    pub(super) fn take_awaited(&mut self) -> Vec<Export> {
        std::mem::take(&mut self.awaited)
    }

    /// Constraint file that was imported last.
    pub(super) fn constraints(&self) -> Option<&PathBuf> {
        self.table.constraints.as_ref()
    }

    /// Remembers the constraint file that was imported last.
    pub(super) fn remember_constraints(&mut self, path: PathBuf) {
        self.table.constraints = Some(path);
    }

    /// Project file of a document.
    pub(super) fn project_file(&self, model: &Model, document: &Document) -> Option<ProjectFile> {
        let mut project = project_of(model, document)?;
        if document.picture.is_none() {
            project.picture.clone_from(&self.table.missing_picture);
        }
        project.view.clone_from(&self.table.view);
        Some(project)
    }

    /// Number of openings so far.
    pub(super) fn opening(&self) -> u64 {
        self.table.opening
    }

    /// Project that the document is saved to.
    pub(super) fn project(&self) -> Option<&PathBuf> {
        self.table.project.as_ref()
    }

    /// View that is saved with the project.
    pub(super) fn view(&self) -> &ProjectView {
        &self.table.view
    }

    /// Sets the view that is saved with the project.
    pub(super) fn set_view(&mut self, view: ProjectView) {
        self.table.view = view;
    }

    /// True while a project is being written.
    pub(super) fn is_saving_project(&self) -> bool {
        self.projects.is_busy()
    }

    /// Memory of the machine, bytes.
    pub(super) fn memory(&self) -> Option<u64> {
        self.memory
    }

    /// Sets the memory of the machine, bytes.
    pub(super) fn set_memory(&mut self, bytes: u64) {
        self.memory = Some(bytes);
    }

    /// File that waits for a confirmation.
    pub(super) fn large(&self) -> Option<&LargeFile> {
        self.large.as_ref()
    }

    /// Message about the mesh that a project lacks.
    pub(super) fn missing_mesh(&self) -> Option<u64> {
        self.missing_mesh.as_ref().map(|missing| missing.message)
    }

    /// Picture that the open project lacks.
    pub(super) fn missing_picture(&self) -> Option<&ProjectSource> {
        self.table.missing_picture.as_ref()
    }

    /// Recently opened files.
    pub(super) fn recent(&self) -> &RecentFiles {
        &self.recent
    }

    /// Recently opened files, mutable.
    pub(super) fn recent_mut(&mut self) -> &mut RecentFiles {
        &mut self.recent
    }

    /// Shows the folder of a file.
    pub(super) fn show_folder(&mut self, file: PathBuf) {
        self.folder.show(file);
    }

    /// Recovery copies.
    pub(super) fn autosave(&self) -> &Autosave {
        &self.autosave
    }

    /// Recovery copies, mutable.
    pub(super) fn autosave_mut(&mut self) -> &mut Autosave {
        &mut self.autosave
    }

    /// Waits until all requested files are written, at most [`PATIENCE`].
    pub(super) fn finish_writing(&mut self, messages: &mut Messages) {
        let begun = Instant::now();
        while self.is_saving() && begun.elapsed() < PATIENCE {
            std::thread::sleep(Duration::from_millis(1));
            self.poll_saving(messages);
        }
    }

    /// Opens the file that waits for a confirmation.
    pub(super) fn open_large(&mut self) {
        if let Some(large) = self.large.take() {
            self.load(large.wanted, None);
        }
    }

    /// Drops the file that waits for a confirmation.
    pub(super) fn leave_large(&mut self) {
        if self.large.take().is_some() {
            self.end_opening();
        }
    }
}

/// Reading of files.
impl Files {
    /// Opens a mesh file or a project.
    pub(super) fn open(&mut self, path: PathBuf) {
        self.begin(OpenRequest::File(path));
    }

    /// Opens a file alone and drops what would follow an earlier request.
    fn begin(&mut self, wanted: OpenRequest) {
        self.together = None;
        self.load(wanted, self.memory);
    }

    fn load(&mut self, wanted: OpenRequest, memory: Option<u64>) {
        self.large = None;
        self.loading.start(wanted.clone(), move |_| wanted.open(memory));
    }

    /// Ends an opening that failed or was cancelled.
    fn end_opening(&mut self) {
        self.together = None;
        self.autosave.give_up_claim();
    }

    /// Opens a mesh or a project. Its picture and constraints follow.
    pub(super) fn open_together(&mut self, files: UndoGroup) {
        self.open(files.mesh.clone());
        self.together = Some(files);
    }

    /// Opens a built-in mesh.
    pub(super) fn open_example(&mut self, example: Example) {
        self.begin(OpenRequest::Example(example));
    }

    /// Opens a recovery copy, which belongs to this session from now on.
    pub(super) fn recover(&mut self, path: PathBuf, messages: &mut Messages) {
        if self.autosave.claim(&path) {
            self.begin(OpenRequest::Recovery(path));
        } else {
            let text = format!("the recovery copy is gone, or in use by another session: {}", path.display());
            messages.fail(MessagePlace::Mesh, text, None);
        }
    }

    /// Opens the project whose mesh does not exist with a mesh that the user located.
    pub(super) fn locate_mesh(&mut self, mesh: PathBuf, messages: &mut Messages) {
        let Some(MissingMesh { project, is_recovery, .. }) = self.missing_mesh.clone() else { return };
        if is_recovery && !self.autosave.claim(&project) {
            return self.recover(project, messages);
        }
        self.begin(OpenRequest::Located { project, is_recovery, file: LocatedFile::Mesh(mesh) });
    }

    /// Opens the project on the table again, with a picture that the user located. Returns the picture if there is no
    /// such project, or its picture is not missing.
    #[must_use = "the picture is still to be opened"]
    pub(super) fn locate_picture(&mut self, picture: PathBuf) -> Option<PathBuf> {
        // A recovered document differs from its project.
        let saved = self.table.saved.as_ref().filter(|saved| saved.picture.is_none());
        let project = self.table.project.clone().filter(|_| saved.is_some() && self.table.missing_picture.is_some());
        let Some(project) = project else { return Some(picture) };
        self.begin(OpenRequest::Located { project, is_recovery: false, file: LocatedFile::Picture(picture) });
        None
    }

    /// Imports constraints after the mesh that is being opened.
    pub(super) fn import_after(&mut self, path: PathBuf) {
        self.beside_mesh().constraints.push(path);
    }

    fn beside_mesh(&mut self) -> &mut UndoGroup {
        let group = UndoGroup { mesh: PathBuf::new(), picture: None, constraints: Vec::new(), left: Vec::new() };
        self.together.get_or_insert(group)
    }

    /// Opens a picture after the mesh that is being opened.
    pub(super) fn open_picture_after(&mut self, path: PathBuf) {
        self.beside_mesh().picture = Some(path);
    }

    /// Cancels the opening of files.
    pub(super) fn cancel_loading(&mut self) {
        self.loading.cancel();
        self.large = None;
        self.end_opening();
    }

    /// Returns the document that was opened. Reports errors.
    pub(super) fn poll_loading(&mut self, messages: &mut Messages) -> Option<Opened> {
        let (wanted, loaded) = self.loading.poll()?;
        match loaded {
            Ok(Ok(opened)) => {
                self.missing_mesh = None;
                if let Some((path, false)) = wanted.project() {
                    self.recent.remember(&path);
                }
                return Some(opened);
            }
            Ok(Err(OpenError::Memory { path, source })) => {
                self.large = Some(LargeFile { wanted, path, shortage: source });
                return None;
            }
            Ok(Err(error)) => {
                let file = wanted.project();
                let text = Message::error(MessagePlace::Mesh, error.to_string()).with_remedy(error.remedy());
                let message = messages.say(text.of_file(file.as_ref().map(|(path, _)| &**path)));
                // Another file can be located if this one is no mesh.
                let is_mesh = matches!(&wanted, OpenRequest::Located { file: LocatedFile::Mesh(_), .. });
                let lacks_mesh = matches!(error, OpenError::NoMesh { .. }) || is_mesh;
                if let Some((project, is_recovery)) = file.filter(|_| lacks_mesh) {
                    let missing = MissingMesh { message, project, is_recovery };
                    if let Some(before) = self.missing_mesh.replace(missing) {
                        messages.dismiss(before.message);
                    }
                }
            }
            Err(failure) => messages.fail_background(MessagePlace::Mesh, "loading", &failure),
        }
        self.end_opening();
        None
    }

    /// Takes the files to be opened after the mesh.
    pub(super) fn take_together(&mut self) -> Option<UndoGroup> {
        self.together.take()
    }

    /// Replaces the open document by the opened one.
    pub(super) fn put_on_table(&mut self, opened: &Opened) {
        let Opened { document, view, origin, missing_picture, is_partial, .. } = opened;
        let is_recovered = matches!(origin, Origin::Recovery(_));
        self.autosave.begin_anew(Some(document).filter(|_| is_recovered));
        let (name, project) = match origin {
            Origin::Mesh => (None, None),
            Origin::Project(path) => (None, Some(path.clone())),
            Origin::Recovery(note) => (Some(note.name.clone()), note.project.clone()),
        };
        self.table = OpenProject {
            opening: self.table.opening + 1,
            name,
            // The project file keeps what is left out here, so saving asks for another path.
            project: project.filter(|_| !is_partial),
            saved: Some(document.clone()).filter(|_| !is_recovered),
            constraints: None,
            missing_picture: missing_picture.clone(),
            view: view.clone(),
        };
    }
}

/// Writing of files.
impl Files {
    /// Writes files that the user requested, in the background.
    pub(super) fn write(&mut self, work: impl FnOnce() -> Result<Written, WriteError> + Send + 'static) {
        self.write_until(|_| work());
    }

    /// Writes files that the user requested, in the background. `work` may stop with an error once its flag is set.
    pub(super) fn write_until(
        &mut self,
        work: impl FnOnce(&AtomicBool) -> Result<Written, WriteError> + Send + 'static,
    ) {
        self.outputs.add((), work);
    }

    /// Asks the writing of files that the user requested to stop. Files that are nearly done are still written.
    pub(super) fn stop_writing(&mut self) {
        self.outputs.interrupt();
    }

    /// Saves the project after the projects requested before.
    pub(super) fn save_project(&mut self, path: PathBuf, project: ProjectFile, document: &Document) {
        let request = Request { path, document: document.clone(), opening: self.table.opening };
        self.projects.start(request, project);
    }

    /// Reports files that were written.
    pub(super) fn poll_saving(&mut self, messages: &mut Messages) {
        while let Some(((), written)) = self.outputs.poll() {
            match written {
                Ok(Ok(written)) => messages.note("wrote", written),
                Ok(Err(error)) if error.is_cancelled() => {
                    let text = format!("{} was not written: cancelled", error.path.display());
                    messages.say(Message::caution(MessagePlace::Embedding, text));
                }
                Ok(Err(error)) => messages.fail(MessagePlace::Embedding, error.to_string(), None),
                Err(failure) => messages.fail_background(MessagePlace::Embedding, "saving", &failure),
            }
        }
        self.folder.poll(messages);
        while let Some(Request { path, document, opening }) = self.projects.poll(messages) {
            self.recent.remember(&path);
            messages.note("saved", Written::file(path.clone()));
            // Another document may have been opened meanwhile.
            if opening == self.table.opening {
                (self.table.project, self.table.saved) = (Some(path), Some(document));
            }
        }
    }

    /// Follows the writing of recovery copies.
    pub(super) fn poll_copies(&mut self, messages: &mut Messages) {
        self.autosave.poll(messages);
    }

    /// Deletes the recovery copy, because there is no unsaved work.
    pub(super) fn leave_copy(&mut self) {
        self.autosave.leave_slot();
    }

    /// True if a recovery copy of the document is due.
    pub(super) fn is_copy_due(&self, now: Instant, document: &Document) -> bool {
        self.autosave.is_due(now, document)
    }

    /// Note of a recovery copy: name of the document, and its project.
    pub(super) fn recovery_note(&self, model: &Model) -> RecoveryNote {
        let absolute = |path: &PathBuf| std::path::absolute(path).unwrap_or_else(|_| path.clone());
        let name = self.name(Some(model)).unwrap_or_default();
        RecoveryNote { name, project: self.table.project.as_ref().map(absolute) }
    }

    /// Writes a recovery copy in the background.
    pub(super) fn begin_copy(
        &mut self,
        now: Instant,
        project: ProjectFile,
        document: &Document,
        messages: &mut Messages,
    ) {
        self.autosave.begin_copy(now, project, document, messages);
    }
}
