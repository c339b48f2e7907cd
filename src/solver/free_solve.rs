//! One factored system of a free boundary, and its solution for given pins.

use std::collections::BTreeMap;
use std::time::Instant;

use glam::DVec2;
use nalgebra_sparse::CscMatrix;
use num_complex::Complex;

use super::equations::Equations;
use super::pinned_rows::{Factored, PinnedRows};
use super::system::FreeSystem;
use super::{Control, Phase, PhaseSeconds, Pins, SolveError, Treatment};
use crate::linalg::{Analysis, Factor, FactorStats, LinalgError};
use crate::mesh::{DiskMesh, VertexId};

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
                let factored = Factored { matrix: &matrix, factor: &factor };
                Some(PinnedRows::new(site.mesh, site.system, &equations, site.pinned, &factored).map_err(named)?)
            }
        };
        seconds.factor += start.elapsed().as_secs_f64();
        Ok(Self { equations, matrix, factor, pinned_rows })
    }

    /// The embedding with the pins on their targets, and the relative residual of the linear solve.
    pub(super) fn solve(&self, site: Site<'_>, pins: &Pins) -> Result<(Vec<DVec2>, f64), SolveError> {
        let named = |error| in_vertices(error, site.system.free());
        let targets: BTreeMap<VertexId, Complex<f64>> =
            pins.iter().map(|(&v, t)| (v, Complex::new(t.x, t.y))).collect();
        let mut terms = site.system.pinned_terms(site.mesh, &self.equations, &targets);
        let mut solved = self.factor.solve(&self.matrix, &terms).map_err(named)?;
        if let Some(rows) = &self.pinned_rows {
            let embedding = embedding_of(site, &solved.x, pins);
            let discrepancy: Vec<_> =
                site.pinned.iter().map(|&v| self.equations.discrepancy(site.mesh, &embedding, v)).collect();
            let factored = Factored { matrix: &self.matrix, factor: &self.factor };
            let correction = rows.correction(&factored, &discrepancy).map_err(named)?;
            for (term, y) in terms.iter_mut().zip(correction) {
                *term += y;
            }
            solved = self.factor.solve(&self.matrix, &terms).map_err(named)?;
        }
        Ok((embedding_of(site, &solved.x, pins), solved.residual))
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

/// Free and pinned positions together; the pinned ones to the last bit.
fn embedding_of(site: Site<'_>, unknowns: &[Complex<f64>], pins: &Pins) -> Vec<DVec2> {
    let mut embedding = vec![DVec2::ZERO; site.mesh.vertex_count()];
    for (vertex, z) in site.system.free().iter().zip(unknowns) {
        embedding[vertex.index()] = DVec2::new(z.re, z.im);
    }
    for (vertex, target) in pins {
        embedding[vertex.index()] = *target;
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
