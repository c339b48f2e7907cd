//! What the session has to tell a person: what happened, where, and what to do.

use std::path::PathBuf;

use super::JobFailure;
use freebound_core::mesh::VertexId;

/// The most vertices that are named one by one.
const MOST_NAMED: usize = 4;

/// Vertices by their names: all of a few, the first of many.
pub fn named(vertices: &[VertexId]) -> String {
    let names: Vec<String> = vertices.iter().take(MOST_NAMED).map(VertexId::to_string).collect();
    match vertices.len().saturating_sub(MOST_NAMED) {
        0 => names.join(", "),
        more => format!("{} and {more} more", names.join(", ")),
    }
}

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Good news, such as a file that was written.
    Note,
    /// Something did not work.
    Error,
}

/// The pane that a message belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MessagePlace {
    /// The mesh in space.
    Mesh,
    /// Its embedding.
    Embedding,
}

/// One thing said.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// Tells this message from all others of the session.
    pub id: u64,
    /// How bad it is.
    pub severity: Severity,
    /// Where it belongs.
    pub place: MessagePlace,
    /// What happened.
    pub text: String,
    /// What to do about it.
    pub remedy: Option<String>,
    /// Vertices of the element concerned, to be shown; empty where it is about the whole.
    pub vertices: Vec<VertexId>,
    /// Files that were written, the one asked for first.
    pub files: Vec<PathBuf>,
}

/// What was written.
#[derive(Debug)]
pub(super) struct Written {
    /// Every file, the one asked for first. They lie in one folder.
    pub(super) files: Vec<PathBuf>,
    /// What there is to say about it.
    pub(super) about: Option<String>,
}

impl Written {
    /// One file of which there is nothing to say.
    pub(super) fn file(path: PathBuf) -> Self {
        Self { files: vec![path], about: None }
    }

    /// The first file with its folder, the others by their names.
    fn names(&self) -> String {
        let others = self.files.iter().skip(1).map(|path| path.file_name().unwrap_or_default().to_string_lossy());
        let first = self.files.first().map(|path| path.display().to_string());
        first.into_iter().chain(others.map(Into::into)).collect::<Vec<String>>().join(", ")
    }
}

impl Message {
    /// A failure. [`Messages::say`] gives it its number.
    pub(super) fn error(place: MessagePlace, text: impl Into<String>) -> Self {
        let (text, vertices, files) = (text.into(), Vec::new(), Vec::new());
        Self { id: 0, severity: Severity::Error, place, text, remedy: None, vertices, files }
    }

    /// With what to do about it.
    pub(super) fn with_remedy(self, remedy: impl Into<String>) -> Self {
        Self { remedy: Some(remedy.into()), ..self }
    }

    /// With the vertices concerned.
    pub(super) fn with_vertices(self, vertices: Vec<VertexId>) -> Self {
        Self { vertices, ..self }
    }
}

/// What was said and not dismissed.
#[derive(Debug, Default)]
pub(super) struct Messages {
    list: Vec<Message>,
    last_id: u64,
}

impl Messages {
    /// Says something. Returns the message's number.
    pub(super) fn say(&mut self, message: Message) -> u64 {
        self.last_id += 1;
        self.list.push(Message { id: self.last_id, ..message });
        self.last_id
    }

    /// Says that files were written, together with what still stands of others.
    pub(super) fn note(&mut self, verb: &str, written: Written) {
        let about = written.about.as_ref().map_or_else(String::new, |about| format!(" ({about})"));
        let news = format!("{verb} {}{about}", written.names());
        let notes = self.list.iter().filter(|message| message.severity == Severity::Note && message.text != news);
        let (mut texts, mut files) = (Vec::new(), Vec::new());
        for note in notes {
            texts.push(note.text.clone());
            files.extend_from_slice(&note.files);
        }
        texts.push(news);
        files.extend(written.files);
        self.forget_notes();
        let message = Message::error(MessagePlace::Embedding, texts.join("; "));
        self.say(Message { severity: Severity::Note, files, ..message });
    }

    /// Says that something did not work, and what to do about it.
    pub(super) fn fail(&mut self, place: MessagePlace, text: impl Into<String>, remedy: Option<&str>) {
        let message = Message::error(place, text);
        self.say(Message { remedy: remedy.map(str::to_owned), ..message });
    }

    /// Says that work in the background gave no outcome. `work` is a noun, such as "saving".
    pub(super) fn fail_background(&mut self, place: MessagePlace, work: &str, failure: &JobFailure) {
        self.fail(place, failure.words(work), failure.remedy());
    }

    pub(super) fn dismiss(&mut self, id: u64) {
        self.list.retain(|message| message.id != id);
    }

    /// Takes away what was said of the mesh: it is another one now.
    pub(super) fn forget_mesh(&mut self) {
        self.list.retain(|message| message.place != MessagePlace::Mesh);
    }

    /// Takes away what went well.
    pub(super) fn forget_notes(&mut self) {
        self.list.retain(|message| message.severity != Severity::Note);
    }

    pub(super) fn clear(&mut self) {
        self.list.clear();
    }

    /// Messages that were not dismissed, oldest first.
    pub(super) fn list(&self) -> &[Message] {
        &self.list
    }
}
