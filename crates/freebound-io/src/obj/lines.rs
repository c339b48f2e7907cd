//! Lines of OBJ text as slices of its bytes, so that reader and writer see identical lines.
//!
//! A line ends with LF, with CR LF, or with CR alone, as other programs read it. A `\` at its end continues it in the
//! next line, unless the `\` is in a comment, in which a path may end with it.

use memchr::{memchr, memchr2};

use super::line::has_comment;

/// Byte-order mark that some programs put before UTF-8 text.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// Splits a text into its byte-order mark, if it has one, and its lines.
pub(crate) fn split_mark(text: &[u8]) -> (&[u8], &[u8]) {
    text.split_at(if text.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 })
}

/// Iterator over the lines of a text without its byte-order mark.
pub(crate) struct Lines<'a> {
    rest: &'a [u8],
}

/// Line, possibly continued over several lines of the file.
#[derive(Clone, Copy)]
pub(crate) struct Line<'a> {
    /// Bytes of the line, including its end.
    pub(crate) whole: &'a [u8],
    /// Number of bytes before its end.
    pub(crate) length: usize,
    /// Number of lines of the file that it covers.
    pub(crate) count: u64,
    /// True if it is continued over several lines of the file.
    pub(super) is_continued: bool,
}

impl<'a> Lines<'a> {
    pub(crate) fn of(text: &'a [u8]) -> Self {
        Self { rest: text }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let text = self.rest;
        if text.is_empty() {
            return None;
        }
        let (mut begin, mut count, mut is_continued) = (0, 0, false);
        loop {
            let (length, end) = first_end(text, begin);
            count += 1;
            let goes_on = text[begin..length].ends_with(b"\\") && !has_comment(&text[begin..length]);
            is_continued |= goes_on;
            if goes_on && end < text.len() {
                begin = end;
                continue;
            }
            let (whole, rest) = text.split_at(end);
            self.rest = rest;
            return Some(Line { whole, length, count, is_continued });
        }
    }
}

impl Line<'_> {
    /// Content as a single line, without its end and of unchanged length. Each continuing `\` and the line end after
    /// it become blanks.
    pub(super) fn as_one<'b>(&'b self, joined: &'b mut Vec<u8>) -> &'b [u8] {
        let content = &self.whole[..self.length];
        if !self.is_continued {
            return content;
        }
        let is_end = |byte: Option<&u8>| matches!(byte, None | Some(b'\r' | b'\n'));
        joined.clear();
        joined.extend(content.iter().enumerate().map(|(at, &byte)| match byte {
            b'\r' | b'\n' => b' ',
            b'\\' if is_end(content.get(at + 1)) => b' ',
            _ => byte,
        }));
        joined
    }

    /// Line end; empty in the last line of some files.
    pub(crate) fn end(&self) -> &[u8] {
        &self.whole[self.length..]
    }
}

/// Splits a text into pieces of about `size` bytes, at line ends that are not continued. The lines of the pieces are
/// the lines of the text. A text without LF is a single piece.
pub(crate) fn pieces(text: &[u8], size: usize) -> Vec<&[u8]> {
    let (mut pieces, mut rest) = (Vec::new(), text);
    while !rest.is_empty() {
        let (piece, behind) = rest.split_at(end_of_line_after(rest, size));
        pieces.push(piece);
        rest = behind;
    }
    pieces
}

/// End of the first line after `bytes` bytes that ends with LF and certainly is not continued, or the end of the
/// text. A `\` in a comment counts as a continuation here.
fn end_of_line_after(text: &[u8], bytes: usize) -> usize {
    let mut at = bytes;
    while let Some(length) = text.get(at..).and_then(|rest| memchr(b'\n', rest)) {
        let line = &text[..at + length];
        at += length + 1;
        if !line.strip_suffix(b"\r").unwrap_or(line).ends_with(b"\\") {
            return at;
        }
    }
    text.len()
}

/// End of the line that begins at `begin`: without and with its line end.
fn first_end(text: &[u8], begin: usize) -> (usize, usize) {
    match memchr2(b'\n', b'\r', &text[begin..]).map(|length| begin + length) {
        Some(at) if text[at..].starts_with(b"\r\n") => (at, at + 2),
        Some(at) => (at, at + 1),
        None => (text.len(), text.len()),
    }
}
