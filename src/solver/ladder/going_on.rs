//! A ladder that goes on from a one-to-one embedding, or from a step of another ladder's: what is there is not thrown away for
//! an edit, nor solved again when the edit is taken back.

use super::continuation::Continue;
use super::flights::{GOING_ON, Kind};
use super::plan::{Part, Plan};
use super::rung::Latest;
use super::{Ladder, Pins, Step};
use crate::mesh::DiskMesh;
use crate::solver::{Embedding, Method, is_one_to_one};

impl Ladder {
    /// The same from a one-to-one embedding on, such as one under a dragged pin: the constraints are met from it as it lies,
    /// and what lies well is but settled. Where that gets stuck, the way is that without it. One position per vertex, in the
    /// plane. It comes after all other choices. Methods that do not continue, and pins that are no constraints, pass over it.
    #[must_use]
    pub fn going_on_from(mut self, embedding: &Embedding) -> Self {
        if !self.task.continues() {
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
        self.notes.say("goes on from the embedding that was there".to_owned());
        self
    }

    /// As [`going_on_from`](Self::going_on_from), but an embedding that meets all constraints is left as it is, to the last bit.
    #[must_use]
    pub fn staying_at(self, embedding: &Embedding) -> Self {
        let mut run = self.going_on_from(embedding);
        if run.plan.part().goes_on() {
            run.plan.part_mut().stay();
        }
        run
    }

    /// The same at rest after the newest step of another ladder's on the same mesh, with the same settings and pins: further
    /// steps go on from it, and count on. `rungs` are those of all its steps, in order.
    #[must_use]
    pub fn resting_after(mut self, step: &Step, rungs: &[Method]) -> Self {
        let is_climber = |rung: &Method| matches!(rung, Method::Continuation | Method::Matchmaker);
        if step.goes_on {
            self.plan = Plan::going_on(&self.task, &self.kept);
        } else if self.task.is_constrained() && rungs.iter().any(is_climber) {
            self.plan = Plan::on_the_way(&self.task, &self.kept);
        }
        self.take_in(step);
        self.step_count = step.index + 1;
        self
    }

    /// Begins afresh where the embedding to go on from is not one-to-one in units of the solve.
    pub(super) fn check_beginning(&mut self, mesh: &DiskMesh) {
        let is_bad =
            |latest: &Latest| latest.embedding.len() != mesh.vertex_count() || !is_one_to_one(mesh, &latest.embedding);
        if self.step_count == 0 && self.latest.as_ref().is_some_and(is_bad) {
            self.plan = Plan::new(&self.task, &self.kept, self.asked.start.as_ref());
            self.latest = None;
            self.notes.take();
            self.notes.say("solved afresh, for the embedding before is not one-to-one".to_owned());
        }
    }
}

impl Part {
    /// Whether it goes on from an embedding that was there before the ladder began.
    pub(super) fn goes_on(&self) -> bool {
        self.flights == GOING_ON
    }

    /// Leaves that as it is, where it meets all constraints.
    fn stay(&mut self) {
        self.rungs.insert(Kind::Continuation, Box::new(Continue::staying()));
    }
}
