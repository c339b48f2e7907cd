//! Factored system of a free boundary, and its solution for given pins.

use std::time::Instant;

use crate::parallel::prelude::*;
use glam::DVec2;
use nalgebra_sparse::CscMatrix;
use num_complex::Complex;

use super::free_layout::{LaidOut, Numbers};
use super::least_squares::{Factored, LeastSquares, Spring, may_be_kept};
use super::left_kernel::better_gauge;
use super::many_pins::ManyPins;
use super::system::Site;
use crate::geom::Bounds;
use crate::linalg::{Factor, Kind, SolveFunction};
use crate::mesh::{DiskMesh, HalfedgeId, VertexId};
use crate::problem::pins::GAUGE_PINS;
use crate::problem::{Control, Embedding, LinearSolve, Phase, PhaseSeconds, PinPositions, SolveError};
use crate::weights::equations::{Equations, modulus};

/// Largest accepted error of the conditions for a minimum of a least-squares solution, relative to their terms.
const GRADIENT_LIMIT: f64 = 1e-10;

/// Share of the extent above which a remaining move triggers another solve.
const MOST_REST: f64 = 1e-11;

/// Ratio of the squared number of boundary vertices to the number of faces above which a mesh counts as a corridor.
const CORRIDOR: usize = 64;

/// Equations, matrix and factors; for least squares also the terms of the pins.
#[derive(Debug)]
pub(crate) struct FreeSolve {
    equations: Equations<Complex<f64>>,
    matrix: CscMatrix<Complex<f64>>,
    factor: Factor<Complex<f64>>,
    least_squares: Option<Ways>,
    /// Pins whose equations are not kept.
    eliminated: Vec<VertexId>,
    is_hermitian: bool,
}

/// Dense system for few pins, or sparse system for many.
#[derive(Debug)]
enum Ways {
    Few(LeastSquares),
    Many(ManyPins),
}

impl Ways {
    fn springs(&self) -> &[Spring] {
        match self {
            Self::Few(few) => &few.rest.springs,
            Self::Many(many) => &many.springs,
        }
    }
}

/// Embedding from which a solve moves.
#[derive(Clone, Copy)]
pub(crate) struct SolveStart<'a> {
    pub(crate) embedding: &'a Embedding,
    /// Residual of the equation of every vertex at the embedding.
    pub(crate) residuals: &'a [Complex<f64>],
}

/// System, targets and cancellation of a solve.
struct Asked<'a> {
    site: Site<'a>,
    targets: &'a PinPositions,
    control: Control<'a>,
}

/// Reason for which there is no factored system.
pub(crate) enum Unsolved {
    /// Two more equations must be left out: the equations of these vertices, if known.
    WithoutGauge(Option<[VertexId; 2]>),
    Error(SolveError),
}

impl From<SolveError> for Unsolved {
    fn from(error: SolveError) -> Self {
        Self::Error(error)
    }
}

impl From<Unsolved> for SolveError {
    fn from(unsolved: Unsolved) -> Self {
        match unsolved {
            Unsolved::WithoutGauge(_) => Self::Linear { reason: "its equations depend on each other".to_owned() },
            Unsolved::Error(error) => error,
        }
    }
}

impl FreeSolve {
    /// Factors the matrix of the equations and adds the elapsed time to `seconds`.
    pub(crate) fn new(
        mesh: &DiskMesh,
        laid_out: &LaidOut,
        numbers: Numbers,
        seconds: &mut PhaseSeconds,
        control: Control<'_>,
    ) -> Result<Self, Unsolved> {
        let LaidOut { layout, system, kind, analysis, .. } = laid_out;
        let Numbers { equations, matrix, unit } = numbers;
        let site = Site { mesh, system };
        let start = Instant::now();
        let mut rest = layout.rest(unit);
        let many = rest.take_if(|_| layout.has_many).map(|rest| ManyPins::new(site, rest));
        let matrix = match (&many, matrix) {
            (Some(many), _) => many.matrix(site, &equations),
            (None, Some(matrix)) => matrix,
            (None, None) => site.system.negated_matrix(site.mesh, &equations, control)?,
        };
        control.go_on()?;
        seconds.assemble += start.elapsed().as_secs_f64();
        control.enter(Phase::Factor)?;
        let start = Instant::now();
        let named = |error| match &many {
            Some(many) => many.named(site, error),
            None => site.system.named(error),
        };
        let unsolved = |error| match named(error) {
            // The factored equations may depend on each other.
            SolveError::Singular { .. } | SolveError::ResidualTooLarge { .. } if laid_out.may_want_gauge() => {
                Unsolved::WithoutGauge(None)
            }
            error => Unsolved::Error(error),
        };
        let factor = analysis.factor(&matrix, control.cancel()).map_err(unsolved)?;
        if let Some(rest) = rest.as_ref().filter(|_| laid_out.may_want_gauge()) {
            let is_known = may_be_kept(system.free().len(), rest.left_out.len());
            let look = || better_gauge(site, &equations, &factor, &rest.left_out, control);
            let gauge = is_known.then(look).transpose()?;
            if gauge != Some(None) {
                seconds.factor += start.elapsed().as_secs_f64();
                return Err(Unsolved::WithoutGauge(gauge.flatten()));
            }
        }
        let factored = Factored { matrix: &matrix, factor: &factor, cancel: control.cancel() };
        let few =
            rest.map(|rest| LeastSquares::new(site, &equations, rest, &factored).map_err(unsolved)).transpose()?;
        let least_squares = few.map(Ways::Few).or(many.map(Ways::Many));
        seconds.factor += start.elapsed().as_secs_f64();
        let eliminated = if layout.keeps_equations { Vec::new() } else { layout.left_out.clone() };
        let is_hermitian = *kind == Kind::Hermitian;
        Ok(Self { equations, matrix, factor, least_squares, eliminated, is_hermitian })
    }

    /// Two vertices whose equations are better left out than those of the two eliminated pins. `None` if the pins
    /// are good enough or if all equations are kept.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] if cancelled.
    pub(crate) fn better_gauge(
        &self,
        site: Site<'_>,
        control: Control<'_>,
    ) -> Result<Option<[VertexId; 2]>, SolveError> {
        if self.eliminated.len() != GAUGE_PINS || self.least_squares.is_some() {
            return Ok(None);
        }
        better_gauge(site, &self.equations, &self.factor, &self.eliminated, control)
    }

    /// Equations of all vertices.
    pub(crate) const fn equations(&self) -> &Equations<Complex<f64>> {
        &self.equations
    }

    /// Pins whose equations are dropped.
    pub(crate) fn eliminated(&self) -> &[VertexId] {
        &self.eliminated
    }

    /// True if the matrix is Hermitian and the equations of two pins are dropped.
    pub(crate) fn has_spectral_gauge(&self) -> bool {
        self.is_hermitian && self.least_squares.is_none() && self.eliminated.len() == GAUGE_PINS
    }

    /// Moves of the other vertices that cancel `terms`, by substitution alone.
    pub(crate) fn substitute(
        &self,
        terms: &[Complex<f64>],
        control: Control<'_>,
    ) -> Result<Vec<Complex<f64>>, SolveError> {
        control.go_on()?;
        Ok(self.factor.substitute(terms, control.cancel())?)
    }

    fn factored<'a>(&'a self, control: Control<'a>) -> Factored<'a> {
        Factored { matrix: &self.matrix, factor: &self.factor, cancel: control.cancel() }
    }

    /// Embedding with hard pins on their targets and soft pins as near as their weights bring them, and its relative
    /// residual. The embedding is linear in the targets.
    ///
    /// # Errors
    ///
    /// [`SolveError::ResidualTooLarge`] if refinement cannot reduce the residual; [`SolveError::Cancelled`].
    pub(crate) fn solve(
        &self,
        site: Site<'_>,
        targets: &PinPositions,
        control: Control<'_>,
    ) -> Result<(Embedding, f64), SolveError> {
        let mut start = Embedding::from(vec![DVec2::ZERO; site.mesh.vertex_count()]);
        for (&vertex, target) in targets {
            start[vertex] = *target;
        }
        let start = SolveStart { embedding: &start, residuals: &self.residuals(site.mesh, &start, control)? };
        let asked = Asked { site, targets, control };
        let solved = self.move_from(&asked, start, Factor::solve)?;
        let (embedding, residual) = self.rest_of(&asked, &solved.0)?.unwrap_or(solved);
        if self.least_squares.is_some() && residual > GRADIENT_LIMIT {
            return Err(SolveError::ResidualTooLarge { residual, limit: GRADIENT_LIMIT });
        }
        Ok((embedding, residual))
    }

    /// Corrects a solution by the move that its residuals still require. `None` if that move is negligible.
    /// Differences of neighbours have full precision, so residuals show the error that remains after solving for
    /// positions. It is large in corridors, because the equations hardly determine long-range moves there. A
    /// Hermitian matrix determines them well enough unless the mesh is a corridor.
    fn rest_of(&self, asked: &Asked<'_>, embedding: &Embedding) -> Result<Option<(Embedding, f64)>, SolveError> {
        let &Asked { site, targets, control } = asked;
        if self.is_hermitian && !is_corridor(site.mesh) {
            return Ok(None);
        }
        let residuals = self.residuals(site.mesh, embedding, control)?;
        let extent = Bounds::of(site.mesh.vertices().filter(|&v| site.mesh.is_used(v)).map(|v| embedding[v])).size();
        let is_little = |largest: f64| largest <= MOST_REST * extent.max_element();
        if self.least_squares.is_none() {
            let terms: Vec<_> = site.system.free().iter().map(|v| residuals[v.index()]).collect();
            let moves = self.factor.substitute(&terms, control.cancel())?;
            if is_little(moves.iter().map(|z| z.norm()).fold(0.0, f64::max)) {
                return Ok(None);
            }
        }
        let again = self.solve_from(site, SolveStart { embedding, residuals: &residuals }, targets, control)?;
        let moved = embedding.iter().zip(&again.0).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        Ok((!is_little(moved)).then_some(again))
    }

    /// Solves like [`solve`](Self::solve), but for the move from an embedding that has the hard pins on their
    /// targets. If the embedding nearly solves the equations, the move is small, and so is its rounding error.
    pub(crate) fn solve_from(
        &self,
        site: Site<'_>,
        start: SolveStart<'_>,
        targets: &PinPositions,
        control: Control<'_>,
    ) -> Result<(Embedding, f64), SolveError> {
        self.move_from(&Asked { site, targets, control }, start, Factor::solve_correction)
    }

    /// Solves for the move from `start` that cancels the residuals there.
    fn move_from(
        &self,
        asked: &Asked<'_>,
        SolveStart { embedding: start, residuals }: SolveStart<'_>,
        answer: SolveFunction<Complex<f64>>,
    ) -> Result<(Embedding, f64), SolveError> {
        let &Asked { site, targets, control } = asked;
        let named = |error| site.system.named(error);
        let mut embedding = start.clone();
        let Some(least_squares) = &self.least_squares else {
            let terms: Vec<_> = site.system.free().iter().map(|v| residuals[v.index()]).collect();
            let moves = answer(&self.factor, &self.matrix, &terms, control.cancel()).map_err(named)?.x;
            for (&vertex, z) in site.system.free().iter().zip(moves) {
                embedding[vertex] += DVec2::new(z.re, z.im);
            }
            let residual = site.system.relative_residual(site.mesh, &self.equations, &embedding, control)?;
            return Ok((embedding, residual));
        };
        let factored = self.factored(control);
        let to_target = |pin: &Spring| {
            let to_target = targets[&pin.vertex] - start[pin.vertex];
            Complex::new(to_target.x, to_target.y)
        };
        let to_targets: Vec<_> = least_squares.springs().iter().map(to_target).collect();
        let moves = match least_squares {
            Ways::Few(few) => few.moves(site, &factored, residuals, &to_targets).map_err(named)?,
            Ways::Many(many) => many.moves(site, &factored, residuals, &to_targets)?,
        };
        // Adding zero would still turn a negative zero into a positive zero.
        embedding.par_iter_mut().zip(moves).filter(|(_, by)| *by != Complex::ZERO).for_each(|(z, by)| {
            *z += DVec2::new(by.re, by.im);
        });
        let residual = self.gradient_residual(asked, &embedding, least_squares.springs())?;
        Ok((embedding, residual))
    }

    /// Relative error of the conditions for a minimum: the residuals must be orthogonal to every move. The error is
    /// ‖Aᴴ A z + W² (z − t)‖ over the vertices that can move. It is relative to ‖|A|ᵀ |A| |z| + W² (|z| + |t|)‖, the
    /// sizes of the terms that should cancel.
    /// |A| |z| + W² (|z| + |t|)‖.
    fn gradient_residual(
        &self,
        asked: &Asked<'_>,
        embedding: &Embedding,
        springs: &[Spring],
    ) -> Result<f64, SolveError> {
        let &Asked { site: Site { mesh, .. }, targets, control } = asked;
        let coefficients = &self.equations.coefficients;
        let equation = |v: VertexId| {
            if self.eliminated.binary_search(&v).is_ok() {
                return (Complex::ZERO, 0.0);
            }
            let bound =
                |h| modulus(coefficients[HalfedgeId::index(h)]) * embedding[mesh.head(h)].distance(embedding[v]);
            (self.equations.residual_of(mesh, embedding, v), mesh.links_from(v).map(bound).sum::<f64>())
        };
        let equations: Vec<(Complex<f64>, f64)> =
            control.each(mesh.vertex_count(), |v| equation(VertexId::from_index(v)))?;
        let sum = |v: VertexId| {
            let (own, own_bound) = equations[v.index()];
            mesh.links_from(v).fold((Complex::<f64>::ZERO, 0.0_f64), |(sum, total), h| {
                let (there, back) = (coefficients[h.index()], coefficients[mesh.twin(h).index()]);
                let (other, bound) = equations[mesh.head(h).index()];
                (
                    sum + back.conj() * other - there.conj() * own,
                    total + modulus(back) * bound + modulus(there) * own_bound,
                )
            })
        };
        let mut sums: Vec<(Complex<f64>, f64)> = control.each(mesh.vertex_count(), |v| sum(VertexId::from_index(v)))?;
        let is_hard = |v: &VertexId| springs.binary_search_by_key(v, |pin| pin.vertex).is_err();
        for vertex in targets.keys().filter(|&v| is_hard(v)) {
            sums[vertex.index()] = (Complex::ZERO, 0.0);
        }
        for pin in springs {
            let at = &mut sums[pin.vertex.index()];
            let (place, target) = (embedding[pin.vertex], targets[&pin.vertex]);
            let pull = (place - target) / pin.compliance;
            at.0 += Complex::new(pull.x, pull.y);
            at.1 += (place.length() + target.length()) / pin.compliance;
        }
        let (gradient, whole) = sums
            .iter()
            .fold((0.0, 0.0), |(gradient, whole), (sum, total)| (gradient + sum.norm_sqr(), whole + total * total));
        Ok(if gradient > 0.0 { f64::sqrt(gradient / whole) } else { 0.0 })
    }

    /// Residual of the equation of every vertex.
    pub(crate) fn residuals(
        &self,
        mesh: &DiskMesh,
        embedding: &Embedding,
        control: Control<'_>,
    ) -> Result<Vec<Complex<f64>>, SolveError> {
        control.each(mesh.vertex_count(), |v| self.equations.residual_of(mesh, embedding, VertexId::from_index(v)))
    }

    pub(crate) fn numbers(
        &self,
        mesh: &DiskMesh,
        embedding: &Embedding,
        residual: f64,
        control: Control<'_>,
    ) -> Result<LinearSolve, SolveError> {
        let Equations { bounded_corners, .. } = self.equations;
        let equation_residual = self.equations.residual(mesh, embedding, |_| true, control)?;
        let keeps_equations = self.least_squares.is_some() && self.eliminated.is_empty();
        Ok(LinearSolve { residual, equation_residual, bounded_corners, keeps_equations, ..self.factor.stats().into() })
    }
}

/// True if the mesh has many boundary vertices for its number of faces: the ratio [`CORRIDOR`] is 8 times that of a
/// regular grid of squares. In corridors the smallest eigenvalues that distinguish maps fall with the fourth power
/// of the ratio.
fn is_corridor(mesh: &DiskMesh) -> bool {
    mesh.boundary_loop().len().pow(2) > CORRIDOR * mesh.face_count()
}
