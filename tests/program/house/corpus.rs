//! Tests over the corpus use `corpus_test!`, so that they are counted as ignored if it is missing.

use std::collections::BTreeSet;

use super::sources::{TESTS, code_of, sources};

/// Functions of the testkit that read the corpus.
const READERS: [&str; 4] = ["corpus", "corpus_disks", "corpus_entry", "manifest"];

/// Function of a file: its name and body; `is_test` is true for a test.
struct Function<'a> {
    name: &'a str,
    body: &'a str,
    is_test: bool,
}

/// End of the first block in `code`, in bytes. Braces in strings count, since they come in pairs.
fn block_end(code: &str) -> usize {
    let mut depth = 0_usize;
    for (at, c) in code.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 1 => return at + 1,
            '}' => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    code.len()
}

/// Code without its `corpus_test!` blocks.
fn outside_the_macro(code: &str) -> String {
    let mut kept = String::new();
    let mut rest = code;
    while let Some((before, from)) = rest.split_once("corpus_test! {") {
        kept += before;
        rest = &from[block_end(&format!("{{{from}")) - 1..];
    }
    kept + rest
}

/// Functions at the top level of a file.
fn functions(code: &str) -> Vec<Function<'_>> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(start) = code[at..].find("fn ").map(|start| at + start) {
        let line = code[..start].rfind('\n').map_or(0, |end| end + 1);
        let name_end = code[start + 3..]
            .find(|c: char| !c.is_alphanumeric() && c != '_')
            .map_or(code.len(), |end| start + 3 + end);
        let is_at_top = ["", "pub(crate) "].contains(&&code[line..start]);
        if !is_at_top {
            at = start + 3;
            continue;
        }
        let end = start + block_end(&code[start..]);
        let attributes = code[..line].lines().rev().take_while(|line| line.starts_with("#["));
        let is_test = attributes.into_iter().any(|line| line == "#[test]");
        found.push(Function { name: &code[start + 3..name_end], body: &code[name_end..end], is_test });
        at = end;
    }
    found
}

/// True if a text calls one of these functions, or mentions it by name.
fn mentions(text: &str, names: &BTreeSet<&str>) -> bool {
    let words = text.split(|c: char| !c.is_alphanumeric() && c != '_' && c != '"' && c != '.');
    words.into_iter().any(|word| names.contains(word))
}

/// Tests outside the macro that reach the corpus, directly or by functions of their file.
fn loose_tests(text: &str) -> Vec<String> {
    let code = outside_the_macro(&code_of(text));
    let functions = functions(&code);
    let mut readers = BTreeSet::from(READERS);
    loop {
        let more = functions.iter().filter(|function| !function.is_test && mentions(function.body, &readers));
        let count = readers.len();
        readers.extend(more.map(|function| function.name).collect::<Vec<_>>());
        if readers.len() == count {
            break;
        }
    }
    let loose = functions.iter().filter(|function| function.is_test && mentions(function.body, &readers));
    loose.map(|function| function.name.to_owned()).collect()
}

#[test]
fn tests_over_the_corpus_stand_in_their_macro() {
    let (mut loose, mut in_macro) = (Vec::new(), 0);
    for source in sources(&TESTS).iter().filter(|source| !source.path.ends_with("house/corpus.rs")) {
        in_macro += source.text.matches("corpus_test! {").count();
        loose.extend(loose_tests(&source.text).into_iter().map(|name| format!("{}: {name}", source.path)));
    }
    assert!(in_macro > 40, "only {in_macro} tests over the corpus were found");
    assert!(loose.is_empty(), "these pass over nothing if the corpus is missing:\n{}", loose.join("\n"));
}

#[test]
fn loose_tests_are_found_in_every_form() {
    let loose = "fn all() -> Vec<Entry> {\n    corpus_disks()\n}\n\nfn each() {\n    for e in all() {}\n}\n";
    for body in ["each();", "let path = corpus().join(\"x\");", "for e in manifest() {}", "names.map(corpus_entry);"] {
        let text = format!("{loose}#[test]\n#[ignore = \"slow\"]\nfn one() {{\n    {body}\n}}\n");
        assert_eq!(loose_tests(&text), ["one"], "{text}");
        let text =
            format!("{loose}corpus_test! {{\n    fn one() {{\n        {body}\n    }}\n}}\n\n#[test]\nfn two() {{}}\n");
        assert!(loose_tests(&text).is_empty(), "{text}");
    }
    assert!(loose_tests("#[test]\nfn one() {\n    // of the corpus\n    f(\"corpus\", x.manifest);\n}\n").is_empty());
}
