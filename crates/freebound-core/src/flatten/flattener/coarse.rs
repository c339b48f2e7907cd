//! Coarse stage, before stage 3 on large meshes: a disk with few vertices is flattened, and the other vertices are put
//! back one-to-one.
//!
//! This is our addition to the flattener. If the boundary crosses itself, stage 3 bends it to a circle, and relaxing
//! has to undo the resulting distortion of every triangle. Both cost little on a disk with few vertices.

use std::time::Instant;

use super::stage::{RunStage, StageFailure, StageInput, StepState, tried};
use super::task::Task;
use super::{Candidate, Flattener, Step};
use crate::bijective::multires::{FineLevel, Hierarchy};
use crate::bijective::relaxing::Relaxed;
use crate::mesh::DiskMesh;
use crate::nonlinear::rest_shape::RestShape;
use crate::problem::{Control, Embedding, Method, Pins, Settings, SolveError, Stage};

/// Least number of vertices for this stage.
const FROM_VERTICES: usize = 4000;

/// Approximate number of vertices of the coarse disk.
const COARSE_VERTICES: usize = 1500;

/// Rounds of relaxing of each level between the coarse disk and the mesh.
const LEVEL_ROUNDS: usize = 6;
/// Rounds of relaxing of the whole mesh afterwards.
const ROUNDS: usize = 3;

#[derive(Debug, Default)]
pub(super) struct FewVertices {
    is_done: bool,
}

impl RunStage for FewVertices {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        let began = Instant::now();
        let found = tried(by_few(from, control))?;
        self.is_done = true;
        found.map(|candidate| candidate.since(began)).ok_or_else(|| StageFailure::in_silence(SolveError::NotPlanar))
    }

    fn has_more(&self, _: &Task, latest: Option<&StepState>) -> bool {
        !self.is_done && latest.is_some_and(|latest| !latest.has_simple_boundary)
    }

    fn relax_rounds_after(&self, task: &Task, _: &Step) -> usize {
        if task.settings.method == Method::Auto { ROUNDS } else { 0 }
    }
}

/// Planar embedding from a coarse disk. `None` if that fails or the mesh is small.
fn by_few(
    StageInput { mesh, latest, .. }: StageInput<'_>,
    control: Control<'_>,
) -> Result<Option<Candidate>, SolveError> {
    let Some(latest) = latest.filter(|_| mesh.used_vertex_count() >= FROM_VERTICES) else { return Ok(None) };
    let Some(hierarchy) = Hierarchy::in_space(mesh, |_| false, COARSE_VERTICES, control)? else { return Ok(None) };
    let coarsest = hierarchy.coarsest();
    if 2 * coarsest.disk.vertex_count() > mesh.used_vertex_count() {
        return Ok(None);
    }
    let Some(coarse) = flattened(&coarsest.disk, control)? else { return Ok(None) };
    let pins = Pins::new();
    let on_the_way = Relaxed { pins: &pins, rounds: LEVEL_ROUNDS, control };
    let fine = FineLevel { mesh, embedding: &latest.embedding, pins: &pins };
    let lifted =
        hierarchy.lifted(fine, &coarse.embedding, |level, embedding| on_the_way.of(level, embedding), control)?;
    let Some(embedding) = lifted else { return Ok(None) };
    let progress = RestShape::progress_at_end(mesh, &embedding);
    let (few, all) = (coarsest.disk.vertex_count(), mesh.used_vertex_count());
    Ok(Some(Candidate {
        progress: Some(progress),
        bent_vertices: coarse.bent_vertices,
        note: Some(format!("solved first on {few} of the {all} vertices")),
        ..Candidate::one_to_one(Stage::VirtualBoundary, embedding, &pins)
    }))
}

/// Result of the flattener on the coarse disk.
struct Flattened {
    embedding: Embedding,
    bent_vertices: usize,
}

/// Planar embedding of a disk, relaxed if its boundary was bent. `None` if there is none.
fn flattened(disk: &DiskMesh, control: Control<'_>) -> Result<Option<Flattened>, SolveError> {
    let mut flattener = Flattener::new(Settings::default(), Pins::new());
    let mut last: Option<Step> = None;
    let mut bent_vertices = 0;
    flattener.finish(disk, control, |step| {
        bent_vertices = bent_vertices.max(step.candidate.bent_vertices);
        last = Some(step);
    })?;
    let last = last.filter(|step| step.verdict.planar && step.candidate.refinement.is_none());
    Ok(last.map(|step| Flattened { embedding: step.candidate.solution.embedding, bent_vertices }))
}
