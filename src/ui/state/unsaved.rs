//! Question about unsaved work: the pending action, and the answers.

use crate::session::Action;

/// Action that waits for the answer.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::ui) enum PendingClose {
    Quit,
    Do(Action),
}

/// Answer of the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnsavedAnswer {
    Save,
    DontSave,
    Cancel,
}
