//! Report file of the current run. The report of an earlier run never stays in its place.

use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use super::say::warn;

/// Path of the current run's report. If the run is interrupted, a report of an earlier run at this path is removed.
static AWAITED: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Sets the path of the current run's report.
pub(super) fn await_report(path: Option<&Path>) {
    if let Ok(mut awaited) = AWAITED.lock() {
        *awaited = path.map(Path::to_owned);
    }
}

/// Removes the report of an earlier run at the path of the awaited report.
pub(super) fn forget_awaited() {
    if let Some(path) = AWAITED.lock().ok().and_then(|mut awaited| awaited.take()) {
        forget(&path);
    }
}

/// True if the path holds no file, or a file that begins like a report. A run that failed early does not know all files
/// that it reads.
pub(super) fn may_be_replaced(path: &Path) -> bool {
    let mut first = [b'{'];
    let begins = fs::File::open(path).and_then(|mut file| file.read(&mut first));
    !path.is_file() || (begins.is_ok() && first == [b'{'])
}

/// Removes the report of an earlier run.
pub(super) fn forget(path: &Path) {
    if !may_be_replaced(path) {
        warn(format_args!("{}: not a report of an earlier run: the file is kept", path.display()));
    } else if path.is_file()
        && let Err(error) = fs::canonicalize(path).and_then(fs::remove_file)
    {
        warn(format_args!("{}: the report of an earlier run cannot be removed: {error}", path.display()));
    }
}
