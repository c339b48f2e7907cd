//! Prose: doc lines begin with their subject, the README fits a screen or two, and links of the book lead somewhere.

use std::fs;
use std::path::PathBuf;

use pulldown_cmark::{Event, LinkType, Options, Parser, Tag, TagEnd};

use super::sources::{CRATES, TESTS, files, root, sources};

/// Words that a doc line must not begin with: the subject comes first.
const FORBIDDEN: [&str; 9] = ["What", "Whether", "How", "Where", "Why", "It", "As", "That", "Those"];
const FORBIDDEN_PAIRS: [&str; 2] = ["The same", "One"];

/// Limits of the README.
const README_LINES: usize = 160;
const README_BYTES: usize = 12 << 10;

/// Doc text of a line, without its slashes.
fn doc_text(line: &str) -> Option<&str> {
    let line = line.trim_start();
    line.strip_prefix("//! ").or_else(|| line.strip_prefix("/// "))
}

fn begins_badly(text: &str) -> bool {
    let begins = |word: &&str| {
        text.strip_prefix(*word).is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '-'))
    };
    FORBIDDEN.iter().chain(&FORBIDDEN_PAIRS).any(begins)
}

#[test]
fn doc_lines_begin_with_their_subject() {
    let folders: Vec<&str> =
        CRATES.into_iter().chain(TESTS).chain(["benches", "examples", "fuzz/fuzz_targets"]).collect();
    let mut bad = Vec::new();
    let mut count = 0;
    for source in sources(&folders) {
        for (number, line) in (1..).zip(source.text.lines()) {
            count += usize::from(doc_text(line).is_some());
            if doc_text(line).is_some_and(begins_badly) {
                bad.push(format!("{}:{number}: {}", source.path, line.trim()));
            }
        }
    }
    assert!(count > 5000, "only {count} doc lines were found");
    assert!(bad.is_empty(), "{} doc lines begin without a subject:\n{}", bad.len(), bad.join("\n"));
}

#[test]
fn bad_beginnings_are_recognised() {
    for bad in ["What it is.", "It ends.", "The same with pins.", "One of two.", "As long as it lasts."] {
        assert!(begins_badly(bad), "{bad}");
    }
    for good in ["Item of a list.", "One-to-one maps.", "Assembles the matrix.", "The samples.", "However it ends."] {
        assert!(!begins_badly(good), "{good}");
    }
}

#[test]
fn the_readme_is_short() {
    let text = fs::read_to_string(root().join("README.md")).expect("the README is there");
    let lines = text.lines().count();
    assert!(lines <= README_LINES, "{lines} lines, more than {README_LINES}");
    assert!(text.len() <= README_BYTES, "{} bytes, more than {README_BYTES}", text.len());
}

/// Anchors that mdBook and GitHub give to the headings of a page.
fn anchors(text: &str) -> Vec<String> {
    let (mut all, mut heading) = (Vec::new(), None);
    for event in Parser::new_ext(text, Options::ENABLE_TABLES) {
        match (event, &mut heading) {
            (Event::Start(Tag::Heading { .. }), _) => heading = Some(String::new()),
            (Event::End(TagEnd::Heading(_)), Some(words)) => {
                let kept = words.to_lowercase();
                let kept = kept.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
                all.push(kept.map(|c| if c == ' ' { '-' } else { c }).collect());
                heading = None;
            }
            (Event::Text(text) | Event::Code(text), Some(words)) => words.push_str(&text),
            _ => {}
        }
    }
    all
}

/// Links of a page that lead to files: their path, and the anchor in it.
fn links(text: &str) -> Vec<(String, String)> {
    let target = |event| match event {
        Event::Start(Tag::Link { link_type, dest_url, .. }) if link_type != LinkType::Autolink => Some(dest_url),
        Event::Start(Tag::Image { dest_url, .. }) => Some(dest_url),
        _ => None,
    };
    let all = Parser::new_ext(text, Options::ENABLE_TABLES).filter_map(target);
    let of_file = all.filter(|link| !link.contains("://") && !link.starts_with("mailto:"));
    of_file
        .map(|link| link.split_once('#').map_or((link.to_string(), String::new()), |(a, b)| (a.into(), b.into())))
        .collect()
}

#[test]
fn links_of_the_book_and_the_documents_lead_somewhere() {
    let mut all = files(&root().join("book/src"), "md");
    let documents = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|name| root().join(name));
    all.extend(documents.into_iter().filter(|path| path.exists()));
    let (mut broken, mut count) = (Vec::new(), 0);
    for page in &all {
        let text = fs::read_to_string(page).expect("a page is text");
        for (path, anchor) in links(&text) {
            count += 1;
            let file = if path.is_empty() { page.clone() } else { page.parent().expect("a folder").join(&path) };
            let is_there = file.exists();
            let has_anchor = anchor.is_empty()
                || file.extension().is_none_or(|end| end != "md")
                || fs::read_to_string(&file).is_ok_and(|text| anchors(&text).contains(&anchor));
            if !is_there || !has_anchor {
                broken.push(format!("{}: {path}#{anchor}", page.strip_prefix(root()).unwrap_or(page).display()));
            }
        }
    }
    assert!(count > 50, "only {count} links were found");
    assert!(broken.is_empty(), "broken links:\n{}", broken.join("\n"));
}

#[test]
fn every_page_of_the_book_is_in_its_summary() {
    let folder = root().join("book/src");
    let summary = fs::read_to_string(folder.join("SUMMARY.md")).expect("the summary is there");
    let listed: Vec<String> = links(&summary).into_iter().map(|(path, _)| path).collect();
    let path = |page: PathBuf| page.strip_prefix(&folder).expect("a page of the book").display().to_string();
    let missing: Vec<String> = files(&folder, "md")
        .into_iter()
        .map(path)
        .filter(|path| path != "SUMMARY.md" && !listed.contains(path))
        .collect();
    assert!(missing.is_empty(), "not in the summary: {}", missing.join(", "));
}

/// Limits of what a person reads at once: words of a sentence in the window, characters of an error's line.
const MOST_WORDS: usize = 20;
const MOST_CHARACTERS: usize = 90;

/// String literals of a source file, up to its unit tests, with their lines. Escaped line ends are joined.
fn literals(text: &str) -> Vec<(usize, String)> {
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    let (mut all, mut rest, mut line) = (Vec::new(), text, 1);
    while let Some(c) = rest.chars().next() {
        let length = match c {
            '/' if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            '\'' if rest[1..].starts_with('"') => 3,
            '\'' if rest.starts_with("'\\\"'") => 4,
            '"' => {
                let mut is_escaped = false;
                let end = rest[1..].char_indices().find(|&(_, c)| {
                    let ends = c == '"' && !is_escaped;
                    is_escaped = c == '\\' && !is_escaped;
                    ends
                });
                let length = end.map_or(rest.len(), |(at, _)| at + 2);
                let inner = rest.get(1..length - 1).unwrap_or_default();
                let mut parts = inner.split("\\\n");
                let first = parts.next().unwrap_or_default().to_owned();
                let joined = parts.fold(first, |joined, part| joined + part.trim_start());
                all.push((line, joined.replace("\\n", "\n").replace("\\\"", "\"")));
                length
            }
            other => other.len_utf8(),
        };
        line += rest[..length].matches('\n').count();
        rest = &rest[length..];
    }
    all
}

/// Sentences of a text.
fn sentences(text: &str) -> impl Iterator<Item = &str> {
    text.split('\n')
        .flat_map(|line| line.split(". "))
        .flat_map(|part| part.split(": "))
        .flat_map(|part| part.split("; "))
}

#[test]
fn sentences_of_the_window_are_short() {
    let (mut long, mut count) = (Vec::new(), 0);
    for source in sources(&["src/ui", "src/session", "src/view", "crates/freebound-core/src/problem"]) {
        for (line, text) in literals(&source.text) {
            for sentence in sentences(&text) {
                let words = sentence.split_whitespace().filter(|word| word.chars().any(char::is_alphanumeric)).count();
                count += usize::from(words > 3);
                if words > MOST_WORDS {
                    long.push(format!("{}:{line}: {words} words: {sentence}", source.path));
                }
            }
        }
    }
    assert!(count > 300, "only {count} sentences were found");
    assert!(long.is_empty(), "sentences of more than {MOST_WORDS} words:\n{}", long.join("\n"));
}

#[test]
fn lines_of_errors_are_short() {
    let (mut long, mut count) = (Vec::new(), 0);
    for source in sources(&CRATES) {
        // The text of an error is the first literal behind its attribute.
        for part in source.text.split("#[error(").skip(1) {
            let Some((_, text)) = literals(part).into_iter().next() else { continue };
            count += 1;
            long.extend(
                text.split('\n')
                    .filter(|line| line.chars().count() > MOST_CHARACTERS)
                    .map(|line| format!("{}: {} characters: {line}", source.path, line.chars().count())),
            );
        }
    }
    assert!(count > 80, "only {count} errors were found");
    assert!(long.is_empty(), "lines of more than {MOST_CHARACTERS} characters:\n{}", long.join("\n"));
}

#[test]
fn literals_are_found_whole() {
    let text = "let a = \"one\"; // \"no\"\nlet q = '\"'; f(\"two \\\n      three\\\"\");\n#[cfg(test)]\n\"four\"";
    let found: Vec<String> = literals(text).into_iter().map(|(_, text)| text).collect();
    assert_eq!(found, ["one", "two three\""]);
}

/// Comparisons of text in a test.
const COMPARISONS: [&str; 5] = ["contains(\"", "starts_with(\"", "ends_with(\"", "matches(\"", "find(\""];

/// True if a text has three words in a row that begin with a lower-case letter.
fn is_prose(text: &str) -> bool {
    let is_word = |word: &&str| word.len() > 1 && word.chars().all(|letter| letter.is_ascii_lowercase());
    let mut run = 0;
    text.split(' ').any(|word| {
        run = if is_word(&word) { run + 1 } else { 0 };
        run == 3
    })
}

#[test]
fn tests_compare_english_in_the_snapshot_alone() {
    let (mut found, mut count) = (Vec::new(), 0);
    for source in sources(&TESTS) {
        for comparison in COMPARISONS {
            for (at, _) in source.text.match_indices(comparison) {
                let text = source.text[at + comparison.len()..].split('"').next().unwrap_or_default();
                count += 1;
                if is_prose(text) {
                    let line = source.text[..at].matches('\n').count() + 1;
                    found.push(format!("{}:{line}: {text}", source.path));
                }
            }
        }
    }
    assert!(count > 100, "only {count} comparisons were found");
    assert!(found.is_empty(), "use assert_message, or compare data:\n{}", found.join("\n"));
}

#[test]
fn every_message_of_the_snapshot_is_asserted() {
    let snapshots = files(&root().join("tests/data/messages"), "snap");
    assert!(snapshots.len() > 200, "only {} messages are in the snapshot", snapshots.len());
    let names: Vec<String> = sources(&TESTS)
        .iter()
        .chain(&sources(&["src"]))
        .flat_map(|source| source.text.split('"').map(str::to_owned).collect::<Vec<_>>())
        .filter(|text| text.contains('-') && !text.contains(' '))
        .collect();
    let is_asserted = |name: &str| {
        names.iter().any(|text| {
            text == name || text.split_once('{').is_some_and(|(start, _)| !start.is_empty() && name.starts_with(start))
        })
    };
    let left: Vec<String> = snapshots
        .iter()
        .map(|path| path.file_stem().expect("a file").to_string_lossy().into_owned())
        .filter(|name| !is_asserted(name))
        .collect();
    assert!(left.is_empty(), "no test asserts these messages: delete them\n{}", left.join("\n"));
}
