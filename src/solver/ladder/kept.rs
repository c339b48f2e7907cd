//! What ladders on a mesh have computed, for further ones on it.

use std::sync::Arc;

use crate::solver::{Embedding, GaugeSize, Prepared};

/// What ladders on a mesh have computed, for further ones on it.
#[derive(Clone, Debug, Default)]
pub struct Kept {
    /// Equations and factors of a linear solve.
    pub prepared: Option<Arc<Prepared>>,
    /// The planar start of the constrained rungs.
    pub planar_start: Option<Arc<PlanarStart>>,
}

/// A planar embedding without constraints.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanarStart {
    /// The size that it was computed at.
    pub(super) size: GaugeSize,
    /// One position per vertex, in the plane.
    pub(super) embedding: Embedding,
}
