//! Every path that `book/src/contributing/architecture.md` names exists.

use std::fs;

use super::sources::root;

/// Source folders by their short names in the document.
const SHORT: [(&str, &str); 5] = [
    ("core/", "crates/freebound-core/src/"),
    ("io/", "crates/freebound-io/src/"),
    ("run/", "crates/freebound-run/src/"),
    ("testkit/", "crates/freebound-testkit/src/"),
    ("", ""),
];

/// Words between backticks that are paths: they have a slash and otherwise only characters of file names.
fn paths(text: &str) -> Vec<&str> {
    let is_sign = |c: char| c.is_alphanumeric() || "/._-".contains(c);
    let is_path = |word: &&str| word.contains('/') && word.chars().all(is_sign);
    text.split('`').skip(1).step_by(2).filter(is_path).collect()
}

#[test]
fn every_path_of_the_architecture_exists() {
    let text = fs::read_to_string(root().join("book/src/contributing/architecture.md")).expect("the page is there");
    let paths = paths(&text);
    assert!(paths.len() > 30, "only {} paths were found", paths.len());
    let exists = |path: &&str| {
        let (short, folder) = SHORT.iter().find(|(short, _)| path.starts_with(short)).expect("the last fits all");
        root().join(folder).join(&path[short.len()..]).exists()
    };
    let missing: Vec<&str> = paths.into_iter().filter(|path| !exists(path)).collect();
    assert!(
        missing.is_empty(),
        "book/src/contributing/architecture.md names what is not there:\n{}",
        missing.join("\n")
    );
}
