//! A pin that follows the pointer: the first solve is linear in the targets (DESIGN: dragging).

use std::sync::Arc;

use glam::DVec2;

use super::Session;
use crate::mesh::VertexId;
use crate::solver::Verdict;

/// The embedding of the first solve while a pin is dragged.
#[derive(Clone, Debug)]
pub struct Preview {
    /// Where vertices lie, in the plane.
    pub embedding: Arc<Vec<DVec2>>,
    /// Counts the moves of this session, so that a screen can tell when to draw anew.
    pub revision: u64,
    /// The newest verdict that there is, with the revision that it is on.
    pub checked: Option<(u64, Arc<Verdict>)>,
}

impl Preview {
    /// The verdict on this very embedding, once it is there.
    pub fn verdict(&self) -> Option<&Arc<Verdict>> {
        self.checked.as_ref().filter(|(revision, _)| *revision == self.revision).map(|(_, verdict)| verdict)
    }
}

impl Session {
    /// What the screen shows while a pin is dragged.
    pub fn preview(&self) -> Option<&Preview> {
        self.preview.as_ref()
    }

    /// Lets the embedding follow pins that were moved.
    pub(super) fn follow(&mut self, _moves: &[(VertexId, DVec2)]) {
        self.solve();
    }
}
