//! Reason for the end of a flattener.

/// Reason for the end of a flattener.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The embedding is proved planar.
    Planar,
    /// The method has no further step.
    Done,
    /// The iteration no longer improves and hardly moves.
    Stalled,
    /// The iteration has taken its maximum number of steps.
    Limit,
    /// The embedding is planar, but constraints cannot be met without new vertices.
    /// [`Step::unmet`](super::Step::unmet) lists them.
    Unmet,
}

impl Ending {
    /// Fixed lower-case name, for reports and tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Planar => "planar",
            Self::Done => "done",
            Self::Stalled => "stalled",
            Self::Limit => "limit",
            Self::Unmet => "unmet",
        }
    }
}
