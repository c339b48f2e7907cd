//! The project of the open document: what is saved, where, and what is not saved yet.

use std::collections::VecDeque;
use std::path::PathBuf;

use super::state::{REPORT_IT, lost};
use super::{Document, Job, Model, PictureFile, Place, Poll, Session};
use crate::io::{PathStyle, ProjectFile, ProjectSource, ProjectView, WriteError};

type SaveJob = Job<(), Result<(), WriteError>>;

/// Projects on their way to the disk: one after the other, so that the last one asked for is the last one written.
#[derive(Debug, Default)]
pub(super) struct ProjectSaves {
    under_way: Option<(Request, SaveJob)>,
    waiting: VecDeque<(Request, ProjectFile)>,
}

/// A wish to save.
#[derive(Debug)]
struct Request {
    path: PathBuf,
    /// What is saved by it.
    document: Document,
    /// What was on the table.
    opening: u64,
}

impl ProjectSaves {
    pub(super) fn is_busy(&self) -> bool {
        self.under_way.is_some() || !self.waiting.is_empty()
    }
}

impl Session {
    /// The project that the document is saved to.
    pub fn project_path(&self) -> Option<&PathBuf> {
        self.on_table.project.as_ref()
    }

    /// What to call what is open.
    pub fn project_name(&self) -> Option<String> {
        let stem = self.on_table.project.as_ref().and_then(|path| path.file_stem());
        let stem = stem.map(|stem| stem.to_string_lossy().into_owned());
        let model = self.model.as_ref().map(|model| model.name.clone());
        stem.or_else(|| self.on_table.name.clone()).or(model)
    }

    /// Whether something would be lost if the session ended now.
    pub fn has_unsaved_work(&self) -> bool {
        self.model.is_some() && self.on_table.saved.as_ref() != Some(&self.document)
    }

    /// Whether a project is being written.
    pub fn is_saving_project(&self) -> bool {
        self.project_saves.is_busy()
    }

    /// How the person looked at it when it was saved: for the screen to take over when
    /// [`opening_revision`](Self::opening_revision) changes.
    pub fn view(&self) -> &ProjectView {
        &self.view
    }

    /// Says how the person looks at it, to be saved with the project. A view alone is no unsaved work.
    pub fn set_view(&mut self, view: ProjectView) {
        self.view = view;
    }

    /// Saves the project.
    pub(super) fn save_project(&mut self, path: PathBuf) {
        let Some(project) = self.project_file() else {
            return self.fail(Place::Embedding, "there is nothing to save yet: open a mesh first".to_owned(), None);
        };
        let request = Request { path, document: self.document.clone(), opening: self.on_table.opening };
        self.project_saves.waiting.push_back((request, project));
        self.begin_next_save();
    }

    /// The document as a project file holds it.
    pub(super) fn project_file(&self) -> Option<ProjectFile> {
        let model = self.model.as_ref()?;
        let document = &self.document;
        Some(ProjectFile {
            mesh: mesh_source(model)?,
            faces_turned: document.faces_turned,
            picture: match &document.picture {
                Some(picture) => picture_source(picture, model),
                None => self.on_table.missing_picture.clone(),
            },
            v_axis: document.v_axis,
            settings: document.settings,
            targets: document.targets.clone(),
            view: self.view.clone(),
            recovery: None,
        })
    }

    fn begin_next_save(&mut self) {
        if self.project_saves.under_way.is_some() {
            return;
        }
        let Some((request, project)) = self.project_saves.waiting.pop_front() else { return };
        let path = request.path.clone();
        match Job::spawn("save", self.waker(), move |_| project.write(&path, PathStyle::Relative)) {
            Ok(job) => self.project_saves.under_way = Some((request, job)),
            Err(error) => self.fail(Place::Embedding, format!("no thread to save with: {error}"), None),
        }
    }

    pub(super) fn poll_project_saves(&mut self) {
        let Some((request, job)) = self.project_saves.under_way.take() else { return };
        match job.poll() {
            Poll::Running => self.project_saves.under_way = Some((request, job)),
            Poll::Done(Ok(())) => self.take_saved(request),
            Poll::Done(Err(error)) => {
                self.fail(Place::Embedding, error.to_string(), Some("save the project in another place"));
            }
            Poll::Lost => self.fail(Place::Embedding, lost("saving"), Some(REPORT_IT)),
        }
        self.begin_next_save();
    }

    fn take_saved(&mut self, request: Request) {
        self.recent.remember(&request.path);
        self.note(format!("saved {}", request.path.display()));
        // Something else may have been opened meanwhile.
        if request.opening == self.on_table.opening {
            self.on_table.project = Some(request.path);
            self.on_table.saved = Some(request.document);
        }
    }
}

fn mesh_source(model: &Model) -> Option<ProjectSource> {
    let example = model.example.map(|example| ProjectSource::Example(example.name().to_owned()));
    let file = || Some(ProjectSource::File { path: model.path.clone()?, stamp: model.stamp.clone() });
    example.or_else(file)
}

/// A picture without a file belongs to the built-in mesh.
fn picture_source(picture: &PictureFile, model: &Model) -> Option<ProjectSource> {
    match &picture.path {
        Some(path) => Some(ProjectSource::File { path: path.clone(), stamp: picture.stamp.clone() }),
        None => model.example.map(|example| ProjectSource::Example(example.name().to_owned())),
    }
}
