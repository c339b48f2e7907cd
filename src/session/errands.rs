//! Small pieces of work for the document that take time: pictures and constraints to read, faces to turn, an embedding
//! to fit the targets to. Each becomes one edit when it comes back.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::state::{REPORT_IT, lost};
use super::targets::Flat;
use super::{Command, Job, JobContext, Model, PictureFile, Place, Poll, Session};
use crate::io::{Constraints, ConstraintsError, PictureError};

/// What an errand brings back.
pub(super) enum Errand {
    /// A picture.
    Picture(Result<PictureFile, PictureError>),
    /// Constraints for the open mesh.
    Constraints(Result<Constraints, ConstraintsError>),
    /// The open mesh with its faces turned around.
    Turned(Box<Model>),
    /// The open mesh flattened, to fit the targets to.
    Flat(Flat),
}

/// What an errand is for: where its failure is told, and what its name is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    Picture,
    Constraints,
    Turn,
    Fit,
}

impl Purpose {
    const fn words(self) -> &'static str {
        match self {
            Self::Picture => "reading the picture",
            Self::Constraints => "reading the constraints",
            Self::Turn => "turning the faces",
            Self::Fit => "fitting the targets",
        }
    }
}

/// Errands under way, and those that came back in the middle of a drag, which no other edit may break up.
#[derive(Default)]
pub(super) struct Errands {
    under_way: Vec<(Purpose, Job<(), Errand>)>,
    arrived: Vec<Errand>,
}

impl Errands {
    /// Whether something is under way.
    pub(super) fn is_busy(&self) -> bool {
        !self.under_way.is_empty()
    }

    pub(super) fn is_under_way(&self, purpose: Purpose) -> bool {
        self.under_way.iter().any(|(of, _)| *of == purpose)
    }
}

impl Session {
    pub(super) fn send(&mut self, purpose: Purpose, work: impl FnOnce(&JobContext<()>) -> Errand + Send + 'static) {
        match Job::spawn("errand", self.waker(), work) {
            Ok(job) => self.errands.under_way.push((purpose, job)),
            Err(error) => self.fail(Place::Embedding, format!("no thread for {}: {error}", purpose.words()), None),
        }
    }

    /// Drops all errands: they were for another mesh, or nobody wants them any more.
    pub(super) fn forget_errands(&mut self) {
        self.errands = Errands::default();
    }

    pub(super) fn open_picture(&mut self, path: PathBuf) {
        if self.model.is_none() {
            return self.fail(Place::Embedding, "a picture needs a mesh: open one first".to_owned(), None);
        }
        self.send(Purpose::Picture, move |_| Errand::Picture(PictureFile::read(&path)));
    }

    pub(super) fn import_constraints(&mut self, path: PathBuf) {
        let Some(model) = &self.model else {
            return self.fail(Place::Embedding, "constraints need a mesh: open one first".to_owned(), None);
        };
        let count = model.mesh().vertex_count();
        self.send(Purpose::Constraints, move |_| Errand::Constraints(Constraints::read(Path::new(&path), count)));
    }

    pub(super) fn poll_errands(&mut self) {
        for (purpose, job) in std::mem::take(&mut self.errands.under_way) {
            match job.poll() {
                Poll::Running => self.errands.under_way.push((purpose, job)),
                Poll::Done(Errand::Turned(model)) => self.take_turned(Arc::new(*model)),
                Poll::Done(errand) => self.errands.arrived.push(errand),
                Poll::Lost => self.fail(Place::Embedding, lost(purpose.words()), Some(REPORT_IT)),
            }
        }
        if !self.history.is_in_gesture() {
            for errand in std::mem::take(&mut self.errands.arrived) {
                self.take_errand(errand);
            }
        }
    }

    fn take_errand(&mut self, errand: Errand) {
        match errand {
            Errand::Picture(Ok(picture)) => self.edit(vec![Command::SetPicture(Some(Arc::new(picture)))]),
            Errand::Picture(Err(error)) => {
                self.fail(Place::Embedding, error.to_string(), Some("choose a PNG or JPEG file"));
            }
            Errand::Constraints(Ok(constraints)) => self.take_constraints(constraints),
            Errand::Constraints(Err(error)) => self.fail(Place::Embedding, error.to_string(), None),
            Errand::Flat(flat) => self.take_flat(&flat),
            Errand::Turned(model) => self.take_turned(Arc::new(*model)),
        }
    }

    fn take_constraints(&mut self, constraints: Constraints) {
        if constraints.targets.is_empty() {
            return self.fail(Place::Embedding, "the file has no constraints".to_owned(), None);
        }
        if self.takes_pins() {
            let known = &self.document.targets;
            let fresh = constraints.targets.into_iter().filter(|(vertex, target)| known.get(vertex) != Some(target));
            let commands = fresh.map(|(vertex, target)| Command::SetPin { vertex, target: Some(target) }).collect();
            self.edit(commands);
        }
    }
}
