//! Prolongation: the rounds of a hierarchy in reverse, which put all vertices back one-to-one.

use std::collections::HashMap;

use crate::parallel::prelude::*;
use glam::DVec2;

use super::hierarchy::{Hierarchy, OUTSIDE, Removed, Round};
use super::level::Level;
use super::place::{Room, resistance};
use super::relaxation_sweep::Sweeps;
use crate::geom::{double_area, outside_triangles};
use crate::mesh::{DiskMesh, VertexId, laid_flat};
use crate::nonlinear::foldover_energy::Element;
use crate::nonlinear::scaffold::{FRAME_POINTS, frame_around};
use crate::problem::{Control, Embedding, Phase, Pins, SolveError};

/// Input mesh, with its embedding before the removal.
#[derive(Clone, Copy, Debug)]
pub struct FineLevel<'a> {
    /// The mesh.
    pub mesh: &'a DiskMesh,
    /// Embedding in which vertices were removed. Without one, any embedding; it only determines the first guess of a
    /// position.
    pub embedding: &'a Embedding,
    /// Vertices that stay where the coarsest disk has them.
    pub pins: &'a Pins,
}

/// Relaxation sweeps over a level before it is improved, and over the whole mesh at the end.
const SWEEPS: usize = 6;

/// Sweeps over very distorted faces that follow.
const SWEEPS_OF_DISTORTED: usize = 6;

/// Point outside each boundary edge up to which its new vertex may move. Keys are the edge's ends in boundary
/// direction.
type Reach = HashMap<[u32; 2], DVec2>;

/// Surroundings of the vertices that a round puts back.
struct Around<'a> {
    /// Positions of all other vertices.
    points: &'a [DVec2],
    reach: Reach,
    /// Length in the plane per length in space.
    scale: f64,
}

impl Hierarchy {
    /// Puts all vertices back: turns a planar embedding of the coarsest disk into a planar one of the input mesh.
    ///
    /// `improve` receives the embedding of each intermediate level and must return a planar one. `None` if rounding
    /// leaves no room for a vertex, or if the outside cannot be triangulated.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`], and the errors of `improve`.
    pub fn lifted(
        &self,
        fine: FineLevel<'_>,
        coarse: &Embedding,
        mut improve: impl FnMut(&Level, Embedding) -> Result<Embedding, SolveError>,
        control: Control<'_>,
    ) -> Result<Option<Embedding>, SolveError> {
        let mut points = fine.embedding.to_vec();
        self.coarsest().put_into(coarse, &mut points);
        let scale = scale_of(&self.coarsest().disk, coarse);
        let mut levels = self.levels.iter().rev().peekable();
        for (index, round) in self.rounds.iter().enumerate().rev() {
            control.enter(Phase::Solve)?;
            let Some(reach) = reach_of(round, &points) else { return Ok(None) };
            let around = Around { points: &points, reach, scale };
            let place = |removed: &Removed| placed(fine, removed, &around);
            let places: Option<Vec<DVec2>> = round.removed.par_iter().with_min_len(64).map(place).collect();
            let Some(places) = places else { return Ok(None) };
            for (removed, z) in round.removed.iter().zip(places) {
                points[removed.vertex as usize] = z;
            }
            if let Some((_, level)) = levels.next_if(|(after, _)| *after == index) {
                let is_held = |vertex: VertexId| fine.pins.contains_key(&level.vertices[vertex.index()]);
                let swept = swept(&level.disk, level.part_of(&points), is_held, control)?;
                level.put_into(&improve(level, swept)?, &mut points);
            }
        }
        let is_held = |vertex: VertexId| fine.pins.contains_key(&vertex);
        Ok(Some(swept(fine.mesh, points.into(), is_held, control)?))
    }
}

/// Embedding after relaxation sweeps. Vertices that are held and vertices of holes stay.
fn swept(
    disk: &DiskMesh,
    mut embedding: Embedding,
    is_held: impl Fn(VertexId) -> bool,
    control: Control<'_>,
) -> Result<Embedding, SolveError> {
    let mut sweeps = Sweeps::new(disk, is_held, scale_of(disk, &embedding));
    for _ in 0..SWEEPS {
        control.enter(Phase::Solve)?;
        sweeps.sweep(&mut embedding);
    }
    for _ in 0..SWEEPS_OF_DISTORTED {
        control.enter(Phase::Solve)?;
        if !sweeps.sweep_distorted(&mut embedding) {
            break;
        }
    }
    Ok(embedding)
}

/// Length in the plane per length in space.
fn scale_of(disk: &DiskMesh, embedding: &Embedding) -> f64 {
    let areas = disk.real_faces().map(|face| {
        let [x, z] = [laid_flat(disk.shape(disk.face(face))), embedding.corners(disk, face)];
        [x, z].map(double_area)
    });
    let [space, plane] = areas.fold([0.0; 2], |sum, area| [sum[0] + area[0], sum[1] + area[1]]);
    (plane / space).sqrt()
}

/// Limits of new boundary vertices: each edge of the coarser boundary has a part of the outside to itself.
fn reach_of(round: &Round, points: &[DVec2]) -> Option<Reach> {
    if round.boundary.is_empty() {
        return Some(Reach::new());
    }
    let polygon: Vec<DVec2> = round.boundary.iter().map(|&v| points[v as usize]).collect();
    let frame = frame_around(polygon.iter().copied(), FRAME_POINTS);
    let at =
        |corner: u32| polygon.get(corner as usize).copied().unwrap_or_else(|| frame[corner as usize - polygon.len()]);
    let mut reach = Reach::new();
    for corners in outside_triangles(&polygon, &frame)? {
        let middle = corners.map(at).iter().sum::<DVec2>() / 3.0;
        for k in 0..3 {
            // The outside traverses the boundary in the opposite direction.
            let ends = [corners[(k + 1) % 3], corners[k]].map(|corner| round.boundary.get(corner as usize));
            if let [Some(&from), Some(&to)] = ends {
                reach.insert([from, to], middle);
            }
        }
    }
    Some(reach)
}

/// Position of a removed vertex in its polygon.
fn placed(FineLevel { mesh, embedding, .. }: FineLevel<'_>, removed: &Removed, around: &Around<'_>) -> Option<DVec2> {
    let Around { points, reach, scale } = around;
    let corners = &removed.polygon;
    let outside = |k: usize| {
        let count = corners.len();
        reach.get(&[corners[(k + count - 1) % count], corners[(k + 1) % count]]).copied()
    };
    let corner = |(k, &v): (usize, &u32)| if v == OUTSIDE { outside(k) } else { Some(points[v as usize]) };
    let polygon: Vec<DVec2> = corners.iter().enumerate().map(corner).collect::<Option<_>>()?;
    let element = |k: usize| {
        let [a, b] = removed.side(k);
        resistance(mesh.shape([removed.vertex, a, b].map(VertexId::new)), [k, (k + 1) % corners.len()], *scale)
    };
    let elements: Vec<Element> = removed.sides().map(element).collect();
    let before = |k: usize| embedding[corners[k] as usize];
    let guess = guess(removed, embedding[removed.vertex as usize], before, &polygon);
    Room { polygon: &polygon, elements: &elements }.place(guess)
}

/// Point with equal barycentric coordinates in the triangle of the fan that held the vertex, or came nearest to
/// holding it.
fn guess(removed: &Removed, z: DVec2, before: impl Fn(usize) -> DVec2, polygon: &[DVec2]) -> Option<DVec2> {
    let coordinates = |corners: [usize; 3]| {
        let [a, b, c] = corners.map(&before);
        let area = (b - a).perp_dot(c - a);
        let shares = [(b - z).perp_dot(c - z), (c - z).perp_dot(a - z), (a - z).perp_dot(b - z)];
        (corners, shares.map(|share| share / area))
    };
    let least = |shares: [f64; 3]| shares.into_iter().fold(f64::INFINITY, f64::min);
    let (corners, shares) = removed.fan().map(coordinates).max_by(|a, b| least(a.1).total_cmp(&least(b.1)))?;
    Some(corners.iter().zip(shares).map(|(&k, share)| share * polygon[k]).sum())
}
