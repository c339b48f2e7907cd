//! Writing of report files.

use std::path::Path;

use serde::Serialize;

use super::error::is_standard;
use freebound_io::{WriteError, write_atomically, write_report, write_to_standard_output};

/// Writes a report to a file, or to standard output for `-`.
pub(super) fn put_report(report: &impl Serialize, path: &Path) -> Result<(), WriteError> {
    if is_standard(path) {
        write_to_standard_output(|out| write_report(out, report))
    } else {
        write_atomically(path, |out| write_report(out, report))
    }
}
