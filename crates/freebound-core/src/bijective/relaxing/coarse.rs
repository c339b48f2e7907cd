//! Relaxing by way of a disk with fewer vertices, where an embedding is very distorted.

use super::super::multires::{FineLevel, Hierarchy, Level};
use super::Relaxing;
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, Embedding, Pins, SolveError};

/// An energy up to this is lowered directly. Of 20 real disks none ends with more energy for it than with 1000, six end with
/// less, and three take two thirds of the time.
pub(super) const MOST_DIRECTLY: f64 = 30.0;

/// About how many vertices the coarsest disk has, and so many more for each pin.
const COARSE_VERTICES: usize = 400;
const VERTICES_A_PIN: usize = 20;

/// Rounds of the coarsest disk at most, and of those on the way.
const COARSE_ROUNDS: usize = 60;
const LEVEL_ROUNDS: usize = 3;

/// Smaller meshes go by themselves where constraints follow: of the places where boundaries come to touch, which those
/// keep, what was relaxed as a whole has somewhat better ones, and there it takes little time.
const FROM_VERTICES: usize = 4000;

/// A coarsest disk with more than this part of the vertices is no way: its rounds are hardly shorter than the mesh's.
const COARSE_PART: f64 = 0.6;

impl Relaxing {
    /// The same as what constraints are met from: on a small mesh, all its vertices from the first round on.
    pub(crate) fn before_constraints(self, mesh: &DiskMesh) -> Self {
        let coarse_from = if mesh.used_vertex_count() >= FROM_VERTICES { self.coarse_from } else { f64::INFINITY };
        Self { coarse_from, ..self }
    }

    /// Takes in what relaxing fewer vertices leads to, where the energy is high and falls by that.
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

/// Rounds of relaxing of a disk with fewer vertices.
#[derive(Clone, Copy)]
pub(crate) struct Relaxed<'a> {
    /// Those of the mesh as given.
    pub(crate) pins: &'a Pins,
    pub(crate) rounds: usize,
    pub(crate) control: Control<'a>,
}

impl Relaxed<'_> {
    /// An embedding of the disk after the rounds.
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
