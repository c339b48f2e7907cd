//! Elements that are measured at their own size: shapes at rest that grow and shrink with what they are mapped to.
//!
//! Distortion is measured at equal total areas. With weights w that sum to 1, s = ½ tr(JᵀJ) and d = det J of elements at rest
//! in shapes of some size, and the area σ = Σ w d of their images by that of the shapes, it is half of
//!
//! ```text
//! E(z) = D/σ + σ I,     D = Σ w s,   I = Σ w s/d²
//! ```
//!
//! and does not change where all points are scaled. Its gradient is that of the elements' energies for a fixed σ, and with it a
//! pressure p on their area:
//!
//! ```text
//! ∇E = ∇D/σ + σ ∇I + p ∇σ,     p = I − D/σ²
//! ```
//!
//! A descent for a fixed σ = 1 alone, which leaves p out, ends where E is not least: where the images would have to grow, and
//! pins keep them from that, or shrink.

use crate::parallel::prelude::*;
use glam::DVec2;

use super::super::foldover_energy::{Element, Energy};
use super::{CHUNK, EnergyProblem};

/// D, I and σ of elements.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    stretch: f64,
    /// Infinite where an element is folded.
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

    /// E.
    pub(super) fn energy(self) -> f64 {
        if self.inverse.is_finite() { self.stretch / self.size + self.size * self.inverse } else { f64::INFINITY }
    }

    /// The energy of each element whose gradients add up to that of E.
    pub(super) fn model(self) -> Energy {
        Energy::AtSize { size: self.size, pressure: self.inverse - self.stretch / (self.size * self.size) }
    }
}

impl EnergyProblem {
    /// The same with its first elements, so many, measured at their own size while none of all is folded and the energy is the
    /// symmetric Dirichlet energy. Their weights sum to 1.
    pub(crate) fn measured_at_own_size(self, count: usize) -> Self {
        Self { own_count: count, ..self }
    }

    /// The sums over the elements that are measured at their own size, the same however many threads share it.
    pub(super) fn own_sums(&self, z: &[DVec2]) -> Sums {
        let of_chunk = |elements: &[Element]| {
            let sums = elements.iter().map(|element| Sums::of(element, Self::corners(element, z)));
            sums.fold(Sums::default(), Sums::and)
        };
        let sums: Vec<Sums> = self.elements[..self.own_count].par_chunks(CHUNK).map(of_chunk).collect();
        sums.into_iter().fold(Sums::default(), Sums::and)
    }
}
