//! The words of one OBJ line: numbers and corners.

use std::ops::Range;

use crate::mesh_file::ParseFaultKind;

/// Next line, line separator and paragraph separator in UTF-8.
const UNICODE_LINE_ENDS: [&[u8]; 3] = ["\u{85}".as_bytes(), "\u{2028}".as_bytes(), "\u{2029}".as_bytes()];

/// Longest piece of a bad word that a message quotes, characters.
const QUOTED: usize = 40;

/// Words of a line between blanks, up to a comment.
pub(crate) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    all_words(line).take_while(|word| word[0] != b'#')
}

/// Where the [`words`] of a line stand in it.
pub(super) fn word_ranges(line: &[u8]) -> impl Iterator<Item = Range<usize>> {
    words(line).map(|word| {
        let begin = word.as_ptr().addr() - line.as_ptr().addr();
        begin..begin + word.len()
    })
}

/// Whether a comment stands on a line.
pub(super) fn has_comment(line: &[u8]) -> bool {
    all_words(line).any(|word| word[0] == b'#')
}

fn all_words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    let is_blank = |byte: &u8| matches!(byte, b' ' | b'\t' | b'\r' | 0x0B | 0x0C);
    line.split(is_blank).filter(|word| !word.is_empty())
}

/// A statement as it is kept and written: one line to every reader. Its keyword stands before a blank, bytes that some
/// readers take for the end of a line are blanks, and it does not end with a `\`, behind which a line goes on.
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

/// The first `N` words as numbers; words behind them are ignored.
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

/// A number, rounded correctly. Infinities and NaNs are numbers here, in the spellings that C libraries write.
pub(crate) fn number(word: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(word).ok()?;
    text.parse().ok().or_else(|| special_number(text))
}

/// `-nan(ind)`, `1.#INF`, `-1.#IND` and the like.
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

/// One corner of a face as written: indices of the position and of the texture coordinate, if it has one.
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
            // The normal: only its form matters.
            rest = if after.is_empty() { after } else { index(after).ok_or_else(bad)?.1 };
        }
    }
    if rest.is_empty() { Ok((vertex, texture)) } else { Err(bad()) }
}

/// A leading integer and what follows it. Amounts too large for any mesh are cut off, not wrapped around.
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

/// A word for a message: readable, and not too long.
pub(crate) fn quoted(word: &[u8]) -> String {
    let text = String::from_utf8_lossy(&word[..word.len().min(4 * QUOTED)]);
    let mut shown: String = text.chars().take(QUOTED).map(|c| if c.is_control() { '\u{FFFD}' } else { c }).collect();
    if shown.len() < word.len() && text.chars().count() >= QUOTED {
        shown.push('…');
    }
    shown
}
