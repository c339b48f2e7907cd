//! Relaxing on a disk with fewer vertices first, if an embedding is very distorted.

use super::super::multires::{FineLevel, Hierarchy, Level};
use super::Relaxing;
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, Embedding, Pins, SolveError};

/// Largest energy that is lowered directly; above it the round starts on a coarse disk. Compared with 1000 on 20 real
/// disks: none ends with more energy, six end with less, three take two thirds of the time.
pub(super) const MOST_DIRECTLY: f64 = 30.0;

/// Approximate number of vertices of the coarsest disk without pins.
const COARSE_VERTICES: usize = 400;
/// Additional vertices of the coarsest disk for each pin.
const VERTICES_A_PIN: usize = 20;

/// Most rounds on the coarsest disk.
const COARSE_ROUNDS: usize = 60;
/// Most rounds on each level between the coarsest disk and the mesh.
const LEVEL_ROUNDS: usize = 3;

/// Least number of vertices for the coarse disk if constraints are met afterwards. Relaxing a smaller mesh directly is
/// fast, and leads to slightly better places of contact between boundaries, which persist while constraints are met.
const FROM_VERTICES: usize = 4000;

/// Largest share of the vertices that the coarsest disk may have. Above it, a coarse round is hardly cheaper than a
/// full one.
const COARSE_PART: f64 = 0.6;

impl Relaxing {
    /// Prepares for meeting constraints afterwards: a mesh with fewer than [`FROM_VERTICES`] vertices is relaxed
    /// directly.
    pub(crate) fn before_constraints(self, mesh: &DiskMesh) -> Self {
        let coarse_from = if mesh.used_vertex_count() >= FROM_VERTICES { self.coarse_from } else { f64::INFINITY };
        Self { coarse_from, ..self }
    }

    /// Replaces the embedding by one that was relaxed on a coarse disk, if its energy is high and becomes lower.
    /// Errors other than cancellation leave it unchanged.
    pub(super) fn go_by_way_of_coarse(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<(), SolveError> {
        let target = COARSE_VERTICES + VERTICES_A_PIN * self.pins.len();
        if self.standing.faces.energy < self.coarse_from || mesh.used_vertex_count() < 2 * target {
            return Ok(());
        }
        let lifted = match self.lifted_from_coarse(mesh, target, control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            Err(_) | Ok(None) => return Ok(()),
            Ok(Some(lifted)) => lifted,
        };
        let holds = if self.with_ears.is_some() && self.sheet.is_planar(mesh, &self.embedding) {
            self.sheet.is_planar(mesh, &lifted)
        } else {
            self.sheet.is_one_to_one(mesh, &lifted)
        };
        let standing = self.standing_of(mesh, &lifted);
        if holds && standing.faces.energy < self.standing.faces.energy {
            (self.embedding, self.standing) = (lifted, standing);
        }
        Ok(())
    }

    fn lifted_from_coarse(
        &self,
        mesh: &DiskMesh,
        target: usize,
        control: Control<'_>,
    ) -> Result<Option<Embedding>, SolveError> {
        let keeps = |vertex: VertexId| self.pins.contains_key(&vertex);
        let Some(hierarchy) = Hierarchy::new(mesh, &self.embedding, keeps, target, control)? else { return Ok(None) };
        let coarsest = hierarchy.coarsest();
        if coarsest.vertices.len() as f64 > COARSE_PART * mesh.used_vertex_count() as f64 {
            return Ok(None);
        }
        let coarse = Relaxed { pins: &self.pins, rounds: COARSE_ROUNDS, control }
            .of(coarsest, coarsest.part_of(&self.embedding))?;
        let on_the_way = Relaxed { pins: &self.pins, rounds: LEVEL_ROUNDS, control };
        let fine = FineLevel { mesh, embedding: &self.embedding, pins: &self.pins };
        hierarchy.lifted(fine, &coarse, |level, embedding| on_the_way.of(level, embedding), control)
    }
}

/// Settings for relaxing a disk with fewer vertices.
#[derive(Clone, Copy)]
pub(crate) struct Relaxed<'a> {
    /// Pins of the input mesh.
    pub(crate) pins: &'a Pins,
    pub(crate) rounds: usize,
    pub(crate) control: Control<'a>,
}

impl Relaxed<'_> {
    /// Embedding of the disk after the rounds.
    pub(crate) fn of(self, level: &Level, embedding: Embedding) -> Result<Embedding, SolveError> {
        let mut relaxing = Relaxing::new(&level.disk, embedding, &level.pins_of(self.pins));
        relaxing.coarse_from = f64::INFINITY;
        for _ in 0..self.rounds {
            if relaxing.has_converged {
                break;
            }
            relaxing.round(&level.disk, self.control)?;
        }
        Ok(relaxing.embedding)
    }
}
