//! Stages of the virtual boundary.

/// Stage of the virtual boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HullStage {
    /// Embedding before, in its hull.
    Before,
    /// Outside triangulated.
    #[default]
    Pockets,
    /// Mesh and outside, solved together.
    Solved,
    /// Result.
    Peeled,
}

impl HullStage {
    /// All stages in their order.
    pub const ALL: [Self; 4] = [Self::Before, Self::Pockets, Self::Solved, Self::Peeled];

    /// Name and description.
    pub const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Before => ["Before", "The previous embedding, in its hull"],
            Self::Pockets => ["Pockets", "The outside, triangulated up to the hull"],
            Self::Solved => ["Solved", "Mesh and outside embedded together, with the hull fixed"],
            Self::Peeled => ["Peeled", "The result, without the outside"],
        }
    }
}
