//! What ladders on a mesh have computed, for further ones on it.

use std::sync::Arc;

use super::plan::{Aim, Plan};
use super::task::Task;
use super::{Ladder, Step};
use crate::geom::PictureFrame;
use crate::mesh::DiskMesh;
use crate::solver::{Embedding, GaugeSize, Method, Prepared, Settings};

/// What ladders on a mesh have computed, for further ones on it.
#[derive(Clone, Debug, Default)]
pub struct Kept {
    /// Equations and factors of a linear solve.
    pub prepared: Option<Arc<Prepared>>,
    /// The planar start of the constrained rungs.
    pub planar_start: Option<Arc<PlanarStart>>,
}

/// A planar embedding without constraints.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanarStart {
    /// The size that it was computed at.
    size: GaugeSize,
    /// The picture that it was proved on.
    frame: PictureFrame,
    /// One position per vertex, in the plane.
    pub(super) embedding: Embedding,
}

impl PlanarStart {
    pub(super) fn new(task: &Task, embedding: Embedding) -> Self {
        Self { size: task.settings.size, frame: task.sheet.frame(), embedding }
    }

    /// Whether it is what another task would begin with.
    pub(super) fn serves(&self, task: &Task) -> bool {
        self.size == task.settings.size && self.frame == task.sheet.frame()
    }
}

impl Ladder {
    /// The same with what earlier ladders on the mesh have computed, used where it serves. Its steps hand on the factors of
    /// linear solves for further ladders; otherwise these go when they have served.
    #[must_use]
    pub fn with_kept(self, kept: &Kept) -> Self {
        let plan = Plan::new(&self.task, kept, self.asked.start.as_ref());
        Self { plan, kept: kept.clone(), hands_on_factors: true, ..self }
    }

    /// Hands a step on as the planar start of ladders with constraints, where theirs would end with it: a ladder without any
    /// takes the same steps, up to where energy alone is lowered. Once; and not of polygons, which a planar start may leave
    /// concave.
    pub(super) fn keep_start(&mut self, step: &mut Step, mesh: &DiskMesh) {
        let part = self.plan.part();
        let Task { settings, pins, start, .. } = &*self.task;
        let usual = Settings { size: settings.size, new_vertices: settings.new_vertices, ..Settings::default() };
        let has_polygons = mesh.mesh().polygon_of.is_some();
        let is_alone = part.aim == Aim::Constraints && pins.is_empty() && start.is_none() && self.units.is_plane();
        let is_alike = settings.method == Method::Auto && settings.amounts_to(&usual);
        let is_end = step.verdict.planar && !step.verdict.mirrored && !part.relax.goes_on_for_digits();
        if is_alone && is_alike && is_end && !has_polygons && self.kept.planar_start.is_none() {
            let kept = Arc::new(PlanarStart::new(&self.task, step.solution.embedding.clone()));
            self.kept.planar_start = Some(Arc::clone(&kept));
            step.candidate.planar_start = Some(kept);
        }
    }
}
