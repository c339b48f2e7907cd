//! Continuation of a disk with fewer vertices: its pins move to the targets first, and the other vertices are put
//! back.

use std::sync::Arc;

use super::super::Advance;
use super::super::multires::{FineLevel, Hierarchy, Level};
use super::super::relaxing::Relaxed;
use super::Continuation;
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, Embedding, Pins, SolveError};

/// Least number of vertices for the coarse disk; smaller meshes move directly.
const FROM_VERTICES: usize = 4000;

/// Approximate number of vertices of the coarsest disk without pins.
const COARSE_VERTICES: usize = 1000;
/// Additional vertices of the coarsest disk for each pin.
const VERTICES_A_PIN: usize = 20;

/// Least distance of a pin from its target for the coarse disk, relative to the size of the embedding. A jump covers
/// less.
const FAR: f64 = 0.02;

/// Most steps of the coarse disk.
const MOST_STEPS: usize = 60;

/// Rounds of relaxing of the coarsest disk.
const COARSE_ROUNDS: usize = 20;
/// Rounds of relaxing of each level between the coarsest disk and the mesh.
const LEVEL_ROUNDS: usize = 3;

impl Continuation {
    /// Meets the hard targets on a disk with fewer vertices first. Returns `None`, with nothing changed, if that fails
    /// or the pins are close to their targets.
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
        // The vertices of filled holes stay on all levels.
        let coarsest = target + mesh.vertices_at_holes().len();
        let is_far = self.progress(mesh).distance_left > FAR * self.embedding.bounds().size().max_element();
        if !is_far || mesh.used_vertex_count() < FROM_VERTICES.max(2 * coarsest) {
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
            "solved first on {} of the {} vertices",
            hierarchy.coarsest().disk.vertex_count(),
            mesh.used_vertex_count()
        );
        Ok(Some(Advance { note: Some(note), ..self.accepted(progress, Arc::new(outside)) }))
    }
}

/// Embedding of the coarsest disk with its hard pins on their targets. `None` if it does not reach them.
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
