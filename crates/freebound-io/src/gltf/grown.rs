//! Elements of an accessor, followed by those of vertices that the file does not have.

use glam::DVec3;

use super::accessor::{Elements, push_number};
use super::growing::ALIGNMENT;

/// Origin of a vertex that the file does not have, in vertices of its set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Origin {
    /// Copy of a vertex with other texture coordinates.
    Copy(usize),
    /// Vertex on an edge: its ends, and the fraction of the way from the first to the second.
    Between([usize; 2], f64),
}

/// Bytes of all elements, each aligned to four bytes, and their stride.
pub(super) fn grown(elements: &Elements<'_>, name: &str, added: &[Origin]) -> (Vec<u8>, usize) {
    let stride = (elements.width * elements.component.size()).next_multiple_of(ALIGNMENT);
    let mut bytes = Vec::with_capacity(stride * (elements.count + added.len()));
    let mut push = |element: &[u8]| {
        bytes.extend_from_slice(element);
        bytes.resize(bytes.len().next_multiple_of(stride), 0);
    };
    (0..elements.count).for_each(|place| push(elements.raw(place)));
    for origin in added {
        match *origin {
            Origin::Copy(place) => push(elements.raw(place)),
            Origin::Between(ends, share) => push(&between(elements, name, ends, share)),
        }
    }
    (bytes, stride)
}

/// Element interpolated between two vertices. Directions keep their length; joints and their weights are those of the
/// nearer vertex.
fn between(elements: &Elements<'_>, name: &str, ends: [usize; 2], share: f64) -> Vec<u8> {
    if name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_") {
        return elements.raw(ends[usize::from(share >= 0.5)]).to_vec();
    }
    let size = elements.component.size();
    let number = |end: usize, at: usize| elements.component.number(&elements.raw(end)[at * size..]);
    let mix = |at| {
        let [a, b] = ends.map(|end| number(end, at));
        a + share * (b - a)
    };
    let mut numbers: Vec<f64> = (0..elements.width).map(mix).collect();
    if let ("NORMAL" | "TANGENT", [x, y, z, ..]) = (name, numbers.as_slice()) {
        let length = [0, 1, 2].map(|at| number(ends[0], at)).iter().map(|x| x * x).sum::<f64>().sqrt();
        let turned = DVec3::new(*x, *y, *z).normalize_or_zero() * length;
        numbers[..3].copy_from_slice(&turned.to_array());
    }
    if name == "TANGENT" && numbers.len() == 4 {
        numbers[3] = number(ends[0], 3);
    }
    let mut bytes = Vec::with_capacity(numbers.len() * size);
    for &number in &numbers {
        push_number(&mut bytes, elements.component, number);
    }
    bytes
}
