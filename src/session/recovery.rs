//! Recovery copies of the current work, and copies left by sessions that ended badly.
//!
//! A session keeps one copy, with a lock that it holds while it lives. The system releases the lock however the session
//! ends. Therefore a copy whose lock is free belongs to a dead session.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};

use super::{Background, Document, MessagePlace, Messages, Wake};
use freebound_io::{PROJECT_EXTENSION, PathStyle, ProjectFile, WriteError};

/// Minimum time between two copies: the work that a crash may lose.
const INTERVAL: Duration = Duration::from_secs(5);

/// Maximum time that the end of a session waits for a copy. Copies are small, so a longer time means that the disk
/// hangs.
const PATIENCE: Duration = Duration::from_secs(2);

/// Extension of lock files.
const LOCK_EXTENSION: &str = "lock";

/// Job that writes a copy of a document.
type CopyJob = Background<Document, Result<(), WriteError>>;

/// Unsaved work of a session.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recoverable {
    /// Path of the copy.
    pub path: PathBuf,
    /// Name of the document.
    pub name: String,
    /// Project that the document was last saved to.
    pub project: Option<PathBuf>,
    /// Time of the copy.
    pub time: SystemTime,
    /// Number of pins in the copy.
    pub pin_count: usize,
}

/// Folder of recovery copies on this system. `None` if the system has no folder for them.
pub fn recovery_folder() -> Option<PathBuf> {
    Some(state_folder()?.join("recovery"))
}

/// Folder for the program's own state.
pub(super) fn state_folder() -> Option<PathBuf> {
    system_folder(["XDG_STATE_HOME", "LOCALAPPDATA"], ".local/state")
}

/// Folder of the program under the first variable that is set, or under `in_home` in the user's home folder.
pub(super) fn system_folder(variables: [&str; 2], in_home: &str) -> Option<PathBuf> {
    let value = |name| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let folder = variables.into_iter().find_map(value).or_else(|| value("HOME").map(|home| home.join(in_home)))?;
    Some(folder.join("freebound"))
}

/// Copies of dead sessions in a folder, newest first. Unreadable copies are skipped.
fn left_behind(folder: &Path) -> Vec<Recoverable> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let is_copy = |path: &PathBuf| path.extension().is_some_and(|extension| extension == PROJECT_EXTENSION);
    let mut found: Vec<Recoverable> = paths.filter(is_copy).filter_map(recoverable).collect();
    found.sort_by(|a, b| b.time.cmp(&a.time).then_with(|| a.path.cmp(&b.path)));
    found
}

fn recoverable(path: PathBuf) -> Option<Recoverable> {
    // Release the lock at once: a listed copy is not claimed.
    drop(Slot::claim(&path)?);
    let project = ProjectFile::read(&path).ok()?;
    let time = fs::metadata(&path).and_then(|data| data.modified()).unwrap_or(SystemTime::UNIX_EPOCH);
    let note = project.recovery.unwrap_or_default();
    Some(Recoverable { path, name: note.name, project: note.project, time, pin_count: project.pins.targets.len() })
}

/// Recovery copy of this session.
pub(super) struct Autosave {
    /// Folder of the copies. Without it no copies are made.
    folder: Option<PathBuf>,
    /// Copies of dead sessions in the folder.
    found: Vec<Recoverable>,
    slot: Option<Slot>,
    /// Copy that is being opened. It becomes the slot.
    claimed: Option<Slot>,
    /// Document in the slot.
    written: Option<Document>,
    /// Job that writes a copy. The key is its document.
    under_way: CopyJob,
    /// Abandoned slots whose copies are still being written.
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

    /// Claims the copy of a dead session. Only copies from the list can be claimed, so that nothing else is ever
    /// deleted.
    pub(super) fn claim(&mut self, path: &Path) -> bool {
        let is_found = self.found.iter().any(|found| found.path == path);
        self.claimed = if is_found { Slot::claim(path) } else { None };
        self.claimed.is_some()
    }

    /// Releases the claimed copy, which could not be opened.
    pub(super) fn give_up_claim(&mut self) {
        self.claimed = None;
    }

    /// Deletes the copy of a dead session.
    pub(super) fn discard(&mut self, path: &Path) {
        let is_found = self.found.iter().any(|found| found.path == path);
        self.found.retain(|found| found.path != path);
        if let Some(slot) = Slot::claim(path).filter(|_| is_found) {
            slot.remove();
        }
    }

    /// Starts with another document. The copy of the document before is deleted. A `recovered` document adopts its
    /// copy.
    pub(super) fn begin_anew(&mut self, recovered: Option<&Document>) {
        self.leave_slot();
        self.slot = self.claimed.take().filter(|_| recovered.is_some());
        self.written = recovered.cloned();
        self.begun = None;
        if let Some(slot) = &self.slot {
            self.found.retain(|found| found.path != slot.path);
        }
    }

    /// Deletes the copy, at once or when its writing has ended.
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

    /// Stores the result of writing a copy.
    pub(super) fn poll(&mut self, messages: &mut Messages) {
        self.clear_left();
        match self.under_way.poll() {
            None => {}
            Some((document, Ok(Ok(())))) => self.written = Some(document),
            Some((_, Ok(Err(error)))) => self.tell_no_copy(&error.to_string(), messages),
            Some((_, Err(failure))) => self.tell_no_copy(&failure.words("the copy"), messages),
        }
    }

    /// True if a copy of the document is due.
    pub(super) fn is_due(&self, now: Instant, document: &Document) -> bool {
        let is_time = self.begun.is_none_or(|begun| now.saturating_duration_since(begun) >= INTERVAL);
        let is_new = self.written.as_ref() != Some(document);
        self.folder.is_some() && is_time && is_new && !self.under_way.is_busy()
    }

    /// Starts writing a copy of the document.
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

    /// Reports a failure to write copies, once per session.
    fn tell_no_copy(&mut self, reason: &str, messages: &mut Messages) {
        if !std::mem::replace(&mut self.has_failed, true) {
            let text = format!("no recovery copy is kept: {reason}");
            messages.fail(MessagePlace::Embedding, text, Some("save the project manually"));
        }
    }

    /// Sets the folder of copies and lists the copies in it.
    pub(super) fn keep_in(&mut self, folder: PathBuf) {
        self.found = left_behind(&folder);
        self.folder = Some(folder);
    }

    /// Copies of dead sessions, newest first.
    pub(super) fn found(&self) -> &[Recoverable] {
        &self.found
    }

    /// Deletes the copy and stops making copies.
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

/// Place of a copy that belongs to this session.
#[derive(Debug)]
struct Slot {
    path: PathBuf,
    /// Lock, held until the slot is dropped.
    _lock: File,
}

impl Slot {
    /// Creates a new slot.
    fn new(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let suffix = format!(".{LOCK_EXTENSION}");
        let named = tempfile::Builder::new().prefix("work-").suffix(&suffix).tempfile_in(folder)?;
        let (lock, path) = named.keep().map_err(|error| error.error)?;
        lock.try_lock()?;
        Ok(Self { path: path.with_extension(PROJECT_EXTENSION), _lock: lock })
    }

    /// Claims a copy that no living session holds.
    fn claim(path: &Path) -> Option<Self> {
        if !path.is_file() {
            return None;
        }
        let mut options = File::options();
        let lock = options.write(true).create(true).truncate(false).open(path.with_extension(LOCK_EXTENSION)).ok()?;
        lock.try_lock().ok()?;
        Some(Self { path: path.to_owned(), _lock: lock })
    }

    /// Deletes the copy. The lock is deleted last, so that no other session mistakes the copy for one of a dead
    /// session.
    fn remove(self) {
        fs::remove_file(&self.path).ok();
        fs::remove_file(self.path.with_extension(LOCK_EXTENSION)).ok();
    }
}
