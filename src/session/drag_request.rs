//! Pins on their way: the request of a drag, and the map on the screen that it starts from.

use std::sync::Arc;

use super::solving::Task;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Problem;
use freebound_core::problem::Embedding;

/// Embedding on the screen when pins begin to move, and the problem that it was made for.
#[derive(Clone, Debug)]
pub(super) struct Screen {
    pub(super) embedding: Arc<Embedding>,
    pub(super) problem: Problem,
    /// True if it is proved planar as it lies.
    pub(super) is_planar: bool,
}

/// Pins on their way: the task with their targets, what is dragged, ascending, and what the screen shows.
pub(super) struct DragRequest {
    pub(super) task: Task,
    pub(super) dragged: Vec<VertexId>,
    pub(super) screen: Option<Screen>,
}

impl DragRequest {
    /// Embedding on the screen, if its problem differs in the dragged pins' targets alone.
    pub(super) fn base(&self) -> Option<&Screen> {
        let problem = &self.task.problem;
        self.screen.as_ref().filter(|screen| screen.problem.differs_in_targets_of(problem, &self.dragged))
    }
}
