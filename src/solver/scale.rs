//! Size of an embedding: true scale, and the unit square of texture coordinates.

use glam::DVec2;

use super::equations::length_scale;
use super::{Embedding, GaugeSize, Pin, Pins};
use crate::geom::{Bounds, power_of_two_near};
use crate::mesh::DiskMesh;

/// Scales an embedding about the origin to the total area of the surface; one without a finite area stays as it is.
/// Both areas are summed at a size near 1, so that no square of a length overflows or vanishes.
pub fn to_true_area(mesh: &DiskMesh, embedding: &mut Embedding) {
    let (in_space, in_plane) = (length_scale(mesh), power_of_two_near(embedding.bounds().size().max_element()).recip());
    let surface: f64 = mesh
        .faces()
        .map(|face| {
            let [a, b, c] = mesh.mesh().corners(face).map(|x| x * in_space);
            (b - a).cross(c - a).length()
        })
        .sum();
    let flat: f64 = mesh
        .faces()
        .map(|face| {
            let [a, b, c] = mesh.face(face).map(|v| embedding[v] * in_plane);
            (b - a).perp_dot(c - a).abs()
        })
        .sum();
    let factor = (surface / flat).sqrt() * (in_plane / in_space);
    if factor.is_finite() && factor > 0.0 {
        for z in embedding.iter_mut() {
            *z *= factor;
        }
    }
}

/// Brings an embedding to its place where fewer than two pins fix it: at the size asked for; with its first pin, if
/// there is one, on its target to the last bit.
pub(super) fn complete_gauge(mesh: &DiskMesh, embedding: &mut Embedding, pins: &Pins, size: GaugeSize) {
    match size {
        GaugeSize::TrueArea => to_true_area(mesh, embedding),
        GaugeSize::Within(bounds) => to_middle_of(bounds, embedding),
    }
    if let Some((vertex, Pin { target, .. })) = pins.first_key_value() {
        let shift = *target - embedding[vertex];
        for z in embedding.iter_mut() {
            *z += shift;
        }
        embedding[*vertex] = *target;
    }
}

/// Moves an embedding by the similarity that takes up to two pins to their targets; without any, to true area. The
/// pins then lie on their targets to the last bit. Returns whether there is such a similarity.
pub(super) fn fit_gauge(mesh: &DiskMesh, embedding: &mut Embedding, pins: &Pins, size: GaugeSize) -> bool {
    let mut iter = pins.iter();
    let (Some((first, Pin { target: a, .. })), Some((second, Pin { target: b, .. }))) = (iter.next(), iter.next())
    else {
        complete_gauge(mesh, embedding, pins, size);
        return true;
    };
    let origin = embedding[first];
    let (is, wanted) = (embedding[second] - origin, *b - *a);
    // The quotient wanted / is of complex numbers.
    let turn = DVec2::new(is.dot(wanted), is.perp_dot(wanted)) / is.length_squared();
    if !turn.is_finite() || turn == DVec2::ZERO {
        return false;
    }
    for z in embedding.iter_mut() {
        *z = *a + turn.rotate(*z - origin);
    }
    embedding[*first] = *a;
    embedding[*second] = *b;
    true
}

/// Scales an embedding uniformly into the middle of a box; one without a finite extent stays as it is.
fn to_middle_of(into: Bounds, embedding: &mut Embedding) {
    let bounds = embedding.bounds();
    let factor = (into.size() / bounds.size()).min_element();
    if factor.is_finite() && factor > 0.0 {
        let (from, to) = (bounds.middle(), into.middle());
        for z in embedding.iter_mut() {
            *z = to + (*z - from) * factor;
        }
    }
}

/// Largest coordinate by amount.
fn extent_of(embedding: &Embedding) -> f64 {
    embedding.iter().fold(0.0, |m, z| m.max(z.abs().max_element()))
}

/// As [`to_unit_square`], but scaled by a power of two alone: the one rounding is that of the move.
pub fn to_unit_square_by_power_of_two(embedding: &mut Embedding) {
    let Bounds { low, .. } = embedding.bounds();
    for z in embedding.iter_mut() {
        *z -= low;
    }
    to_unit_box(embedding);
}

/// Scales an embedding about the origin by a power of two, so that no coordinate lies beyond −1 or 1. No digit is lost
/// unless a coordinate is too small for 64 bits afterwards.
pub fn to_unit_box(embedding: &mut Embedding) {
    let extent = extent_of(embedding);
    if extent.is_finite() && extent > 0.0 {
        let factor = (-extent.log2().ceil()).exp2();
        for z in embedding.iter_mut() {
            *z *= factor;
        }
    }
}

/// Moves and scales an embedding uniformly to fill the unit square's width or height from the origin on; one without a
/// finite extent stays as it is.
pub fn to_unit_square(embedding: &mut Embedding) {
    let bounds = embedding.bounds();
    let extent = bounds.size().max_element();
    if extent.is_finite() && extent > 0.0 {
        for z in embedding.iter_mut() {
            *z = (*z - bounds.low) / extent;
        }
    }
}
