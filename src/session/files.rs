//! Writing files, in the background.

use std::path::PathBuf;

use super::state::{REPORT_IT, lost};
use super::{Finished, Job, Message, Place, Poll, SaveRequest, Session, Severity};
use crate::geom::Picture;
use crate::io::{WriteError, write_atomically, write_constraints, write_durably};
use crate::solver::Verdict;

/// A file being written.
pub(super) type SaveJob = Job<(), Result<Saved, WriteError>>;

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

impl Session {
    /// Writes the embedding on the screen.
    pub(super) fn save(&mut self, request: SaveRequest) {
        let (Some(model), Some(outcome)) = (self.model.clone(), self.outcome().cloned()) else {
            return self.fail(Place::Embedding, "there is nothing to save yet: open a mesh first".to_owned(), None);
        };
        if !self.is_current() {
            let text = "the embedding on the screen does not belong to these settings and pins yet".to_owned();
            return self.fail(Place::Embedding, text, Some("save again when it is solved"));
        }
        let records = self.timeline.records()[..=outcome.step.index].to_vec();
        let picture = self.document.picture.clone();
        self.write(move || {
            let disk = model.disk().expect("only a disk has an outcome");
            let finished = Finished::new((&model, disk), &outcome, records, request.fit, 0.0).with_picture(picture);
            finished.write(request.kind, &request.path)?;
            Ok(Saved::Output(request.path, finished.verdict().clone()))
        });
    }

    /// Writes the targets as a constraint file.
    pub(super) fn export_constraints(&mut self, path: PathBuf) {
        let targets = self.document.targets.clone();
        if targets.is_empty() {
            return self.fail(
                Place::Embedding,
                "there are no constraints to write: pin a vertex first".to_owned(),
                None,
            );
        }
        self.write(move || {
            write_durably(&path, |out| write_constraints(out, &targets))?;
            Ok(Saved::Constraints(path, targets.len()))
        });
    }

    /// Writes a picture of what the screen shows, as a PNG.
    pub fn save_picture(&mut self, path: PathBuf, picture: Picture) {
        self.write(move || {
            write_atomically(&path, |out| picture.write_png(out).map_err(std::io::Error::other))?;
            Ok(Saved::Picture(path))
        });
    }

    fn write(&mut self, work: impl FnOnce() -> Result<Saved, WriteError> + Send + 'static) {
        match Job::spawn("save", self.waker(), move |_| work()) {
            Ok(job) => self.saving.push(job),
            Err(error) => self.fail(Place::Embedding, format!("no thread to save with: {error}"), None),
        }
    }

    pub(super) fn poll_saving(&mut self) {
        for job in std::mem::take(&mut self.saving) {
            match job.poll() {
                Poll::Running => self.saving.push(job),
                Poll::Done(Ok(Saved::Output(path, verdict))) => {
                    self.note(format!("wrote {} ({})", path.display(), verdict.summary()));
                }
                Poll::Done(Ok(Saved::Constraints(path, count))) => {
                    let noun = if count == 1 { "constraint" } else { "constraints" };
                    self.note(format!("wrote {} ({count} {noun})", path.display()));
                }
                Poll::Done(Ok(Saved::Picture(path))) => self.note(format!("wrote {}", path.display())),
                Poll::Done(Err(error)) => self.fail(Place::Embedding, error.to_string(), None),
                Poll::Lost => self.fail(Place::Embedding, lost("saving"), Some(REPORT_IT)),
            }
        }
    }

    /// Says that something went well.
    pub(super) fn note(&mut self, text: String) {
        let id = self.next_id();
        let (severity, place) = (Severity::Note, Place::Embedding);
        self.messages.push(Message { id, severity, place, text, remedy: None, vertices: Vec::new() });
    }
}
