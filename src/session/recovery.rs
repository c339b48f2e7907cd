//! Copies for recovery: made while a person works, and what sessions that ended badly have left.
//!
//! A session keeps one copy, and beside it a lock that it holds as long as it lives; the system lets go of the lock
//! however the session ends. So a copy whose lock can be taken was left by the dead.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};

use super::{Background, Document, MessagePlace, Messages, Wake};
use freebound_io::{PROJECT_EXTENSION, PathStyle, ProjectFile, WriteError};

/// Time from one copy to the next: what a crash may cost.
const INTERVAL: Duration = Duration::from_secs(5);

/// How long the end of a session waits for a copy that is being written. It is small: longer means that the disk hangs.
const PATIENCE: Duration = Duration::from_secs(2);

/// Extension of a lock's name.
const LOCK_EXTENSION: &str = "lock";

/// Writes a copy of a document.
type CopyJob = Background<Document, Result<(), WriteError>>;

/// Work that a session left unsaved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recoverable {
    /// The copy.
    pub path: PathBuf,
    /// What the work was called.
    pub name: String,
    /// The project that it was last saved to.
    pub project: Option<PathBuf>,
    /// When the copy was made.
    pub time: SystemTime,
    /// How many pins it has.
    pub pin_count: usize,
}

/// Where copies are kept on this system, `None` where it has no place for them.
pub fn recovery_folder() -> Option<PathBuf> {
    Some(state_folder()?.join("recovery"))
}

/// Where the program keeps what is its own from run to run.
pub(super) fn state_folder() -> Option<PathBuf> {
    system_folder(["XDG_STATE_HOME", "LOCALAPPDATA"], ".local/state")
}

/// The program's folder under the first of these variables that is set, or under a folder of the person's home.
pub(super) fn system_folder(variables: [&str; 2], in_home: &str) -> Option<PathBuf> {
    let value = |name| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let folder = variables.into_iter().find_map(value).or_else(|| value("HOME").map(|home| home.join(in_home)))?;
    Some(folder.join("freebound"))
}

/// What dead sessions have left in a folder, newest first. What cannot be read is left alone.
fn left_behind(folder: &Path) -> Vec<Recoverable> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let is_copy = |path: &PathBuf| path.extension().is_some_and(|extension| extension == PROJECT_EXTENSION);
    let mut found: Vec<Recoverable> = paths.filter(is_copy).filter_map(recoverable).collect();
    found.sort_by(|a, b| b.time.cmp(&a.time).then_with(|| a.path.cmp(&b.path)));
    found
}

fn recoverable(path: PathBuf) -> Option<Recoverable> {
    // The lock is let go of at once: looking is not taking.
    drop(Slot::claim(&path)?);
    let project = ProjectFile::read(&path).ok()?;
    let time = fs::metadata(&path).and_then(|data| data.modified()).unwrap_or(SystemTime::UNIX_EPOCH);
    let note = project.recovery.unwrap_or_default();
    Some(Recoverable { path, name: note.name, project: note.project, time, pin_count: project.targets.len() })
}

/// The copy of this session's work.
pub(super) struct Autosave {
    /// Where copies are kept; none are made without it.
    folder: Option<PathBuf>,
    /// What dead sessions have left there.
    found: Vec<Recoverable>,
    slot: Option<Slot>,
    /// The copy that is being opened, to become the slot.
    claimed: Option<Slot>,
    /// The document in the slot.
    written: Option<Document>,
    /// The copy being written, by its document.
    under_way: CopyJob,
    /// Slots that are given up, but still written to.
    leaving: Vec<(Slot, CopyJob)>,
    begun: Option<Instant>,
    has_failed: bool,
    wake: Wake,
}

impl Autosave {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            folder: None,
            found: Vec::new(),
            slot: None,
            claimed: None,
            written: None,
            under_way: Background::new("copy", wake),
            leaving: Vec::new(),
            begun: None,
            has_failed: false,
            wake: Arc::clone(wake),
        }
    }

    /// Takes what a dead session has left. Nothing else is ever taken, so that nothing else is ever deleted.
    pub(super) fn claim(&mut self, path: &Path) -> bool {
        let is_found = self.found.iter().any(|found| found.path == path);
        self.claimed = if is_found { Slot::claim(path) } else { None };
        self.claimed.is_some()
    }

    /// What was claimed stays where it is: it could not be opened.
    pub(super) fn give_up_claim(&mut self) {
        self.claimed = None;
    }

    /// Deletes what a dead session has left.
    pub(super) fn discard(&mut self, path: &Path) {
        let is_found = self.found.iter().any(|found| found.path == path);
        self.found.retain(|found| found.path != path);
        if let Some(slot) = Slot::claim(path).filter(|_| is_found) {
            slot.remove();
        }
    }

    /// Something else is on the table: the copy of what was there is of no use, and `recovered` has one already.
    pub(super) fn begin_anew(&mut self, recovered: Option<&Document>) {
        self.leave_slot();
        self.slot = self.claimed.take().filter(|_| recovered.is_some());
        self.written = recovered.cloned();
        self.begun = None;
        if let Some(slot) = &self.slot {
            self.found.retain(|found| found.path != slot.path);
        }
    }

    /// Deletes the copy, or has it deleted once it is written.
    pub(super) fn leave_slot(&mut self) {
        let job = std::mem::replace(&mut self.under_way, Background::new("copy", &self.wake));
        match self.slot.take() {
            Some(slot) if job.is_busy() => self.leaving.push((slot, job)),
            Some(slot) => slot.remove(),
            None => {}
        }
        self.written = None;
    }

    fn clear_left(&mut self) {
        for (slot, mut job) in std::mem::take(&mut self.leaving) {
            if job.poll().is_none() {
                self.leaving.push((slot, job));
            } else {
                slot.remove();
            }
        }
    }

    /// Takes in a copy that was written.
    pub(super) fn poll(&mut self, messages: &mut Messages) {
        self.clear_left();
        match self.under_way.poll() {
            None => {}
            Some((document, Ok(Ok(())))) => self.written = Some(document),
            Some((_, Ok(Err(error)))) => self.tell_no_copy(&error.to_string(), messages),
            Some((_, Err(failure))) => self.tell_no_copy(&failure.words("the copy"), messages),
        }
    }

    /// Whether a copy of the document is to be made now.
    pub(super) fn is_due(&self, now: Instant, document: &Document) -> bool {
        let is_time = self.begun.is_none_or(|begun| now.saturating_duration_since(begun) >= INTERVAL);
        let is_new = self.written.as_ref() != Some(document);
        self.folder.is_some() && is_time && is_new && !self.under_way.is_busy()
    }

    /// Writes a copy of the document.
    pub(super) fn begin_copy(
        &mut self,
        now: Instant,
        project: ProjectFile,
        document: &Document,
        messages: &mut Messages,
    ) {
        let Some(folder) = &self.folder else { return };
        self.begun = Some(now);
        let path = match self.slot.take().map_or_else(|| Slot::new(folder), Ok) {
            Ok(slot) => self.slot.insert(slot).path.clone(),
            Err(error) => {
                let reason = format!("{error}: {}", folder.display());
                return self.tell_no_copy(&reason, messages);
            }
        };
        self.under_way.start(document.clone(), move |_| project.write(&path, PathStyle::Absolute));
    }

    /// Says once that there is no copy: it is no reason to disturb a person again and again.
    fn tell_no_copy(&mut self, reason: &str, messages: &mut Messages) {
        if !std::mem::replace(&mut self.has_failed, true) {
            let text = format!("no copy is kept for recovery: {reason}");
            messages.fail(MessagePlace::Embedding, text, Some("save the project by hand"));
        }
    }

    /// Makes copies in a folder from now on, and looks at what is there.
    pub(super) fn keep_in(&mut self, folder: PathBuf) {
        self.found = left_behind(&folder);
        self.folder = Some(folder);
    }

    /// Copies that dead sessions have left, newest first.
    pub(super) fn found(&self) -> &[Recoverable] {
        &self.found
    }

    /// Deletes the copy, and makes no further one.
    pub(super) fn close(&mut self) {
        self.leave_slot();
        let begun = Instant::now();
        self.clear_left();
        while !self.leaving.is_empty() && begun.elapsed() < PATIENCE {
            std::thread::sleep(Duration::from_millis(1));
            self.clear_left();
        }
        self.folder = None;
    }
}

/// A place for a copy that belongs to this session.
#[derive(Debug)]
struct Slot {
    path: PathBuf,
    /// Held until the slot is dropped.
    _lock: File,
}

impl Slot {
    /// Makes a new place.
    fn new(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let suffix = format!(".{LOCK_EXTENSION}");
        let named = tempfile::Builder::new().prefix("work-").suffix(&suffix).tempfile_in(folder)?;
        let (lock, path) = named.keep().map_err(|error| error.error)?;
        lock.try_lock()?;
        Ok(Self { path: path.with_extension(PROJECT_EXTENSION), _lock: lock })
    }

    /// Takes over a copy that no living session holds.
    fn claim(path: &Path) -> Option<Self> {
        if !path.is_file() {
            return None;
        }
        let mut options = File::options();
        let lock = options.write(true).create(true).truncate(false).open(path.with_extension(LOCK_EXTENSION)).ok()?;
        lock.try_lock().ok()?;
        Some(Self { path: path.to_owned(), _lock: lock })
    }

    /// Deletes the copy. The lock goes last, so that nobody takes the copy for one of the dead.
    fn remove(self) {
        fs::remove_file(&self.path).ok();
        fs::remove_file(self.path.with_extension(LOCK_EXTENSION)).ok();
    }
}
