//! A ladder that goes on from a one-to-one embedding: what is there is not thrown away for an edit.

use super::plan::Plan;
use super::rung::Latest;
use super::{Ladder, Pins};
use crate::mesh::DiskMesh;
use crate::solver::{Embedding, Method, is_one_to_one};

impl Ladder {
    /// The same from a one-to-one embedding on, such as one under a dragged pin: the constraints are met from it as it lies,
    /// and what lies well is but settled. Where that gets stuck, the way is that without it. One position per vertex, in the
    /// plane. It comes after all other choices. Methods that do not continue, and pins that are no constraints, pass over it.
    #[must_use]
    pub fn going_on_from(mut self, embedding: &Embedding) -> Self {
        let is_continued = matches!(self.task.settings.method, Method::Auto | Method::Continuation);
        if !is_continued || !self.task.is_constrained() {
            return self;
        }
        self.plan = Plan::going_on(&self.task, &self.kept);
        self.latest = Some(Latest {
            embedding: self.units.embedding(embedding),
            onward: None,
            pins: Pins::new(),
            has_simple_boundary: true,
            is_one_to_one: true,
            is_solved: false,
            is_unplaced: false,
            is_solved_but_for_polygons: false,
            concave_polygons: Vec::new(),
            refinement: None,
        });
        self
    }

    /// Begins afresh where the embedding to go on from is not one-to-one in units of the solve.
    pub(super) fn check_beginning(&mut self, mesh: &DiskMesh) {
        let is_bad =
            |latest: &Latest| latest.embedding.len() != mesh.vertex_count() || !is_one_to_one(mesh, &latest.embedding);
        if self.step_count == 0 && self.latest.as_ref().is_some_and(is_bad) {
            self.plan = Plan::new(&self.task, &self.kept, self.asked.start.as_ref());
            self.latest = None;
            self.notes.say("solved afresh, for the embedding before is not one-to-one".to_owned());
        }
    }
}
