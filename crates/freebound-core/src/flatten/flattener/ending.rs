//! Why a flattener has come to its end.

/// Why a flattener has come to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The embedding is proved planar.
    Planar,
    /// The method has no further step.
    Done,
    /// The iteration gets no better and hardly moves.
    Stalled,
    /// The iteration has taken as many steps as it may.
    Limit,
    /// The embedding is planar, but constraints could not be met without new vertices: [`Step::unmet`](super::Step::unmet) names them.
    Unmet,
}

impl Ending {
    /// A fixed lower-case name, for reports and tables.
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
