//! A picture of what the window shows, written in the background.

use std::path::PathBuf;

use super::{Job, Message, Place, Poll, Session, Severity};
use crate::geom::Picture;
use crate::io::{WriteError, write_atomically};

/// Pictures being written.
pub(super) type PictureJob = Job<(), Result<PathBuf, WriteError>>;

impl Session {
    /// Writes a picture as a PNG.
    pub fn save_picture(&mut self, path: PathBuf, picture: Picture) {
        let work = move |_: &super::JobContext<()>| {
            write_atomically(&path, |out| picture.write_png(out).map_err(std::io::Error::other))?;
            Ok(path)
        };
        match Job::spawn("picture", self.waker(), work) {
            Ok(job) => self.saving_pictures.push(job),
            Err(error) => self.fail(Place::Embedding, format!("no thread to save with: {error}"), None),
        }
    }

    /// Says how writing went. Call once per frame.
    pub(super) fn poll_pictures(&mut self) {
        for job in std::mem::take(&mut self.saving_pictures) {
            match job.poll() {
                Poll::Running => self.saving_pictures.push(job),
                Poll::Lost => self.fail(Place::Embedding, super::state::lost("saving"), Some(super::state::REPORT_IT)),
                Poll::Done(Err(error)) => self.fail(Place::Embedding, error.to_string(), None),
                Poll::Done(Ok(path)) => {
                    let id = self.next_id();
                    let text = format!("wrote {}", path.display());
                    let (severity, place) = (Severity::Note, Place::Embedding);
                    self.messages.push(Message { id, severity, place, text, remedy: None, vertices: Vec::new() });
                }
            }
        }
    }
}
