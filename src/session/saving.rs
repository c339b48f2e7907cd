//! Writing files in the background: results beside each other, projects one after the other.

use std::collections::VecDeque;
use std::path::PathBuf;

use super::{Background, Document, Messages, Model, Place, Wake};
use crate::io::{PathStyle, PictureFile, ProjectFile, ProjectSource, WriteError};
use crate::solver::Verdict;

/// A file that was written.
#[derive(Debug)]
pub(super) enum Saved {
    /// A result, with the verdict on it.
    Output(PathBuf, Verdict),
    /// So many constraints.
    Constraints(PathBuf, usize),
    /// A picture of what the screen shows.
    Picture(PathBuf),
}

impl Saved {
    fn words(&self) -> String {
        match self {
            Self::Output(path, verdict) => format!("wrote {} ({})", path.display(), verdict.summary()),
            Self::Constraints(path, 1) => format!("wrote {} (1 constraint)", path.display()),
            Self::Constraints(path, count) => format!("wrote {} ({count} constraints)", path.display()),
            Self::Picture(path) => format!("wrote {}", path.display()),
        }
    }
}

/// Results being written.
pub(super) struct OutputSaves {
    jobs: Background<(), Result<Saved, WriteError>>,
}

impl OutputSaves {
    /// Nothing is being written.
    pub(super) fn new(wake: &Wake) -> Self {
        Self { jobs: Background::new("save", wake) }
    }

    /// Whether something is being written.
    pub(super) fn is_busy(&self) -> bool {
        self.jobs.is_busy()
    }

    /// Writes a file.
    pub(super) fn start(&mut self, work: impl FnOnce() -> Result<Saved, WriteError> + Send + 'static) {
        self.jobs.add((), move |_| work());
    }

    /// Tells what was written.
    pub(super) fn poll(&mut self, messages: &mut Messages) {
        while let Some(((), saved)) = self.jobs.poll() {
            match saved {
                Ok(Ok(saved)) => messages.note(saved.words()),
                Ok(Err(error)) => messages.fail(Place::Embedding, error.to_string(), None),
                Err(failure) => messages.fail_background(Place::Embedding, "saving", &failure),
            }
        }
    }
}

/// A wish to save a project.
#[derive(Debug)]
pub(super) struct Request {
    pub(super) path: PathBuf,
    /// What is saved by it.
    pub(super) document: Document,
    /// What was on the table.
    pub(super) opening: u64,
}

/// Projects on their way to the disk: one after the other, so that the last one asked for is the last one written.
pub(super) struct ProjectSaves {
    under_way: Background<Request, Result<(), WriteError>>,
    waiting: VecDeque<(Request, ProjectFile)>,
}

impl ProjectSaves {
    /// Nothing is being written.
    pub(super) fn new(wake: &Wake) -> Self {
        Self { under_way: Background::new("save", wake), waiting: VecDeque::new() }
    }

    /// Whether a project is being written, or waits to be.
    pub(super) fn is_busy(&self) -> bool {
        self.under_way.is_busy() || !self.waiting.is_empty()
    }

    /// Writes a project once those before it are written.
    pub(super) fn start(&mut self, request: Request, project: ProjectFile) {
        self.waiting.push_back((request, project));
        self.begin_next();
    }

    fn begin_next(&mut self) {
        if self.under_way.is_busy() {
            return;
        }
        let Some((request, project)) = self.waiting.pop_front() else { return };
        let path = request.path.clone();
        self.under_way.start(request, move |_| project.write(&path, PathStyle::Relative));
    }

    /// A project that was written. Tells where one was not.
    pub(super) fn poll(&mut self, messages: &mut Messages) -> Option<Request> {
        let (request, result) = self.under_way.poll()?;
        self.begin_next();
        match result {
            Ok(Ok(())) => return Some(request),
            Ok(Err(error)) => {
                messages.fail(Place::Embedding, error.to_string(), Some("save the project in another place"));
            }
            Err(failure) => messages.fail_background(Place::Embedding, "saving", &failure),
        }
        None
    }
}

/// Where a mesh comes from.
pub(super) fn source_of(model: &Model) -> Option<ProjectSource> {
    let example = model.example.map(|example| ProjectSource::Example(example.name().to_owned()));
    let file = || Some(ProjectSource::File { path: model.path.clone()?, stamp: model.stamp.clone() });
    example.or_else(file)
}

/// Where a picture comes from. One without a file belongs to the built-in mesh.
pub(super) fn picture_source(picture: &PictureFile, model: &Model) -> Option<ProjectSource> {
    match &picture.path {
        Some(path) => Some(ProjectSource::File { path: path.clone(), stamp: picture.stamp.clone() }),
        None => model.example.map(|example| ProjectSource::Example(example.name().to_owned())),
    }
}
