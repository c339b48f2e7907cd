//! The lines of OBJ text as pieces of its bytes, so that reader and writer see the same ones.
//!
//! A line ends with LF, with CR LF, or with CR alone, as other programs read it. It goes on in the next where it ends
//! with a `\` that stands in no comment, where a path may end so.

use memchr::{memchr, memchr2};

use super::line::has_comment;

/// What some programs put before a text in UTF-8.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// A text's byte order mark, if it has one, and its lines.
pub(crate) fn split_mark(text: &[u8]) -> (&[u8], &[u8]) {
    text.split_at(if text.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 })
}

/// All lines of a text without its byte order mark.
pub(crate) struct Lines<'a> {
    rest: &'a [u8],
}

/// A line, put together from continued ones if it was.
#[derive(Clone, Copy)]
pub(crate) struct Line<'a> {
    /// All its bytes, its end among them.
    pub(crate) whole: &'a [u8],
    /// How many bytes stand before its end.
    pub(crate) length: usize,
    /// How many lines of the file it is.
    pub(crate) count: u64,
    /// Whether one of them goes on in the next.
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
    /// The line as one, of as many bytes as it has before its end: blanks stand for each `\` where it goes on, and for
    /// the line end behind that.
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

    /// What ends it; empty in the last line of some files.
    pub(crate) fn end(&self) -> &[u8] {
        &self.whole[self.length..]
    }
}

/// Cuts a text into pieces of about so many bytes where a line ends that does not go on, so that the lines of the pieces are
/// those of the text. A text without LF is one piece.
pub(crate) fn pieces(text: &[u8], size: usize) -> Vec<&[u8]> {
    let (mut pieces, mut rest) = (Vec::new(), text);
    while !rest.is_empty() {
        let (piece, behind) = rest.split_at(end_of_line_after(rest, size));
        pieces.push(piece);
        rest = behind;
    }
    pieces
}

/// The end of the first line that ends with LF behind so many bytes and surely does not go on, or that of the text. A `\`
/// that stands in a comment is taken for one that goes on.
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

/// Where the line that begins there ends, without and with its end.
fn first_end(text: &[u8], begin: usize) -> (usize, usize) {
    match memchr2(b'\n', b'\r', &text[begin..]).map(|length| begin + length) {
        Some(at) if text[at..].starts_with(b"\r\n") => (at, at + 2),
        Some(at) => (at, at + 1),
        None => (text.len(), text.len()),
    }
}
