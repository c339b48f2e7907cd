//! Factored system of a fixed boundary: a real matrix, shared by x and y.

use glam::DVec2;
use nalgebra_sparse::CscMatrix;

use super::system::Site;
use crate::linalg::{Analysis, Factor, SolveFunction};
use crate::mesh::VertexId;
use crate::problem::{Control, Embedding, LinearSolve, PinPositions, SolveError};
use crate::weights::equations::Equations;

/// Equations, matrix and factors.
#[derive(Debug)]
pub(crate) struct FixedSolve {
    equations: Equations<f64>,
    matrix: CscMatrix<f64>,
    factor: Factor<f64>,
}

impl FixedSolve {
    pub(crate) fn new(
        site: Site<'_>,
        equations: Equations<f64>,
        analysis: &Analysis,
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        let matrix = site.system.negated_matrix(site.mesh, &equations, control)?;
        let factor = analysis.factor(&matrix, control.cancel()).map_err(|error| site.system.named(error))?;
        Ok(Self { equations, matrix, factor })
    }

    /// Solves for the embedding with the fixed vertices at the given positions. Returns the embedding and its
    /// residual.
    ///
    /// # Errors
    ///
    /// [`SolveError::ResidualTooLarge`] if refinement cannot reduce the residual; [`SolveError::Cancelled`].
    pub(crate) fn solve(
        &self,
        site: Site<'_>,
        places: &PinPositions,
        control: Control<'_>,
    ) -> Result<(Embedding, f64), SolveError> {
        let terms = site.system.pinned_terms(site.mesh, &self.equations, |v| places[&v]);
        let (free, residual) = self.answer(site, &terms, Factor::solve, control)?;
        let mut embedding = Embedding::from(vec![DVec2::ZERO; site.mesh.vertex_count()]);
        // Assigned, not added: adding to zero would turn a negative zero into a positive zero.
        for (vertex, place) in free.into_iter().chain(places.iter().map(|(&v, &place)| (v, place))) {
            embedding[vertex] = place;
        }
        Ok((embedding, residual))
    }

    /// Solves like [`solve`](Self::solve), but for the move from an embedding whose free vertices have the given
    /// residuals.
    pub(crate) fn solve_from(
        &self,
        site: Site<'_>,
        start: &Embedding,
        residuals: &[DVec2],
        control: Control<'_>,
    ) -> Result<(Embedding, f64), SolveError> {
        let mut embedding = start.clone();
        for (vertex, by) in self.answer(site, residuals, Factor::solve_correction, control)?.0 {
            embedding[vertex] += by;
        }
        let residual = site.system.relative_residual(site.mesh, &self.equations, &embedding, control)?;
        Ok((embedding, residual))
    }

    /// Solves for the free vertices from a term for each; returns their values and the residual.
    fn answer(
        &self,
        site: Site<'_>,
        terms: &[DVec2],
        by: SolveFunction<f64>,
        control: Control<'_>,
    ) -> Result<(Vec<(VertexId, DVec2)>, f64), SolveError> {
        let both: Vec<f64> = terms.iter().map(|z| z.x).chain(terms.iter().map(|z| z.y)).collect();
        let solved = by(&self.factor, &self.matrix, &both, control.cancel());
        let solved = solved.map_err(|error| site.system.named(error))?;
        let (x, y) = solved.x.split_at(terms.len());
        let free = site.system.free().iter().zip(x.iter().zip(y)).map(|(&v, (&x, &y))| (v, DVec2::new(x, y)));
        Ok((free.collect(), solved.residual))
    }

    /// Equations, without the factors.
    pub(crate) fn into_equations(self) -> Equations<f64> {
        self.equations
    }

    /// Statistics of a solve. Fixed vertices have no equation.
    pub(crate) fn numbers(
        &self,
        site: Site<'_>,
        embedding: &Embedding,
        residual: f64,
        control: Control<'_>,
    ) -> Result<LinearSolve, SolveError> {
        let has_equation = |v| site.system.row(v).is_some();
        let equation_residual = self.equations.to_complex().residual(site.mesh, embedding, has_equation, control)?;
        let bounded_corners = self.equations.bounded_corners;
        Ok(LinearSolve { residual, equation_residual, bounded_corners, ..self.factor.stats().into() })
    }
}
