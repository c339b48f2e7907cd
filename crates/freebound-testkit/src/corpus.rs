//! Corpus of third-party meshes, which are not part of the project.

use std::path::{Path, PathBuf};

/// Folder of the corpus: `../shared/corpus`, or the one that `FREEBOUND_CORPUS` named when this crate was built.
///
/// # Panics
///
/// If there is no corpus. Tests over the corpus belong in [`corpus_test!`](crate::corpus_test).
pub fn corpus() -> PathBuf {
    let folder = Path::new(env!("FREEBOUND_CORPUS_FOLDER")).to_path_buf();
    assert!(folder.join("manifest.csv").is_file(), "there is no corpus at {}", folder.display());
    folder
}

/// Tests over the corpus: ordinary tests if it is there, ignored and counted as such if it is missing.
///
/// ```
/// freebound_testkit::corpus_test! {
///     /// Attributes and documentation pass through.
///     fn every_disk_has_one_boundary_loop() {
///         for entry in freebound_testkit::corpus_disks() {
///             assert_eq!(entry.number("boundary_loops"), Some(1), "{}", entry.file);
///         }
///     }
/// }
/// ```
#[cfg(corpus)]
#[macro_export]
macro_rules! corpus_test {
    ($($(#[$attribute:meta])* fn $name:ident() $body:block)+) => {
        $(
            $(#[$attribute])*
            #[test]
            fn $name() $body
        )+
    };
}

/// Tests over the corpus, which is missing: ignored, and counted as such.
#[cfg(not(corpus))]
#[macro_export]
macro_rules! corpus_test {
    ($($(#[$attribute:meta])* fn $name:ident() $body:block)+) => {
        $(
            #[test]
            #[ignore = "../shared/corpus is missing"]
            #[allow(unused_attributes, reason = "a slow test has a reason of its own to be ignored")]
            $(#[$attribute])*
            fn $name() $body
        )+
    };
}
