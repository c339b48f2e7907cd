//! Imports between the files of each crate: short cycles within a folder, and none between the folders of the
//! library.
//!
//! The graph has a node for each file and an edge for each name that a file imports from another: by a `use` line,
//! or by a path that begins with `crate`, `self` or `super`. A re-exported name counts for the file that defines it,
//! and the re-export is no edge.

use std::collections::{BTreeMap, BTreeSet};

use super::sources::{CRATES, code_of, sources};

/// Largest number of files in a cycle.
const CYCLE_FILES: usize = 5;

/// Largest number of imports between a name and its definition.
const HOPS: usize = 12;

/// Source folder of the library.
const CORE: &str = "crates/freebound-core/src";

/// Folders of the library: each imports from those of the lines above it, and from itself.
const ORDER: [&[&str]; 11] = [
    &["geom", "mesh", "parallel"],
    &["linalg"],
    &["problem"],
    &["verify"],
    &["weights"],
    &["linear"],
    &["nonlinear"],
    &["bijective"],
    &["flatten"],
    &["cutting"],
    &["pipeline"],
];

/// Path of a module from the crate's root, or of an item in it.
type ModulePath = Vec<String>;

type Graph = BTreeMap<ModulePath, BTreeSet<ModulePath>>;

/// A name that a `use` line brings into a module.
struct Import {
    is_reexport: bool,
    path: ModulePath,
    name: String,
}

/// Imports of a file, and the paths in its code.
struct Module {
    imports: Vec<Import>,
    inline: Vec<ModulePath>,
}

type Modules = BTreeMap<ModulePath, Module>;

fn module_path(path: &str) -> ModulePath {
    let mut names: ModulePath = path.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
    names.pop_if(|name| ["mod", "lib", "main"].contains(&name.as_str()));
    names
}

/// Names of a use tree, and the signs `::`, `{`, `}`, `,` and `*`.
fn tokens(tree: &str) -> Vec<String> {
    let spaced =
        ["::", "{", "}", ",", "*"].iter().fold(tree.to_owned(), |text, sign| text.replace(sign, &format!(" {sign} ")));
    spaced.split_whitespace().filter(|token| *token != "::").map(str::to_owned).collect()
}

/// Paths of a use tree, each with the name that it imports.
fn paths(tokens: &[String], at: &mut usize, prefix: &[String]) -> Vec<(ModulePath, String)> {
    let mut path = prefix.to_vec();
    // After the last comma.
    if tokens.get(*at).is_some_and(|token| token == "}") {
        return Vec::new();
    }
    while let Some(token) = tokens.get(*at) {
        match token.as_str() {
            "{" => {
                let mut all = Vec::new();
                while tokens[*at] != "}" {
                    *at += 1;
                    all.extend(paths(tokens, at, &path));
                }
                *at += 1;
                return all;
            }
            "," | "}" => break,
            "as" => {
                *at += 2;
                return vec![(path, tokens[*at - 1].clone())];
            }
            // The path `a::{self}` is a.
            "self" if !path.is_empty() => *at += 1,
            _ => {
                path.push(token.clone());
                *at += 1;
            }
        }
    }
    path.last().cloned().map(|name| (path, name)).into_iter().collect()
}

/// Parses visibility and `use` at the start of a line: true if it re-exports, and the rest.
fn use_line(line: &str) -> Option<(bool, &str)> {
    let line = line.trim_start();
    let (is_reexport, rest) = match line.strip_prefix("pub") {
        Some(rest) => {
            (true, rest.strip_prefix('(').and_then(|rest| rest.split_once(')')).map_or(rest, |(_, rest)| rest))
        }
        None => (false, line),
    };
    rest.trim_start().strip_prefix("use ").map(|rest| (is_reexport, rest))
}

fn module(text: &str) -> Module {
    let code = code_of(text);
    // In tests within a file `super` is the file.
    let code = code.split("\n#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let (mut imports, mut rest) = (Vec::new(), String::new());
    let mut lines = code.lines();
    while let Some(line) = lines.next() {
        let Some((is_reexport, tree)) = use_line(line) else {
            rest += line;
            rest.push('\n');
            continue;
        };
        let mut tree = tree.to_owned();
        while !tree.contains(';') {
            tree += lines.next().expect("a use line ends");
        }
        let found = paths(&tokens(tree.trim_end_matches(';')), &mut 0, &[]);
        imports.extend(found.into_iter().map(|(path, name)| Import { is_reexport, path, name }));
    }
    Module { imports, inline: inline_paths(&rest) }
}

/// Paths in code that begin at the crate, at the module or above it. `pub(in …)` is none.
fn inline_paths(code: &str) -> Vec<ModulePath> {
    let code = code.replace("pub(in ", "pub(in_");
    let is_name = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let words = code.split(|c: char| !is_name(c)).map(|word| word.trim_end_matches(':'));
    let is_path = |word: &&str| ["crate::", "self::", "super::"].iter().any(|root| word.starts_with(root));
    words.filter(is_path).map(|word| word.split("::").map(str::to_owned).collect()).collect()
}

/// Path from the crate's root of a path written in a module; `None` for names of other crates.
fn from_root(modules: &Modules, module: &[String], path: &[String]) -> Option<ModulePath> {
    let joined = |base: &[String], rest: &[String]| [base, rest].concat();
    match path.first()?.as_str() {
        "crate" => Some(path[1..].to_vec()),
        "self" => Some(joined(module, &path[1..])),
        "super" => {
            let up = path.iter().take_while(|name| *name == "super").count();
            Some(joined(&module[..module.len().checked_sub(up)?], &path[up..]))
        }
        name => modules.contains_key(&joined(module, &[name.to_owned()])).then(|| joined(module, path)),
    }
}

/// Module that defines a path from the root. Re-imported names are followed at most `most` times.
fn definition(modules: &Modules, path: &[String], most: usize) -> Option<ModulePath> {
    let count = (0..=path.len()).rev().find(|&count| modules.contains_key(&path[..count]))?;
    let (module, rest) = path.split_at(count);
    let Some(name) = rest.first().filter(|name| *name != "*") else { return Some(module.to_vec()) };
    let Some(import) = modules[module].imports.iter().find(|import| import.name == *name) else {
        return Some(module.to_vec());
    };
    let target = from_root(modules, module, &import.path)?;
    definition(modules, &[&target, &rest[1..]].concat(), most.checked_sub(1)?)
}

fn graph(modules: &Modules) -> Graph {
    let edges = |(path, module): (&ModulePath, &Module)| {
        let imports = module.imports.iter().filter(|import| !import.is_reexport).map(|import| &import.path);
        let names = imports.chain(&module.inline).filter_map(|name| from_root(modules, path, name));
        let files = names.filter_map(|name| definition(modules, &name, HOPS)).filter(|file| file != path);
        (path.clone(), files.collect())
    };
    modules.iter().map(edges).collect()
}

/// Graph of the crate in a source folder.
fn graph_of(folder: &str) -> Graph {
    let sources = sources(&[folder]);
    let named = sources.iter().filter(|source| !source.path.ends_with("/main.rs"));
    graph(&named.map(|source| (module_path(&source.path[folder.len() + 1..]), module(&source.text))).collect())
}

fn reached<'a>(graph: &'a Graph, from: &'a ModulePath) -> BTreeSet<&'a ModulePath> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(file) = open.pop() {
        open.extend(graph.get(file).into_iter().flatten().filter(|next| seen.insert(*next)));
    }
    seen
}

/// Sets of two or more files that reach each other.
fn cycles(graph: &Graph) -> Vec<Vec<&ModulePath>> {
    let reach: BTreeMap<&ModulePath, BTreeSet<&ModulePath>> =
        graph.keys().map(|file| (file, reached(graph, file))).collect();
    let cycle = |file| reach[file].iter().copied().filter(|other| reach[*other].contains(file)).collect::<Vec<_>>();
    let all: BTreeSet<Vec<&ModulePath>> = graph.keys().map(cycle).filter(|cycle| cycle.len() > 1).collect();
    all.into_iter().collect()
}

fn words(cycle: &[&ModulePath]) -> String {
    let names: Vec<String> = cycle.iter().map(|file| file.join("::")).collect();
    format!("{} files: {}", names.len(), names.join(" "))
}

#[test]
fn no_cycle_of_imports_is_long() {
    let mut long = Vec::new();
    for folder in CRATES {
        let graph = graph_of(folder);
        let cycles = cycles(&graph).into_iter().filter(|cycle| cycle.len() > CYCLE_FILES);
        long.extend(cycles.map(|cycle| format!("{folder}: {}", words(&cycle))));
    }
    assert!(long.is_empty(), "cycles of more than {CYCLE_FILES} files:\n{}", long.join("\n"));
}

#[test]
fn no_cycle_crosses_a_folder_of_the_library() {
    let graph = graph_of(CORE);
    let crosses = |cycle: &&Vec<&ModulePath>| cycle.iter().any(|file| file.first() != cycle[0].first());
    let wrong: Vec<String> = cycles(&graph).iter().filter(crosses).map(|cycle| words(cycle)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn folders_of_the_library_import_in_their_order() {
    let level = |folder: &String| ORDER.iter().position(|level| level.contains(&folder.as_str()));
    let mut wrong = Vec::new();
    for (file, imported) in graph_of(CORE) {
        let Some(folder) = file.first() else { continue };
        assert!(level(folder).is_some(), "add {folder} to the order of the folders");
        let is_below =
            |other: &&ModulePath| other.first().is_some_and(|other| other != folder && level(other) >= level(folder));
        wrong.extend(
            imported.iter().filter(is_below).map(|other| format!("{} imports {}", file.join("::"), other.join("::"))),
        );
    }
    assert!(wrong.is_empty(), "against the order of the folders:\n{}", wrong.join("\n"));
}

#[test]
fn imports_of_every_form_are_edges_and_reexports_are_none() {
    let files = [
        ("lib.rs", "pub use a::Thing;\npub mod a;"),
        ("a/mod.rs", "mod one;\nmod two;\npub(crate) use one::{Thing, Other as Renamed};\npub use two::*;"),
        (
            "a/one.rs",
            "use super::two::Two;\nuse std::fmt;\n// use crate::c::Three;\n\n#[cfg(test)]\nmod tests {\n    use super::*;\n}\n",
        ),
        ("a/two.rs", "fn f() { crate::b::g(); super::super::c::h() }"),
        ("b.rs", "use crate::{\n    Thing,\n    a::Renamed,\n};\npub(in crate::c) fn g() {}"),
        ("c.rs", "use crate::a::{self, two::{Two}};"),
    ];
    let modules = files.iter().map(|(path, text)| (module_path(path), module(text))).collect();
    let told: Vec<String> = graph(&modules)
        .iter()
        .flat_map(|(file, others)| others.iter().map(move |other| format!("{} {}", file.join("/"), other.join("/"))))
        .collect();
    assert_eq!(told, ["a/one a/two", "a/two b", "a/two c", "b a/one", "c a", "c a/two"]);
    assert_eq!(cycles(&graph(&modules)).iter().map(std::vec::Vec::len).collect::<Vec<_>>(), [4]);
}
