//! The way of a disk with fewer vertices: it goes to the targets first, and the other vertices are put back.

use std::sync::Arc;

use super::super::Advance;
use super::super::multires::{FineLevel, Hierarchy, Level};
use super::super::relaxing::Relaxed;
use super::Continuation;
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, Embedding, Pins, SolveError};

/// Meshes with fewer vertices go by themselves.
const FROM_VERTICES: usize = 4000;

/// About how many vertices the coarsest disk has, and so many more for each pin.
const COARSE_VERTICES: usize = 1000;
const VERTICES_A_PIN: usize = 20;

/// The least distance of a pin from its target that is worth it, by the size of the embedding: shorter ways are a jump.
const FAR: f64 = 0.02;

/// The most steps of the coarse disk.
const MOST_STEPS: usize = 60;

/// Rounds of relaxing of the coarsest disk, and of those on the way.
const COARSE_ROUNDS: usize = 20;
const LEVEL_ROUNDS: usize = 3;

impl Continuation {
    /// Meets the exact targets by the way of a disk with fewer vertices. `None` where that leads nowhere, or the way is
    /// short: nothing has changed then.
    pub(crate) fn by_way_of_coarse(
        &mut self,
        mesh: &DiskMesh,
        control: Control<'_>,
    ) -> Result<Option<Advance>, SolveError> {
        match self.tried_coarse(mesh, control) {
            Err(SolveError::Cancelled) => Err(SolveError::Cancelled),
            Err(_) => Ok(None),
            Ok(found) => Ok(found),
        }
    }

    fn tried_coarse(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Option<Advance>, SolveError> {
        let target = COARSE_VERTICES + VERTICES_A_PIN * self.pins.len();
        let is_far = self.progress(mesh).distance_left > FAR * self.embedding.bounds().size().max_element();
        if !is_far || mesh.used_vertex_count() < FROM_VERTICES.max(2 * target) {
            return Ok(None);
        }
        let keeps = |vertex: VertexId| self.pins.contains_key(&vertex);
        control.go_on()?;
        let Some(hierarchy) = Hierarchy::new(mesh, &self.embedding, keeps, target, control)? else { return Ok(None) };
        let Some(coarse) = arrived(hierarchy.coarsest(), &self.embedding, &self.pins, control)? else {
            return Ok(None);
        };
        let on_the_way = Relaxed { pins: &self.pins, rounds: LEVEL_ROUNDS, control };
        let improve = |level: &Level, embedding| on_the_way.of(level, embedding);
        let fine = FineLevel { mesh, embedding: &self.embedding, pins: &self.pins };
        let Some(lifted) = hierarchy.lifted(fine, &coarse, improve, control)? else { return Ok(None) };
        let Some(outside) = self.outside_of(mesh, &lifted) else { return Ok(None) };
        control.go_on()?;
        if !self.sheet.is_one_to_one(mesh, &lifted) {
            return Ok(None);
        }
        control.go_on()?;
        (self.embedding, self.jumps) = (lifted, false);
        let progress = self.progress(mesh);
        self.sound = (self.embedding.clone(), progress.energy);
        self.distances.push(progress.distance_left);
        let note = format!(
            "by way of {} of the {} vertices",
            hierarchy.coarsest().disk.vertex_count(),
            mesh.used_vertex_count()
        );
        Ok(Some(Advance { note: Some(note), ..self.accepted(progress, Arc::new(outside)) }))
    }
}

/// The embedding of the coarsest disk with its exact pins on their targets; `None` where it does not come there.
fn arrived(
    level: &Level,
    start: &Embedding,
    pins: &Pins,
    control: Control<'_>,
) -> Result<Option<Embedding>, SolveError> {
    let mut continuation = Continuation::new(&level.disk, level.part_of(start), &level.pins_of(pins));
    for _ in 0..MOST_STEPS {
        continuation.step(&level.disk, control)?;
        if continuation.is_at_its_end() {
            return Relaxed { pins, rounds: COARSE_ROUNDS, control }.of(level, continuation.embedding).map(Some);
        }
    }
    Ok(None)
}
