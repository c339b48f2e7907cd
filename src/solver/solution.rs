//! What a solve gives back.

use super::{Embedding, Pins};
use crate::linalg::FactorStats;

/// An embedding and the numbers of the solve that made it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solution {
    /// One position per vertex of the mesh, in the plane.
    pub embedding: Embedding,
    /// The pins in force, as they were held: the user's, the two gauge pins where those were fewer, or all of a convex boundary.
    pub pins: Pins,
    /// Whether the pins are gauge pins that the solver chose by itself.
    pub gauge_completed: bool,
    /// The linear solve; none where an energy was minimised.
    pub linear: Option<LinearSolve>,
    /// Where the time went.
    pub seconds: PhaseSeconds,
}

/// The numbers of a linear solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinearSolve {
    /// ‖Ax − b‖ / ‖b‖, measured on the original system.
    pub residual: f64,
    /// ‖A z‖ of all vertex equations, pinned ones included, relative to the sizes of their terms: how far the
    /// embedding is from satisfying the boundary condition everywhere. Vertices on a convex boundary have no equation.
    pub equation_residual: f64,
    /// Pivots too small to divide by that were replaced.
    pub replaced_pivots: usize,
    /// Corners whose weight hit a bound, being degenerate.
    pub bounded_corners: usize,
    /// Bytes of the matrix's factors.
    pub factor_bytes: usize,
}

impl From<FactorStats> for LinearSolve {
    fn from(FactorStats { replaced_pivots, factor_bytes, .. }: FactorStats) -> Self {
        Self { replaced_pivots, factor_bytes, ..Self::default() }
    }
}

/// Seconds by phase of a solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhaseSeconds {
    /// Weights and matrix.
    pub assemble: f64,
    /// Ordering and symbolic analysis.
    pub analyze: f64,
    /// Numeric factorization.
    pub factor: f64,
    /// Substitution and refinement.
    pub solve: f64,
}

impl PhaseSeconds {
    /// All phases together.
    pub fn total(&self) -> f64 {
        self.assemble + self.analyze + self.factor + self.solve
    }
}
