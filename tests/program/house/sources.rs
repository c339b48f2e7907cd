//! Source files of the workspace, for the tests of the house.

use std::fs;
use std::path::{Path, PathBuf};

/// Source folders of all crates, the program first.
pub(crate) const CRATES: [&str; 5] = [
    "src",
    "crates/freebound-core/src",
    "crates/freebound-io/src",
    "crates/freebound-run/src",
    "crates/freebound-testkit/src",
];

/// Folders of all tests.
pub(crate) const TESTS: [&str; 4] =
    ["tests", "crates/freebound-core/tests", "crates/freebound-io/tests", "crates/freebound-run/tests"];

/// Rust file.
pub(crate) struct Source {
    /// Path from the root of the workspace.
    pub(crate) path: String,
    pub(crate) text: String,
}

/// Root of the workspace.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All Rust files of some folders of the workspace, sorted by name.
pub(crate) fn sources(folders: &[&str]) -> Vec<Source> {
    let paths: Vec<PathBuf> = folders.iter().flat_map(|folder| files(&root().join(folder), "rs")).collect();
    assert!(!paths.is_empty(), "{folders:?} hold no source");
    let source = |path: PathBuf| Source {
        text: fs::read_to_string(&path).expect("source is text"),
        path: path.strip_prefix(root()).expect("a file of the workspace").display().to_string(),
    };
    paths.into_iter().map(source).collect()
}

/// All files below a folder whose names end in `extension`, sorted by name.
pub(crate) fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    let below = |path: PathBuf| if path.is_dir() { files(&path, extension) } else { vec![path] };
    let is_wanted = |path: &PathBuf| path.extension().is_some_and(|end| end == extension);
    paths.into_iter().flat_map(below).filter(is_wanted).collect()
}

/// Text without its comments. Two slashes within a string stay.
pub(crate) fn code_of(text: &str) -> String {
    let is_comment = |line: &str, at: usize| line[..at].matches('"').count().is_multiple_of(2);
    let code = |line: &str| {
        let end = line.match_indices("//").map(|(at, _)| at).find(|&at| is_comment(line, at));
        line[..end.unwrap_or(line.len())].to_owned() + "\n"
    };
    text.lines().map(code).collect()
}
