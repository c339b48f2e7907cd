//! Origin of the weights of a step, and reasons why a vertex has no equation.

/// Origin of the weights of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WeightSource {
    /// The surface in space (§3).
    Surface,
    /// The embedding of the step before (§4).
    StepBefore,
    /// The embedding before, with its outside (§5).
    Extended,
}

/// Reason why a vertex has no equation to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoEquation {
    /// The vertex has its place on a convex boundary.
    Prescribed,
    /// Lévy's equations have complex coefficients, and no barycentre.
    OfTriangles,
    /// The weights come from a step that was not kept.
    StepBeforeMissing,
    /// The weights are a last resort against rounding: equal ones, or those of the surface.
    OtherWeights,
    /// The vertex has neighbours in layers that were peeled off.
    Peeled,
    /// The vertex meets the equation of an eigenvector: its terms add up to a multiple of where it lies.
    OfEigenvector,
    /// The weights were divided by the stretch of solve after solve.
    OfStretch,
    /// The step minimises an energy.
    OfEnergy,
    /// The step counts vertices.
    OnGrid,
    /// The step solves for the angles of faces.
    OfAngles,
    /// The step is the layout of the file.
    OfFile,
}

impl NoEquation {
    /// The reason in words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Prescribed => "Its place is prescribed: it has no equation.",
            Self::OfTriangles => "Lévy's equations belong to triangles: they have no barycentre.",
            Self::StepBeforeMissing => "Its weights come from the step before, of which only the numbers were kept.",
            Self::OtherWeights => "Its weights are a last resort against rounding, not those of an embedding.",
            Self::OfAngles => "This step solves for the angles of its faces: vertices have no equations of their own.",
            Self::OfFile => "This step is the layout of the file: nothing was solved for it.",
            Self::OnGrid => "This step is a drawing on a grid: its coordinates count vertices.",
            Self::Peeled => "It has neighbours among the virtual triangles, which were peeled off.",
            Self::OfEigenvector => {
                "Its terms do not add up to zero but to a multiple of its place: it is of an eigenvector."
            }
            Self::OfStretch => "Its weights were divided by the stretch of every solve before: they are not kept.",
            Self::OfEnergy => "This step minimises an energy of whole faces: vertices have no equations of their own.",
        }
    }
}
