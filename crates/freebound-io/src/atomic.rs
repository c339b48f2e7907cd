//! Files that are written whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::unfinished::Unfinished;

/// Size of the write buffer, bytes.
const BUFFER: usize = 256 << 10;

/// Failure to write a file. Nothing of the file is left behind.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot be {}: {source}", path.display(), if *cause == WriteFailure::Input { "read" } else { "written" })]
pub struct WriteError {
    /// File to be written, or the unreadable file to be copied.
    pub path: PathBuf,
    /// Error of the operating system.
    pub source: io::Error,
    cause: WriteFailure,
}

/// Cause of a failure to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum WriteFailure {
    /// The file cannot be written.
    Output,
    /// A file that is to be copied cannot be read.
    Input,
    /// The user stopped the writing.
    Cancelled,
}

impl WriteError {
    /// Failure to write a file.
    pub fn writing(path: impl Into<PathBuf>, source: impl Into<io::Error>) -> Self {
        Self { path: path.into(), source: source.into(), cause: WriteFailure::Output }
    }

    /// Failure to read a file that is to be copied.
    pub(crate) fn reading(path: impl Into<PathBuf>, source: impl Into<io::Error>) -> Self {
        Self { cause: WriteFailure::Input, ..Self::writing(path, source) }
    }

    /// The user stopped the writing.
    pub fn cancelled(path: impl Into<PathBuf>) -> Self {
        Self { cause: WriteFailure::Cancelled, ..Self::writing(path, io::ErrorKind::Interrupted) }
    }

    /// True if the user stopped the writing.
    pub fn is_cancelled(&self) -> bool {
        self.cause == WriteFailure::Cancelled
    }

    /// True if a file could not be read; false if one could not be written.
    pub fn is_of_input(&self) -> bool {
        self.cause == WriteFailure::Input
    }
}

/// Writes a temporary file in the target's folder and renames it when it is complete. On an error nothing is left
/// behind, and an older file of that name stays unchanged.
///
/// A link is followed, so that the file it names is replaced. Anything that is not a regular file, such as a pipe, is
/// written directly, because renaming would replace it.
///
/// # Errors
///
/// [`WriteError`] with the path and the cause.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), WriteError> {
    write_inner(path, write).map_err(|source| WriteError::writing(path, source))
}

/// Tests if [`write_atomically`] could write a file, and leaves nothing behind. Call before long work whose result
/// goes to that file.
///
/// # Errors
///
/// [`WriteError`] if the folder is missing or accepts no new file, or if the path is a folder itself.
pub fn try_place(path: &Path) -> Result<(), WriteError> {
    let target = target_of(path);
    let tried = match fs::metadata(&target) {
        Ok(data) if data.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        // Opening a pipe would wait for its reader.
        Ok(data) if !data.is_file() => Ok(()),
        _ => aside_of(&target).map(|(_unfinished, aside)| drop(aside)),
    };
    tried.map_err(|source| WriteError::writing(path, source))
}

/// Writes like [`write_atomically`] and returns once the file is on the disk: a loss of power leaves the old file or
/// the new one. Meant for the user's own work. Files that can be generated again are not worth the wait.
///
/// # Errors
///
/// [`WriteError`] with the path and the cause.
pub fn write_durably(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), WriteError> {
    write_atomically(path, |out| {
        write(out)?;
        out.flush()?;
        // A pipe stores nothing, so there is nothing to sync.
        if out.get_ref().metadata()?.is_file() { out.get_ref().sync_all() } else { Ok(()) }
    })?;
    // The name is synced too. If a folder cannot be opened, as on some systems, the file itself is still safe.
    File::open(folder_of(&target_of(path))).and_then(|folder| folder.sync_all()).ok();
    Ok(())
}

/// Writes to standard output. A pipe that its reader has closed is no error.
///
/// # Errors
///
/// [`WriteError`] with the cause.
pub fn write_to_standard_output(write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> Result<(), WriteError> {
    let written = standard_output().and_then(|file| {
        let mut out = BufWriter::with_capacity(BUFFER, file);
        write(&mut out)?;
        out.flush()
    });
    match written {
        Err(source) if source.kind() != io::ErrorKind::BrokenPipe => {
            Err(WriteError::writing("standard output", source))
        }
        _ => Ok(()),
    }
}

/// Standard output as a file: avoids the line buffering of [`io::stdout`].
fn standard_output() -> io::Result<File> {
    #[cfg(unix)]
    let own = std::os::fd::AsFd::as_fd(&io::stdout()).try_clone_to_owned();
    #[cfg(windows)]
    let own = std::os::windows::io::AsHandle::as_handle(&io::stdout()).try_clone_to_owned();
    own.map(File::from)
}

/// File that is written: links are followed.
fn target_of(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

fn write_inner(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let target = target_of(path);
    let present = fs::metadata(&target).ok();
    if present.as_ref().is_some_and(|data| !data.is_file()) {
        let mut out = BufWriter::with_capacity(BUFFER, File::options().write(true).open(&target)?);
        write(&mut out)?;
        return out.flush();
    }
    let (_unfinished, aside) = aside_of(&target)?;
    let (file, aside) = aside.into_parts();
    if let Some(data) = present {
        file.set_permissions(data.permissions())?;
    }
    let mut out = BufWriter::with_capacity(BUFFER, file);
    write(&mut out)?;
    drop(out.into_inner().map_err(io::IntoInnerError::into_error)?);
    aside.persist(&target).map_err(|error| error.error)?;
    Ok(())
}

/// New temporary file in the target's folder. Dropping it removes it.
fn aside_of(target: &Path) -> io::Result<(Unfinished, NamedTempFile<File>)> {
    // Created like any new file: the permissions that `tempfile` sets by itself exclude all other users.
    Unfinished::new(|names| names.make_in(folder_of(target), |path| File::create_new(path)))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}
