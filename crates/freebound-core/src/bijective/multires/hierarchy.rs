//! Vertices taken from a disk, round by round.

use crate::parallel::prelude::*;

use super::collapse::Collapse;
use super::level::Level;
use super::surface::{Ring, Surface};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, Embedding, Phase, SolveError};

/// The corner of a boundary vertex's polygon that lies outside, and is no vertex.
pub(super) const OUTSIDE: u32 = u32::MAX;

/// Candidates of a round that may be removed, those of the lowest cost: 3 of 5. Small triangles go first.
const REMOVED: usize = 3;
const REMOVED_OF: usize = 5;

/// A round that takes less than this share of the vertices is the last.
const LEAST_SHARE: f64 = 0.01;

/// From level to level there are so many times as many vertices.
const FACTOR: usize = 4;

/// A disk with fewer and fewer vertices, down to a coarse one, and what is needed to put them back.
#[derive(Debug)]
pub struct Hierarchy {
    /// In the order in which they were taken.
    pub(super) rounds: Vec<Round>,
    /// Disks on the way, by the number of rounds that led to them, finest first.
    pub(super) levels: Vec<(usize, Level)>,
    coarsest: Level,
}

/// Vertices that were taken at once: no two are neighbours.
#[derive(Debug)]
pub(super) struct Round {
    pub(super) removed: Vec<Removed>,
    /// The boundary without them, where any of them lay on it.
    pub(super) boundary: Vec<u32>,
}

/// A vertex that was taken.
#[derive(Debug)]
pub(super) struct Removed {
    pub(super) vertex: u32,
    /// Its neighbours, counter-clockwise, from the one on that it was moved onto. At the boundary [`OUTSIDE`] stands
    /// between the last and the first.
    pub(super) polygon: Vec<u32>,
}

impl Removed {
    /// Sides of the polygon that are sides of faces of the vertex, by the place of their first corner.
    pub(super) fn sides(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.polygon.len()).filter(|&k| !self.side(k).contains(&OUTSIDE))
    }

    /// A side of the polygon.
    pub(super) fn side(&self, k: usize) -> [u32; 2] {
        [self.polygon[k], self.polygon[(k + 1) % self.polygon.len()]]
    }

    /// The triangles that fill its place, as places in the polygon.
    pub(super) fn fan(&self) -> impl Iterator<Item = [usize; 3]> + '_ {
        self.sides().filter(|&k| k > 0 && k + 1 < self.polygon.len()).map(|k| [0, k, k + 1])
    }
}

impl Hierarchy {
    /// Takes vertices from a disk in a planar embedding until about `target` are left or no more can go, without those
    /// that are kept. It is the same for any number of threads. `None` where the mesh has holes that were filled, and
    /// where too few vertices can go.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub fn new(
        mesh: &DiskMesh,
        embedding: &Embedding,
        keeps: impl Fn(VertexId) -> bool,
        target: usize,
        control: Control<'_>,
    ) -> Result<Option<Self>, SolveError> {
        Self::of(Surface::new(mesh, embedding), keeps, target, control)
    }

    /// The same where there is no embedding yet: the shape of the surface alone says which vertices can go.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub fn in_space(
        mesh: &DiskMesh,
        keeps: impl Fn(VertexId) -> bool,
        target: usize,
        control: Control<'_>,
    ) -> Result<Option<Self>, SolveError> {
        Self::of(Surface::alone(mesh), keeps, target, control)
    }

    fn of(
        mut surface: Surface<'_>,
        keeps: impl Fn(VertexId) -> bool,
        target: usize,
        control: Control<'_>,
    ) -> Result<Option<Self>, SolveError> {
        let mesh = surface.mesh;
        if mesh.real_faces().len() < mesh.face_count() {
            return Ok(None);
        }
        surface.look_around();
        let kept: Vec<bool> = mesh.vertices().map(keeps).collect();
        let mut left: Vec<u32> = mesh.vertices().filter(|&v| mesh.is_used(v)).map(VertexId::number).collect();
        let (mut rounds, mut levels) = (Vec::new(), Vec::new());
        let mut before = left.len();
        while left.len() > target {
            control.enter(Phase::Assemble)?;
            if left.len() * FACTOR <= before {
                let Some(level) = Level::new(mesh, &surface.inner) else { return Ok(None) };
                levels.push((rounds.len(), level));
                before = left.len();
            }
            let removed = surface.round(&left, &kept, left.len() - target);
            if (removed.len() as f64) < LEAST_SHARE * left.len() as f64 {
                break;
            }
            surface.take(&removed, &mut left);
            let is_at_boundary = removed.iter().any(|removed| removed.polygon.contains(&OUTSIDE));
            let boundary = if is_at_boundary { surface.boundary.clone() } else { Vec::new() };
            rounds.push(Round { removed, boundary });
        }
        let Some(coarsest) = Level::new(mesh, &surface.inner).filter(|_| !rounds.is_empty()) else { return Ok(None) };
        Ok(Some(Self { rounds, levels, coarsest }))
    }

    /// The disk with the fewest vertices.
    pub fn coarsest(&self) -> &Level {
        &self.coarsest
    }

    /// The disks between that and the mesh as given, finest first.
    pub fn levels(&self) -> impl DoubleEndedIterator<Item = &Level> {
        self.levels.iter().map(|(_, level)| level)
    }
}

impl Surface<'_> {
    /// Vertices that can go at once, `most` of them at most.
    fn round(&self, left: &[u32], kept: &[bool], most: usize) -> Vec<Removed> {
        let mut found: Vec<Collapse> = left
            .par_iter()
            .with_min_len(256)
            .map_init(Ring::default, |ring, &vertex| self.best_collapse(vertex, kept, ring))
            .flatten()
            .collect();
        found.par_sort_unstable_by(|a, b| a.cost.total_cmp(&b.cost).then(a.vertex.cmp(&b.vertex)));
        found.truncate((found.len() * REMOVED).div_ceil(REMOVED_OF));
        let mut is_blocked = vec![false; self.points.len()];
        let mut ring = Ring::default();
        // A boundary of three vertices is the last that there can be.
        let mut spare = self.boundary.len().saturating_sub(3);
        let mut removed = Vec::new();
        for Collapse { vertex, onto, .. } in found {
            if removed.len() == most {
                break;
            }
            if is_blocked[vertex as usize] || !self.find_ring(vertex, &mut ring) {
                continue;
            }
            if ring.is_of_boundary() {
                if spare == 0 {
                    continue;
                }
                spare -= 1;
            }
            is_blocked[vertex as usize] = true;
            ring.vertices.iter().for_each(|&v| is_blocked[v as usize] = true);
            removed.push(Removed { vertex, polygon: polygon(&ring, onto) });
        }
        removed
    }

    /// Takes vertices away.
    fn take(&mut self, removed: &[Removed], left: &mut Vec<u32>) {
        let mut is_gone = vec![false; self.vertex_count()];
        for removed in removed {
            is_gone[removed.vertex as usize] = true;
        }
        self.inner.retain(|corners| corners.iter().all(|&v| !is_gone[v as usize]));
        for removed in removed {
            self.inner.extend(removed.fan().map(|corners| corners.map(|k| removed.polygon[k])));
        }
        self.boundary.retain(|&v| !is_gone[v as usize]);
        left.retain(|&v| !is_gone[v as usize]);
        self.look_around();
    }
}

/// The polygon that a vertex leaves, from the neighbour on that it is moved onto.
fn polygon(ring: &Ring, onto: usize) -> Vec<u32> {
    let mut polygon = if ring.is_of_boundary() { ring.vertices[..=ring.inner].to_vec() } else { ring.vertices.clone() };
    if ring.is_of_boundary() {
        polygon.push(OUTSIDE);
    }
    polygon.rotate_left(onto);
    polygon
}
