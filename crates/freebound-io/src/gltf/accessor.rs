//! Arrays of elements in the bytes of a file's buffers.

use super::container::Buffers;
use super::document::{Accessor, Document, Part};
use crate::mesh_file::{ParseFaultKind, ReadError, fault_in};

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    const ALL: [Self; 6] = [Self::I8, Self::U8, Self::I16, Self::U16, Self::U32, Self::F32];

    fn of(code: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.code() == code)
    }

    /// Code in the JSON.
    pub(super) const fn code(self) -> u32 {
        match self {
            Self::I8 => 5120,
            Self::U8 => 5121,
            Self::I16 => 5122,
            Self::U16 => 5123,
            Self::U32 => 5125,
            Self::F32 => 5126,
        }
    }

    pub(super) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// Largest integer, which represents 1 in normalized numbers.
    pub(super) const fn largest(self) -> f32 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32_767.0,
            Self::U16 => 65_535.0,
            Self::U32 | Self::F32 => 1.0,
        }
    }

    /// First number in these bytes, not normalized.
    pub(super) fn number(self, bytes: &[u8]) -> f64 {
        let mut four = [0; 4];
        four[..self.size()].copy_from_slice(&bytes[..self.size()]);
        let two = [four[0], four[1]];
        match self {
            Self::I8 => f64::from(i8::from_le_bytes([two[0]])),
            Self::U8 => f64::from(two[0]),
            Self::I16 => f64::from(i16::from_le_bytes(two)),
            Self::U16 => f64::from(u16::from_le_bytes(two)),
            Self::U32 => f64::from(u32::from_le_bytes(four)),
            Self::F32 => f64::from(f32::from_le_bytes(four)),
        }
    }
}

/// Appends a number, rounded and clamped to the type.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "to be rounded, and cut off at the ends")]
pub(super) fn push_number(bytes: &mut Vec<u8>, kind: Component, number: f64) {
    let whole = number.round();
    match kind {
        Component::I8 => bytes.extend((whole as i8).to_le_bytes()),
        Component::U8 => bytes.push(whole as u8),
        Component::I16 => bytes.extend((whole as i16).to_le_bytes()),
        Component::U16 => bytes.extend((whole as u16).to_le_bytes()),
        Component::U32 => bytes.extend((whole as u32).to_le_bytes()),
        Component::F32 => bytes.extend((number as f32).to_le_bytes()),
    }
}

/// Bytes of the largest possible element, for elements that are not stored: all are 0.
const ZEROS: [u8; 64] = [0; 64];

/// Elements of an accessor, checked to be complete.
#[derive(Debug)]
pub(super) struct Elements<'a> {
    /// Bytes from the first element on; `None` if all elements are 0.
    bytes: Option<&'a [u8]>,
    stride: usize,
    pub(super) count: usize,
    pub(super) component: Component,
    /// Numbers per element.
    pub(super) width: usize,
    is_normalized: bool,
    /// Replaced elements of a sparse accessor, by their indices, ascending.
    sparse: Vec<(usize, &'a [u8])>,
}

impl<'a> Elements<'a> {
    /// Elements of an accessor.
    pub(super) fn of(document: &Document, buffers: &'a Buffers, index: usize) -> Result<Self, ReadError> {
        let fault = |kind| fault_in("accessor", index, kind);
        let accessor = document.accessors.get(index).ok_or_else(|| out_of(index, document.accessors.len()))?;
        let component = component(accessor.component_type).map_err(fault)?;
        let width = match accessor.shape.as_str() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" | "MAT2" => 4,
            "MAT3" => 9,
            "MAT4" => 16,
            other => {
                let found = other.chars().take(20).collect();
                return Err(fault(ParseFaultKind::Unexpected { found, expected: "a type of elements" }));
            }
        };
        let count = count(document, buffers, index)?;
        let size = width * component.size();
        let window = Window { offset: accessor.byte_offset, count, size };
        let (bytes, stride) = match accessor.buffer_view {
            Some(view) => {
                let (bytes, stride) = window.within(document, buffers, view).map_err(fault)?;
                (Some(bytes), stride)
            }
            None => (None, size),
        };
        let sparse = sparse(document, buffers, accessor, size).map_err(fault)?;
        Ok(Self { bytes, stride, count, component, width, is_normalized: accessor.normalized, sparse })
    }

    /// Bytes of an element.
    pub(super) fn raw(&self, place: usize) -> &'a [u8] {
        let size = self.width * self.component.size();
        if let Ok(found) = self.sparse.binary_search_by_key(&place, |&(place, _)| place) {
            return self.sparse[found].1;
        }
        self.bytes.map_or(&ZEROS[..size], |bytes| &bytes[place * self.stride..][..size])
    }

    /// Number of an element. Normalized integers become fractions of the largest, in 32 bits.
    #[expect(clippy::cast_possible_truncation, reason = "integers of 16 bits are exact")]
    pub(super) fn number(&self, place: usize, at: usize) -> f64 {
        let number = self.component.number(&self.raw(place)[at * self.component.size()..]);
        if self.is_normalized && self.component != Component::F32 {
            f64::from((number as f32 / self.component.largest()).max(-1.0))
        } else {
            number
        }
    }

    /// Element as an index.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked to be unsigned integers")]
    pub(super) fn index(&self, place: usize) -> usize {
        self.component.number(self.raw(place)) as usize
    }

    /// True if the elements can be indices.
    pub(super) fn are_indices(&self) -> bool {
        self.width == 1 && matches!(self.component, Component::U8 | Component::U16 | Component::U32)
    }
}

/// Number of elements of an accessor. Fails if it exceeds the number of bytes, even if all elements are 0.
pub(super) fn count(document: &Document, buffers: &Buffers, index: usize) -> Result<usize, ReadError> {
    let accessor = document.accessors.get(index).ok_or_else(|| out_of(index, document.accessors.len()))?;
    let count = usize::try_from(accessor.count).ok().filter(|&count| count <= buffers.bytes.len());
    let too_many = ParseFaultKind::TooMany { element: "element".to_owned(), count: accessor.count };
    count.ok_or_else(|| fault_in("accessor", index, too_many))
}

fn component(code: u32) -> Result<Component, ParseFaultKind> {
    let unknown = || ParseFaultKind::Unexpected { found: code.to_string(), expected: "a type of numbers" };
    Component::of(code).ok_or_else(unknown)
}

fn out_of(index: usize, count: usize) -> ReadError {
    fault_in("accessor", index, no_such("accessor", index, count))
}

pub(super) fn no_such(element: &'static str, index: usize, count: usize) -> ParseFaultKind {
    ParseFaultKind::IndexOutOfRange { element, index: i64::try_from(index).unwrap_or(i64::MAX), count }
}

/// Elements of `size` bytes in a view, from an offset on.
struct Window {
    offset: u64,
    count: usize,
    size: usize,
}

impl Window {
    /// Bytes of the elements, and their stride.
    fn within<'a>(
        &self,
        document: &Document,
        buffers: &'a Buffers,
        view: usize,
    ) -> Result<(&'a [u8], usize), ParseFaultKind> {
        let views = &document.buffer_views;
        let view = views.get(view).ok_or_else(|| no_such("view", view, views.len()))?;
        let buffer = document.buffers.get(view.buffer);
        let buffer = buffer.ok_or_else(|| no_such("buffer", view.buffer, document.buffers.len()))?;
        let stride = view.byte_stride.unwrap_or(self.size as u64);
        if stride < self.size as u64 {
            let found = stride.to_string();
            return Err(ParseFaultKind::Unexpected { found, expected: "a stride of at least an element" });
        }
        let ends_within =
            |offset: u64, length: u64, whole: u64| offset.checked_add(length).is_some_and(|end| end <= whole);
        let length = match self.count as u64 {
            0 => Some(0),
            count => stride.checked_mul(count - 1).and_then(|apart| apart.checked_add(self.size as u64)),
        };
        let length = length.filter(|&length| ends_within(self.offset, length, view.byte_length));
        if length.is_none() || !ends_within(view.byte_offset, view.byte_length, buffer.byte_length) {
            return Err(ParseFaultKind::BeyondEnd);
        }
        let place = |x: u64| usize::try_from(x).map_err(|_| ParseFaultKind::BeyondEnd);
        let begin = buffers.starts[view.buffer] + place(view.byte_offset + self.offset)?;
        let end = buffers.starts[view.buffer] + place(view.byte_offset + view.byte_length)?;
        Ok((&buffers.bytes[begin..end], place(stride)?))
    }
}

/// Replaced elements of a sparse accessor.
fn sparse<'a>(
    document: &Document,
    buffers: &'a Buffers,
    accessor: &Accessor,
    size: usize,
) -> Result<Vec<(usize, &'a [u8])>, ParseFaultKind> {
    let Some(sparse) = &accessor.sparse else { return Ok(Vec::new()) };
    let too_many = || ParseFaultKind::TooMany { element: "element".to_owned(), count: sparse.count };
    let count = usize::try_from(sparse.count).ok().filter(|&count| count as u64 <= accessor.count);
    let count = count.ok_or_else(too_many)?;
    let kind = component(sparse.indices.component_type.unwrap_or_default())?;
    let part = |part: &Part, size| {
        Window { offset: part.byte_offset, count, size }.within(document, buffers, part.buffer_view)
    };
    let (indices, apart) = part(&sparse.indices, kind.size())?;
    let (values, step) = part(&sparse.values, size)?;
    let mut found: Vec<(usize, &[u8])> = Vec::with_capacity(count);
    for k in 0..count {
        let place = kind.number(&indices[k * apart..]);
        let before = found.last().map_or(-1.0, |&(place, _)| place as f64);
        if place >= accessor.count as f64 || place <= before || place.fract() != 0.0 {
            let expected = "a place beyond the one before, and within the elements";
            return Err(ParseFaultKind::Unexpected { found: place.to_string(), expected });
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the elements")]
        found.push((place as usize, &values[k * step..][..size]));
    }
    Ok(found)
}
