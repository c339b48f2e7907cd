//! Structs and parameters of all crates: few fields, and no tuples of unlike things.
//!
//! Clippy limits the length of functions (`clippy.toml`).

use super::sources::{CRATES, sources};

/// Largest number of fields in a struct.
const FIELDS: usize = 12;

/// Words in the attributes of structs that mirror something external: a file, the command line, a uniform buffer.
const WIRE: [&str; 5] = ["Serialize", "Deserialize", "Args", "Parser", "Pod"];

/// Offences over the sources of all crates, one line each.
fn offences(find: impl Fn(&str) -> Vec<String>) -> Vec<String> {
    let in_file =
        |path: &str, text: &str| find(text).into_iter().map(|what| format!("{path}: {what}")).collect::<Vec<_>>();
    sources(&CRATES).iter().flat_map(|source| in_file(&source.path, &source.text)).collect()
}

/// Structs with too many named fields, with their counts.
fn crowded_structs(text: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (at, line) in lines.iter().enumerate() {
        let Some((_, rest)) = line.split_once("struct ") else { continue };
        if !line.ends_with('{') || line.trim_start().starts_with("//") {
            continue;
        }
        let attributes = lines[..at].iter().rev().take_while(|line| is_before_item(line));
        if attributes.filter(|line| line.starts_with("#[")).any(|line| WIRE.iter().any(|word| line.contains(word))) {
            continue;
        }
        let body = lines[at + 1..].iter().take_while(|line| **line != "}");
        let count = body.filter(|line| is_field(line)).count();
        if count > FIELDS {
            found.push(format!("{} has {count} fields", rest.trim_end_matches(" {")));
        }
    }
    found
}

/// True for a line of the attributes and documentation before an item.
fn is_before_item(line: &str) -> bool {
    line.starts_with("#[") || line.starts_with("///") || line.starts_with(' ') || line.starts_with(")]")
}

/// True for a line of a struct's body that begins a field.
fn is_field(line: &str) -> bool {
    let is_indented_once = line.starts_with("    ") && !line.starts_with("     ");
    let name = line.trim_start().trim_start_matches("pub(crate) ");
    let Some((name, _)) = name.trim_start_matches("pub ").split_once(':') else { return false };
    is_indented_once && !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// Pieces of a list, split at commas outside brackets.
fn pieces(list: &str) -> Vec<String> {
    let mut depth = 0_i32;
    let mut pieces = vec![String::new()];
    let mut before = ' ';
    for c in list.chars() {
        match c {
            '(' | '[' | '{' | '<' => depth += 1,
            '>' if before == '-' => {}
            ')' | ']' | '}' | '>' => depth -= 1,
            _ => {}
        }
        match (c, pieces.last_mut()) {
            (',', _) if depth == 0 => pieces.push(String::new()),
            (c, Some(piece)) => piece.push(c),
            (_, None) => {}
        }
        before = c;
    }
    pieces.iter().map(|piece| piece.trim().to_owned()).filter(|piece| !piece.is_empty()).collect()
}

/// Text within the bracket at the start of `text`.
fn bracketed(text: &str) -> &str {
    let mut depth = 0_i32;
    for (at, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return &text[1..at.max(1)];
        }
    }
    ""
}

/// Type of a parameter, without its reference: of `(a, b): &(f64, usize)` this is `(f64, usize)`.
fn parameter_type(parameter: &str) -> &str {
    let after_pattern = match parameter.strip_prefix('(') {
        Some(_) => parameter[bracketed(parameter).len() + 2..].trim_start().strip_prefix(':'),
        None => parameter.split_once(':').map(|(_, rest)| rest),
    };
    after_pattern.unwrap_or_default().trim().trim_start_matches('&').trim_start_matches("mut ")
}

/// Functions with a tuple of unlike things as a parameter.
fn unlike_tuples(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let code: String = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    for rest in code.split("fn ").skip(1) {
        let name: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        let after_name = &rest[name.len()..];
        let generics = match after_name.strip_prefix('<') {
            Some(_) => after_name.find(">(").map_or(after_name.len(), |end| end + 1),
            None => 0,
        };
        let Some(parameters) = after_name.get(generics..).filter(|list| list.starts_with('(')) else { continue };
        for parameter in pieces(bracketed(parameters)) {
            let kind = parameter_type(&parameter);
            let members = if kind.starts_with('(') { pieces(bracketed(kind)) } else { Vec::new() };
            if members.iter().any(|member| *member != members[0]) {
                found.push(format!("{name} takes {kind}"));
            }
        }
    }
    found
}

#[test]
fn no_struct_has_more_fields_than_can_be_kept_in_mind() {
    let mut wrong = offences(crowded_structs);
    // A theme is a list of colours.
    wrong.retain(|what| !what.contains("ui/theme.rs"));
    assert!(wrong.is_empty(), "more than {FIELDS} fields:\n{}", wrong.join("\n"));
}

#[test]
fn no_parameter_is_a_tuple_of_unlike_things() {
    let wrong = offences(unlike_tuples);
    assert!(wrong.is_empty(), "a struct with names would say what is what:\n{}", wrong.join("\n"));
}

#[test]
fn offences_are_found_in_every_form() {
    let fields = (0..13).map(|i| format!("    /// One.\n    pub f{i}: usize,\n")).collect::<Vec<_>>().concat();
    let crowded = crowded_structs(&format!("pub struct Crowd<'a> {{\n{fields}}}\n"));
    assert!(matches!(&crowded[..], [what] if what.starts_with("Crowd<'a>") && what.contains(" 13 ")), "{crowded:?}");
    assert!(crowded_structs(&format!("#[derive(Serialize)]\n/// Wire.\nstruct Wire {{\n{fields}}}\n")).is_empty());
    for text in [
        "fn f((a, b): (f64, usize)) {}",
        "fn f<T: Fn(u8) -> u8>(&self, pair: &(f64, Vec<(u8, u8)>)) {}",
        "fn f(\n    one: u8,\n    (a, b): (&[f64], &mut Vec<u8>),\n) {}",
    ] {
        assert_eq!(unlike_tuples(text).len(), 1, "{text}");
    }
    for text in ["fn f(a: (u8, u8), b: fn(u8, f64) -> (u8, f64)) {}", "fn f(x: &dyn Fn((u8, f64)) -> u8) {}"] {
        assert!(unlike_tuples(text).is_empty(), "{text}");
    }
}
