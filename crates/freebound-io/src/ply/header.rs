//! Header of a PLY file: its elements, their numbers, and the properties of each.

use crate::mesh_file::{FaultPlace, ParseFaultKind, ReadError, fault_at};
use crate::obj::{Lines, quoted};

/// Layout of a PLY file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Length of the header, bytes.
    pub(super) length: usize,
    /// Number of lines of the header.
    pub(super) lines: u64,
}

/// Encoding of the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// List of items of one kind.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

/// Number or list of numbers that each item has.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Property {
    pub(super) name: String,
    /// Type of the length of a list; `None` for a single number.
    pub(super) count: Option<Scalar>,
    pub(super) item: Scalar,
}

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn of(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::I8 => "char",
            Self::U8 => "uchar",
            Self::I16 => "short",
            Self::U16 => "ushort",
            Self::I32 => "int",
            Self::U32 => "uint",
            Self::F32 => "float",
            Self::F64 => "double",
        }
    }

    /// True for an integer type that can number `count` elements.
    pub(super) fn holds(self, count: usize) -> bool {
        let bits = match self {
            Self::I8 => 7,
            Self::U8 => 8,
            Self::I16 => 15,
            Self::U16 => 16,
            Self::I32 => 31,
            Self::U32 => 32,
            Self::F32 | Self::F64 => return false,
        };
        count as u64 <= 1 << bits
    }

    /// Size in a binary file, bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Number that stands for the full share of a colour.
    pub(super) fn largest_colour(self) -> f64 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32_767.0,
            Self::U16 => 65_535.0,
            Self::I32 => f64::from(i32::MAX),
            Self::U32 => f64::from(u32::MAX),
            Self::F32 | Self::F64 => 1.0,
        }
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

impl Element {
    /// Property with the first of these names that exists.
    pub(super) fn property(&self, names: &[&str]) -> Option<usize> {
        names.iter().find_map(|name| self.properties.iter().position(|property| property.name == *name))
    }

    /// Least number of bytes of an item.
    pub(super) fn least_size(&self, encoding: Encoding) -> usize {
        let of = |property: &Property| property.count.unwrap_or(property.item).size();
        match encoding {
            // A digit and the character that ends it.
            Encoding::Text => 2 * self.properties.len(),
            _ => self.properties.iter().map(of).sum(),
        }
    }
}

impl Header {
    /// Parses the header at the beginning of a file.
    pub(super) fn of(bytes: &[u8]) -> Result<Self, ReadError> {
        let mut header = Self { encoding: Encoding::Text, elements: Vec::new(), length: 0, lines: 0 };
        for line in Lines::of(bytes) {
            header.lines += line.count;
            header.length += line.whole.len();
            let words: Vec<&[u8]> = line.whole.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
            if words.first() == Some(&&b"end_header"[..]) {
                return Ok(header);
            }
            header.take(&words)?;
        }
        Err(header.fault(ParseFaultKind::EndsEarly))
    }

    fn take(&mut self, words: &[&[u8]]) -> Result<(), ReadError> {
        match *words {
            [b"ply"] if self.lines == 1 => Ok(()),
            [b"format", encoding, ..] => {
                self.encoding = match encoding {
                    b"ascii" => Encoding::Text,
                    b"binary_little_endian" => Encoding::LittleEndian,
                    b"binary_big_endian" => Encoding::BigEndian,
                    _ => return Err(self.unexpected(encoding, "ascii or binary_little_endian or binary_big_endian")),
                };
                Ok(())
            }
            [b"element", name, count] => {
                let parsed = std::str::from_utf8(count).ok().and_then(|text| text.parse().ok());
                let count = parsed.ok_or_else(|| self.fault(ParseFaultKind::BadNumber(quoted(count))))?;
                let name = String::from_utf8_lossy(name).into_owned();
                self.elements.push(Element { name, count, properties: Vec::new() });
                Ok(())
            }
            [b"property", b"list", count, item, name] => self.property(name, Some(count), item),
            [b"property", item, name] => self.property(name, None, item),
            [] | [b"comment" | b"obj_info", ..] if self.lines > 1 => Ok(()),
            [first, ..] => {
                let expected = if self.lines == 1 { "ply" } else { "a line of a PLY header" };
                Err(self.unexpected(first, expected))
            }
            [] => Err(self.unexpected(b"", "ply")),
        }
    }

    /// Adds a property. `count` is the type of a list's length, for a list, and `item` that of its items.
    fn property(&mut self, name: &[u8], count: Option<&[u8]>, item: &[u8]) -> Result<(), ReadError> {
        let is_list = count.is_some();
        let count = count.and_then(Scalar::of).filter(|kind| kind.is_integer());
        let Some(item) = Scalar::of(item).filter(|_| count.is_some() == is_list) else {
            return Err(self.unexpected(name, "a property of a PLY type"));
        };
        let name = String::from_utf8_lossy(name).into_owned();
        match self.elements.last_mut() {
            Some(element) => {
                element.properties.push(Property { name, count, item });
                Ok(())
            }
            None => Err(self.unexpected(name.as_bytes(), "an element, before its properties")),
        }
    }

    fn unexpected(&self, found: &[u8], expected: &'static str) -> ReadError {
        self.fault(ParseFaultKind::Unexpected { found: quoted(found), expected })
    }

    fn fault(&self, kind: ParseFaultKind) -> ReadError {
        fault_at(FaultPlace::Line(self.lines), kind)
    }
}
