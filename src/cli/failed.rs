//! The report of a run that came to nothing. The report of an earlier run is never left in its place.

use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use super::Failure;
use super::exit::{
    FALLS_SHORT, FRAMES_REMEDY, MEMORY_REMEDY, METHOD_REMEDY, MORPH_REMEDY, TEXTURE_REMEDY, UNUSABLE_INPUT, WRONG_USE,
    message_of,
};
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

    fn report_of(self, failure: &Failure) -> ErrorReport {
        let (remedy, faults) = remedy_and_faults(failure);
        let message = message_of(failure, Some(self));
        let words = ErrorWords { exit_status: failure.code(), kind: kind_of(failure), message, remedy, faults };
        ErrorReport::new(name_of_input(self.mesh), words)
    }
}

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
fn may_be_replaced(path: &Path) -> bool {
    let mut first = [b'{'];
    let begins = fs::File::open(path).and_then(|mut file| file.read(&mut first));
    !path.is_file() || (begins.is_ok() && first == [b'{'])
}

/// Takes away what an earlier run has reported.
fn forget(path: &Path) {
    if !may_be_replaced(path) {
        warn(format_args!("{}: no report of an earlier run, left as it is", path.display()));
    } else if path.is_file()
        && let Err(error) = fs::canonicalize(path).and_then(fs::remove_file)
    {
        warn(format_args!("{}: the report of an earlier run cannot be removed: {error}", path.display()));
    }
}

fn remedy_and_faults(failure: &Failure) -> (Option<&'static str>, Vec<FaultReport>) {
    match failure {
        Failure::Read { error, .. } => (Some(error.remedy()), FaultReport::of_file(error)),
        Failure::Constraints(error) => (None, FaultReport::of_constraints(error)),
        Failure::Edges(error) => (None, FaultReport::of_edges(error)),
        Failure::Texture { error, .. } => (Some(TEXTURE_REMEDY), FaultReport::of_texture(error)),
        Failure::NotADisk { diagnosis, .. } => (None, FaultReport::of_diagnosis(diagnosis)),
        Failure::Memory { .. } => (Some(MEMORY_REMEDY), Vec::new()),
        Failure::Method { .. } => (Some(METHOD_REMEDY), Vec::new()),
        Failure::NoMorph { .. } => (Some(MORPH_REMEDY), Vec::new()),
        Failure::MorphMemory { .. } => (Some(FRAMES_REMEDY), Vec::new()),
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
        Failure::Memory { .. } | Failure::MorphMemory { .. } => "too-large-for-memory",
        Failure::Constraints(_) => "constraints",
        Failure::Edges(_) => "edges",
        Failure::Picture(_) => "picture",
        Failure::Texture { .. } => "texture-coordinates",
        Failure::NotADisk { .. } => "not-a-disk",
        Failure::Solve(error) | Failure::Method { error, .. } => error.name(),
        Failure::NoMorph { .. } => "no-morph",
        Failure::Write(error) if error.is_of_input() => "unreadable",
        Failure::Write(_) | Failure::StandardOutput(_) => "not-written",
        Failure::Usage(_) => "wrong-use",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::MorphShortage;

    #[test]
    fn frames_that_take_too_much_memory_are_no_result_and_the_remedy_is_fewer() {
        let shortage = MorphShortage { frames: 1000, needed: 3 << 30, memory: 4 << 30 };
        let failure = Failure::MorphMemory { path: "mesh.obj".to_owned(), shortage };
        let words = "mesh.obj: 1000 frames from map to map take 3.0 GiB in all, more than half of the machine's memory of 4.0 GiB; \
                     ask for fewer --frames, or name fewer --methods";
        assert_eq!(failure.to_string(), words);
        assert_eq!((failure.code(), kind_of(&failure)), (FALLS_SHORT, "too-large-for-memory"));
        let (remedy, faults) = remedy_and_faults(&failure);
        assert!(remedy == Some(FRAMES_REMEDY) && faults.is_empty());
    }
}
