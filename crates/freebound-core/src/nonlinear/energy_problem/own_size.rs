//! Elements that are measured at their own size: rest shapes that grow and shrink with their images.
//!
//! Distortion is measured at equal total areas. With weights w that sum to 1, let s = ½ tr(JᵀJ) and d = det J of
//! elements with rest shapes of some size. Let σ = Σ w d be the area of their images relative to the area of the
//! shapes. Then the distortion is half of
//!
//! ```text
//! E(z) = D/σ + σ I,     D = Σ w s,   I = Σ w s/d²
//! ```
//!
//! and does not change if all points are scaled. Its gradient is the gradient of the elements' energies for a fixed σ
//! plus a pressure p on their area:
//!
//! ```text
//! ∇E = ∇D/σ + σ ∇I + p ∇σ,     p = I − D/σ²
//! ```
//!
//! A descent for a fixed σ = 1, which leaves p out, does not end at the minimum of E. The images would have to grow or
//! shrink, and pins keep them from it.

use crate::parallel::prelude::*;
use glam::DVec2;

use super::super::foldover_energy::{Element, Energy};
use super::{CHUNK, EnergyProblem};

/// Sums D, I and σ of elements.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    stretch: f64,
    /// Infinite if an element is folded.
    inverse: f64,
    size: f64,
}

impl Sums {
    fn of(element: &Element, z: [DVec2; 3]) -> Self {
        let (alpha, beta) = element.derivatives(z);
        let (s, d) = (alpha.length_squared() + beta.length_squared(), element.determinant(z));
        let weight = element.weight();
        let inverse = if d > 0.0 { weight * s * d.powi(-2) } else { f64::INFINITY };
        Self { stretch: weight * s, inverse, size: weight * d }
    }

    fn and(self, other: Self) -> Self {
        Self {
            stretch: self.stretch + other.stretch,
            inverse: self.inverse + other.inverse,
            size: self.size + other.size,
        }
    }

    /// Energy E.
    pub(super) fn energy(self) -> f64 {
        if self.inverse.is_finite() { self.stretch / self.size + self.size * self.inverse } else { f64::INFINITY }
    }

    /// Energy of each element, so that the elements' gradients add up to the gradient of E.
    pub(super) fn model(self) -> Energy {
        Energy::AtSize { size: self.size, pressure: self.inverse - self.stretch / (self.size * self.size) }
    }
}

impl EnergyProblem {
    /// Measures the first `count` elements at their own size. Applies while no element is folded and the energy is the
    /// symmetric Dirichlet energy. Their weights must sum to 1.
    pub(crate) fn measured_at_own_size(self, count: usize) -> Self {
        Self { own_count: count, ..self }
    }

    /// Sums over the elements that are measured at their own size, independent of the number of threads.
    pub(super) fn own_sums(&self, z: &[DVec2]) -> Sums {
        let of_chunk = |elements: &[Element]| {
            let sums = elements.iter().map(|element| Sums::of(element, Self::corners(element, z)));
            sums.fold(Sums::default(), Sums::and)
        };
        let sums: Vec<Sums> = self.elements[..self.own_count].par_chunks(CHUNK).map(of_chunk).collect();
        sums.into_iter().fold(Sums::default(), Sums::and)
    }
}
