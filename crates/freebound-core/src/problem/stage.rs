//! Stages: the parts of methods that each make steps, with their names and traits.

use super::{BoundaryShape, Method, NoEquation, WeightSource};

/// Stage of a method that made a step.
///
/// A method has one stage or several. Relaxing, cutting and a given layout are stages only, not methods.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Stage {
    /// Single linear solve with a natural boundary (paper §3.3).
    #[default]
    Natural,
    /// A mean-value iteration (paper §4).
    Iterate,
    /// A boundary made simple, or mesh and outside embedded together (paper §5).
    VirtualBoundary,
    /// Single linear solve with the boundary on a convex shape.
    Convex(BoundaryShape),
    /// A solve with weights divided by stretch, the boundary on a convex shape.
    Stretch(BoundaryShape),
    /// Single linear solve of the mesh and the layers of virtual triangles around it.
    Lee(BoundaryShape),
    /// The least-squares conformal map.
    Lscm,
    /// Lévy's triangle equations summed around each vertex.
    Levy,
    /// An iteration of scalable locally injective mappings.
    Slim,
    /// The eigenvector of the least conformal energy.
    Spectral,
    /// Angles by a system of all of them.
    Abf,
    /// Angles by the reduced system.
    AbfPlusPlus,
    /// A one-to-one step towards the constraints.
    Continuation,
    /// New vertices, so that the constraints can be met.
    Matchmaker,
    /// Schnyder's drawing on a grid.
    Schnyder,
    /// A round of relaxing: less distortion, one-to-one throughout.
    Relax,
    /// Polygons that cannot be convex, cut into triangles.
    Cut,
    /// The given layout, unchanged.
    Given,
    /// The map with which automatic seams were found.
    Seams,
    /// The map that was saved with a project, unchanged.
    Saved,
}

impl Stage {
    /// Stage of the first linear solve of a method: its own stage if it has a single solve, otherwise a natural
    /// boundary.
    pub(crate) fn of_linear_solve(method: &Method) -> Self {
        match method {
            Method::Convex(shape) => Self::Convex(shape.clone()),
            Method::Lee(shape) => Self::Lee(shape.clone()),
            Method::Stretch(shape) => Self::Stretch(shape.clone()),
            Method::Lscm => Self::Lscm,
            Method::Levy => Self::Levy,
            Method::Auto
            | Method::Natural
            | Method::Iterate
            | Method::VirtualBoundary
            | Method::Slim
            | Method::Spectral
            | Method::Abf
            | Method::AbfPlusPlus
            | Method::Continuation
            | Method::Matchmaker
            | Method::Schnyder => Self::Natural,
        }
    }

    /// Fixed lower-case name, for reports, tables and files.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Natural => "natural",
            Self::Iterate => "iterate",
            Self::VirtualBoundary => "virtual-boundary",
            Self::Convex(_) => "convex",
            Self::Stretch(_) => "stretch",
            Self::Lee(_) => "lee",
            Self::Lscm => "lscm",
            Self::Levy => "levy",
            Self::Slim => "slim",
            Self::Spectral => "spectral",
            Self::Abf => "abf",
            Self::AbfPlusPlus => "abf++",
            Self::Continuation => "continuation",
            Self::Matchmaker => "matchmaker",
            Self::Schnyder => "schnyder",
            Self::Relax => "relax",
            Self::Cut => "cut",
            Self::Given => "given",
            Self::Seams => "seams",
            Self::Saved => "saved",
        }
    }

    /// Lower-case words for messages and summaries.
    pub const fn words(&self) -> &'static str {
        match self {
            Self::Natural => "natural boundary",
            Self::Iterate => "iteration",
            other => other.short_words(),
        }
    }

    /// Short words for a chip of the timeline or the status bar.
    pub const fn short_words(&self) -> &'static str {
        match self {
            Self::Iterate => "mean value",
            Self::VirtualBoundary => "virtual boundary",
            Self::Matchmaker => "new vertices",
            Self::Schnyder => "grid",
            Self::Relax => "relaxed",
            Self::Cut => "cut polygons",
            Self::Given => "file's layout",
            Self::Seams => "automatic seams",
            Self::Saved => "saved map",
            other => other.name(),
        }
    }

    /// True if the stage keeps a one-to-one embedding one-to-one.
    pub const fn is_one_to_one(&self) -> bool {
        matches!(self, Self::Continuation | Self::Matchmaker | Self::Relax | Self::Cut)
    }

    /// True if the stage uses the chosen family of weights.
    pub const fn uses_family(&self) -> bool {
        matches!(self, Self::Natural | Self::Iterate | Self::VirtualBoundary | Self::Convex(_) | Self::Lee(_))
    }

    /// True if pins do not change the shape of the result. They only place it.
    pub const fn only_places_pins(&self) -> bool {
        matches!(self, Self::Schnyder | Self::Lee(_) | Self::Slim | Self::Spectral | Self::Abf | Self::AbfPlusPlus)
    }

    /// Shape that the stage lays the boundary on, if it has one.
    pub const fn boundary_shape(&self) -> Option<&BoundaryShape> {
        match self {
            Self::Convex(shape) | Self::Stretch(shape) | Self::Lee(shape) => Some(shape),
            _ => None,
        }
    }

    /// Source of the weights in the equations of vertices.
    ///
    /// # Errors
    ///
    /// Reason why vertices have no equations with a barycentre.
    pub const fn weight_source(&self) -> Result<WeightSource, NoEquation> {
        match self {
            Self::Natural | Self::Convex(_) | Self::Lee(_) | Self::Lscm | Self::Spectral => Ok(WeightSource::Surface),
            Self::Iterate => Ok(WeightSource::StepBefore),
            Self::VirtualBoundary => Ok(WeightSource::Extended),
            Self::Levy => Err(NoEquation::OfTriangles),
            Self::Stretch(_) => Err(NoEquation::OfStretch),
            Self::Schnyder => Err(NoEquation::OnGrid),
            Self::Abf | Self::AbfPlusPlus => Err(NoEquation::OfAngles),
            Self::Slim | Self::Continuation | Self::Matchmaker | Self::Relax | Self::Cut | Self::Seams => {
                Err(NoEquation::OfEnergy)
            }
            Self::Given => Err(NoEquation::OfFile),
            Self::Saved => Err(NoEquation::OfProject),
        }
    }
}

/// Serialised by name.
#[cfg(feature = "serde")]
impl serde::Serialize for Stage {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}
