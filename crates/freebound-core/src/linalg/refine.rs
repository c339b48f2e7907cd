//! Iterative refinement: solutions as accurate as the matrix allows.
//!
//! ```text
//! r = b − A x,   x ← x + (LU)⁻¹ r     until   ω = maxᵢ |r|ᵢ / (|A||x| + |b|)ᵢ   stops falling
//! ```
//!
//! ω is the componentwise backward error (Arioli, Demmel and Duff 1989, "Solving sparse linear systems with sparse
//! backward error"). It does not depend on the scale of the rows. If refinement stalls above the goal, GMRES
//! preconditioned with the current factors takes over.

use crate::parallel::prelude::*;

use super::LinalgError;
use super::gmres::gmres;
use super::scalar::Scalar;
use super::sparse::{Operator, norm};

/// Largest accepted relative residual.
const LIMIT: f64 = 1e-10;

/// Relative residual above which GMRES is tried, but only if refinement stalled as well.
const GOAL: f64 = 1e-12;

/// Backward error above which the factors do not belong to the matrix. With a smaller error, a large residual comes
/// from a large ‖A‖‖x‖/‖b‖, which no method can improve in working precision.
const STALLED: f64 = 1e3 * f64::EPSILON;

/// Componentwise backward error that cannot be improved in working precision.
const GOOD_BACKWARD_ERROR: f64 = 2.0 * f64::EPSILON;

/// Componentwise backward error that substitution usually leaves.
const SMALL_BACKWARD_ERROR: f64 = 64.0 * f64::EPSILON;

/// Largest ratio of the backward errors after and before a step at which another step is worthwhile.
const WORTHWHILE: f64 = 0.5;

/// Largest number of steps. Two are usual; more help only if pivots were replaced.
const MOST_STEPS: usize = 8;

/// Number of right-hand sides refined together; each needs three vectors.
const GROUP: usize = 8;

/// Solution of a linear system, with its accuracy.
#[derive(Clone, Debug, PartialEq)]
pub struct Solved<T> {
    /// Solution; for several right-hand sides, consecutive columns.
    pub x: Vec<T>,
    /// Relative residual ‖Ax − b‖ / ‖b‖ in the Euclidean norm, 0 if b = 0; of the worst right-hand side.
    pub residual: f64,
    /// Relative residual with every row divided by (a power of two near) its diagonal entry, like the LU sees the
    /// system. If the rows differ by many decades, every equation contributes to this residual.
    pub scaled_residual: f64,
    /// Componentwise backward error after refinement, of the worst right-hand side. A few units of rounding if the
    /// solution is as accurate as possible.
    pub backward_error: f64,
    /// Number of kept steps of refinement and of GMRES steps; the most for any right-hand side.
    pub refinement_steps: usize,
}

/// Criterion for accepting a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Accept {
    /// Small relative residual.
    Residual,
    /// Small relative residual, or a backward error of a few units of rounding by faithful factors. For right-hand
    /// sides far smaller than ‖A‖‖x‖: then ‖A‖‖x‖ε alone can exceed the limit of the relative residual.
    BackwardError,
    /// Accepted like [`Self::BackwardError`], and not refined if substitution leaves a small backward error. For
    /// solutions from which refined solutions are composed.
    SmallBackwardError,
}

impl Accept {
    /// Backward error at which refinement ends.
    fn goal(self) -> f64 {
        match self {
            Self::Residual | Self::BackwardError => GOOD_BACKWARD_ERROR,
            Self::SmallBackwardError => SMALL_BACKWARD_ERROR,
        }
    }
}

/// Norms of a vector, or ratios of two such norms.
#[derive(Clone, Copy)]
struct Sizes {
    /// Euclidean norm.
    plain: f64,
    /// Euclidean norm with scaled rows.
    scaled: f64,
}

pub(super) struct System<'a, T> {
    pub(super) operator: Operator<'a, T>,
    /// Factors of the rows of op(A), if they are scaled.
    pub(super) row_scale: Option<&'a [f64]>,
    /// True if the factors are those of the matrix up to rounding: no pivot was replaced.
    pub(super) is_faithful: bool,
    pub(super) accept: Accept,
    /// Solves in place, column by column.
    pub(super) solve: &'a (dyn Fn(&mut [T]) -> Result<(), LinalgError> + Sync),
}

impl<T: Scalar> System<'_, T> {
    /// Norms of `v`.
    fn sizes(&self, v: &[T]) -> Sizes {
        let plain = norm(v.iter().copied());
        let scaled = |scale: &[f64]| norm(v.iter().zip(scale).map(|(&v, &scale)| v.scale(scale)));
        Sizes { plain, scaled: self.row_scale.map_or(plain, scaled) }
    }

    /// Relative residuals of the residual vector `r`.
    fn relative(&self, r: &[T], b: Sizes) -> Sizes {
        let ratio = |r: f64, b: f64| if r == 0.0 { 0.0 } else { r / b };
        let r = self.sizes(r);
        Sizes { plain: ratio(r.plain, b.plain), scaled: ratio(r.scaled, b.scaled) }
    }
}

/// Solves for every column of `rhs` and refines each.
pub(super) fn refined<T: Scalar>(system: &System<'_, T>, rhs: &[T]) -> Result<Solved<T>, LinalgError> {
    let mut x: Vec<T> = rhs.par_iter().copied().collect();
    let mut all =
        Solved { x: Vec::new(), residual: 0.0, scaled_residual: 0.0, backward_error: 0.0, refinement_steps: 0 };
    if rhs.is_empty() {
        return Ok(all);
    }
    let n = system.operator.matrix.nrows();
    for (x, b) in x.chunks_mut(GROUP * n).zip(rhs.chunks(GROUP * n)) {
        (system.solve)(x)?;
        let columns = x.par_chunks_exact_mut(n).zip(b.par_chunks_exact(n));
        let mut columns: Vec<Column<'_, T>> = columns.map(|(x, b)| Column::new(system, x, b)).collect();
        refine(system, &mut columns)?;
        for column in &mut columns {
            let relative = accept(system, column)?;
            all.residual = all.residual.max(relative.plain);
            all.scaled_residual = all.scaled_residual.max(relative.scaled);
            all.backward_error = all.backward_error.max(column.backward_error);
            all.refinement_steps = all.refinement_steps.max(column.steps);
        }
    }
    all.x = x;
    Ok(all)
}

/// Improves a refined solution by GMRES if necessary, and returns its relative residuals if it is accepted.
fn accept<T: Scalar>(system: &System<'_, T>, column: &mut Column<'_, T>) -> Result<Sizes, LinalgError> {
    let measure = |x: &[T]| {
        let mut r = vec![T::ZERO; x.len()];
        system.operator.residual(x, column.b, &mut r)?;
        Ok(system.relative(&r, column.b_sizes))
    };
    // Neither a NaN nor an infinity on either side is good.
    let good = |limit: f64, Sizes { plain, scaled }: Sizes| plain.min(scaled) <= limit && (plain + scaled).is_finite();
    let mut relative = column.relative;
    // Written so that a NaN counts as stalled.
    let converged = column.backward_error <= STALLED;
    let at_the_floor = converged && system.accept != Accept::Residual && system.is_faithful;
    if !good(GOAL, relative) && !converged {
        column.steps += gmres(system, column.x, column.b)?;
        relative = measure(column.x)?;
    }
    if good(LIMIT, relative) || at_the_floor {
        return Ok(relative);
    }
    Err(LinalgError::ResidualTooLarge { residual: relative.plain, limit: LIMIT })
}

/// Right-hand side with its current solution.
struct Column<'a, T> {
    x: &'a mut [T],
    b: &'a [T],
    /// Norms of b.
    b_sizes: Sizes,
    backward_error: f64,
    /// Relative residuals of `x`; NaN before the first measurement.
    relative: Sizes,
    steps: usize,
}

impl<'a, T: Scalar> Column<'a, T> {
    fn new(system: &System<'_, T>, x: &'a mut [T], b: &'a [T]) -> Self {
        let b_sizes = system.sizes(b);
        Self {
            x,
            b,
            b_sizes,
            backward_error: f64::INFINITY,
            relative: Sizes { plain: f64::NAN, scaled: f64::NAN },
            steps: 0,
        }
    }
}

/// Refines the solutions in place, all that still improve together.
fn refine<T: Scalar>(system: &System<'_, T>, columns: &mut [Column<'_, T>]) -> Result<(), LinalgError> {
    let n = system.operator.matrix.nrows();
    let mut active: Vec<&mut Column<'_, T>> = columns.iter_mut().collect();
    let mut r = vec![T::ZERO; active.len() * n];
    for step in 0..=MOST_STEPS {
        let judged = active.into_par_iter().zip(r.par_chunks_exact_mut(n));
        let judged: Vec<_> = judged.map(|(column, r)| (judge(system, column, r, step), column)).collect();
        let mut still = Vec::with_capacity(judged.len());
        for (place, (may_gain, column)) in judged.into_iter().enumerate() {
            if may_gain? && step < MOST_STEPS {
                r.copy_within(place * n..(place + 1) * n, still.len() * n);
                still.push(column);
            }
        }
        active = still;
        r.truncate(active.len() * n);
        if active.is_empty() {
            break;
        }
        (system.solve)(&mut r)?;
        active.par_iter_mut().zip(r.par_chunks_exact_mut(n)).for_each(|(column, r)| {
            // The previous solution stays in `r`, in case the step makes it worse.
            column.x.iter_mut().zip(r).for_each(|(x, r)| {
                let before = *x;
                *x += *r;
                *r = before;
            });
        });
    }
    Ok(())
}

/// Measures the residual after `step` steps. `r` holds the solution before the last step, which is restored if it was
/// better. Returns true if another step may help.
fn judge<T: Scalar>(
    system: &System<'_, T>,
    column: &mut Column<'_, T>,
    r: &mut [T],
    step: usize,
) -> Result<bool, LinalgError> {
    let Column { x, b, b_sizes, backward_error: before, relative, steps } = column;
    let previous = (step > 0).then(|| r.to_vec());
    let now = system.operator.backward_error(x, b, r)?;
    let better = now < *before;
    if !better {
        if let Some(previous) = previous {
            x.copy_from_slice(&previous);
        }
        return Ok(false);
    }
    *relative = system.relative(r, *b_sizes);
    *steps = step;
    let worthwhile = now <= WORTHWHILE * *before;
    *before = now;
    Ok(worthwhile && now > system.accept.goal())
}
