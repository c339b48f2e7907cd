//! Greatest eigenvalue of a Hermitian operator and its eigenvector, by the Lanczos method.
//!
//! # Equation
//!
//! ```text
//! β_{j+1} v_{j+1} = T v_j − α_j v_j − β_j v_{j−1}        V* T V = tridiag(β, α, β)
//! (θ, s) the greatest eigenpair of that small matrix:    ‖T (V s) − θ V s‖ = β_{j+1} |s_j|
//! ```
//!
//! If T is the inverse of a matrix, this is inverse iteration that keeps all iterates and uses their best
//! combination. Every vector is orthogonalised against all previous vectors, twice, so that rounding does not
//! duplicate eigenvalues.
//!
//! # Symbols
//!
//! | formula | code         | meaning                                   |
//! |---------|--------------|-------------------------------------------|
//! | T       | `apply`      | the operator, Hermitian on complex vectors|
//! | V       | `basis`      | orthonormal iterates                      |
//! | α, β    | `diagonal`, `beside` | entries of the small matrix       |
//! | θ       | `value`      | the greatest eigenvalue so far            |
//!
//! Source: C. Lanczos, "An iteration method for the solution of the eigenvalue problem of linear differential and
//! integral operators", 1950; with inverted matrices T. Ericsson, A. Ruhe, "The spectral transformation Lanczos
//! method", 1980.

use nalgebra::{DMatrix, SymmetricEigen};
use num_complex::Complex;

type C64 = Complex<f64>;

/// Eigenvalue with its eigenvector and accuracy.
#[derive(Clone, Debug, PartialEq)]
pub struct Eigenpair {
    /// Eigenvalue θ.
    pub value: f64,
    /// Eigenvector x, of length 1.
    pub vector: Vec<C64>,
    /// Weight in x of each vector that the operator was applied to, in order.
    pub weights: Vec<f64>,
    /// Number of applications of the operator.
    pub applications: usize,
    /// Relative residual ‖T x − θ x‖ / |θ|.
    pub residual: f64,
}

/// Stopping criteria.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EigenLimits {
    /// Largest residual that counts as converged.
    pub tolerance: f64,
    /// Largest number of applications of the operator.
    pub applications: usize,
}

/// Greatest eigenpair of a Hermitian operator in the Krylov space of `start`, which must not be zero. If numbers
/// overflow, value and residual are NaN.
///
/// # Errors
///
/// Errors of `apply`.
pub fn greatest_eigenpair<E>(
    start: &[C64],
    limits: EigenLimits,
    mut apply: impl FnMut(&[C64]) -> Result<Vec<C64>, E>,
) -> Result<Eigenpair, E> {
    let mut next = start.to_vec();
    let mut length = norm(&next);
    let mut basis: Vec<Vec<C64>> = Vec::new();
    let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
    loop {
        for x in &mut next {
            *x /= length;
        }
        basis.push(next);
        let newest = &basis[basis.len() - 1];
        next = apply(newest)?;
        diagonal.push(dot(newest, &next).re);
        for _ in 0..2 {
            for vector in &basis {
                let share = dot(vector, &next);
                next.iter_mut().zip(vector).for_each(|(x, v)| *x -= share * v);
            }
        }
        length = norm(&next);
        if !length.is_finite() {
            // The search for eigenvalues of a matrix with NaN entries would not end.
            let (value, residual) = (f64::NAN, f64::NAN);
            return Ok(Eigenpair { value, vector: next, weights: Vec::new(), applications: basis.len(), residual });
        }
        let (value, weights) = greatest_of(&diagonal, &beside);
        let residual = length * weights[weights.len() - 1].abs() / value.abs();
        let is_whole = basis.len() >= start.len();
        // Written so that a NaN ends the iteration, too.
        let is_continued = residual > limits.tolerance && basis.len() < limits.applications && !is_whole;
        if !is_continued {
            let combined = |place: usize| basis.iter().zip(&weights).map(|(v, &w)| v[place] * w).sum();
            let vector = (0..start.len()).map(combined).collect();
            return Ok(Eigenpair { value, vector, weights, applications: basis.len(), residual });
        }
        beside.push(length);
    }
}

/// Greatest eigenvalue of a real symmetric tridiagonal matrix, with its eigenvector.
fn greatest_of(diagonal: &[f64], beside: &[f64]) -> (f64, Vec<f64>) {
    let mut matrix = DMatrix::from_diagonal(&nalgebra::DVector::from_column_slice(diagonal));
    for (k, &entry) in beside.iter().enumerate() {
        matrix[(k, k + 1)] = entry;
        matrix[(k + 1, k)] = entry;
    }
    let eigen = SymmetricEigen::new(matrix);
    let at = eigen.eigenvalues.imax();
    (eigen.eigenvalues[at], eigen.eigenvectors.column(at).iter().copied().collect())
}

/// Inner product a* b.
fn dot(a: &[C64], b: &[C64]) -> C64 {
    a.iter().zip(b).fold(C64::ZERO, |sum, (a, b)| sum + a.conj() * b)
}

fn norm(x: &[C64]) -> f64 {
    super::sparse::norm(x.iter().copied())
}
