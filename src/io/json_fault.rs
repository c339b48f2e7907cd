//! Where a fault of a JSON text is, in words: line and field.

/// A line, counted from 1, the field on it, and what is wrong. The parser gives the place where it noticed.
pub(super) fn json_fault(text: &str, error: &serde_json::Error) -> (usize, String, String) {
    let line_start: usize = text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum();
    let noticed = (line_start + error.column()).min(text.len());
    // The parser has skipped the blanks behind the fault.
    let before = String::from_utf8_lossy(&text.as_bytes()[..noticed]).trim_end().to_owned();
    let message = error.to_string();
    let reason = message.rfind(" at line ").map_or(message.as_str(), |end| &message[..end]);
    let path = open_levels(&before);
    (before.lines().count().max(1), in_words(&path), reason.to_owned())
}

/// What is open at a place of a JSON text.
enum Level {
    Object { key: String, wants_key: bool },
    Array { index: usize },
}

fn open_levels(text: &str) -> Vec<Level> {
    let mut levels = Vec::new();
    let mut rest = text.chars();
    while let Some(c) = rest.next() {
        match (c, levels.last_mut()) {
            ('"', level) => {
                let string = string_of(&mut rest);
                if let Some(Level::Object { key, wants_key: true }) = level {
                    *key = string;
                }
            }
            (':', Some(Level::Object { wants_key, .. })) => *wants_key = false,
            (',', Some(Level::Object { wants_key, .. })) => *wants_key = true,
            (',', Some(Level::Array { index })) => *index += 1,
            ('{', _) => levels.push(Level::Object { key: String::new(), wants_key: true }),
            ('[', _) => levels.push(Level::Array { index: 0 }),
            ('}' | ']', _) => drop(levels.pop()),
            _ => {}
        }
    }
    levels
}

/// The string that begins here, up to its closing quote.
fn string_of(rest: &mut std::str::Chars<'_>) -> String {
    let mut string = String::new();
    while let Some(c) = rest.next() {
        match c {
            '"' => break,
            '\\' => string.extend(rest.next()),
            _ => string.push(c),
        }
    }
    string
}

fn in_words(levels: &[Level]) -> String {
    use std::fmt::Write as _;
    let mut words = String::new();
    for level in levels {
        match level {
            Level::Object { key, .. } if key.is_empty() => {}
            Level::Object { key, .. } => {
                words.push_str(if words.is_empty() { "" } else { "." });
                words.push_str(key);
            }
            Level::Array { index } => write!(words, "[{index}]").expect("a string takes all that is written"),
        }
    }
    if words.is_empty() { "the project".to_owned() } else { words }
}
