//! One factored system of a free boundary, and its solution for given pins.

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use glam::DVec2;
use nalgebra_sparse::CscMatrix;
use num_complex::Complex;
use rayon::prelude::*;

use super::equations::Equations;
use super::gauge_rows::GaugeRows;
use super::pinned_rows::{Factored, PinnedRows};
use super::system::FreeSystem;
use super::{Control, Phase, PhaseSeconds, Pins, SolveError, Treatment};
use crate::linalg::{Analysis, Factor, FactorStats, LinalgError, Solved};
use crate::mesh::{DiskMesh, VertexId};

/// One further solve is not worth an interruption.
static NEVER: AtomicBool = AtomicBool::new(false);

/// Equations, matrix and factors; for least squares also what the pinned vertices' equations add.
pub(super) struct FreeSolve {
    equations: Equations<Complex<f64>>,
    matrix: CscMatrix<Complex<f64>>,
    factor: Factor<Complex<f64>>,
    pinned_rows: Option<PinnedRows>,
}

/// Where a system stands: its mesh, its unknowns, and the vertices that are not among them.
#[derive(Clone, Copy)]
pub(super) struct Site<'a> {
    pub(super) mesh: &'a DiskMesh,
    pub(super) system: &'a FreeSystem,
    pub(super) pinned: &'a [VertexId],
}

impl FreeSolve {
    /// Factors the matrix of `equations`; adds the time that took to `seconds`.
    pub(super) fn new(
        site: Site<'_>,
        equations: Equations<Complex<f64>>,
        (analysis, treatment): (&Analysis, Treatment),
        seconds: &mut PhaseSeconds,
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        let named = |error| in_vertices(error, site.system.free());
        let start = Instant::now();
        let matrix = site.system.negated_matrix(site.mesh, &equations);
        seconds.assemble += start.elapsed().as_secs_f64();
        control.enter(Phase::Factor)?;
        let start = Instant::now();
        let factor = analysis.factor(&matrix, control.cancel()).map_err(named)?;
        let pinned_rows = match treatment {
            Treatment::Eliminate => None,
            Treatment::LeastSquares => {
                let factored = Factored { matrix: &matrix, factor: &factor, cancel: control.cancel() };
                Some(PinnedRows::new(site.mesh, site.system, &equations, site.pinned, &factored).map_err(named)?)
            }
        };
        seconds.factor += start.elapsed().as_secs_f64();
        Ok(Self { equations, matrix, factor, pinned_rows })
    }

    /// The embedding with the pins on their targets, and the relative residual of the linear solve.
    pub(super) fn solve(&self, site: Site<'_>, pins: &Pins) -> Result<(Vec<DVec2>, f64), SolveError> {
        let mut start = vec![DVec2::ZERO; site.mesh.vertex_count()];
        for (vertex, target) in pins {
            start[vertex.index()] = *target;
        }
        let left = self.left_over(site.mesh, &start);
        self.move_from(site, (&start, &left), pins, |rhs| self.factor.solve(&self.matrix, rhs))
    }

    /// The same, found as a move from an embedding that has the pins on their targets already; `left` is what it leaves
    /// of every vertex's equation. Where it nearly solves the equations the move is small, and so is its rounding.
    pub(super) fn solve_from(
        &self,
        site: Site<'_>,
        (from, left): (&[DVec2], &[Complex<f64>]),
        pins: &Pins,
    ) -> Result<(Vec<DVec2>, f64), SolveError> {
        self.move_from(site, (from, left), pins, |rhs| self.factor.solve_correction(&self.matrix, rhs))
    }

    /// The embedding that leaves least of all equations with the pins where they are, found as a move from `from`, which
    /// leaves `left`. The system is that of all vertices but the gauge. The residual is that of the conditions for a
    /// minimum: what is left must be orthogonal to every move.
    pub(super) fn least_squares_from(
        &self,
        site: Site<'_>,
        (gauge, pinned): ([VertexId; 2], &[VertexId]),
        (from, left): (&[DVec2], &[Complex<f64>]),
        control: Control<'_>,
    ) -> Result<(Vec<DVec2>, f64), SolveError> {
        let factored = Factored { matrix: &self.matrix, factor: &self.factor, cancel: control.cancel() };
        let Site { mesh, system, .. } = site;
        let rows = GaugeRows { mesh, system, gauge, pinned, equations: &self.equations, factored };
        let moves = rows.moves(left).map_err(|error| in_vertices(error, system.free()))?;
        let embedding: Vec<DVec2> = from.iter().zip(moves).map(|(z, by)| *z + DVec2::new(by.re, by.im)).collect();
        let residual = self.gradient_residual(mesh, &embedding, pinned);
        Ok((embedding, residual))
    }

    /// ‖Aᴴ A z‖ over the vertices that are free, relative to ‖|A|ᵀ |A z|‖.
    fn gradient_residual(&self, mesh: &DiskMesh, embedding: &[DVec2], pinned: &[VertexId]) -> f64 {
        let left = self.left_over(mesh, embedding);
        let mut sums = vec![(Complex::<f64>::ZERO, 0.0_f64); mesh.vertex_count()];
        for (h, &coefficient) in mesh.halfedges().zip(&self.equations.coefficients) {
            let term = coefficient.conj() * left[mesh.tail(h).index()];
            for (vertex, sign) in [(mesh.head(h), 1.0), (mesh.tail(h), -1.0)] {
                let (sum, size) = &mut sums[vertex.index()];
                *sum += term * sign;
                *size += term.norm();
            }
        }
        for v in pinned {
            sums[v.index()] = (Complex::ZERO, 0.0);
        }
        let (left, whole) =
            sums.iter().fold((0.0, 0.0), |(left, whole), (sum, size)| (left + sum.norm_sqr(), whole + size * size));
        if left > 0.0 { f64::sqrt(left / whole) } else { 0.0 }
    }

    /// Solves for the move from `start` that takes up what is left there.
    fn move_from(
        &self,
        site: Site<'_>,
        (start, left): (&[DVec2], &[Complex<f64>]),
        pins: &Pins,
        solve: impl Fn(&[Complex<f64>]) -> Result<Solved<Complex<f64>>, LinalgError>,
    ) -> Result<(Vec<DVec2>, f64), SolveError> {
        let named = |error| in_vertices(error, site.system.free());
        let mut terms: Vec<_> = site.system.free().iter().map(|v| left[v.index()]).collect();
        let mut moves = solve(&terms).map_err(named)?.x;
        let mut correction = vec![Complex::ZERO; terms.len()];
        if let Some(rows) = &self.pinned_rows {
            let factored = Factored { matrix: &self.matrix, factor: &self.factor, cancel: &NEVER };
            let discrepancy = rows.discrepancy(site.pinned.iter().map(|v| left[v.index()]), &moves);
            correction = rows.correction(&factored, &discrepancy).map_err(named)?;
            for (term, y) in terms.iter_mut().zip(&correction) {
                *term += y;
            }
            moves = solve(&terms).map_err(named)?.x;
        }
        let embedding = moved(site, start, &moves);
        let residual = self.relative_residual(site, &embedding, pins, &correction);
        Ok((embedding, residual))
    }

    /// What all equations leave.
    fn left_over(&self, mesh: &DiskMesh, embedding: &[DVec2]) -> Vec<Complex<f64>> {
        let at = |v: usize| self.equations.discrepancy(mesh, embedding, VertexId::from_index(v));
        (0..mesh.vertex_count()).into_par_iter().map(at).collect()
    }

    /// ‖Ax − b‖ / ‖b‖ of the free vertices' equations, b being what the pins and the correction give.
    fn relative_residual(&self, site: Site<'_>, embedding: &[DVec2], pins: &Pins, correction: &[Complex<f64>]) -> f64 {
        let targets: BTreeMap<VertexId, Complex<f64>> =
            pins.iter().map(|(&v, t)| (v, Complex::new(t.x, t.y))).collect();
        let rhs = site.system.pinned_terms(site.mesh, &self.equations, &targets);
        let whole: f64 = rhs.iter().zip(correction).map(|(b, y)| (b + y).norm_sqr()).sum();
        let left = self.left_over(site.mesh, embedding);
        let free = site.system.free().iter().map(|v| left[v.index()]);
        let left: f64 = free.zip(correction).map(|(r, y)| (r + y).norm_sqr()).sum();
        if left > 0.0 { f64::sqrt(left / whole) } else { 0.0 }
    }

    /// ‖A z‖ of all equations, relative to their terms.
    pub(super) fn equation_residual(&self, mesh: &DiskMesh, embedding: &[DVec2]) -> f64 {
        self.equations.residual(mesh, embedding, |_| true)
    }

    pub(super) fn stats(&self) -> FactorStats {
        self.factor.stats()
    }

    pub(super) fn bounded_corners(&self) -> usize {
        self.equations.bounded_corners
    }
}

/// An embedding with its free vertices moved; the pinned ones stay to the last bit.
fn moved(site: Site<'_>, start: &[DVec2], moves: &[Complex<f64>]) -> Vec<DVec2> {
    let mut embedding = start.to_vec();
    for (vertex, z) in site.system.free().iter().zip(moves) {
        embedding[vertex.index()] += DVec2::new(z.re, z.im);
    }
    embedding
}

/// Says a linear solver's error in terms of the mesh: its rows are the free vertices.
pub(super) fn in_vertices(error: LinalgError, free: &[VertexId]) -> SolveError {
    match error {
        LinalgError::Cancelled => SolveError::Cancelled,
        LinalgError::ResidualTooLarge { residual, limit } => SolveError::ResidualTooLarge { residual, limit },
        LinalgError::Singular { row } | LinalgError::NotPositiveDefinite { row } | LinalgError::NotFinite { row } => {
            SolveError::Singular { vertex: free[row] }
        }
        other => SolveError::Linear { reason: other.to_string() },
    }
}
