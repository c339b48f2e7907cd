//! Words on standard output and standard error. `println!` panics where they cannot be written; these do not.

use std::fmt::Display;
use std::io::{ErrorKind, Write as _, stderr, stdout};

use super::error::CommandError;

/// Writes a line to standard output. A reader who has had enough and closed the pipe is no fault.
///
/// # Errors
///
/// Where it cannot be written: on a full disk, say.
pub(super) fn say(text: impl Display) -> Result<(), CommandError> {
    let mut out = stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(CommandError::StandardOutput(error)),
        _ => Ok(()),
    }
}

/// Writes a line to standard error. Where that is impossible, there is nobody to tell.
pub fn warn(text: impl Display) {
    writeln!(stderr().lock(), "freebound: {text}").ok();
}
