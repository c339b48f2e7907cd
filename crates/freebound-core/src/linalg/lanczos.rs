//! The greatest eigenvalue of a Hermitian operator and its eigenvector, by Lanczos' method.
//!
//! # Equation
//!
//! ```text
//! β_{j+1} v_{j+1} = T v_j − α_j v_j − β_j v_{j−1}        V* T V = tridiag(β, α, β)
//! (θ, s) the greatest eigenpair of that small matrix:    ‖T (V s) − θ V s‖ = β_{j+1} |s_j|
//! ```
//!
//! Where T is the inverse of a matrix this is inverse iteration that forgets none of its iterates: of all their
//! combinations it takes the best. Every vector is made orthogonal to all before it, twice, so that no eigenvalue shows up
//! again by rounding.
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
//! Source: C. Lanczos, "An iteration method for the solution of the eigenvalue problem of linear differential and integral
//! operators", 1950; with inverted matrices T. Ericsson, A. Ruhe, "The spectral transformation Lanczos method", 1980.

use nalgebra::{DMatrix, SymmetricEigen};
use num_complex::Complex;

type C64 = Complex<f64>;

/// An eigenvalue, and how well it is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Eigenpair {
    /// The eigenvalue θ.
    pub value: f64,
    /// Its eigenvector x, of length 1.
    pub vector: Vec<C64>,
    /// How often the operator was applied.
    pub applications: usize,
    /// ‖T x − θ x‖ / |θ|.
    pub residual: f64,
}

/// When to be content.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EigenLimits {
    /// A residual that is small enough.
    pub tolerance: f64,
    /// The most applications of the operator.
    pub applications: usize,
}

/// The greatest eigenpair of a Hermitian operator in the space that its powers make of `start`, which must not be zero.
/// Where numbers overflow, value and residual are none.
///
/// # Errors
///
/// Those of `apply`.
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
            // The search for eigenvalues of what is no number would not end.
            return Ok(Eigenpair { value: f64::NAN, vector: next, applications: basis.len(), residual: f64::NAN });
        }
        let (value, weights) = greatest_of(&diagonal, &beside);
        let residual = length * weights[weights.len() - 1].abs() / value.abs();
        let is_whole = basis.len() >= start.len();
        // Written so that a NaN ends it, too.
        let is_continued = residual > limits.tolerance && basis.len() < limits.applications && !is_whole;
        if !is_continued {
            let combined = |place: usize| basis.iter().zip(&weights).map(|(v, &w)| v[place] * w).sum();
            let vector = (0..start.len()).map(combined).collect();
            return Ok(Eigenpair { value, vector, applications: basis.len(), residual });
        }
        beside.push(length);
    }
}

/// The greatest eigenvalue of a real symmetric tridiagonal matrix, with its eigenvector.
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

/// a* b.
fn dot(a: &[C64], b: &[C64]) -> C64 {
    a.iter().zip(b).fold(C64::ZERO, |sum, (a, b)| sum + a.conj() * b)
}

fn norm(x: &[C64]) -> f64 {
    super::sparse::norm(x.iter().copied())
}
