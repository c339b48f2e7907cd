//! The files of `tests/data` are up to date with their makers.

use std::fs;

use freebound_testkit::{data_disks, data_files, data_folder};

#[test]
#[cfg_attr(not(all(target_os = "linux", target_env = "gnu")), ignore = "sines differ by the last bit between systems")]
fn the_files_of_tests_data_are_what_their_makers_make() {
    let remedy = "cargo run -p freebound-testkit --example data writes the files anew";
    let files = data_files();
    for (name, bytes) in &files {
        let read = fs::read(data_folder().join(name)).unwrap_or_else(|error| panic!("{name}: {error}; {remedy}"));
        assert!(*bytes == read, "{name}: {remedy}");
        assert!(bytes.len() < 60_000, "{name}: {} bytes", bytes.len());
    }
    // The folder of the messages has no maker.
    let found = fs::read_dir(data_folder()).unwrap().filter(|entry| entry.as_ref().is_ok_and(|e| e.path().is_file()));
    assert_eq!(found.count(), files.len(), "a file without a maker");
}

#[test]
fn the_disks_of_tests_data_are_disks() {
    for entry in data_disks() {
        assert!((100..1_000).contains(&entry.disk().face_count()), "{}", entry.file);
    }
}
