//! Relaxing by way of a disk with fewer vertices, where an embedding is very distorted.

use super::super::coarse::{Fine, Hierarchy, Level};
use super::super::{Control, Embedding, Pins, SolveError};
use super::Relaxing;
use crate::mesh::{DiskMesh, VertexId};

/// An energy up to this is lowered directly.
const HUGE: f64 = 1000.0;

/// About how many vertices the coarsest disk has, and so many more for each pin.
const COARSE_VERTICES: usize = 400;
const VERTICES_A_PIN: usize = 20;

/// Rounds of the coarsest disk at most, and of those on the way.
const COARSE_ROUNDS: usize = 60;
const LEVEL_ROUNDS: usize = 3;

impl Relaxing {
    /// Takes in what relaxing fewer vertices leads to, where the energy is huge and falls by that.
    pub(super) fn go_by_way_of_coarse(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<(), SolveError> {
        let target = COARSE_VERTICES + VERTICES_A_PIN * self.pins.len();
        if self.progress.energy < HUGE || mesh.used_vertex_count() < 2 * target {
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
        let progress = self.rest.progress(mesh, &lifted, 0.0);
        if holds && progress.energy < self.progress.energy {
            self.inner = self.with_ears.as_ref().map_or(progress, |all| all.progress(mesh, &lifted, 0.0));
            (self.embedding, self.progress) = (lifted, progress);
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
        let coarse = Relaxed { pins: &self.pins, rounds: COARSE_ROUNDS, control }
            .of(coarsest, coarsest.part_of(&self.embedding))?;
        let on_the_way = Relaxed { pins: &self.pins, rounds: LEVEL_ROUNDS, control };
        let fine = Fine { mesh, embedding: &self.embedding, pins: &self.pins };
        hierarchy.lifted(fine, &coarse, |level, embedding| on_the_way.of(level, embedding), control)
    }
}

/// Rounds of relaxing of a disk with fewer vertices.
#[derive(Clone, Copy)]
pub(in crate::solver) struct Relaxed<'a> {
    /// Those of the mesh as given.
    pub(in crate::solver) pins: &'a Pins,
    pub(in crate::solver) rounds: usize,
    pub(in crate::solver) control: Control<'a>,
}

impl Relaxed<'_> {
    /// An embedding of the disk after the rounds.
    pub(in crate::solver) fn of(self, level: &Level, embedding: Embedding) -> Result<Embedding, SolveError> {
        let mut relaxing = Relaxing::new(&level.disk, embedding, &level.pins_of(self.pins));
        relaxing.may_go_by_coarse = false;
        for _ in 0..self.rounds {
            if relaxing.has_converged {
                break;
            }
            relaxing.round(&level.disk, self.control)?;
        }
        Ok(relaxing.embedding)
    }
}
