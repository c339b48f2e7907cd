//! The arrows of DESIGN §4: a layer imports only from those above it.

use std::fs;
use std::path::{Path, PathBuf};

/// Each layer of `src`, with the layers that it may import from, itself excepted.
const ARROWS: [(&str, &[&str]); 12] = [
    ("geom", &[]),
    ("mesh", &[]),
    ("linalg", &[]),
    ("solver", &["geom", "mesh", "linalg"]),
    ("io", &["geom", "mesh", "linalg", "solver"]),
    ("examples", &["geom", "mesh", "io"]),
    ("session", &["geom", "mesh", "linalg", "examples", "solver", "io"]),
    ("view", &["geom", "mesh", "linalg", "examples", "solver", "io", "session"]),
    ("render", &["geom", "mesh", "linalg", "examples", "solver", "io", "session", "view"]),
    ("ui", &["geom", "mesh", "linalg", "examples", "solver", "io", "session", "view", "render"]),
    ("app", &["geom", "mesh", "linalg", "examples", "solver", "io", "session", "view", "render", "ui"]),
    // Below the screen in the picture, but it has to compile without one.
    ("cli", &["geom", "mesh", "linalg", "examples", "solver", "io", "session", "view"]),
];

fn source_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// All Rust files under a folder, by name.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    paths
        .into_iter()
        .flat_map(|path| if path.is_dir() { rust_files(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .collect()
}

/// The modules that a file lies in, from the top: `["mesh", "disk"]` for `src/mesh/disk.rs`.
fn module_path(file: &Path) -> Vec<String> {
    let relative = file.strip_prefix(source_folder()).expect("a file of src").with_extension("");
    let mut names: Vec<String> = relative.iter().map(|name| name.to_string_lossy().into_owned()).collect();
    names.pop_if(|name| name == "mod");
    names
}

/// Without comments. Strings stay: the names that are looked for do not stand in any.
fn code_of(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// The first names behind a path's root: of `{a::b, c}` both a and c.
fn first_names(rest: &str) -> Vec<String> {
    let name_at =
        |text: &str| -> String { text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect() };
    let Some(group) = rest.strip_prefix('{') else { return vec![name_at(rest)] };
    let mut depth = 0;
    let mut names = vec![name_at(group)];
    for (at, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => names.push(name_at(&group[at + 1..])),
            _ => {}
        }
    }
    names
}

/// The names at the top of the crate that code of a module reaches: through `crate::`, and through enough `super::`.
fn imports(code: &str, depth: usize) -> Vec<String> {
    let mut found: Vec<String> = code.split("crate::").skip(1).flat_map(first_names).collect();
    let above = "super::".repeat(depth);
    found.extend(code.split(above.as_str()).skip(1).flat_map(first_names));
    found
}

/// Imports of a file against the arrows, in words.
fn wrong_imports(modules: &[String], text: &str) -> Vec<String> {
    let own = modules[0].as_str();
    let Some((_, allowed)) = ARROWS.iter().find(|(layer, _)| *layer == own) else {
        return vec![format!("src/{own} stands in no layer: add it to the arrows")];
    };
    let is_layer = |name: &str| ARROWS.iter().any(|(layer, _)| *layer == name);
    imports(&code_of(text), modules.len())
        .into_iter()
        .filter(|name| is_layer(name) && name != own && !allowed.contains(&name.as_str()))
        .map(|name| format!("{} imports {name}", modules.join("::")))
        .collect()
}

#[test]
fn no_layer_imports_from_below_or_beside() {
    let mut wrong = Vec::new();
    let mut seen = 0;
    for file in rust_files(&source_folder()) {
        let modules = module_path(&file);
        if modules == ["lib"] || modules == ["main"] {
            continue;
        }
        seen += 1;
        wrong.extend(wrong_imports(&modules, &fs::read_to_string(&file).expect("source is text")));
    }
    assert!(seen > 50, "only {seen} files were found");
    assert!(wrong.is_empty(), "against the arrows of src/lib.rs:\n{}", wrong.join("\n"));
}

#[test]
fn a_wrong_import_is_found_in_every_form() {
    let modules = ["mesh", "disk"].map(str::to_owned);
    for text in [
        "use crate::solver::Verdict;",
        "use crate::{mesh::FaceId, solver::Verdict};",
        "use crate::{mesh::{FaceId, EdgeId},\n    solver};",
        "fn f() { crate::solver::verdict(); }",
        "use super::super::solver::Verdict;",
        "pub(crate) use crate::solver as maths;",
    ] {
        assert_eq!(wrong_imports(&modules, text), ["mesh::disk imports solver"], "{text}");
    }
    for text in ["// use crate::solver::Verdict;", "use crate::mesh::{solver, FaceId};", "use super::solver;"] {
        assert!(wrong_imports(&modules, text).is_empty(), "{text}");
    }
}
