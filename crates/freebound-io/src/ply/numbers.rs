//! Numbers of a PLY file after its header, in any encoding.

use std::ops::Range;

use super::header::{Element, Encoding, Header, Property, Scalar};
use crate::mesh_file::{FaultPlace, ParseFaultKind, ReadError, TokenWords, fault_at};
use crate::obj::quoted;

/// Reader of the numbers of a file.
pub(super) enum Numbers<'a> {
    Text { words: TokenWords<'a>, begin: usize },
    Binary { bytes: &'a [u8], at: usize, is_big_endian: bool },
}

impl<'a> Numbers<'a> {
    /// Reader that begins after the header.
    pub(super) fn of(bytes: &'a [u8], header: &Header) -> Self {
        match header.encoding {
            Encoding::Text => {
                Self::Text { words: TokenWords::of(&bytes[header.length..], header.lines + 1), begin: header.length }
            }
            Encoding::LittleEndian => Self::Binary { bytes, at: header.length, is_big_endian: false },
            Encoding::BigEndian => Self::Binary { bytes, at: header.length, is_big_endian: true },
        }
    }

    /// Position of the next number; in text, the line of the last one.
    pub(super) fn place(&self) -> FaultPlace {
        match self {
            Self::Text { words, .. } => words.place(),
            Self::Binary { at, .. } => FaultPlace::Byte(*at as u64),
        }
    }

    /// Number of bytes left.
    fn left(&self) -> usize {
        match self {
            Self::Text { words, .. } => words.left(),
            Self::Binary { bytes, at, .. } => bytes.len() - at,
        }
    }

    /// Fails if the rest of the file is too short for the items of an element.
    pub(super) fn check_room(&self, element: &Element, encoding: Encoding) -> Result<(), ReadError> {
        let least = (element.least_size(encoding) as u64).checked_mul(element.count);
        // The last number of a text needs no blank after it.
        if least.is_some_and(|least| least <= self.left() as u64 + 1) {
            return Ok(());
        }
        let kind = ParseFaultKind::TooMany { element: element.name.clone(), count: element.count };
        Err(fault_at(self.place(), kind))
    }

    pub(super) fn next(&mut self, kind: Scalar) -> Result<f64, ReadError> {
        match self {
            Self::Text { words, .. } => words.number(),
            Self::Binary { bytes, at, is_big_endian } => {
                let end = *at + kind.size();
                let Some(found) = bytes.get(*at..end) else {
                    return Err(fault_at(FaultPlace::Byte(bytes.len() as u64), ParseFaultKind::EndsEarly));
                };
                *at = end;
                Ok(binary(found, kind, *is_big_endian))
            }
        }
    }

    /// Reads the length of a list. Fails if the rest of the file is too short for the list.
    pub(super) fn count(&mut self, kind: Scalar, item: Scalar) -> Result<usize, ReadError> {
        let before = self.place();
        let count = self.integer(kind)?;
        let is_text = matches!(self, Self::Text { .. });
        let (place, size) = if is_text { (self.place(), 1) } else { (before, item.size()) };
        let found =
            usize::try_from(count).ok().filter(|count| count.checked_mul(size).is_some_and(|all| all <= self.left()));
        found.ok_or_else(|| {
            let element = "list item".to_owned();
            fault_at(place, ParseFaultKind::TooMany { element, count: count.unsigned_abs() })
        })
    }

    /// Reads an integer.
    pub(super) fn integer(&mut self, kind: Scalar) -> Result<i64, ReadError> {
        let place = self.place();
        if let Self::Text { words, .. } = self {
            let word = words.next().ok_or_else(|| fault_at(place, ParseFaultKind::EndsEarly))?;
            let parsed = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
            return parsed.ok_or_else(|| fault_at(words.place(), ParseFaultKind::BadNumber(quoted(word))));
        }
        // Integers of all types have at most 32 bits, so this is exact.
        #[expect(clippy::cast_possible_truncation, reason = "integers have at most 32 bits")]
        self.next(kind).map(|number| number as i64)
    }

    /// Passes over the next property and returns its byte range in the file.
    pub(super) fn span(&mut self, property: &Property) -> Result<Range<usize>, ReadError> {
        let begin = match self {
            // Leading blanks are not part of the property.
            Self::Text { words, begin } => {
                let mut ahead = words.clone();
                ahead.next_range().map_or(*begin, |range| *begin + range.start)
            }
            Self::Binary { at, .. } => *at,
        };
        let count = match property.count {
            Some(count) => self.count(count, property.item)?,
            None => 1,
        };
        self.skip(property.item, count)?;
        let end = match self {
            Self::Text { words, begin } => *begin + words.passed(),
            Self::Binary { at, .. } => *at,
        };
        Ok(begin..end)
    }

    /// Value of these bytes as a number, in the encoding of this file.
    pub(super) fn at(&self, bytes: &[u8], kind: Scalar) -> Result<f64, ReadError> {
        match self {
            Self::Text { .. } => TokenWords::of(bytes, 1).number(),
            Self::Binary { is_big_endian, .. } => Ok(binary(bytes, kind, *is_big_endian)),
        }
    }

    /// Skips numbers of one type.
    pub(super) fn skip(&mut self, kind: Scalar, count: usize) -> Result<(), ReadError> {
        match self {
            Self::Text { words, .. } => {
                for _ in 0..count {
                    words.next().ok_or_else(|| fault_at(words.place(), ParseFaultKind::EndsEarly))?;
                }
            }
            Self::Binary { bytes, at, .. } => {
                let end = count.checked_mul(kind.size()).and_then(|length| at.checked_add(length));
                match end.filter(|&end| end <= bytes.len()) {
                    Some(end) => *at = end,
                    None => return Err(fault_at(FaultPlace::Byte(bytes.len() as u64), ParseFaultKind::EndsEarly)),
                }
            }
        }
        Ok(())
    }
}

fn binary(bytes: &[u8], kind: Scalar, is_big_endian: bool) -> f64 {
    macro_rules! number {
        ($kind:ty) => {{
            let bytes = bytes.try_into().expect("as many bytes as the kind has");
            f64::from(if is_big_endian { <$kind>::from_be_bytes(bytes) } else { <$kind>::from_le_bytes(bytes) })
        }};
    }
    match kind {
        Scalar::I8 => number!(i8),
        Scalar::U8 => number!(u8),
        Scalar::I16 => number!(i16),
        Scalar::U16 => number!(u16),
        Scalar::I32 => number!(i32),
        Scalar::U32 => number!(u32),
        Scalar::F32 => number!(f32),
        Scalar::F64 => number!(f64),
    }
}
