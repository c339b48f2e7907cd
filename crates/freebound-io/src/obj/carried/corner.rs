//! Word of a corner with other indices.

use super::super::digits::push_index;

/// Parts of a word of the form `v`, `v/vt`, `v//vn` or `v/vt/vn`.
pub(super) struct CornerWord<'a> {
    vertex: &'a [u8],
    pub(super) has_texture: bool,
    /// Index of the normal, if there is one.
    normal: Option<&'a [u8]>,
}

impl<'a> CornerWord<'a> {
    pub(super) fn of(word: &'a [u8]) -> Self {
        let mut parts = word.split(|&byte| byte == b'/');
        let vertex = parts.next().unwrap_or_default();
        let has_texture = parts.next().is_some_and(|texture| !texture.is_empty());
        Self { vertex, has_texture, normal: parts.next().filter(|normal| !normal.is_empty()) }
    }

    /// Index of the vertex as written.
    pub(super) fn vertex_index(&self) -> Option<i64> {
        number(self.vertex)
    }

    /// Index of the normal as written.
    pub(super) fn normal_index(&self) -> Option<i64> {
        self.normal.and_then(number)
    }

    /// True if the indices count backwards.
    pub(super) fn is_negative(&self) -> bool {
        self.vertex.starts_with(b"-")
    }
}

/// Counts of the elements before a line, which determine its indices.
#[derive(Clone, Copy)]
pub(super) struct Indices {
    /// Number of vertices of the text before the line.
    pub(super) vertices: usize,
    /// Number of new vertices before the line.
    pub(super) new_vertices: usize,
    pub(super) normals: usize,
    pub(super) new_normals: usize,
    pub(super) coordinates: usize,
}

impl Indices {
    /// True if negative indices change.
    pub(super) fn are_shifted(&self) -> bool {
        self.new_vertices > 0 || self.new_normals > 0
    }

    /// Appends a corner of the text with this texture coordinate (from 0), or without one.
    pub(super) fn push(&self, line: &mut Vec<u8>, word: &CornerWord<'_>, texture: Option<u32>) {
        push_shifted(line, word.vertex, self.new_vertices);
        if let Some(texture) = texture {
            line.push(b'/');
            push_any(line, texture as usize, word.is_negative().then_some(self.coordinates));
        }
        if let Some(normal) = word.normal {
            line.extend_from_slice(if texture.is_some() { b"/" } else { b"//" });
            push_shifted(line, normal, self.new_normals);
        }
    }

    /// Appends a corner that the text does not have. All indices count from 0; the normal is a new one. They are
    /// written as negative indices if those of the other corners are negative.
    pub(super) fn push_new(&self, line: &mut Vec<u8>, new: &NewCorner) {
        let backwards = |count: usize| new.is_negative.then_some(count);
        push_any(line, new.vertex as usize, backwards(self.vertices + self.new_vertices));
        if let Some(texture) = new.texture {
            line.push(b'/');
            push_any(line, texture as usize, backwards(self.coordinates));
        }
        if let Some(normal) = new.normal {
            line.extend_from_slice(if new.texture.is_some() { b"/" } else { b"//" });
            push_any(line, normal, backwards(self.normals + self.new_normals));
        }
    }
}

/// Corner at a new vertex.
pub(super) struct NewCorner {
    pub(super) vertex: u32,
    pub(super) texture: Option<u32>,
    pub(super) normal: Option<usize>,
    pub(super) is_negative: bool,
}

/// Appends an index from 0 in the form of the format: backwards from `backwards_behind` elements, or from 1. An
/// element later in the file can only be counted from 1.
fn push_any(line: &mut Vec<u8>, index: usize, backwards_behind: Option<usize>) {
    match backwards_behind.and_then(|count| count.checked_sub(index)).filter(|&back| back > 0) {
        Some(back) => {
            line.push(b'-');
            push_index(line, back as u64);
        }
        None => push_index(line, index as u64 + 1),
    }
}

/// Appends an index of the text. A negative index counts back over `by` more elements.
fn push_shifted(line: &mut Vec<u8>, word: &[u8], by: usize) {
    match number(word).filter(|&index| index < 0 && by > 0) {
        Some(index) => {
            line.push(b'-');
            push_index(line, index.unsigned_abs() + by as u64);
        }
        None => line.extend_from_slice(word),
    }
}

fn number(word: &[u8]) -> Option<i64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}
