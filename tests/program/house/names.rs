//! Names of public types: each is unique in the workspace.

use std::collections::BTreeMap;

use super::sources::{CRATES, code_of, sources};

/// Names of the public structs, enums and traits that a file defines.
fn public_types(text: &str) -> Vec<String> {
    let name = |line: &str| {
        let item = line.trim_start().strip_prefix("pub ")?;
        let item = item.strip_prefix("unsafe ").unwrap_or(item);
        let rest = ["struct ", "enum ", "trait "].iter().find_map(|kind| item.strip_prefix(kind))?;
        Some(rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect())
    };
    code_of(text).lines().filter_map(name).collect()
}

#[test]
fn no_two_public_types_share_a_name() {
    let mut files: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for source in sources(&CRATES) {
        for name in public_types(&source.text) {
            files.entry(name).or_default().push(source.path.clone());
        }
    }
    assert!(files.len() > 100, "only {} public types were found", files.len());
    let shared: Vec<String> = files
        .iter()
        .filter(|(_, files)| files.len() > 1)
        .map(|(name, files)| format!("{name}: {}", files.join(" ")))
        .collect();
    assert!(shared.is_empty(), "one name, two types:\n{}", shared.join("\n"));
}

#[test]
fn public_types_of_every_form_are_found() {
    let text = "pub struct A<T>(T);\n    pub enum B {}\npub trait C: Send {}\npub(crate) struct D;\n// pub struct E;\npub type F = u8;";
    assert_eq!(public_types(text), ["A", "B", "C"]);
}
