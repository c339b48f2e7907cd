//! Verdicts by theorem and by brute force; distortion, conflicts, hull condition.

pub(crate) mod conflicts;
pub(crate) mod distortion;
pub(crate) mod hull_condition;
pub(crate) mod layout;
mod moved;
pub(crate) mod verdict;
pub(crate) mod verdict_cases;
pub(crate) mod verdict_random;
