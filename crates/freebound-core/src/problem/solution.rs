//! Result of a solve.

use super::{Embedding, Pins};
use crate::linalg::FactorStats;

/// An embedding and the numbers of the solve that made it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solution {
    /// Position of each vertex of the mesh, in the plane.
    pub embedding: Embedding,
    /// Pins of the solve: the user's pins, two gauge pins if the user has fewer, or all vertices of a convex
    /// boundary.
    pub pins: Pins,
    /// True if the solver chose gauge pins by itself.
    pub gauge_completed: bool,
    /// Numbers of the linear solve. Absent if an energy was minimised.
    pub linear: Option<LinearSolve>,
    /// Convergence of a method that approaches its answer within one step. Absent for all other methods.
    pub convergence: Option<Convergence>,
    /// Seconds by phase.
    pub seconds: PhaseSeconds,
}

/// Numbers of a linear solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinearSolve {
    /// Relative residual ‖Ax − b‖ / ‖b‖, measured on the original system.
    pub residual: f64,
    /// Residual ‖A z‖ of all vertex equations, also at pinned vertices, relative to the sizes of their terms.
    /// Measures how far the embedding is from satisfying the boundary condition everywhere. Vertices on a convex
    /// boundary have no equation.
    pub equation_residual: f64,
    /// Number of pivots that were replaced, because they were too small to divide by.
    pub replaced_pivots: usize,
    /// Number of corners whose weight is clamped, because they are degenerate.
    pub bounded_corners: usize,
    /// Memory of the matrix's factors, in bytes.
    pub factor_bytes: usize,
    /// True if all equations were kept (least squares). False if the equations of pinned vertices were dropped.
    pub keeps_equations: bool,
}

impl From<FactorStats> for LinearSolve {
    fn from(FactorStats { replaced_pivots, factor_bytes, .. }: FactorStats) -> Self {
        Self { replaced_pivots, factor_bytes, ..Self::default() }
    }
}

/// Convergence of a method that approaches its answer within one step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Convergence {
    /// Number of solves or Newton steps.
    pub steps: usize,
    /// Residual of the method's conditions. Each method defines the conditions and the scale.
    pub residual: f64,
    /// Reason of the end.
    pub stop: Stop,
}

/// Reason why a method stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Stop {
    /// A further step would change nothing but rounding.
    Converged,
    /// No step improves the result.
    Stalled,
    /// The step limit was reached.
    Limit,
}

impl Stop {
    /// Name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::Stalled => "stalled",
            Self::Limit => "limit",
        }
    }

    /// Words that follow a count of steps.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::Stalled => "no step improves it",
            Self::Limit => "step limit reached",
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
    /// Sum of all phases.
    pub fn total(&self) -> f64 {
        self.assemble + self.analyze + self.factor + self.solve
    }
}
