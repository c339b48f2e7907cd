//! Lines on standard output and standard error. `println!` panics if it cannot write; these functions do not.

use std::fmt::Display;
use std::io::{ErrorKind, Write as _, stderr, stdout};

use super::error::CommandError;

/// Writes a line to standard output. A closed pipe is no error.
///
/// # Errors
///
/// [`CommandError::StandardOutput`] if the line cannot be written, for example on a full disk.
pub(super) fn say(text: impl Display) -> Result<(), CommandError> {
    let mut out = stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(CommandError::StandardOutput(error)),
        _ => Ok(()),
    }
}

/// Writes a line to standard error. Errors of writing are ignored.
pub fn warn(text: impl Display) {
    writeln!(stderr().lock(), "freebound: {text}").ok();
}
