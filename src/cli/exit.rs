//! End of a command: its last message, its report and its exit status.

use std::process::ExitCode;

use super::error::{CommandError, CommandOutcome, FALLS_SHORT, message_of};
use super::failed::ReportTarget;
use super::say::warn;

/// Prints an error, writes the report of a failed run, and returns the exit status of the process.
pub(super) fn conclude(outcome: Result<CommandOutcome, CommandError>, subject: Option<ReportTarget<'_>>) -> ExitCode {
    match outcome {
        Ok(CommandOutcome::Fine) => ExitCode::SUCCESS,
        Ok(CommandOutcome::FallsShort) => ExitCode::from(FALLS_SHORT),
        Ok(CommandOutcome::Batch(worst)) => ExitCode::from(worst),
        Err(failure) => {
            warn(message_of(&failure, subject.map(|subject| subject.mesh)));
            if let Some(subject) = subject {
                subject.report_failure(&failure);
            }
            ExitCode::from(failure.code())
        }
    }
}
