//! Everything that can stop a solve.

use crate::linalg::LinalgError;
use crate::mesh::{FaceId, VertexId};

/// Why no embedding was produced. One with flipped faces is no error: it is a result, described by its verdict.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// A corner's weight is infinite or not a number.
    #[error(
        "face {face} has a corner whose weight is not finite, its edges being too long or too short for 64-bit numbers: choose \
         another family or method"
    )]
    NotFinite {
        /// The face that owns the corner.
        face: FaceId,
    },

    /// Two pins on one place leave the similarity undetermined.
    #[error("vertices {first} and {second} are pinned to the same place: move one of them")]
    CoincidentPins {
        /// The vertex that was pinned there first.
        first: VertexId,
        /// The other vertex.
        second: VertexId,
    },

    /// A pin on a vertex that the mesh does not have.
    #[error("vertex {vertex} is pinned, but the mesh has only {count} vertices (numbered from 0)")]
    NoSuchVertex {
        /// The vertex asked for.
        vertex: VertexId,
        /// How many vertices there are.
        count: usize,
    },

    /// A pin on a vertex of no face.
    #[error("vertex {vertex} is pinned, but belongs to no face: free it")]
    UnusedVertex {
        /// The vertex asked for.
        vertex: VertexId,
    },

    /// A pin's target is infinite or not a number.
    #[error("the target of pinned vertex {vertex} is not finite")]
    TargetNotFinite {
        /// The pinned vertex.
        vertex: VertexId,
    },

    /// A constraint's weight is zero, negative, infinite or not a number.
    #[error("the weight {weight} of pinned vertex {vertex} is not a positive number")]
    WeightNotPositive {
        /// The pinned vertex.
        vertex: VertexId,
        /// Its weight.
        weight: f64,
    },

    /// A choice of method and family that has no meaning.
    #[error("{method} does not go with the family {family}: {remedy}")]
    FamilyNotApplicable {
        /// The method's name.
        method: &'static str,
        /// The family's name.
        family: String,
        /// What to choose instead.
        remedy: &'static str,
    },

    /// A boundary with too few vertices for the shape that it should lie on.
    #[error("the boundary has {found} vertices, {shape} needs {needed}: choose a circle")]
    BoundaryTooShort {
        /// The shape, in words.
        shape: &'static str,
        /// Vertices of the boundary loop.
        found: usize,
        /// Vertices that the shape needs.
        needed: usize,
    },

    /// A boundary whose projection has no area, or goes round in no order.
    #[error("the boundary's projection to its best plane has no hull that it runs around: choose a circle")]
    NoHull,

    /// Equations and factors were asked for, but the method does not begin with a linear solve that has any.
    #[error("{method} does not begin with a linear solve for positions: only a whole run gives its embedding")]
    NoLinearSolve {
        /// The method's name.
        method: &'static str,
    },

    /// More pins than the method can do with.
    #[error(
        "{count} vertices are constrained, but {method} goes with at most {most} exact pins: choose auto or iterate"
    )]
    TooManyPins {
        /// The method's name.
        method: &'static str,
        /// Pins of the user's.
        count: usize,
        /// The most that only fix the similarity.
        most: usize,
    },

    /// Two exact targets so near to each other that numbers between them run out.
    #[error(
        "the targets of vertices {first} and {second} are nearer to each other than 1e-9 of all targets' extent: move one of them"
    )]
    TargetsTooNear {
        /// The one with the lower number.
        first: VertexId,
        /// The other.
        second: VertexId,
    },

    /// Continuation is stuck, and no stage follows it.
    #[error("the constraints cannot be met without new vertices: the best planar embedding is the step before")]
    Unmet,

    /// Paths match the targets, but the faces between them are too fine.
    #[error("64-bit numbers cannot hold the faces between the targets apart: move targets that are near to each other")]
    TooFine,

    /// Paths between the targets wind around each other.
    #[error(
        "the targets lie in such an order that more than {most} new vertices would be needed: use fewer constraints, or \
         move their targets nearer to the order that the vertices have"
    )]
    TooManyNewVertices {
        /// The most that are made.
        most: usize,
    },

    /// Relaxing was asked for where faces overlap.
    #[error("only a planar embedding can be relaxed: make it planar first")]
    NotPlanar,

    /// The virtual boundary has no further vertex to bend.
    #[error("the whole boundary is on a circle, and no weights give a planar embedding: choose auto or schnyder")]
    AllBent,

    /// No stage of a flattener has a further step.
    #[error("no rung gives a planar embedding: {reasons}")]
    StagesExhausted {
        /// Which stages failed, and why.
        reasons: String,
    },

    /// A position that 64-bit numbers cannot hold.
    #[error("vertex {vertex} comes to lie beyond the range of 64-bit numbers: choose another family or method")]
    OutOfRange {
        /// The first such vertex.
        vertex: VertexId,
    },

    /// The linear solver found the matrix singular.
    #[error("the system is singular at vertex {vertex}: choose other pins or another family")]
    Singular {
        /// The vertex whose equation depends on the others.
        vertex: VertexId,
    },

    /// The linear solver returned, but its answer does not satisfy the system.
    #[error(
        "relative residual {residual:.1e} is above the limit {limit:.1e}, the answer would be wrong: choose another family or \
         method"
    )]
    ResidualTooLarge {
        /// ‖Ax − b‖ / ‖b‖.
        residual: f64,
        /// The limit in force.
        limit: f64,
    },

    /// The linear solver could not take the system.
    #[error("the linear solver failed, {reason}: choose another family or method")]
    Linear {
        /// What it said.
        reason: String,
    },

    /// The caller asked the solve to stop.
    #[error("the solve was cancelled")]
    Cancelled,
}

/// The side that has to change before a solve can succeed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The caller cancelled the solve.
    Cancelled,
    /// Targets that no embedding in doubles can meet.
    Targets,
    /// The method has no result on this mesh. Another method may have one.
    Method,
    /// A request that contradicts itself or the mesh.
    Request,
}

impl SolveError {
    /// The side that has to change. Every error is named, so that a new one has to choose.
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

    /// A fixed lower-case name, for reports and tests.
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
            Self::StagesExhausted { .. } => "ladder-exhausted",
            Self::OutOfRange { .. } => "out-of-range",
            Self::Singular { .. } => "singular",
            Self::ResidualTooLarge { .. } => "residual-too-large",
            Self::Linear { .. } => "linear-solver",
            Self::Cancelled => "cancelled",
        }
    }

    /// The vertices that it names, which a person may want to see.
    pub fn vertices(&self) -> Vec<VertexId> {
        // One that the mesh does not have cannot be shown.
        if matches!(self, Self::NoSuchVertex { .. }) {
            return Vec::new();
        }
        self.clone().named().into_iter().map(|vertex| *vertex).collect()
    }

    /// The same with other numbers for the vertices.
    #[must_use]
    pub fn renumbered(mut self, number: impl Fn(VertexId) -> VertexId) -> Self {
        for vertex in self.named() {
            *vertex = number(*vertex);
        }
        self
    }

    /// All vertices that it names.
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

    /// Whether pins are asked for that cannot be, whatever the method.
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

/// An error that belongs to no vertex.
impl From<LinalgError> for SolveError {
    fn from(error: LinalgError) -> Self {
        match error {
            LinalgError::Cancelled => Self::Cancelled,
            LinalgError::ResidualTooLarge { residual, limit } => Self::ResidualTooLarge { residual, limit },
            other => Self::Linear { reason: other.to_string() },
        }
    }
}
