//! Errors that stop a solve.

use crate::linalg::LinalgError;
use crate::mesh::{FaceId, VertexId};

/// Reason why no embedding was produced. Flipped faces are no error: such an embedding is a result, described by its
/// verdict.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// A corner's weight is infinite or not a number.
    #[error("face {face}: its weights are not finite: choose another family or method")]
    NotFinite {
        /// Face of the corner.
        face: FaceId,
    },

    /// Two hard pins at one position leave the similarity undetermined.
    #[error("vertices {first} and {second} are pinned to the same place: move one of them")]
    CoincidentPins {
        /// Vertex that was pinned there first.
        first: VertexId,
        /// Other vertex.
        second: VertexId,
    },

    /// Pin on a vertex that the mesh does not have.
    #[error("vertex {vertex} is pinned, but the mesh has only {count} vertices (numbered from 0)")]
    NoSuchVertex {
        /// Requested vertex.
        vertex: VertexId,
        /// Number of vertices of the mesh.
        count: usize,
    },

    /// Pin on an unreferenced vertex.
    #[error("vertex {vertex} is pinned, but belongs to no face: remove its pin")]
    UnusedVertex {
        /// Requested vertex.
        vertex: VertexId,
    },

    /// Target of a pin is infinite or not a number.
    #[error("the target of pinned vertex {vertex} is not finite")]
    TargetNotFinite {
        /// Pinned vertex.
        vertex: VertexId,
    },

    /// Weight of a constraint is zero, negative, infinite or not a number.
    #[error("the weight {weight} of pinned vertex {vertex} is not a positive number")]
    WeightNotPositive {
        /// Pinned vertex.
        vertex: VertexId,
        /// Weight of the pin.
        weight: f64,
    },

    /// Family of weights that the method cannot use.
    #[error("{method} does not support {family} weights: {remedy}")]
    FamilyNotApplicable {
        /// Title of the method.
        method: &'static str,
        /// Title of the family.
        family: String,
        /// Choice to make instead.
        remedy: &'static str,
    },

    /// Boundary with too few vertices for its convex shape.
    #[error("the boundary has {found} vertices, but {shape} needs {needed}: choose a circle")]
    BoundaryTooShort {
        /// Name of the shape.
        shape: &'static str,
        /// Number of vertices of the boundary loop.
        found: usize,
        /// Number of vertices that the shape needs.
        needed: usize,
    },

    /// Boundary whose projection has no area, or does not run around its hull in order.
    #[error("the projected boundary does not follow its convex hull: choose a circle")]
    NoHull,

    /// Equations and factors were requested, but the method does not begin with a linear solve that has any.
    #[error("{method} does not begin with a linear solve for positions: run the whole method")]
    NoLinearSolve {
        /// Title of the method.
        method: &'static str,
    },

    /// More pins than the method accepts.
    #[error("{method} takes at most {most} hard pins, not {count}: choose Auto or Mean-value iteration")]
    TooManyPins {
        /// Title of the method.
        method: &'static str,
        /// Number of the user's pins.
        count: usize,
        /// Largest number of pins, which only fix the similarity.
        most: usize,
    },

    /// Two hard targets so near to each other that numbers between them run out.
    #[error("vertices {first} and {second}: targets closer than 1e-9 of their extent: move one of them")]
    TargetsTooNear {
        /// Vertex with the lower number.
        first: VertexId,
        /// Other vertex.
        second: VertexId,
    },

    /// Continuation is stuck, and no stage follows it.
    #[error("the constraints cannot be met without new vertices: allow new vertices")]
    Unmet,

    /// Paths match the targets, but the faces between them are too fine.
    #[error("faces between the targets are too small for 64-bit numbers: move close targets apart")]
    TooFine,

    /// Paths between the targets wind around each other.
    #[error("the targets need more than {most} new vertices: use fewer constraints, or reorder targets")]
    TooManyNewVertices {
        /// Largest number of new vertices.
        most: usize,
    },

    /// Relaxing was requested for an embedding that is not planar.
    #[error("only a planar embedding can be relaxed: make it planar first")]
    NotPlanar,

    /// No boundary vertex is left for the virtual boundary to bend.
    #[error("no weights give a planar map with the boundary on a circle: choose Auto or Schnyder's grid")]
    AllBent,

    /// No stage of a flattener has a further step.
    #[error("no stage gives a planar embedding: {reasons}")]
    StagesExhausted {
        /// Failed stages and their reasons.
        reasons: String,
    },

    /// Position that 64-bit numbers cannot hold.
    #[error("vertex {vertex} is beyond the range of 64-bit numbers: choose another family or method")]
    OutOfRange {
        /// First vertex with such a position.
        vertex: VertexId,
    },

    /// The linear solver found the matrix singular.
    #[error("the system is singular at vertex {vertex}: choose other pins or another family")]
    Singular {
        /// Vertex whose equation depends on others.
        vertex: VertexId,
    },

    /// The linear solver returned a solution that does not satisfy the system.
    #[error("residual {residual:.1e} is above the limit {limit:.1e}: choose another family or method")]
    ResidualTooLarge {
        /// Relative residual ‖Ax − b‖ / ‖b‖.
        residual: f64,
        /// Limit of the relative residual.
        limit: f64,
    },

    /// The linear solver failed.
    #[error("the linear solver failed ({reason}): choose another family or method")]
    Linear {
        /// Reason that the solver gave.
        reason: String,
    },

    /// The caller cancelled the solve.
    #[error("the solve was cancelled")]
    Cancelled,
}

/// Side that has to change before a solve can succeed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The caller cancelled the solve.
    Cancelled,
    /// Targets that no embedding in doubles can meet.
    Targets,
    /// The method has no result on this mesh. Another method may have one.
    Method,
    /// Request that contradicts itself or the mesh.
    Request,
}

impl SolveError {
    /// Side that has to change. The match lists every error, so that a new error must choose.
    pub const fn cause(&self) -> Cause {
        match self {
            Self::Cancelled => Cause::Cancelled,
            Self::TargetsTooNear { .. } => Cause::Targets,
            Self::NotFinite { .. }
            | Self::Unmet
            | Self::TooFine
            | Self::TooManyNewVertices { .. }
            | Self::NotPlanar
            | Self::AllBent
            | Self::StagesExhausted { .. }
            | Self::OutOfRange { .. }
            | Self::Singular { .. }
            | Self::ResidualTooLarge { .. }
            | Self::Linear { .. } => Cause::Method,
            Self::CoincidentPins { .. }
            | Self::NoSuchVertex { .. }
            | Self::UnusedVertex { .. }
            | Self::TargetNotFinite { .. }
            | Self::WeightNotPositive { .. }
            | Self::FamilyNotApplicable { .. }
            | Self::BoundaryTooShort { .. }
            | Self::NoHull
            | Self::NoLinearSolve { .. }
            | Self::TooManyPins { .. } => Cause::Request,
        }
    }

    /// Fixed lower-case name, for reports and tests.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::NotFinite { .. } => "weight-not-finite",
            Self::CoincidentPins { .. } => "coincident-pins",
            Self::NoSuchVertex { .. } => "no-such-vertex",
            Self::UnusedVertex { .. } => "unused-vertex",
            Self::TargetNotFinite { .. } => "target-not-finite",
            Self::WeightNotPositive { .. } => "weight-not-positive",
            Self::FamilyNotApplicable { .. } => "family-not-applicable",
            Self::BoundaryTooShort { .. } => "boundary-too-short",
            Self::NoHull => "no-hull",
            Self::TooManyPins { .. } => "too-many-pins",
            Self::TargetsTooNear { .. } => "targets-too-near",
            Self::Unmet => "unmet",
            Self::TooFine => "too-fine",
            Self::TooManyNewVertices { .. } => "too-many-new-vertices",
            Self::NotPlanar => "not-planar",
            Self::NoLinearSolve { .. } => "no-linear-solve",
            Self::AllBent => "all-bent",
            Self::StagesExhausted { .. } => "stages-exhausted",
            Self::OutOfRange { .. } => "out-of-range",
            Self::Singular { .. } => "singular",
            Self::ResidualTooLarge { .. } => "residual-too-large",
            Self::Linear { .. } => "linear-solver",
            Self::Cancelled => "cancelled",
        }
    }

    /// Vertices that the error names, to show to the user.
    pub fn vertices(&self) -> Vec<VertexId> {
        // A vertex that the mesh does not have cannot be shown.
        if matches!(self, Self::NoSuchVertex { .. }) {
            return Vec::new();
        }
        self.clone().named().into_iter().map(|vertex| *vertex).collect()
    }

    /// Error with renumbered vertices.
    #[must_use]
    pub fn renumbered(mut self, number: impl Fn(VertexId) -> VertexId) -> Self {
        for vertex in self.named() {
            *vertex = number(*vertex);
        }
        self
    }

    /// All vertices that the error names.
    fn named(&mut self) -> Vec<&mut VertexId> {
        match self {
            Self::CoincidentPins { first, second } | Self::TargetsTooNear { first, second } => vec![first, second],
            Self::NoSuchVertex { vertex, .. }
            | Self::UnusedVertex { vertex }
            | Self::TargetNotFinite { vertex }
            | Self::WeightNotPositive { vertex, .. }
            | Self::OutOfRange { vertex }
            | Self::Singular { vertex } => vec![vertex],
            Self::NotFinite { .. }
            | Self::FamilyNotApplicable { .. }
            | Self::BoundaryTooShort { .. }
            | Self::NoHull
            | Self::TooManyPins { .. }
            | Self::Unmet
            | Self::TooFine
            | Self::TooManyNewVertices { .. }
            | Self::NotPlanar
            | Self::NoLinearSolve { .. }
            | Self::AllBent
            | Self::StagesExhausted { .. }
            | Self::ResidualTooLarge { .. }
            | Self::Linear { .. }
            | Self::Cancelled => Vec::new(),
        }
    }

    /// True if pins are invalid for every method.
    pub const fn is_of_pins(&self) -> bool {
        matches!(
            self,
            Self::CoincidentPins { .. }
                | Self::NoSuchVertex { .. }
                | Self::UnusedVertex { .. }
                | Self::TargetNotFinite { .. }
                | Self::WeightNotPositive { .. }
        )
    }

    /// True if the method has no result although pins and settings are valid: another method may have one.
    pub const fn is_failure_of_method(&self) -> bool {
        matches!(self.cause(), Cause::Method)
    }
}

/// Conversion of an error that names no vertex.
impl From<LinalgError> for SolveError {
    fn from(error: LinalgError) -> Self {
        match error {
            LinalgError::Cancelled => Self::Cancelled,
            LinalgError::ResidualTooLarge { residual, limit } => Self::ResidualTooLarge { residual, limit },
            other => Self::Linear { reason: other.to_string() },
        }
    }
}
