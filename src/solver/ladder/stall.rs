//! When an iteration gets no better.

use super::Step;

/// Steps without an improvement after which an iteration that hardly moves has stalled.
const PATIENCE: usize = 5;

/// Steps without an improvement after which it has stalled however much it moves: it goes round in circles.
const LONG_PATIENCE: usize = 12;

/// A move of every vertex below this share of the embedding's diameter is hardly any.
const STILL: f64 = 1e-3;

/// An iteration is slow where a step has more than this part of the fewest defects before.
const SLOW: f64 = 0.9;

/// Watches steps for improvement.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stall {
    best: Option<usize>,
    steps_since: usize,
    is_still: bool,
    is_slow: bool,
}

impl Stall {
    /// Takes in a step.
    pub(super) fn look_at(&mut self, step: &Step) {
        let count = step.verdict.defect_count();
        self.is_slow = self.best.is_some_and(|best| count as f64 > SLOW * best as f64);
        if self.best.is_none_or(|best| count < best) {
            self.best = Some(count);
            self.steps_since = 0;
        } else {
            self.steps_since += 1;
        }
        let limit = STILL * step.solution.embedding.bounds().diameter();
        self.is_still = step.max_move.is_some_and(|moved| moved <= limit);
    }

    /// Whether the last step is hardly better than one before it, or no better.
    pub(super) fn is_slow(&self) -> bool {
        self.is_slow
    }

    /// Whether the iteration gets no better.
    pub(super) fn is_reached(&self) -> bool {
        self.steps_since >= LONG_PATIENCE || (self.steps_since >= PATIENCE && self.is_still)
    }
}
