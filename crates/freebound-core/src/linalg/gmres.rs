//! GMRES for a system whose factors were perturbed by replaced pivots.
//!
//! Saad and Schultz 1986, preconditioned from the right with the factors M and, for rows of very different sizes, with
//! the rows scaled by R⁻¹:
//!
//! ```text
//! minimise ‖R⁻¹ (b − A (x + M⁻¹ V y))‖   over the Krylov space V of R⁻¹ A M⁻¹
//! ```
//!
//! Replacing k pivots changes A by a matrix of rank k, so about k + 1 steps suffice.

use super::LinalgError;
use super::refine::System;
use super::scalar::Scalar;
use super::sparse::norm;

/// Number of steps before a restart; each step stores a vector.
const RESTART: usize = 30;
/// Largest number of restarts.
const MOST_RESTARTS: usize = 4;
/// Reduction of the residual that ends a cycle; the next cycle starts from the true residual.
const REDUCTION: f64 = 1e-13;

/// Improves `x` in place; returns the number of steps.
///
/// # Errors
///
/// [`LinalgError::Cancelled`].
pub(super) fn gmres<T: Scalar>(system: &System<'_, T>, x: &mut [T], b: &[T]) -> Result<usize, LinalgError> {
    if x.iter().any(|x| !x.is_finite()) {
        x.fill(T::ZERO);
    }
    let mut steps = 0;
    let mut before = f64::INFINITY;
    for _ in 0..MOST_RESTARTS {
        let mut r = scaled_residual(system, x, b)?;
        let size = norm(r.iter().copied());
        let worthwhile = size < 0.5 * before && size > 0.0;
        if !worthwhile {
            return Ok(steps);
        }
        before = size;
        scale(&mut r, size.recip());
        let mut space =
            Krylov { basis: vec![r], triangle: Vec::new(), rotations: Vec::new(), rhs: vec![T::from_real(size)] };
        while space.triangle.len() < RESTART && space.extend(system)? && space.remaining() > REDUCTION * size {}
        steps += space.triangle.len();
        let mut correction = space.combination();
        (system.solve)(&mut correction)?;
        if correction.iter().any(|value| !value.is_finite()) {
            return Ok(steps);
        }
        x.iter_mut().zip(&correction).for_each(|(x, &correction)| *x += correction);
    }
    Ok(steps)
}

fn scale<T: Scalar>(vector: &mut [T], factor: f64) {
    for value in vector {
        *value = value.scale(factor);
    }
}

/// Scaled residual R⁻¹ (b − op(A) x).
fn scaled_residual<T: Scalar>(system: &System<'_, T>, x: &[T], b: &[T]) -> Result<Vec<T>, LinalgError> {
    let mut r = vec![T::ZERO; b.len()];
    system.operator.residual(x, b, &mut r)?;
    if let Some(scale) = system.row_scale {
        r.iter_mut().zip(scale).for_each(|(r, &scale)| *r = r.scale(scale));
    }
    Ok(r)
}

/// Orthonormal basis of the Krylov space and its least-squares problem, made triangular by rotations.
struct Krylov<T> {
    basis: Vec<Vec<T>>,
    /// Columns of the triangular factor.
    triangle: Vec<Vec<T>>,
    /// Cosine and sine of each rotation.
    rotations: Vec<(f64, T)>,
    rhs: Vec<T>,
}

impl<T: Scalar> Krylov<T> {
    /// Adds a vector. Returns false if the space cannot grow.
    fn extend(&mut self, system: &System<'_, T>) -> Result<bool, LinalgError> {
        let mut direction = self.basis.last().expect("begins with one").clone();
        (system.solve)(&mut direction)?;
        let zero = vec![T::ZERO; direction.len()];
        let mut next = scaled_residual(system, &direction, &zero)?;
        scale(&mut next, -1.0);
        let before = norm(next.iter().copied());
        let mut column: Vec<T> = vec![T::ZERO; self.basis.len()];
        // Orthogonalising twice is enough (Kahan and Parlett).
        for _ in 0..2 {
            for (entry, known) in column.iter_mut().zip(&self.basis) {
                let part = known.iter().zip(&next).fold(T::ZERO, |sum, (&q, &v)| sum + q.conjugate() * v);
                next.iter_mut().zip(known).for_each(|(v, &q)| *v -= part * q);
                *entry += part;
            }
        }
        let below = norm(next.iter().copied());
        if !before.is_finite() || before == 0.0 {
            return Ok(false);
        }
        self.rotate(column, below);
        let grows = below > f64::EPSILON * before;
        if grows {
            scale(&mut next, below.recip());
            self.basis.push(next);
        }
        Ok(grows)
    }

    /// Applies the previous rotations to a new column and adds the rotation that removes the entry `below` its
    /// diagonal.
    fn rotate(&mut self, mut column: Vec<T>, below: f64) {
        for (k, &(cosine, sine)) in self.rotations.iter().enumerate() {
            let (upper, lower) = (column[k], column[k + 1]);
            column[k] = upper.scale(cosine) + sine * lower;
            column[k + 1] = lower.scale(cosine) - sine.conjugate() * upper;
        }
        let k = column.len() - 1;
        let diagonal = column[k];
        let modulus = norm(std::iter::once(diagonal));
        let length = modulus.hypot(below);
        let (cosine, sine) =
            if modulus == 0.0 { (0.0, T::ONE) } else { (modulus / length, diagonal.scale(below / (modulus * length))) };
        column[k] = diagonal.scale(cosine) + sine.scale(below);
        let above = self.rhs[k];
        self.rhs[k] = above.scale(cosine);
        self.rhs.push(-(sine.conjugate() * above));
        self.rotations.push((cosine, sine));
        self.triangle.push(column);
    }

    /// Norm of the residual of the least-squares problem.
    fn remaining(&self) -> f64 {
        self.rhs.last().map_or(0.0, |last| norm(std::iter::once(*last)))
    }

    /// Combination V y of the basis.
    fn combination(&self) -> Vec<T> {
        let count = self.triangle.len();
        let mut y = self.rhs[..count].to_vec();
        for k in (0..count).rev() {
            let diagonal = self.triangle[k][k];
            y[k] = if diagonal == T::ZERO { T::ZERO } else { y[k] / diagonal };
            for (row, &entry) in self.triangle[k][..k].iter().enumerate() {
                let known = y[k];
                y[row] -= entry * known;
            }
        }
        let mut sum = vec![T::ZERO; self.basis[0].len()];
        for (&y, known) in y.iter().zip(&self.basis) {
            sum.iter_mut().zip(known).for_each(|(sum, &q)| *sum += y * q);
        }
        sum
    }
}
