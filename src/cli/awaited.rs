//! The report file of a run under way: an earlier run's report never stays in its place.

use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use super::say::warn;

/// Where the report of a run under way goes: should it be interrupted, that of an earlier run goes.
static AWAITED: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Says where the report of the run goes.
pub(super) fn await_report(path: Option<&Path>) {
    if let Ok(mut awaited) = AWAITED.lock() {
        *awaited = path.map(Path::to_owned);
    }
}

/// Takes away the report of an earlier run in the place of the one that will not come.
pub(super) fn forget_awaited() {
    if let Some(path) = AWAITED.lock().ok().and_then(|mut awaited| awaited.take()) {
        forget(&path);
    }
}

/// Whether a file is a report, as far as its first byte tells, or none at all. A run that has failed early does not know
/// all files that it reads.
pub(super) fn may_be_replaced(path: &Path) -> bool {
    let mut first = [b'{'];
    let begins = fs::File::open(path).and_then(|mut file| file.read(&mut first));
    !path.is_file() || (begins.is_ok() && first == [b'{'])
}

/// Takes away what an earlier run has reported.
pub(super) fn forget(path: &Path) {
    if !may_be_replaced(path) {
        warn(format_args!("{}: no report of an earlier run, left as it is", path.display()));
    } else if path.is_file()
        && let Err(error) = fs::canonicalize(path).and_then(fs::remove_file)
    {
        warn(format_args!("{}: the report of an earlier run cannot be removed: {error}", path.display()));
    }
}
