//! The outline of the compared step over the one on the screen.

use std::sync::Arc;

use glam::DVec2;

use super::PlaneView;
use crate::mesh::VertexId;
use crate::render::{GhostLayer, LineLayer};
use crate::session::{Outcome, Session};
use crate::ui::theme::Theme;
use crate::view::{EdgeList, PlaneArrays};

/// The boundary of the compared step, ready to be drawn over the one on the screen.
#[derive(Debug)]
pub(super) struct Ghost {
    /// The revision of the outcome on the screen, and the compared step.
    key: (u64, usize),
    /// The boundary's vertices only, in the unit space of the outcome on the screen.
    arrays: Arc<PlaneArrays>,
    edges: Arc<EdgeList>,
}

impl PlaneView {
    /// The outline, as the pane draws it.
    pub(in crate::ui) fn ghost_layer(&self, theme: &Theme) -> Option<GhostLayer> {
        let ghost = self.ghost.as_ref()?;
        let line = LineLayer { edges: Arc::clone(&ghost.edges), colour: theme.ghost, width_in_points: 2.0 };
        Some(GhostLayer { plane: Arc::clone(&ghost.arrays), line })
    }

    /// The step whose outline shows.
    pub fn ghost_step(&self) -> Option<usize> {
        self.ghost.as_ref().map(|ghost| ghost.key.1)
    }

    /// The step that moves are measured from: the compared one, or else the one before, as far as it is kept.
    pub fn moved_from<'a>(&self, session: &'a Session) -> Option<&'a Arc<Outcome>> {
        let timeline = session.timeline();
        let shown = self.scene.as_ref()?.outcome.step.index;
        let compared = timeline.compared().filter(|&compared| compared != shown);
        timeline.outcome(compared.or_else(|| shown.checked_sub(1))?)
    }

    /// Makes the outline of the compared step where another one is wanted. Call once per frame.
    pub(super) fn refresh_ghost(&mut self, session: &Session) {
        let before = self.ghost.take();
        let (Some(plane), Some(step)) = (&self.scene, session.timeline().compared()) else { return };
        let key = (plane.outcome_revision, step);
        self.ghost = before.filter(|ghost| ghost.key == key).or_else(|| {
            let other = session.compared().filter(|_| step != plane.outcome.step.index)?;
            let embedding = &other.step.solution.embedding;
            let loop_of_other = other.step.mesh(plane.mesh.model.disk()?).boundary_loop();
            let position_of = |v: &VertexId| embedding.get(v.index()).copied().unwrap_or(DVec2::NAN);
            let boundary: Vec<DVec2> = loop_of_other.iter().map(position_of).collect();
            let vertices: Vec<VertexId> = (0..boundary.len()).map(VertexId::from_index).collect();
            let arrays = Arc::new(PlaneArrays::in_frame(&boundary, &[], plane.arrays.frame));
            Some(Ghost { key, arrays, edges: Arc::new(EdgeList::closed_loop(&vertices)) })
        });
    }
}
