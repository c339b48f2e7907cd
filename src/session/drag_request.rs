//! Request of a drag, and the map on the screen that the drag starts from.

use std::sync::Arc;

use super::solving::Task;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Problem;
use freebound_core::problem::Embedding;

/// Embedding on the screen when the drag begins, with its problem.
#[derive(Clone, Debug)]
pub(super) struct Screen {
    pub(super) embedding: Arc<Embedding>,
    pub(super) problem: Problem,
    /// True if the embedding is proved planar.
    pub(super) is_planar: bool,
}

/// Request of a drag: the task with the new targets, the dragged vertices in ascending order, and the state of the
/// screen.
pub(super) struct DragRequest {
    pub(super) task: Task,
    pub(super) dragged: Vec<VertexId>,
    pub(super) screen: Option<Screen>,
}

impl DragRequest {
    /// State of the screen, if its problem differs in the targets of the dragged pins alone.
    pub(super) fn base(&self) -> Option<&Screen> {
        let problem = &self.task.problem;
        self.screen.as_ref().filter(|screen| screen.problem.differs_in_targets_of(problem, &self.dragged))
    }
}
