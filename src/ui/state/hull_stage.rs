//! Stages of the virtual boundary.

/// A stage of the virtual boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HullStage {
    /// The embedding before, in its hull.
    Before,
    /// The outside triangulated.
    #[default]
    Pockets,
    /// Mesh and outside as solved together.
    Solved,
    /// The result.
    Peeled,
}

impl HullStage {
    /// All stages in their order.
    pub const ALL: [Self; 4] = [Self::Before, Self::Pockets, Self::Solved, Self::Peeled];

    /// Its name, and what it shows.
    pub const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Before => ["Before", "The embedding before, in its hull"],
            Self::Pockets => ["Pockets", "The outside triangulated up to the hull"],
            Self::Solved => ["Solved", "Mesh and outside embedded together, the hull where it was"],
            Self::Peeled => ["Peeled", "The outside taken away: the result"],
        }
    }
}
