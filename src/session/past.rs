//! Solutions of documents that undo and redo return to. They are restored bit for bit, without solving.
//!
//! An edit continues from the solution before it, so solving an earlier document from scratch would give another
//! embedding. A document is identified by its place in the history: the number of edits that can be undone.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::solving::{Solved, Task};
use freebound_core::mesh::DiskMesh;

/// Memory budget of all solutions, bytes. The solution farthest from the current document is dropped first. At a
/// million faces the budget holds about ten edits.
const BUDGET: usize = 512_000_000;

/// Memory budget for the steps of one document, bytes. The steps needed to show it are kept in any case.
pub(super) const BUDGET_OF_ONE: usize = 16_000_000;

/// Solutions by their place in the history, and by their chart.
#[derive(Debug, Default)]
pub(super) struct Past {
    states: BTreeMap<(usize, Solution), State>,
}

/// Owner of a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Solution {
    /// Shown chart, or the whole mesh.
    Shown,
    /// Chart that is not shown.
    Chart(usize),
}

/// Solution of a document.
#[derive(Debug)]
pub(super) struct State {
    pub(super) mesh: Arc<DiskMesh>,
    pub(super) relaxed: usize,
    pub(super) solved: Solved,
}

impl Past {
    pub(super) fn keep(&mut self, place: usize, of: Solution, state: State) {
        self.states.insert((place, of), state);
        while self.states.len() > 1 && self.states.values().map(|state| state.solved.bytes()).sum::<usize>() > BUDGET {
            let farthest = self.states.keys().copied().max_by_key(|(other, _)| other.abs_diff(place));
            farthest.map(|farthest| self.states.remove(&farthest));
        }
    }

    /// Drops solutions after a place, which redo cannot reach any more.
    pub(super) fn forget_beyond(&mut self, place: usize) {
        self.states.retain(|&(other, _), _| other <= place);
    }

    /// Drops the solution at a place.
    pub(super) fn forget(&mut self, place: usize, of: Solution) {
        self.states.remove(&(place, of));
    }

    /// Charts that are not shown and have solutions, at this place or at any place.
    pub(super) fn charts(&self, at: Option<usize>) -> BTreeSet<usize> {
        let chart = |&(place, of): &(usize, Solution)| match of {
            Solution::Chart(chart) if at.is_none_or(|at| at == place) => Some(chart),
            _ => None,
        };
        self.states.keys().filter_map(chart).collect()
    }

    /// Removes the solution at a place. Returns it if it solves this task with this number of relaxation rounds.
    pub(super) fn take(&mut self, place: usize, of: Solution, task: &Task, relaxed: usize) -> Option<Solved> {
        let is_of = |state: &State| {
            Arc::ptr_eq(&state.mesh, &task.mesh) && state.relaxed == relaxed && state.solved.is_of(&task.problem)
        };
        self.states.remove(&(place, of)).filter(is_of).map(|state| state.solved)
    }
}
