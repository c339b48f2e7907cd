//! Temporary files and folders of writers, removed even at a sudden end of the program.
//!
//! A single lock covers the creation of a temporary file, its registration, and the clean-up at the end. The clean-up
//! never releases the lock: any later attempt to create a file blocks until the process ends.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::{fs, io};

use tempfile::Builder;

/// Prefix of the names of temporary files and folders.
const PREFIX: &str = ".freebound-";

/// Temporary files and folders in existence.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Registration of a temporary file or folder. Must outlive the guard that removes it.
#[derive(Debug)]
pub(super) struct Unfinished(PathBuf);

impl Unfinished {
    /// Creates a temporary file or folder under a name from the builder, and registers it before the clean-up can
    /// begin.
    ///
    /// # Errors
    ///
    /// If it cannot be created.
    pub(super) fn new<T: AsRef<Path>>(
        make: impl FnOnce(&Builder<'_, 'static>) -> io::Result<T>,
    ) -> io::Result<(Self, T)> {
        let mut all = unfinished();
        let whole = make(Builder::new().prefix(PREFIX))?;
        all.insert(whole.as_ref().to_owned());
        Ok((Self(whole.as_ref().to_owned()), whole))
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        unfinished().remove(&self.0);
    }
}

/// Runs short work on files, such as those in a temporary folder, under the lock. The clean-up runs before the work
/// or after it, and the work never starts after the clean-up.
pub(super) fn before_clean_up<T>(work: impl FnOnce() -> T) -> T {
    let _noted = unfinished();
    work()
}

/// Removes all temporary files and folders. Only for the last moment of the process: any later attempt to create one
/// blocks for ever.
pub fn discard_unfinished() {
    let noted = unfinished();
    for path in &*noted {
        // A file that cannot be removed stays: nobody is left to receive the error.
        if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) }.ok();
    }
    std::mem::forget(noted);
}
