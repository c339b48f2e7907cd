//! Weights between the mean-value weights of two embeddings, and their linear systems.

use glam::DVec2;
use num_complex::Complex;

use super::toward;
use crate::geom::{Orientation, orientation};
use crate::linalg::{Analysis, Kind};
use crate::linear::fixed_solve::FixedSolve;
use crate::linear::system::{FreeSystem, Site};
use crate::mesh::{DiskMesh, VertexId};
use crate::nonlinear::scaffold::disk_in_plane;
use crate::problem::{Control, Embedding, Phase, SolveError};
use crate::weights::equations::Equations;
use crate::weights::plane_weights::mean_value_in_plane;

/// Mean-value equations of an embedding, each divided by the sum of its weights.
pub(super) fn normalized(disk: &DiskMesh, embedding: &Embedding) -> Equations<f64> {
    let mut equations = mean_value_in_plane(disk, embedding, Control::unattended())
        .expect("nobody stops it, and a planar embedding is finite");
    let mut sums = vec![0.0; disk.vertex_count()];
    for (link, weight) in disk.links().zip(&equations.coefficients) {
        sums[disk.tail(link).index()] += weight;
    }
    for (link, weight) in disk.links().zip(&mut equations.coefficients) {
        *weight /= sums[disk.tail(link).index()];
    }
    equations
}

/// Equations between two sets, linear in `share` from 0 to 1.
pub(super) fn between([from, to]: [&Equations<f64>; 2], share: f64) -> Equations<f64> {
    let mix = |(a, b): (&f64, &f64)| (1.0 - share) * a + share * b;
    let coefficients = from.coefficients.iter().zip(&to.coefficients).map(mix).collect();
    Equations { coefficients, bounded_corners: from.bounded_corners.max(to.bounded_corners) }
}

/// Free and held points, with the analysis of the system of the free ones.
pub(super) struct Held {
    system: FreeSystem,
    analysis: Analysis,
}

impl Held {
    pub(super) fn new(
        disk: &DiskMesh,
        is_held: impl Fn(VertexId) -> bool,
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        control.enter(Phase::Analyze)?;
        let system = FreeSystem::new(disk, is_held, control)?;
        let analysis = system.analysis(Kind::General, control)?;
        Ok(Self { system, analysis })
    }

    /// Solves for the free points, starting from `start`. The unknown is the move, so that rounding is relative to the
    /// move and not to the coordinates.
    pub(super) fn solve(
        &self,
        disk: &DiskMesh,
        equations: Equations<f64>,
        start: &Embedding,
        control: Control<'_>,
    ) -> Result<Embedding, SolveError> {
        if self.system.free().is_empty() {
            return Ok(start.clone());
        }
        let site = Site { mesh: disk, system: &self.system };
        let residual = |&v: &VertexId| {
            let Complex { re, im } = equations.residual_of(disk, start, v);
            DVec2::new(re, im)
        };
        let residuals: Vec<DVec2> = self.system.free().iter().map(residual).collect();
        control.enter(Phase::Factor)?;
        let solve = FixedSolve::new(site, equations, &self.analysis, control)?;
        control.enter(Phase::Solve)?;
        Ok(solve.solve_from(site, start, &residuals, control)?.0)
    }
}

/// Weights between those of two embeddings of one disk, whose boundary moves straight.
pub(super) struct Blend {
    disk: DiskMesh,
    equations: [Equations<f64>; 2],
    ends: [Embedding; 2],
    held: Held,
}

impl Blend {
    /// Blend of two embeddings of a disk whose boundary is convex in both.
    pub(super) fn new(disk: DiskMesh, ends: [Embedding; 2], control: Control<'_>) -> Result<Self, SolveError> {
        let equations = [0, 1].map(|k| normalized(&disk, &ends[k]));
        let held = Held::new(&disk, |v| disk.boundary_place(v).is_some(), control)?;
        Ok(Self { disk, equations, ends, held })
    }

    /// Blend of the mesh alone. `None` unless its boundary is convex at both ends.
    pub(super) fn within_boundary(
        mesh: &DiskMesh,
        ends: [&Embedding; 2],
        control: Control<'_>,
    ) -> Option<Result<Self, SolveError>> {
        if !ends.iter().all(|end| is_convex(&end.boundary(mesh))) {
            return None;
        }
        let disk = disk_in_plane(ends[0], mesh.mesh().triangles.clone())?;
        Some(Self::new(disk, ends.map(Embedding::clone), control))
    }

    /// All points at the start: those of the mesh, then those of the frame.
    pub(super) fn points_at_start(&self) -> Embedding {
        self.ends[0].clone()
    }

    /// All points at time t, computed from those at a slightly earlier time. The boundary moves straight.
    pub(super) fn at(&self, t: f64, before: &Embedding, control: Control<'_>) -> Result<Embedding, SolveError> {
        let mut start = before.clone();
        for v in self.disk.boundary_loop() {
            start[*v] = toward([self.ends[0][v], self.ends[1][v]], t);
        }
        self.solve(t, &start, control)
    }

    /// All points at time t, with the boundary as in `start`.
    pub(super) fn solve(&self, t: f64, start: &Embedding, control: Control<'_>) -> Result<Embedding, SolveError> {
        let [from, to] = &self.equations;
        self.held.solve(&self.disk, between([from, to], t), start, control)
    }
}

/// True if a simple polygon nowhere turns right.
fn is_convex(polygon: &[DVec2]) -> bool {
    let count = polygon.len();
    let turn = |k: usize| orientation(polygon[k], polygon[(k + 1) % count], polygon[(k + 2) % count]);
    (0..count).all(|k| matches!(turn(k), Some(Orientation::CounterClockwise | Orientation::Collinear)))
}
