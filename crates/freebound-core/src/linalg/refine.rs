//! Iterative refinement: what makes an answer as good as the matrix allows.
//!
//! ```text
//! r = b − A x,   x ← x + (LU)⁻¹ r     until   ω = maxᵢ |r|ᵢ / (|A||x| + |b|)ᵢ   stops falling
//! ```
//!
//! ω is the componentwise backward error (Arioli, Demmel and Duff 1989, "Solving sparse linear systems with sparse
//! backward error"): it does not depend on the scale of the rows. Where refinement stalls above the goal, GMRES
//! preconditioned with the same factors takes over.

use crate::parallel::prelude::*;

use super::LinalgError;
use super::gmres::gmres;
use super::scalar::Scalar;
use super::sparse::{Operator, norm};

/// Answers with a larger relative residual are errors.
const LIMIT: f64 = 1e-10;

/// Above this, GMRES is tried, but only where refinement stalled as well.
const GOAL: f64 = 1e-12;

/// A larger backward error means that the factors are those of another matrix. With a smaller one a large residual
/// comes from a large ‖A‖‖x‖/‖b‖, which no method can better in working precision.
const STALLED: f64 = 1e3 * f64::EPSILON;

/// A componentwise backward error of so many units of rounding cannot be bettered in working precision.
const GOOD_BACKWARD_ERROR: f64 = 2.0 * f64::EPSILON;

/// One of so many is what substitution mostly leaves.
const SMALL_BACKWARD_ERROR: f64 = 64.0 * f64::EPSILON;

/// A step must at least halve the backward error to be followed by another.
const WORTHWHILE: f64 = 0.5;

/// Two steps are the rule; more help only where pivots were replaced.
const MOST_STEPS: usize = 8;

/// Right-hand sides refined together; each takes three vectors meanwhile.
const GROUP: usize = 8;

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
    /// The componentwise backward error that refinement reached, of the worst right-hand side: a few units of rounding
    /// where the answer is as good as the numbers allow.
    pub backward_error: f64,
    /// Steps of refinement that were kept, and of GMRES; the most for any right-hand side.
    pub refinement_steps: usize,
}

/// What makes an answer good.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Accept {
    /// A small relative residual.
    Residual,
    /// That, or a backward error of a few units of rounding by faithful factors. For right-hand sides that are far
    /// smaller than ‖A‖‖x‖, where ‖A‖‖x‖ε alone can pass the limit of the relative residual.
    BackwardError,
    /// The same, and not refined where substitution leaves a small backward error. For answers that others are made of, and
    /// these are refined.
    SmallBackwardError,
}

impl Accept {
    /// The backward error at which refinement ends.
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
    /// Whether the factors are those of the matrix up to rounding: no pivot was replaced.
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

    /// The relative residuals that `r` is of.
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

/// Betters a refined answer by GMRES if need be, and returns its relative residuals if they are good.
fn accept<T: Scalar>(system: &System<'_, T>, column: &mut Column<'_, T>) -> Result<Sizes, LinalgError> {
    let measure = |x: &[T]| {
        let mut r = vec![T::ZERO; x.len()];
        system.operator.residual(x, column.b, &mut r)?;
        Ok(system.relative(&r, column.b_sizes))
    };
    // A NaN is not good, and neither is an infinity on one side.
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

/// One right-hand side and its answer under way.
struct Column<'a, T> {
    x: &'a mut [T],
    b: &'a [T],
    /// ‖b‖.
    b_sizes: Sizes,
    backward_error: f64,
    /// The relative residuals of `x`; no numbers before it was judged.
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

/// Refines the answers in place, all that still gain by it together.
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
            // The answer so far stays in `r`, in case the step makes it worse.
            column.x.iter_mut().zip(r).for_each(|(x, r)| {
                let before = *x;
                *x += *r;
                *r = before;
            });
        });
    }
    Ok(())
}

/// Takes the residual after `step` steps. `r` holds the answer before the last, which comes back if that was
/// better. Returns whether another step may help.
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
