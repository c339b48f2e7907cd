//! What is being written aside, so that a sudden end of the program leaves none of it behind.
//!
//! One lock covers the making of a file aside, its note, and the clean-up at the end. The clean-up never gives it back:
//! what would make another file from then on waits for the end of the process.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::{fs, io};

use tempfile::Builder;

/// How the names of files and folders aside begin.
const PREFIX: &str = ".freebound-";

/// Files and folders under way.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Notes a file or folder as unfinished for as long as it lives. It is to outlive the file's own guard.
#[derive(Debug)]
pub(super) struct Unfinished(PathBuf);

impl Unfinished {
    /// Makes a file or folder aside, under a name from the builder, and notes it before the clean-up can begin.
    ///
    /// # Errors
    ///
    /// Where it cannot be made.
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

/// Does short work on files, such as those in a folder aside, that the clean-up neither meets half-done nor is followed by.
pub(super) fn before_clean_up<T>(work: impl FnOnce() -> T) -> T {
    let _noted = unfinished();
    work()
}

/// Removes all files and folders that are being written aside. For the last moment of the process: what would write
/// another one waits for ever from then on.
pub fn discard_unfinished() {
    let noted = unfinished();
    for path in &*noted {
        // What cannot be removed stays: there is nobody left to tell.
        if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) }.ok();
    }
    std::mem::forget(noted);
}
