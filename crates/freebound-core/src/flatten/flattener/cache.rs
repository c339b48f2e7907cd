//! Results of flatteners on one mesh, for reuse by further ones.

use std::sync::Arc;

use super::task::Task;
use crate::flatten::Prepared;
use crate::geom::PictureFrame;
use crate::problem::{Embedding, GaugeSize};

/// Results of flatteners on one mesh, for reuse by further ones.
#[derive(Clone, Debug, Default)]
pub struct SolverCache {
    /// Equations and factors of a linear solve.
    pub prepared: Option<Arc<Prepared>>,
    /// Planar start of the stages that meet constraints.
    pub planar_start: Option<Arc<PlanarStart>>,
}

/// A planar embedding without constraints.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanarStart {
    /// Size for which it was computed.
    size: GaugeSize,
    /// Picture frame in which it was proved.
    frame: PictureFrame,
    /// Position of every vertex in the plane.
    pub(super) embedding: Embedding,
}

impl PlanarStart {
    pub(super) fn new(task: &Task, embedding: Embedding) -> Self {
        Self { size: task.settings.size, frame: task.frame.frame(), embedding }
    }

    /// True if another task can start from it: size and picture frame are equal.
    pub(super) fn serves(&self, task: &Task) -> bool {
        self.size == task.settings.size && self.frame == task.frame.frame()
    }
}
