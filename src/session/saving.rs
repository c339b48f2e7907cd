//! Projects on their way to the disk, one after the other.

use std::collections::VecDeque;
use std::path::PathBuf;

use super::{Background, Document, Messages, Model, Place, Wake};
use crate::io::{PathStyle, PictureFile, ProjectFile, ProjectSource, WriteError};

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
