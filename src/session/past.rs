//! What was solved for documents that undo and redo come back to: it is shown again to the last bit, and nothing is solved.
//!
//! An edit goes on from what was solved before it: solved from scratch, an earlier document has another embedding than it had. A
//! document is known by its place in the history: how many edits can be taken back from it.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::solving::{Solved, Task};
use freebound_core::mesh::DiskMesh;

/// Bytes that all of it may take: what is farthest from the present document goes first. At a million faces that is some
/// ten edits.
const BUDGET: usize = 512_000_000;

/// Bytes that the steps of one document may take, but for those without which it is not shown.
pub(super) const BUDGET_OF_ONE: usize = 16_000_000;

/// What was solved, by its place in the history.
#[derive(Debug, Default)]
pub(super) struct Past {
    states: BTreeMap<usize, State>,
}

/// What was solved for a document.
#[derive(Debug)]
pub(super) struct State {
    pub(super) mesh: Arc<DiskMesh>,
    pub(super) relaxed: usize,
    pub(super) solved: Solved,
}

impl Past {
    pub(super) fn keep(&mut self, place: usize, state: State) {
        self.states.insert(place, state);
        while self.states.len() > 1 && self.states.values().map(|state| state.solved.bytes()).sum::<usize>() > BUDGET {
            let farthest = self.states.keys().copied().max_by_key(|other| other.abs_diff(place));
            farthest.map(|farthest| self.states.remove(&farthest));
        }
    }

    /// Drops what cannot be come back to.
    pub(super) fn forget_beyond(&mut self, place: usize) {
        self.states.retain(|&other, _| other <= place);
    }

    /// Forgets the state at a place.
    pub(super) fn forget(&mut self, place: usize) {
        self.states.remove(&place);
    }

    /// Takes out what was solved at a place, if it is of a task with so many rounds of relaxing.
    pub(super) fn take(&mut self, place: usize, task: &Task, relaxed: usize) -> Option<Solved> {
        let is_of = |state: &State| {
            Arc::ptr_eq(&state.mesh, &task.mesh) && state.relaxed == relaxed && state.solved.is_of(&task.problem)
        };
        self.states.remove(&place).filter(is_of).map(|state| state.solved)
    }
}
