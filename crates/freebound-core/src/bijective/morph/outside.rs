//! Outside of two embeddings with a common triangulation: each triangle is positive around both.
//!
//! The frame is a regular polygon around both. Four triangulations are tried: those of the mean of both ends and of
//! each end, and one without pockets, in which each triangle has a corner on the frame.
//!
//! # Without pockets
//!
//! A triangulation without pockets goes around boundary and frame once, by one side of either at a time:
//!
//! ```text
//! (i, j) → (i + 1, j)    triangle of the boundary's side i and the frame's corner j
//! (i, j) → (i, j + 1)    triangle of the frame's side j and the boundary's vertex i
//! ```
//!
//! from (0, j₀) to (n, j₀ + m) through triangles that are positive at both ends. A row-by-row search decides if it
//! exists.

use glam::DVec2;

use super::blend::Blend;
use crate::geom::{Bounds, Orientation, orientation};
use crate::mesh::{DiskMesh, VertexId};
use crate::nonlinear::scaffold::{disk_in_plane, triangles_around};
use crate::problem::{Control, Embedding, SolveError};

/// Corners of the frame.
const FRAME_CORNERS: u32 = 16;

/// Radius of the frame, relative to half the diagonal of the box around both ends.
const FRAME_RADIUS: f64 = 1.3;

/// Blend of mesh and outside of both ends. `None` if no outside fits both.
pub(super) fn common_outside(
    mesh: &DiskMesh,
    ends: [&Embedding; 2],
    control: Control<'_>,
) -> Option<Result<Blend, SolveError>> {
    let boundaries = ends.map(|end| end.boundary(mesh));
    let frame = frame_around(boundaries.iter().flatten().copied());
    let points = ends.map(|end| end.iter().chain(&frame).copied().collect::<Embedding>());
    let suits = |triangles: &Vec<[VertexId; 3]>| {
        triangles.iter().all(|t| points.iter().all(|points| is_positive(t.map(|v| points[v]))))
    };
    let mean: Vec<DVec2> = boundaries[0].iter().zip(&boundaries[1]).map(|(a, b)| a.midpoint(*b)).collect();
    let by_shape = [&mean, &boundaries[0], &boundaries[1]];
    let around = by_shape.into_iter().find_map(|shape| triangles_around(mesh, shape, &frame).filter(suits));
    let triangles = around.or_else(|| without_pockets(mesh, &points, frame.len()).filter(suits))?;
    let all = mesh.mesh().triangles.iter().chain(&triangles).copied().collect();
    let disk = disk_in_plane(&points[0], all)?;
    Some(Blend::new(disk, points, control))
}

fn is_positive([a, b, c]: [DVec2; 3]) -> bool {
    orientation(a, b, c) == Some(Orientation::CounterClockwise)
}

/// Strictly convex polygon around points, counter-clockwise.
fn frame_around(points: impl Iterator<Item = DVec2>) -> Vec<DVec2> {
    let bounds = Bounds::of(points);
    let radius = FRAME_RADIUS * 0.5 * bounds.size().length();
    let corner = |k: u32| DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / f64::from(FRAME_CORNERS));
    (0..FRAME_CORNERS).map(|k| bounds.middle() + radius * corner(k)).collect()
}

/// Triangulation without pockets, starting at the first possible corner of the frame.
fn without_pockets(mesh: &DiskMesh, points: &[Embedding; 2], frame: usize) -> Option<Vec<[VertexId; 3]>> {
    let strip = Strip { mesh, points, frame };
    (0..frame).find_map(|first| strip.from(first))
}

/// Loop whose side a triangle covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Boundary,
    Frame,
}

/// Boundary and frame, with a single strip of triangles between them.
struct Strip<'a> {
    mesh: &'a DiskMesh,
    points: &'a [Embedding; 2],
    /// Number of corners of the frame.
    frame: usize,
}

impl Strip<'_> {
    fn inner(&self, place: usize) -> VertexId {
        let boundary = self.mesh.boundary_loop();
        boundary[place % boundary.len()]
    }

    fn outer(&self, place: usize) -> VertexId {
        VertexId::from_index(self.mesh.vertex_count() + place % self.frame)
    }

    /// Triangle that starts at a place of each loop and covers a side of one.
    fn triangle(&self, [inner, outer]: [usize; 2], side: Side) -> [VertexId; 3] {
        match side {
            Side::Boundary => [self.inner(inner + 1), self.inner(inner), self.outer(outer)],
            Side::Frame => [self.outer(outer), self.outer(outer + 1), self.inner(inner)],
        }
    }

    fn suits(&self, triangle: [VertexId; 3]) -> bool {
        self.points.iter().all(|points| is_positive(triangle.map(|v| points[v])))
    }

    /// Strip of triangles that starts between the boundary's first vertex and a corner of the frame, if there is one.
    fn from(&self, first: usize) -> Option<Vec<[VertexId; 3]>> {
        let (rows, columns) = (self.mesh.boundary_loop().len() + 1, self.frame + 1);
        // Last step to each pair of places, if it can be reached.
        let mut come_by: Vec<Option<Side>> = vec![None; rows * columns];
        for at in 0..rows * columns {
            let (i, j) = (at / columns, at % columns);
            if at > 0 && come_by[at].is_none() {
                continue;
            }
            let ways = [(i + 1 < rows, Side::Boundary, columns), (j + 1 < columns, Side::Frame, 1)];
            for (is_within, side, ahead) in ways {
                if is_within && come_by[at + ahead].is_none() && self.suits(self.triangle([i, first + j], side)) {
                    come_by[at + ahead] = Some(side);
                }
            }
        }
        let mut triangles = Vec::with_capacity(rows + columns);
        let mut at = rows * columns - 1;
        while at > 0 {
            let side = come_by[at]?;
            at -= if side == Side::Boundary { columns } else { 1 };
            triangles.push(self.triangle([at / columns, first + at % columns], side));
        }
        Some(triangles)
    }
}
