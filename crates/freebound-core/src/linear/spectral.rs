//! Spectral conformal parameterization: the map of least conformal energy for a fixed size of the boundary, without
//! a pin.
//!
//! # Equation
//!
//! The conformal energy of an embedding is E(z) = z* L z. L = −A is the negated matrix of the natural boundary
//! equations with conformal weights, pinned vertices not eliminated. E is 0 if all vertices coincide, so the size
//! must be fixed:
//!
//! ```text
//! min  z* L z     with  z* B z = 1,  1* B z = 0          L z = λ B z,  λ the least but that of the constants
//! ```
//!
//! B has ones at boundary vertices and zeros inside: the free-boundary version of the source. The whole boundary
//! fixes the size, in place of two pins. So no single vertex bears the distortion of being chosen.
//!
//! # Method
//!
//! Inverse iteration on the factors of L + σB: (L + σB)⁻¹ B has the eigenvectors of the pencil (L, B), with
//! eigenvalues θ = 1/(λ + σ). The *shift* σ > 0 is needed because L alone is singular: the constants, and all
//! similarities of a planar surface, have no energy. L + σB is positive definite for every surface: a vector without
//! energy that vanishes on the boundary is zero. Holding a vertex instead would work for curved surfaces alone, and
//! would single that vertex out. So σ is as small as rounding allows. Constants, whose θ would be the greatest, are
//! removed from every iterate.
//!
//! The iteration works on the boundary alone: with P the rows of its vertices, it iterates T = P (L + σB)⁻¹ Pᵀ, an
//! ordinary Hermitian operator on boundary vectors. If λ₂ and λ₃ are close, plain iteration is slow; the combination
//! of all iterates is not (`linalg/lanczos.rs`).
//!
//! # Symbols
//!
//! | source | code         | meaning                                            | unit            |
//! |--------|--------------|----------------------------------------------------|-----------------|
//! | `L_C`  | `matrix` − σB| conformal energy, Hermitian, n × n                 | none            |
//! | B      | `boundary`   | rows of the boundary vertices                      | none            |
//! | σ      | `shift`      | moves all eigenvalues up                           | none            |
//! | λ      | `eigenvalue` | energy at boundary norm 1                          | none            |
//!
//! Source: P. Mullen, Y. Tong, P. Alliez, M. Desbrun, "Spectral Conformal Parameterization", 2008, §3; here as a
//! complex system in place of a real system of twice the order.

use std::f64::consts::TAU;
use std::time::Instant;

use glam::DVec2;
use nalgebra_sparse::CscMatrix;
use num_complex::Complex;

use super::system::FreeSystem;
use crate::linalg::{Analysis, EigenLimits, Eigenpair, Factor, Kind, LinalgError, greatest_eigenpair};
use crate::mesh::{DiskMesh, HalfedgeId, VertexId};
use crate::problem::{
    Control, Convergence, Embedding, Family, LinearSolve, Phase, PhaseSeconds, Pins, Solution, SolveError, Stop,
};
use crate::weights::equations::{Equations, natural};

type C64 = Complex<f64>;

/// Shift, relative to the median diagonal entry times the number of vertices per boundary vertex: the share that
/// rounding leaves to a constant.
const SHIFT: f64 = 1e-13;

/// Factor of the shift if the factorization finds no positive pivot.
const RAISED: f64 = 100.0;

/// Largest number of raises of the shift.
const RAISES: usize = 5;

/// Limits of the iteration: it converges if the operator rotates the iterate by at most the tolerance.
const LIMITS: EigenLimits = EigenLimits { tolerance: 1e-13, applications: 100 };

/// Share of scattered numbers in the first iterate. They break symmetries of a mesh, which could make the iterate
/// orthogonal to the solution.
const SCATTERED: f64 = 1e-3;

/// Spectral conformal embedding of a disk.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectral {
    /// Embedding with its boundary centred at the origin, and statistics of the solves. The residual of the
    /// convergence is ‖T x − θ x‖ / θ. The residual of the linear solve is ‖L z − λ B z‖ relative to the sizes of
    /// the terms of L z.
    pub solution: Solution,
    /// Eigenvalue λ: the conformal energy at Σ |z|² = 1 over the boundary.
    pub eigenvalue: f64,
}

/// Computes the spectral conformal embedding.
///
/// # Errors
///
/// Returns an error if weights are not finite or if the matrix stays indefinite for every shift;
/// [`SolveError::Cancelled`].
pub fn spectral(mesh: &DiskMesh, control: Control<'_>) -> Result<Spectral, SolveError> {
    control.enter(Phase::Assemble)?;
    let start = Instant::now();
    let equations = natural(mesh, Family::CONFORMAL_POWER, control)?;
    let system = FreeSystem::new(mesh, |_| false, control)?;
    let boundary: Vec<usize> = mesh.boundary_loop().iter().filter_map(|&v| system.row(v)).collect();
    let mut seconds = PhaseSeconds { assemble: start.elapsed().as_secs_f64(), ..PhaseSeconds::default() };
    control.enter(Phase::Analyze)?;
    let start = Instant::now();
    let analysis = system.analysis(Kind::Hermitian, control)?;
    seconds.analyze = start.elapsed().as_secs_f64();
    control.enter(Phase::Factor)?;
    let start = Instant::now();
    let shifted = Shifted::new(mesh, &system, Setup { equations: &equations, analysis: &analysis, boundary }, control)?;
    seconds.factor = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let named = |error| system.named(error);
    let apply = |x: &[C64]| {
        control.enter(Phase::Solve)?;
        let mut on_boundary = shifted.on_boundary(&shifted.inverse(x, control).map_err(named)?);
        centre(&mut on_boundary);
        Ok::<_, SolveError>(on_boundary)
    };
    let found = greatest_eigenpair(&first_iterate(mesh), LIMITS, apply)?;
    let z = shifted.inverse(&found.vector, control).map_err(named)?;
    let mut answer = Answer { mesh, system: &system, equations: &equations, control }.spectral(&shifted, &found, z)?;
    seconds.solve = start.elapsed().as_secs_f64();
    answer.solution.seconds = seconds;
    Ok(answer)
}

/// First iterate: the boundary on a circle, in proportion to its lengths.
fn first_iterate(mesh: &DiskMesh) -> Vec<C64> {
    let boundary = mesh.boundary_loop();
    let lengths = boundary.iter().zip(boundary.iter().cycle().skip(1)).map(|(&a, &b)| mesh.length([a, b]));
    let lengths: Vec<f64> = lengths.collect();
    let total: f64 = lengths.iter().sum();
    let mut walked = 0.0;
    let mut iterate: Vec<C64> = Vec::with_capacity(boundary.len());
    for (place, length) in lengths.into_iter().enumerate() {
        let scattered = C64::from_polar(SCATTERED, (place * place) as f64);
        iterate.push(C64::from_polar(1.0, TAU * walked / total) + scattered);
        walked += length;
    }
    centre(&mut iterate);
    iterate
}

/// Removes the constant part.
pub(super) fn centre(x: &mut [C64]) {
    let mean = x.iter().sum::<C64>() / x.len() as f64;
    for x in x {
        *x -= mean;
    }
}

struct Setup<'a> {
    equations: &'a Equations<C64>,
    analysis: &'a Analysis,
    boundary: Vec<usize>,
}

/// Matrix L + σB with its factors.
struct Shifted {
    matrix: CscMatrix<C64>,
    factor: Factor<C64>,
    /// Rows of the boundary vertices, in the order of the loop.
    boundary: Vec<usize>,
}

impl Shifted {
    /// Factors L + σB with the least shift that makes it positive definite in 64 bits.
    fn new(
        mesh: &DiskMesh,
        system: &FreeSystem,
        Setup { equations, analysis, boundary }: Setup<'_>,
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        let mut matrix = system.negated_matrix(mesh, equations, control)?;
        let places: Vec<usize> = boundary.iter().map(|&row| system.place_of_diagonal(row)).collect();
        let mut diagonal: Vec<f64> =
            (0..system.free().len()).map(|row| matrix.values()[system.place_of_diagonal(row)].re).collect();
        let middle = diagonal.len() / 2;
        let (_, &mut usual, _) = diagonal.select_nth_unstable_by(middle, f64::total_cmp);
        let mut step = SHIFT * usual.abs() * (diagonal.len() as f64 / boundary.len() as f64);
        let mut raises = 0;
        loop {
            for &place in &places {
                matrix.values_mut()[place] += step;
            }
            // A matrix that has positive pivots only by rounding fails this trial solve.
            let factored = analysis.factor(&matrix, control.cancel()).and_then(|factor| {
                factor.solve_correction(&matrix, &vec![C64::ONE; diagonal.len()], control.cancel())?;
                Ok(factor)
            });
            match factored {
                Ok(factor) => return Ok(Self { matrix, factor, boundary }),
                Err(LinalgError::Cancelled) => return Err(SolveError::Cancelled),
                Err(error) if raises == RAISES => return Err(system.named(error)),
                Err(_) => (step, raises) = (step * RAISED, raises + 1),
            }
        }
    }

    /// Vector (L + σB)⁻¹ Pᵀ x.
    fn inverse(&self, x: &[C64], control: Control<'_>) -> Result<Vec<C64>, LinalgError> {
        let mut rhs = vec![C64::ZERO; self.matrix.nrows()];
        for (&row, &x) in self.boundary.iter().zip(x) {
            rhs[row] = x;
        }
        Ok(self.factor.solve_correction(&self.matrix, &rhs, control.cancel())?.x)
    }

    fn on_boundary(&self, z: &[C64]) -> Vec<C64> {
        self.boundary.iter().map(|&row| z[row]).collect()
    }
}

/// Data that turns an eigenvector into an embedding.
struct Answer<'a> {
    mesh: &'a DiskMesh,
    system: &'a FreeSystem,
    equations: &'a Equations<C64>,
    control: Control<'a>,
}

impl Answer<'_> {
    /// Embedding of an eigenvector z, with its residuals.
    fn spectral(&self, shifted: &Shifted, found: &Eigenpair, z: Vec<C64>) -> Result<Spectral, SolveError> {
        let on_boundary = shifted.on_boundary(&z);
        let mean = on_boundary.iter().sum::<C64>() / on_boundary.len() as f64;
        let length = on_boundary.iter().map(|z| (z - mean).norm_sqr()).sum::<f64>().sqrt();
        let mut embedding = Embedding::from(vec![DVec2::ZERO; self.mesh.vertex_count()]);
        for (&vertex, z) in self.system.free().iter().zip(z) {
            let z = (z - mean) / length;
            embedding[vertex] = DVec2::new(z.re, z.im);
        }
        embedding.check_finite()?;
        let (eigenvalue, residual) = pencil_residual(self.mesh, self.equations, &embedding, self.control)?;
        let limit = LIMITS.tolerance;
        let stop = if found.residual <= limit { Stop::Converged } else { Stop::Limit };
        let convergence = Convergence { steps: found.applications, residual: found.residual, stop };
        let linear = LinearSolve {
            residual,
            equation_residual: self.equations.residual(self.mesh, &embedding, |_| true, self.control)?,
            bounded_corners: self.equations.bounded_corners,
            ..shifted.factor.stats().into()
        };
        let solution = Solution {
            embedding,
            pins: Pins::new(),
            gauge_completed: true,
            linear: Some(linear),
            convergence: Some(convergence),
            seconds: PhaseSeconds::default(),
        };
        Ok(Spectral { solution, eigenvalue })
    }
}

/// Eigenvalue λ as the energy of an embedding of boundary norm 1, and its residual. The residual is ‖L z − λ B z‖
/// relative to the sizes of the terms of L z.
pub(super) fn pencil_residual(
    mesh: &DiskMesh,
    equations: &Equations<C64>,
    embedding: &Embedding,
    control: Control<'_>,
) -> Result<(f64, f64), SolveError> {
    let used: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.is_used(v)).collect();
    let place = |v: VertexId| C64::new(embedding[v].x, embedding[v].y);
    let forces: Vec<C64> = control.each(used.len(), |at| -equations.residual_of(mesh, embedding, used[at]))?;
    let work = |(&v, force): (&VertexId, &C64)| (place(v).conj() * force).re;
    let eigenvalue = used.iter().zip(&forces).map(work).sum::<f64>().max(0.0);
    let (mut left, mut whole) = (0.0, 0.0);
    for run in control.runs(used.len()) {
        for at in run? {
            let (v, force) = (used[at], forces[at]);
            let held = if mesh.boundary_place(v).is_some() { eigenvalue * place(v) } else { C64::ZERO };
            let size = |h: HalfedgeId| {
                let coefficient: C64 = equations.coefficients[h.index()];
                coefficient.norm() * embedding[mesh.head(h)].distance(embedding[v])
            };
            left += (force - held).norm_sqr();
            whole += mesh.links_from(v).map(size).sum::<f64>().powi(2);
        }
    }
    Ok((eigenvalue, if left > 0.0 { f64::sqrt(left / whole) } else { 0.0 }))
}
