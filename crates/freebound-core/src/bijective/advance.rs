//! Result of one step of continuation or one round of relaxing.

use std::sync::Arc;

use crate::nonlinear::Scaffold;
use crate::problem::{Embedding, Progress};

/// Intermediate one-to-one embedding with its progress numbers and the scaffold around it.
#[derive(Clone, Debug)]
pub(crate) struct Advance {
    pub(crate) embedding: Embedding,
    pub(crate) progress: Progress,
    pub(crate) scaffold: Arc<Scaffold>,
    /// Remark for the user, if the step was not an ordinary one.
    pub(crate) note: Option<String>,
}
