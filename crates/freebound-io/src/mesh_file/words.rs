//! Words of a text, with their lines.

use std::ops::Range;

use super::{FaultPlace, ParseFaultKind, ReadError, fault_at};
use crate::obj::{number, quoted};

/// Iterator over the words of a text, separated by blanks and line ends.
#[derive(Clone)]
pub(crate) struct TokenWords<'a> {
    text: &'a [u8],
    at: usize,
    /// Current line, counted from 1.
    line: u64,
}

impl<'a> TokenWords<'a> {
    /// Words of a text whose first line has this number.
    pub(crate) fn of(text: &'a [u8], line: u64) -> Self {
        Self { text, at: 0, line }
    }

    /// Current line: that of the last word, and of the next word unless a line end comes before it.
    pub(crate) fn place(&self) -> FaultPlace {
        FaultPlace::Line(self.line)
    }

    /// Number of bytes passed.
    pub(crate) fn passed(&self) -> usize {
        self.at
    }

    /// Number of bytes left.
    pub(crate) fn left(&self) -> usize {
        self.text.len() - self.at
    }

    /// Byte range of the next word.
    pub(crate) fn next_range(&mut self) -> Option<Range<usize>> {
        loop {
            match *self.text.get(self.at)? {
                b'\n' => self.line += 1,
                b'\r' if self.text.get(self.at + 1) != Some(&b'\n') => self.line += 1,
                byte if is_blank(byte) => {}
                _ => break,
            }
            self.at += 1;
        }
        let rest = &self.text[self.at..];
        let length = rest.iter().position(|&byte| is_blank(byte)).unwrap_or(rest.len());
        self.at += length;
        Some(self.at - length..self.at)
    }

    /// Next word as a number. Fails at the end of the text, too.
    pub(crate) fn number(&mut self) -> Result<f64, ReadError> {
        let word = self.next().ok_or_else(|| fault_at(self.place(), ParseFaultKind::EndsEarly))?;
        number(word).ok_or_else(|| fault_at(self.place(), ParseFaultKind::BadNumber(quoted(word))))
    }
}

impl<'a> Iterator for TokenWords<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        self.next_range().map(|range| &self.text[range])
    }
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | 0x0B | 0x0C)
}
