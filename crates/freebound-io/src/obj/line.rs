//! Words of a single OBJ line: numbers and corners.

use std::ops::Range;

use crate::mesh_file::ParseFaultKind;

/// Next line, line separator and paragraph separator in UTF-8.
const UNICODE_LINE_ENDS: [&[u8]; 3] = ["\u{85}".as_bytes(), "\u{2028}".as_bytes(), "\u{2029}".as_bytes()];

/// Maximum length of a bad word in a message, in characters.
const QUOTED: usize = 40;

/// Words of a line, separated by blanks, up to a comment.
pub(crate) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    all_words(line).take_while(|word| word[0] != b'#')
}

/// True if the words after an `f` are fewer than three corners. Such a face has no area and counts as a line element.
pub(super) fn has_few_corners<'a>(words: impl Iterator<Item = &'a [u8]>) -> bool {
    words.take(3).count() < 3
}

/// First word of a line. `l` for a face of fewer than three corners, which counts as a line element.
pub(super) fn keyword(line: &[u8]) -> Option<&[u8]> {
    let mut words = words(line);
    let keyword = words.next()?;
    Some(if keyword == b"f" && has_few_corners(words) { b"l" } else { keyword })
}

/// Byte ranges of the [`words`] of a line.
pub(super) fn word_ranges(line: &[u8]) -> impl Iterator<Item = Range<usize>> {
    words(line).map(|word| {
        let begin = word.as_ptr().addr() - line.as_ptr().addr();
        begin..begin + word.len()
    })
}

/// True if the line contains a comment.
pub(super) fn has_comment(line: &[u8]) -> bool {
    all_words(line).any(|word| word[0] == b'#')
}

fn all_words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    let is_blank = |byte: &u8| matches!(byte, b' ' | b'\t' | b'\r' | 0x0B | 0x0C);
    line.split(is_blank).filter(|word| !word.is_empty())
}

/// Statement in the form that is kept and written: a single line for every reader. Its keyword is followed by a
/// blank. Bytes that some readers take for a line end become blanks. It does not end with `\`, which would continue
/// the line.
pub(super) fn statement(line: &[u8]) -> Vec<u8> {
    let mut text: Vec<u8> = line.iter().map(|&byte| if byte < b' ' { b' ' } else { byte }).collect();
    for end in UNICODE_LINE_ENDS {
        while let Some(at) = text.windows(end.len()).position(|bytes| bytes == end) {
            text.splice(at..at + end.len(), *b" ");
        }
    }
    while let Some(b' ' | b'\\') = text.last() {
        text.pop();
    }
    text.trim_ascii_start().to_vec()
}

/// Parses the first `N` words as numbers; further words are ignored.
pub(super) fn numbers<'a, const N: usize>(
    mut words: impl Iterator<Item = &'a [u8]>,
) -> Result<[f64; N], ParseFaultKind> {
    let mut values = [0.0; N];
    for (found, value) in values.iter_mut().enumerate() {
        let word = words.next().ok_or(ParseFaultKind::TooFewNumbers { found, needed: N })?;
        *value = number(word).ok_or_else(|| ParseFaultKind::BadNumber(quoted(word)))?;
    }
    Ok(values)
}

/// Parses a number, correctly rounded. Infinities and NaNs are accepted, in the spellings that C libraries write.
pub(crate) fn number(word: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(word).ok()?;
    text.parse().ok().or_else(|| special_number(text))
}

/// Parses `-nan(ind)`, `1.#INF`, `-1.#IND` and the like.
fn special_number(text: &str) -> Option<f64> {
    let lower = text.to_ascii_lowercase();
    let (sign, amount) = match lower.strip_prefix('-') {
        Some(amount) => (-1.0, amount),
        None => (1.0, lower.strip_prefix('+').unwrap_or(&lower)),
    };
    if amount.starts_with("1.#inf") {
        return Some(sign * f64::INFINITY);
    }
    let nan =
        amount.starts_with("nan(") || ["1.#ind", "1.#qnan", "1.#snan", "1.#nan"].iter().any(|s| amount.starts_with(s));
    nan.then_some(f64::NAN)
}

/// Parses a corner of a face: indices of the position and of the texture coordinate, if it has one.
pub(super) fn corner(word: &[u8]) -> Result<(i64, Option<i64>), ParseFaultKind> {
    let bad = || ParseFaultKind::BadCorner(quoted(word));
    let (vertex, mut rest) = index(word).ok_or_else(bad)?;
    let mut texture = None;
    if let [b'/', after @ ..] = rest {
        rest = after;
        if !matches!(rest, [] | [b'/', ..]) {
            let (value, after) = index(rest).ok_or_else(bad)?;
            (texture, rest) = (Some(value), after);
        }
        if let [b'/', after @ ..] = rest {
            // The normal: only its syntax is checked.
            rest = if after.is_empty() { after } else { index(after).ok_or_else(bad)?.1 };
        }
    }
    if rest.is_empty() { Ok((vertex, texture)) } else { Err(bad()) }
}

/// Vertex and normal of a corner, as written, if it is well formed.
pub(super) fn normal_of_corner(word: &[u8]) -> Option<(i64, Option<i64>)> {
    let (vertex, rest) = index(word)?;
    let normal = rest.splitn(3, |&byte| byte == b'/').nth(2).and_then(index);
    Some((vertex, normal.map(|(normal, _)| normal)))
}

/// Splits off a leading integer. Values too large for any mesh saturate instead of wrapping around.
fn index(word: &[u8]) -> Option<(i64, &[u8])> {
    let (negative, digits) = match word {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, word),
    };
    let mut value: i64 = 0;
    let mut length = 0;
    while let Some(digit) = digits.get(length).filter(|byte| byte.is_ascii_digit()) {
        value = value.saturating_mul(10).saturating_add(i64::from(digit - b'0'));
        length += 1;
    }
    (length > 0).then(|| (if negative { -value } else { value }, &digits[length..]))
}

/// Word for a message: printable, and shortened to [`QUOTED`] characters.
pub(crate) fn quoted(word: &[u8]) -> String {
    let text = String::from_utf8_lossy(&word[..word.len().min(4 * QUOTED)]);
    let mut shown: String = text.chars().take(QUOTED).map(|c| if c.is_control() { '\u{FFFD}' } else { c }).collect();
    if shown.len() < word.len() && text.chars().count() >= QUOTED {
        shown.push('…');
    }
    shown
}
