//! The question about unsaved work: what waits for its answer, and the answers.

use crate::session::Action;

/// Actions that wait for the answer.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::ui) enum PendingClose {
    Quit,
    Do(Action),
}

/// The answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnsavedAnswer {
    Save,
    DontSave,
    Cancel,
}
