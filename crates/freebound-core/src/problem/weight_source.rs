//! Origin of the weights of a step, and reasons why a vertex has no equation.

/// Origin of the weights of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WeightSource {
    /// Surface in space (§3).
    Surface,
    /// Embedding of the step before (§4).
    StepBefore,
    /// Embedding of the step before, with its outside (§5).
    Extended,
}

/// Reason why a vertex has no equation to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoEquation {
    /// The vertex has a prescribed position on a convex boundary.
    Prescribed,
    /// Lévy's equations have complex coefficients and no barycentre.
    OfTriangles,
    /// The weights come from a step that was not kept.
    StepBeforeMissing,
    /// The weights are a last resort against rounding: equal weights, or the weights of the surface.
    OtherWeights,
    /// The vertex has neighbours in layers that were peeled off.
    Peeled,
    /// The vertex satisfies the equation of an eigenvector: its terms sum to a multiple of its position.
    OfEigenvector,
    /// The weights were divided by the stretch of each solve before.
    OfStretch,
    /// The step minimises an energy.
    OfEnergy,
    /// The step is a drawing on a grid: its coordinates count vertices.
    OnGrid,
    /// The step solves for the angles of faces.
    OfAngles,
    /// The step is the layout of the file.
    OfFile,
    /// The map was saved with a project.
    OfProject,
}

impl NoEquation {
    /// Reason as a sentence.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Prescribed => "This vertex has a prescribed position, so it has no equation.",
            Self::OfTriangles => "Lévy's equations belong to triangles, so they have no barycentre.",
            Self::StepBeforeMissing => "The weights come from the previous step, of which only the numbers were kept.",
            Self::OtherWeights => "The weights are a fallback against rounding, not those of an embedding.",
            Self::OfAngles => "This step solves for the angles of its faces, so vertices have no equations.",
            Self::OfProject => "This step was saved with the project, without its equations. Solve to see them.",
            Self::OfFile => "This step is the layout of the file, so it has no equations.",
            Self::OnGrid => "This step is a drawing on a grid: its coordinates count vertices.",
            Self::Peeled => "This vertex has neighbours among the virtual triangles, which were removed.",
            Self::OfEigenvector => {
                "This step is an eigenvector: the terms sum to a multiple of the position, not to zero."
            }
            Self::OfStretch => "The weights were divided by the stretch of each earlier solve and were not kept.",
            Self::OfEnergy => "This step minimises an energy of whole faces, so vertices have no equations.",
        }
    }
}
