//! The folder of copies for recovery: what sessions that ended badly have left.
//!
//! A session keeps one copy, and beside it a lock that it holds as long as it lives; the system lets go of the lock
//! however the session ends. So a copy whose lock can be taken was left by the dead.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::io::{PROJECT_EXTENSION, ProjectFile};

/// Extension of a lock's name.
const LOCK_EXTENSION: &str = "lock";

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
    let variable = |name| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let folder = variable("XDG_STATE_HOME")
        .or_else(|| variable("LOCALAPPDATA"))
        .or_else(|| variable("HOME").map(|home| home.join(".local").join("state")))?;
    Some(folder.join("freebound").join("recovery"))
}

/// What dead sessions have left in a folder, newest first. What cannot be read is left alone.
pub(super) fn left_behind(folder: &Path) -> Vec<Recoverable> {
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

/// A place for a copy that belongs to this session.
#[derive(Debug)]
pub(super) struct Slot {
    pub(super) path: PathBuf,
    /// Held until the slot is dropped.
    _lock: File,
}

impl Slot {
    /// Makes a new place.
    pub(super) fn new(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let suffix = format!(".{LOCK_EXTENSION}");
        let named = tempfile::Builder::new().prefix("work-").suffix(&suffix).tempfile_in(folder)?;
        let (lock, path) = named.keep().map_err(|error| error.error)?;
        lock.try_lock()?;
        Ok(Self { path: path.with_extension(PROJECT_EXTENSION), _lock: lock })
    }

    /// Takes over a copy that no living session holds.
    pub(super) fn claim(path: &Path) -> Option<Self> {
        if !path.is_file() {
            return None;
        }
        let mut options = File::options();
        let lock = options.write(true).create(true).truncate(false).open(path.with_extension(LOCK_EXTENSION)).ok()?;
        lock.try_lock().ok()?;
        Some(Self { path: path.to_owned(), _lock: lock })
    }

    /// Deletes the copy. The lock goes last, so that nobody takes the copy for one of the dead.
    pub(super) fn remove(self) {
        fs::remove_file(&self.path).ok();
        fs::remove_file(self.path.with_extension(LOCK_EXTENSION)).ok();
    }
}
