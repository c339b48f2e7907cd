//! What was solved for documents that undo and redo come back to: it is shown again to the last bit, and nothing is solved.
//!
//! An edit goes on from what was solved before it: solved afresh, an earlier document has another embedding than it had. A
//! document is known by its place in the history: how many edits can be taken back from it.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Session;
use super::solving::Solved;
use crate::mesh::DiskMesh;

/// Bytes that all of it may take: what is farthest from the present document goes first. At a million faces that is some
/// ten edits.
const BUDGET: usize = 512_000_000;

/// Bytes that the steps of one document may take, but for those without which it is not shown.
const BUDGET_OF_ONE: usize = 16_000_000;

/// What was solved, by its place in the history.
#[derive(Debug, Default)]
pub(super) struct Past {
    states: BTreeMap<usize, State>,
}

/// What was solved for a document.
#[derive(Debug)]
struct State {
    mesh: Arc<DiskMesh>,
    relaxed: usize,
    solved: Solved,
}

impl Past {
    fn keep(&mut self, place: usize, state: State) {
        self.states.insert(place, state);
        while self.states.len() > 1 && self.states.values().map(|state| state.solved.bytes()).sum::<usize>() > BUDGET {
            let farthest = self.states.keys().copied().max_by_key(|other| other.abs_diff(place));
            farthest.map(|farthest| self.states.remove(&farthest));
        }
    }

    /// Drops what cannot be come back to.
    fn forget_beyond(&mut self, place: usize) {
        self.states.retain(|&other, _| other <= place);
    }
}

impl Session {
    /// Keeps what is solved for the document as it is, where a run has come to rest with it: it is about to become another.
    pub(super) fn remember(&mut self) {
        let place = self.history.depth();
        if !self.history.can_redo() {
            self.history.past.forget_beyond(place);
        }
        if self.history.is_in_gesture() && !self.is_current() {
            return;
        }
        self.history.past.states.remove(&place);
        let mesh = self.disk().filter(|_| self.has_form_as_wanted()).cloned();
        let solved = self.solving.solved(&self.document.problem(), BUDGET_OF_ONE);
        if let (Some(mesh), Some(solved)) = (mesh, solved) {
            self.history.past.keep(place, State { mesh, relaxed: self.document.relaxed, solved });
        }
    }

    /// Shows what was solved for the document when it was as it is again. Returns whether that is kept.
    pub(super) fn recall(&mut self) -> bool {
        let Some(task) = self.task() else { return false };
        let relaxed = self.document.relaxed;
        let is_of = |state: &State| {
            Arc::ptr_eq(&state.mesh, &task.mesh) && state.relaxed == relaxed && state.solved.is_of(&task.problem)
        };
        let Some(state) = self.history.past.states.remove(&self.history.depth()).filter(is_of) else { return false };
        self.drag.end();
        self.solving.show_again(state.solved, task, &mut self.messages);
        true
    }
}
