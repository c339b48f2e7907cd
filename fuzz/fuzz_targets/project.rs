//! Reads any bytes as a project file: accepted or refused. An accepted project is written and read again unchanged.
#![no_main]

use freebound_io::{PathStyle, ProjectFile};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("any.freebound");
    std::fs::write(&path, bytes).expect("written");
    let Ok(project) = ProjectFile::read(&path) else { return };
    let again = folder.path().join("again.freebound");
    project.write(&again, PathStyle::Relative).expect("what was read can be written");
    assert_eq!(ProjectFile::read(&again).expect("what was written can be read"), project);
});
