//! Messages to the user: the event, its place and a remedy.

use std::collections::{VecDeque, vec_deque};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::JobFailure;
use freebound_core::mesh::VertexId;

/// Maximum number of vertices that are listed one by one.
const MOST_NAMED: usize = 4;

/// Names of vertices: all of a few, the first of many.
pub fn named(vertices: &[VertexId]) -> String {
    let names: Vec<String> = vertices.iter().take(MOST_NAMED).map(VertexId::to_string).collect();
    match vertices.len().saturating_sub(MOST_NAMED) {
        0 => names.join(", "),
        more => format!("{} and {more} more", names.join(", ")),
    }
}

/// Severity of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Success, such as a file that was written.
    Note,
    /// Remark on something that was not done, or not as it was asked for. Nothing failed.
    Caution,
    /// Failure.
    Error,
}

/// Pane that a message belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MessagePlace {
    /// Pane of the mesh in space.
    Mesh,
    /// Pane of the embedding.
    Embedding,
}

/// Message to the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// Unique number of the message within the session.
    pub id: u64,
    /// Severity of the message.
    pub severity: Severity,
    /// Pane that the message belongs to.
    pub place: MessagePlace,
    /// Text of the message.
    pub text: String,
    /// Action that the message suggests.
    pub remedy: Option<String>,
    /// Vertices to highlight, by their numbers in files. Empty if the message concerns no single element.
    pub vertices: Vec<VertexId>,
    /// Files that were written, the requested file first.
    pub files: Vec<PathBuf>,
    /// File that is at fault. Messages about one file form a group.
    pub about: Option<PathBuf>,
}

/// Result of writing files.
#[derive(Debug)]
pub(super) struct Written {
    /// Written files, the requested file first. All of them are in one folder.
    pub(super) files: Vec<PathBuf>,
    /// Summary of the content.
    pub(super) about: Option<String>,
}

impl Written {
    /// Result for a single file without a summary.
    pub(super) fn file(path: PathBuf) -> Self {
        Self { files: vec![path], about: None }
    }

    /// Names of the files, the first with its folder.
    fn names(&self) -> String {
        let others = self.files.iter().skip(1).map(|path| path.file_name().unwrap_or_default().to_string_lossy());
        let first = self.files.first().map(|path| path.display().to_string());
        first.into_iter().chain(others.map(Into::into)).collect::<Vec<String>>().join(", ")
    }
}

impl Message {
    /// Creates a failure. [`Messages::say`] sets its number.
    pub(super) fn error(place: MessagePlace, text: impl Into<String>) -> Self {
        let (text, vertices, files) = (text.into(), Vec::new(), Vec::new());
        Self { id: 0, severity: Severity::Error, place, text, remedy: None, vertices, files, about: None }
    }

    pub(super) fn note(place: MessagePlace, text: impl Into<String>) -> Self {
        Self { severity: Severity::Note, ..Self::error(place, text) }
    }

    pub(super) fn caution(place: MessagePlace, text: impl Into<String>) -> Self {
        Self { severity: Severity::Caution, ..Self::error(place, text) }
    }

    /// True for success and remarks that do not belong to the file of the mesh.
    fn is_passing(&self) -> bool {
        self.severity != Severity::Error && self.place != MessagePlace::Mesh
    }

    /// Adds a remedy.
    pub(super) fn with_remedy(self, remedy: impl Into<String>) -> Self {
        Self { remedy: Some(remedy.into()), ..self }
    }

    /// Adds the file at fault, unless the message names one already.
    pub(super) fn of_file(self, path: Option<&Path>) -> Self {
        Self { about: self.about.or_else(|| path.map(Path::to_owned)), ..self }
    }

    /// Adds the vertices concerned, by their numbers in files.
    pub(super) fn with_vertices(self, vertices: Vec<VertexId>) -> Self {
        Self { vertices, ..self }
    }
}

/// Greatest number of messages in the log.
const LOG: usize = 500;

/// Message in the log of a run.
#[derive(Clone, Debug)]
pub struct LoggedMessage {
    /// Time of the message.
    pub time: SystemTime,
    /// The message.
    pub message: Message,
}

/// Messages that were not dismissed, and the log of all messages.
#[derive(Debug, Default)]
pub(super) struct Messages {
    list: Vec<Message>,
    last_id: u64,
    log: VecDeque<LoggedMessage>,
}

impl Messages {
    /// Adds a message and returns its number.
    pub(super) fn say(&mut self, message: Message) -> u64 {
        self.last_id += 1;
        let message = Message { id: self.last_id, ..message };
        if self.log.len() == LOG {
            self.log.pop_front();
        }
        self.log.push_back(LoggedMessage { time: SystemTime::now(), message: message.clone() });
        self.list.push(message);
        self.last_id
    }

    /// Reports written files. Merges the report with earlier success messages.
    pub(super) fn note(&mut self, verb: &str, written: Written) {
        let about = written.about.as_ref().map_or_else(String::new, |about| format!(" ({about})"));
        let news = format!("{verb} {}{about}", written.names());
        let is_success = |message: &&Message| message.is_passing() && message.severity == Severity::Note;
        let notes = self.list.iter().filter(is_success).filter(|message| message.text != news);
        let (mut texts, mut files) = (Vec::new(), Vec::new());
        for note in notes {
            texts.push(note.text.clone());
            files.extend_from_slice(&note.files);
        }
        texts.push(news);
        files.extend(written.files);
        self.forget_notes();
        self.say(Message { files, ..Message::note(MessagePlace::Embedding, texts.join("; ")) });
    }

    /// Reports a failure with its remedy.
    pub(super) fn fail(&mut self, place: MessagePlace, text: impl Into<String>, remedy: Option<&str>) {
        let message = Message::error(place, text);
        self.say(Message { remedy: remedy.map(str::to_owned), ..message });
    }

    /// Reports a background job without an outcome. `work` is a noun, such as "saving".
    pub(super) fn fail_background(&mut self, place: MessagePlace, work: &str, failure: &JobFailure) {
        self.fail(place, failure.words(work), failure.remedy());
    }

    pub(super) fn dismiss(&mut self, id: u64) {
        self.list.retain(|message| message.id != id);
    }

    /// Removes error messages of the mesh pane, because the mesh has changed. Notes on its file stay.
    pub(super) fn forget_mesh(&mut self) {
        self.list.retain(|message| message.place != MessagePlace::Mesh || message.severity != Severity::Error);
    }

    /// Removes reports of written files.
    pub(super) fn forget_written(&mut self) {
        self.list.retain(|message| message.severity != Severity::Note || message.files.is_empty());
    }

    /// Removes success messages of the embedding. Notes on the file of the mesh stay.
    pub(super) fn forget_notes(&mut self) {
        self.list.retain(|message| !message.is_passing());
    }

    pub(super) fn clear(&mut self) {
        self.list.clear();
    }

    /// Newest messages of the run, dismissed or not, oldest first.
    pub(super) fn log(&self) -> vec_deque::Iter<'_, LoggedMessage> {
        self.log.iter()
    }

    /// Messages that were not dismissed, oldest first.
    pub(super) fn list(&self) -> &[Message] {
        &self.list
    }
}
