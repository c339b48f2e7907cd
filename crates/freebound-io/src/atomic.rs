//! Files that are written whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::unfinished::Unfinished;

/// Bytes gathered before they are handed to the operating system.
const BUFFER: usize = 256 << 10;

/// Why a file was not written. Nothing of it is left behind.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot be {}: {source}", path.display(), if *is_of_input { "read" } else { "written" })]
pub struct WriteError {
    /// The file that was to be written, or the one to be copied that cannot be read.
    pub path: PathBuf,
    /// What the operating system says.
    pub source: io::Error,
    is_of_input: bool,
}

impl WriteError {
    /// A file cannot be written.
    pub fn writing(path: impl Into<PathBuf>, source: impl Into<io::Error>) -> Self {
        Self { path: path.into(), source: source.into(), is_of_input: false }
    }

    /// A file that is to be copied cannot be read.
    pub(crate) fn reading(path: impl Into<PathBuf>, source: impl Into<io::Error>) -> Self {
        Self { is_of_input: true, ..Self::writing(path, source) }
    }

    /// Whether the fault is with a file that is read, not with one that is written.
    pub fn is_of_input(&self) -> bool {
        self.is_of_input
    }
}

/// Writes a file aside, in the same folder, and renames it when it is complete; on an error nothing is left behind and
/// an older file of that name stays as it was.
///
/// A link is followed, so that the file it names is replaced. Something that is no regular file, such as a pipe, is
/// written to directly, because renaming would replace it.
///
/// # Errors
///
/// [`WriteError`] names the path and says what went wrong.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), WriteError> {
    write_inner(path, write).map_err(|source| WriteError::writing(path, source))
}

/// Tries whether [`write_atomically`] could write a file, and leaves nothing behind: before long work whose result goes
/// there.
///
/// # Errors
///
/// [`WriteError`] where its folder is missing or takes no new file, or where it is a folder itself.
pub fn try_place(path: &Path) -> Result<(), WriteError> {
    let target = target_of(path);
    let tried = match fs::metadata(&target) {
        Ok(data) if data.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        // To open a pipe would wait for its reader.
        Ok(data) if !data.is_file() => Ok(()),
        _ => aside_of(&target).map(|(_unfinished, aside)| drop(aside)),
    };
    tried.map_err(|source| WriteError::writing(path, source))
}

/// As [`write_atomically`], and when it returns the file is on the disk: a loss of power leaves the old file or the new
/// one. For what a person has made by hand; files that can be made again are not worth the wait.
///
/// # Errors
///
/// [`WriteError`] names the path and says what went wrong.
pub fn write_durably(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), WriteError> {
    write_atomically(path, |out| {
        write(out)?;
        out.flush()?;
        // A pipe holds nothing that could last.
        if out.get_ref().metadata()?.is_file() { out.get_ref().sync_all() } else { Ok(()) }
    })?;
    // The name is written too. Where a folder cannot be opened, as on some systems, the file itself is safe.
    File::open(folder_of(&target_of(path))).and_then(|folder| folder.sync_all()).ok();
    Ok(())
}

/// Writes to standard output. A reader who has had enough and closed the pipe is no fault.
///
/// # Errors
///
/// [`WriteError`] says what went wrong.
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

/// Standard output as a file: what is written to it is not searched for line ends.
fn standard_output() -> io::Result<File> {
    #[cfg(unix)]
    let own = std::os::fd::AsFd::as_fd(&io::stdout()).try_clone_to_owned();
    #[cfg(windows)]
    let own = std::os::windows::io::AsHandle::as_handle(&io::stdout()).try_clone_to_owned();
    own.map(File::from)
}

/// The file that is written to: links are followed.
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

/// A new file beside the one that is to be written. It is removed where it is dropped.
fn aside_of(target: &Path) -> io::Result<(Unfinished, NamedTempFile<File>)> {
    // Made as any new file is: what `tempfile` makes by itself shuts out all others.
    Unfinished::new(|names| names.make_in(folder_of(target), |path| File::create_new(path)))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}
