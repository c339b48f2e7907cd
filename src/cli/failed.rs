//! Report of a failed run. The report of an earlier run never stays in its place.

use std::path::Path;

use super::awaited::{forget, may_be_replaced};
use super::error::{
    CommandError, FALLS_SHORT, FRAMES_REMEDY, LAYOUT_REMEDY, MEMORY_REMEDY, METHOD_REMEDY, MORPH_REMEDY,
    TEXTURE_REMEDY, UNUSABLE_INPUT, WRONG_USE, message_of, name_of_input, transfer_remedy,
};
use super::report_file::put_report;
use super::say::warn;
use freebound_io::{ErrorReport, ErrorWords, FaultReport, LayoutToPackError, ReadError, TransferError};

/// Mesh of a run, and path of its report.
#[derive(Clone, Copy)]
pub(super) struct ReportTarget<'a> {
    pub(super) mesh: &'a Path,
    pub(super) report: Option<&'a Path>,
}

impl ReportTarget<'_> {
    /// Writes the report of a failed run. It holds the error if the input cannot be used or the method fails. After an
    /// interruption or internal error an earlier report is removed. Invalid usage leaves all files unchanged.
    pub(super) fn report_failure(self, failure: &CommandError) {
        let Some(path) = self.report else { return };
        match failure.code() {
            WRONG_USE => {}
            UNUSABLE_INPUT | FALLS_SHORT if may_be_replaced(path) => {
                if let Err(error) = put_report(&self.report_of(failure), path) {
                    forget(path);
                    warn(error);
                }
            }
            _ => forget(path),
        }
    }

    fn report_of(self, failure: &CommandError) -> ErrorReport {
        let (remedy, faults) = remedy_and_faults(failure);
        let message = message_of(failure, Some(self.mesh));
        let words = ErrorWords { exit_status: failure.code(), kind: kind_of(failure), message, remedy, faults };
        ErrorReport::new(name_of_input(self.mesh), words)
    }
}

fn remedy_and_faults(failure: &CommandError) -> (Option<&'static str>, Vec<FaultReport>) {
    match failure {
        CommandError::Read { error, .. } => (Some(error.remedy()), FaultReport::of_file(error)),
        CommandError::Constraints(error) => (None, FaultReport::of_constraints(error)),
        CommandError::Edges(error) => (None, FaultReport::of_edges(error)),
        CommandError::Texture { error, .. } => (Some(TEXTURE_REMEDY), FaultReport::of_texture(error)),
        CommandError::LayoutToPack { error, .. } => (Some(LAYOUT_REMEDY), faults_of_layout(error)),
        CommandError::Transfer { error, .. } => (Some(transfer_remedy(error)), faults_of_transfer(error)),
        CommandError::NotADisk { diagnosis, .. } => (None, FaultReport::of_diagnosis(diagnosis)),
        CommandError::Memory { .. } => (Some(MEMORY_REMEDY), Vec::new()),
        CommandError::Method { .. } => (Some(METHOD_REMEDY), Vec::new()),
        CommandError::NoMorph { .. } => (Some(MORPH_REMEDY), Vec::new()),
        CommandError::MorphMemory { .. } => (Some(FRAMES_REMEDY), Vec::new()),
        _ => (None, Vec::new()),
    }
}

fn faults_of_layout(error: &LayoutToPackError) -> Vec<FaultReport> {
    match error {
        LayoutToPackError::Texture(error) => FaultReport::of_texture(error),
        _ => Vec::new(),
    }
}

fn faults_of_transfer(error: &TransferError) -> Vec<FaultReport> {
    match error {
        TransferError::Texture(error) => FaultReport::of_texture(error),
        _ => Vec::new(),
    }
}

/// Short name of the failure.
fn kind_of(failure: &CommandError) -> &'static str {
    match failure {
        CommandError::Read { error, .. } => match error {
            ReadError::Unreadable(_) => "unreadable",
            ReadError::NotReadYet(_) => "format-not-read",
            ReadError::NoFaces { .. } => "no-faces",
            ReadError::TooLarge => "too-large",
            _ => "not-understood",
        },
        CommandError::Memory { .. } | CommandError::MorphMemory { .. } => "too-large-for-memory",
        CommandError::Constraints(_) => "constraints",
        CommandError::Landmarks(_) => "landmarks",
        CommandError::Edges(_) => "edges",
        CommandError::Picture(_) => "picture",
        CommandError::Transfer { error: TransferError::NoFaces, .. } => "no-faces",
        CommandError::Texture { .. } | CommandError::LayoutToPack { .. } | CommandError::Transfer { .. } => {
            "texture-coordinates"
        }
        CommandError::NotADisk { .. } => "not-a-disk",
        CommandError::Solve(error) | CommandError::Method { error, .. } => error.name(),
        CommandError::NoMorph { .. } => "no-morph",
        CommandError::Pattern(_) => "no-pattern",
        CommandError::Write(error) if error.is_of_input() => "unreadable",
        CommandError::Write(_) | CommandError::StandardOutput(_) => "not-written",
        CommandError::Usage(_) => "wrong-use",
    }
}

#[cfg(test)]
mod tests {
    use freebound_testkit::assert_message;

    use super::*;
    use crate::session::MorphShortage;

    #[test]
    fn frames_that_take_too_much_memory_are_no_result_and_the_remedy_is_fewer() {
        let shortage = MorphShortage { frames: 1000, needed: 3 << 30, memory: 4 << 30 };
        let failure = CommandError::MorphMemory { path: "mesh.obj".to_owned(), shortage };
        assert_message("failed-morph-too-large-for-memory", &failure.to_string());
        assert_eq!((failure.code(), kind_of(&failure)), (FALLS_SHORT, "too-large-for-memory"));
        let (remedy, faults) = remedy_and_faults(&failure);
        assert!(remedy == Some(FRAMES_REMEDY) && faults.is_empty());
    }
}
