//! Removal of vertices from a disk, round by round.

use crate::parallel::prelude::*;

use super::collapse::Collapse;
use super::level::{Level, virtual_face_count};
use super::surface::{Ring, Surface};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, Embedding, Phase, SolveError};

/// Corner of a boundary vertex's polygon that lies outside and is not a vertex.
pub(super) const OUTSIDE: u32 = u32::MAX;

/// Numerator of the share of candidates that a round may remove, lowest cost first. Small triangles go first.
const REMOVED: usize = 3;
/// Denominator of that share.
const REMOVED_OF: usize = 5;

/// Least share of the vertices that a round must remove; a smaller round is dropped and ends the removal.
const LEAST_SHARE: f64 = 0.01;

/// Ratio of vertex counts between successive levels.
const FACTOR: usize = 4;

/// Hierarchy of coarser disks, with the data for putting the vertices back.
#[derive(Debug)]
pub struct Hierarchy {
    /// Rounds in order of removal.
    pub(super) rounds: Vec<Round>,
    /// Intermediate disks, each with the number of rounds before it, finest first.
    pub(super) levels: Vec<(usize, Level)>,
    coarsest: Level,
}

/// Vertices that were removed at once: no two are neighbours.
#[derive(Debug)]
pub(super) struct Round {
    pub(super) removed: Vec<Removed>,
    /// Boundary without the removed vertices. Empty if none lay on the boundary.
    pub(super) boundary: Vec<u32>,
}

/// Removed vertex.
#[derive(Debug)]
pub(super) struct Removed {
    pub(super) vertex: u32,
    /// Neighbours, counter-clockwise, starting with the one that the vertex was moved onto. At the boundary
    /// [`OUTSIDE`] stands for the outside.
    pub(super) polygon: Vec<u32>,
}

impl Removed {
    /// Sides of the polygon that belong to faces of the vertex, by the place of their first corner.
    pub(super) fn sides(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.polygon.len()).filter(|&k| !self.side(k).contains(&OUTSIDE))
    }

    /// Side of the polygon, from corner `k` to the next.
    pub(super) fn side(&self, k: usize) -> [u32; 2] {
        [self.polygon[k], self.polygon[(k + 1) % self.polygon.len()]]
    }

    /// Triangles that fill the polygon, as places in it.
    pub(super) fn fan(&self) -> impl Iterator<Item = [usize; 3]> + '_ {
        self.sides().filter(|&k| k > 0 && k + 1 < self.polygon.len()).map(|k| [0, k, k + 1])
    }
}

impl Hierarchy {
    /// Removes vertices of a disk in a planar embedding until about `target` are left or no more can go. Vertices for
    /// which `keeps` is true stay, and so do the vertices of filled holes, beyond `target`. The result does not depend
    /// on the number of threads.
    ///
    /// `None` if not even one round removes enough vertices.
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

    /// Removes vertices without an embedding, by the shape of the surface alone. Otherwise like [`Hierarchy::new`].
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
        surface.look_around();
        let mut kept: Vec<bool> = mesh.vertices().map(keeps).collect();
        // Virtual faces stay as they are.
        let at_holes = mesh.vertices_at_holes();
        let target = target + at_holes.len();
        for vertex in at_holes {
            kept[vertex.index()] = true;
        }
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

    /// Disk with the fewest vertices.
    pub fn coarsest(&self) -> &Level {
        &self.coarsest
    }

    /// Disks between the coarsest one and the input mesh, finest first.
    pub fn levels(&self) -> impl DoubleEndedIterator<Item = &Level> {
        self.levels.iter().map(|(_, level)| level)
    }
}

impl Surface<'_> {
    /// Vertices that can be removed at once, at most `most`.
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
        // The boundary must keep three vertices.
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

    /// Removes vertices, and fills their polygons.
    fn take(&mut self, removed: &[Removed], left: &mut Vec<u32>) {
        let mut is_gone = vec![false; self.vertex_count()];
        for removed in removed {
            is_gone[removed.vertex as usize] = true;
        }
        let virtual_faces = self.inner.split_off(self.inner.len() - virtual_face_count(self.mesh));
        self.inner.retain(|corners| corners.iter().all(|&v| !is_gone[v as usize]));
        for removed in removed {
            self.inner.extend(removed.fan().map(|corners| corners.map(|k| removed.polygon[k])));
        }
        self.inner.extend(virtual_faces);
        self.boundary.retain(|&v| !is_gone[v as usize]);
        left.retain(|&v| !is_gone[v as usize]);
        self.look_around();
    }
}

/// Polygon that a vertex leaves, starting with the neighbour that it is moved onto.
fn polygon(ring: &Ring, onto: usize) -> Vec<u32> {
    let mut polygon = if ring.is_of_boundary() { ring.vertices[..=ring.inner].to_vec() } else { ring.vertices.clone() };
    if ring.is_of_boundary() {
        polygon.push(OUTSIDE);
    }
    polygon.rotate_left(onto);
    polygon
}
