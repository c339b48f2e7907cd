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
    /// How a method that comes nearer and nearer to its answer within one step ended; none where it does not.
    pub convergence: Option<Convergence>,
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
    /// Whether all equations were kept and met as well as can be; otherwise those of pinned vertices were dropped.
    pub keeps_equations: bool,
}

impl From<FactorStats> for LinearSolve {
    fn from(FactorStats { replaced_pivots, factor_bytes, .. }: FactorStats) -> Self {
        Self { replaced_pivots, factor_bytes, ..Self::default() }
    }
}

/// How far a method has come that approaches its answer within one step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Convergence {
    /// Solves or Newton steps that it took.
    pub steps: usize,
    /// What is left of its conditions: the method says of which, and relative to what.
    pub residual: f64,
    /// Why it ended.
    pub stop: Stop,
}

/// Why a method went no further.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Stop {
    /// A further step would change nothing but rounding.
    Converged,
    /// No step led nearer.
    Stalled,
    /// It took as many steps as it may.
    Limit,
}

impl Stop {
    /// What a report calls it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::Stalled => "stalled",
            Self::Limit => "limit",
        }
    }

    /// The reason in words, to follow a count of steps.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::Stalled => "no step leads nearer",
            Self::Limit => "as many as it may take",
        }
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
