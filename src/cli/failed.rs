//! The report of a run that came to nothing. The report of an earlier run is never left in its place.

use std::fs;
use std::path::Path;

use super::Failure;
use super::exit::{FALLS_SHORT, METHOD_REMEDY, TEXTURE_REMEDY, UNUSABLE_INPUT, message_of};
use super::say::warn;
use super::standard::name_of_input;
use super::summary::put_report;
use crate::io::{ErrorReport, ErrorWords, FaultReport, ReadError};

/// What a run is about, and where its report goes.
#[derive(Clone, Copy)]
pub(super) struct Subject<'a> {
    pub(super) mesh: &'a Path,
    pub(super) report: Option<&'a Path>,
}

impl Subject<'_> {
    /// Writes the report of a run that failed: one with the error where the input cannot be used or the method gives
    /// nothing. Where a run broke off there is none, and wrong use leaves everything as it is.
    pub(super) fn report_failure(self, failure: &Failure) {
        let Some(path) = self.report else { return };
        match (failure, failure.code()) {
            (_, UNUSABLE_INPUT | FALLS_SHORT) => {
                if let Err(error) = put_report(&self.report_of(failure), path) {
                    forget(path);
                    warn(error);
                }
            }
            (Failure::Usage(_), _) => {}
            _ => forget(path),
        }
    }

    fn report_of(self, failure: &Failure) -> ErrorReport {
        let (remedy, faults) = remedy_and_faults(failure);
        let message = message_of(failure, Some(self));
        let words = ErrorWords { exit_status: failure.code(), kind: kind_of(failure), message, remedy, faults };
        ErrorReport::new(name_of_input(self.mesh), words)
    }
}

/// Takes away what an earlier run has reported.
fn forget(path: &Path) {
    if path.is_file()
        && let Err(error) = fs::remove_file(path)
    {
        warn(format_args!("{}: the report of an earlier run cannot be removed: {error}", path.display()));
    }
}

fn remedy_and_faults(failure: &Failure) -> (Option<&'static str>, Vec<FaultReport>) {
    match failure {
        Failure::Read { error, .. } => (Some(error.remedy()), FaultReport::of_file(error)),
        Failure::Constraints(error) => (None, FaultReport::of_constraints(error)),
        Failure::Texture { error, .. } => (Some(TEXTURE_REMEDY), FaultReport::of_texture(error)),
        Failure::NotADisk { diagnosis, .. } => (None, FaultReport::of_diagnosis(diagnosis)),
        Failure::Method { .. } => (Some(METHOD_REMEDY), Vec::new()),
        _ => (None, Vec::new()),
    }
}

/// What could not be used or done, in a word.
fn kind_of(failure: &Failure) -> &'static str {
    match failure {
        Failure::Read { error, .. } => match error {
            ReadError::Unreadable(_) => "unreadable",
            ReadError::NotReadYet(_) => "format-not-read",
            ReadError::NoFaces { .. } => "no-faces",
            ReadError::TooLarge => "too-large",
            _ => "not-understood",
        },
        Failure::Constraints(_) => "constraints",
        Failure::Picture(_) => "picture",
        Failure::Texture { .. } => "texture-coordinates",
        Failure::NotADisk { .. } => "not-a-disk",
        Failure::Solve(error) | Failure::Method { error, .. } => error.name(),
        Failure::Write(_) | Failure::StandardOutput(_) => "not-written",
        Failure::Usage(_) => "wrong-use",
    }
}
