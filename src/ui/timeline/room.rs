//! Amount of room in the row of the timeline.

/// Width of the strip below which it has shorter texts, points.
const ROOMY: f32 = 720.0;

/// Width of the strip below which it has fewer buttons, and steps show only their numbers, points.
const TIGHT: f32 = 440.0;

/// Amount of room in one row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Room {
    Ample,
    Scarce,
    Tight,
}

impl Room {
    pub(super) fn of(width: f32) -> Self {
        match width {
            _ if width >= ROOMY => Self::Ample,
            _ if width >= TIGHT => Self::Scarce,
            _ => Self::Tight,
        }
    }
}
