//! Iterative refinement: what makes an answer as good as the matrix allows.
//!
//! ```text
//! r = b − A x,   x ← x + (LU)⁻¹ r     until   ω = maxᵢ |r|ᵢ / (|A||x| + |b|)ᵢ   stops falling
//! ```
//!
//! ω is the componentwise backward error (Arioli, Demmel and Duff 1989, "Solving sparse linear systems with sparse
//! backward error"): it does not depend on the scale of the rows. Where refinement stalls above the goal, GMRES
//! preconditioned with the same factors takes over.

use nalgebra_sparse::CscMatrix;

use super::LinalgError;
use super::gmres::gmres;
use super::scalar::Scalar;
use super::sparse::{Operation, backward_error, norm, residual};

/// Answers with a larger relative residual are errors.
const LIMIT: f64 = 1e-10;

/// Above this, GMRES is tried.
const GOAL: f64 = 1e-12;

/// A componentwise backward error of so many units of rounding cannot be bettered in working precision.
const GOOD_BACKWARD_ERROR: f64 = 2.0 * f64::EPSILON;

/// A step must at least halve the backward error to be followed by another.
const WORTHWHILE: f64 = 0.5;

/// Two steps are the rule; more help only where pivots were replaced.
const MOST_STEPS: usize = 8;

/// The answer to a linear system, and how good it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Solved<T> {
    /// The solution; several, one after another, for several right-hand sides.
    pub x: Vec<T>,
    /// ‖Ax − b‖ / ‖b‖ in the Euclidean norm, 0 where b = 0; of the worst right-hand side.
    pub residual: f64,
    /// The same with every row divided by (a power of two near) its diagonal entry, as the LU sees the system. Where
    /// the rows differ by many decades, this is the one that every equation has a part in.
    pub scaled_residual: f64,
    /// Steps of refinement that were kept, and of GMRES; the most for any right-hand side.
    pub refinement_steps: usize,
}

/// A system, its scaling, and an approximate solver for it.
pub(super) struct System<'a, T> {
    pub(super) matrix: &'a CscMatrix<T>,
    pub(super) operation: Operation,
    /// Factors of the rows of op(A), if they are scaled.
    pub(super) row_scale: Option<&'a [f64]>,
    /// Solves in place, column by column.
    pub(super) solve: &'a dyn Fn(&mut [T]),
}

impl<T: Scalar> System<'_, T> {
    /// ‖r‖/‖b‖, plain and with scaled rows; 0 where both are 0.
    fn relative(&self, r: &[T], b: &[T]) -> (f64, f64) {
        let ratio = |r: f64, b: f64| if r == 0.0 { 0.0 } else { r / b };
        let plain = ratio(norm(r.iter().copied()), norm(b.iter().copied()));
        let Some(scale) = self.row_scale else { return (plain, plain) };
        let scaled = |v: &[T]| norm(v.iter().zip(scale).map(|(&v, &scale)| v.scaled(scale)));
        (plain, ratio(scaled(r), scaled(b)))
    }
}

/// Solves for every column of `rhs` and refines each.
pub(super) fn refined<T: Scalar>(system: &System<'_, T>, rhs: &[T]) -> Result<Solved<T>, LinalgError> {
    let mut x = rhs.to_vec();
    let mut all = Solved { x: Vec::new(), residual: 0.0, scaled_residual: 0.0, refinement_steps: 0 };
    if rhs.is_empty() {
        return Ok(all);
    }
    (system.solve)(&mut x);
    let n = system.matrix.nrows();
    for (x, b) in x.chunks_exact_mut(n).zip(rhs.chunks_exact(n)) {
        let mut steps = refine(system, x, b);
        let mut r = vec![T::ZERO; n];
        residual(system.matrix, system.operation, x, b, &mut r);
        let (mut plain, mut scaled) = system.relative(&r, b);
        // Written so that a NaN is not good.
        let good = |limit: f64, plain: f64, scaled: f64| plain.min(scaled) <= limit && (plain + scaled).is_finite();
        if !good(GOAL, plain, scaled) {
            steps += gmres(system, x, b);
            residual(system.matrix, system.operation, x, b, &mut r);
            (plain, scaled) = system.relative(&r, b);
        }
        if !good(LIMIT, plain, scaled) {
            return Err(LinalgError::ResidualTooLarge { residual: plain, limit: LIMIT });
        }
        all.residual = all.residual.max(plain);
        all.scaled_residual = all.scaled_residual.max(scaled);
        all.refinement_steps = all.refinement_steps.max(steps);
    }
    all.x = x;
    Ok(all)
}

/// Refines one answer in place; returns the steps that were kept.
fn refine<T: Scalar>(system: &System<'_, T>, x: &mut [T], b: &[T]) -> usize {
    let mut r = vec![T::ZERO; b.len()];
    let mut before = x.to_vec();
    residual(system.matrix, system.operation, x, b, &mut r);
    let mut error = backward_error(system.matrix, system.operation, x, b, &r);
    for step in 0..MOST_STEPS {
        if error <= GOOD_BACKWARD_ERROR || !error.is_finite() {
            return step;
        }
        before.copy_from_slice(x);
        (system.solve)(&mut r);
        x.iter_mut().zip(&r).for_each(|(x, &correction)| *x += correction);
        residual(system.matrix, system.operation, x, b, &mut r);
        let now = backward_error(system.matrix, system.operation, x, b, &r);
        // Written so that a NaN is no progress.
        if !(now < error) {
            x.copy_from_slice(&before);
            return step;
        }
        if now > WORTHWHILE * error {
            return step + 1;
        }
        error = now;
    }
    MOST_STEPS
}
