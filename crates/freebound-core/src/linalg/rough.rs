//! Real positive definite systems of which a few digits are enough, such as systems for a direction of descent.
//!
//! In double precision the solution comes from substitution alone. In single precision the factor takes half the
//! memory and half the time, and it is a preconditioner:
//!
//! ```text
//! S A S + δ I ≈ L Lᵀ  in f32,     S = diag(A)^−½,     δ = 0 if that can be factored
//! A x = b             by conjugate gradients in f64, preconditioned by S (L Lᵀ)⁻¹ S
//! ```
//!
//! S scales all entries to at most 1. The error of rounding, or of δ, in the softest modes costs an iteration or two
//! for each of them. Sums run over parts of fixed length, so that they do not depend on the number of threads.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::parallel::prelude::*;
use crate::parallel::reduce;

use super::analysis::{Shared, Symbolic};
use super::fronts::FrontAnalysis;
use super::llt::Llt;
use super::pattern::{Pattern, go_on_unless};
use super::{Analysis, LinalgError};

/// Multiples of the diagonal that are added if rounding to `f32` has made the matrix indefinite.
const SHIFTS: [f32; 3] = [0.0, 1e-6, 1e-5];

/// Largest accepted error of a solution in the norm of the matrix, relative to the error of x = 0. A direction of
/// descent then promises less energy decrease than the best direction by the square of this error. Usually a single
/// iteration suffices and leaves 1e-4 to 3e-3.
const GOAL: f64 = 1e-2;

/// Number of iterations after which a factor in double precision costs less.
const MOST_ITERATIONS: usize = 30;

/// Number of rows per task, also the length of a partial sum.
const ROWS_PER_TASK: usize = 4096;

/// Precision of a factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FactorPrecision {
    /// `f64`: solves by substitution.
    Double,
    /// `f32`: solves by conjugate gradients against the matrix in `f64`.
    Single,
}

/// Factored matrix. Holds the required data of its [`Analysis`], but not the matrix.
#[derive(Debug)]
pub struct RoughFactor {
    shared: Arc<Shared>,
    numeric: Numeric,
}

#[derive(Debug)]
enum Numeric {
    Double(Llt<f64>),
    /// Factor, and S.
    Single(Llt<f32>, Vec<f64>),
}

impl Analysis {
    /// Factors the positive definite matrix with the given values, in the order of the analysed pattern. Reuses the
    /// memory of an earlier factor: allocating new memory costs a considerable part of the time of a factorization.
    ///
    /// # Errors
    ///
    /// [`LinalgError::NotPositiveDefinite`]: in single precision rounding may be the reason.
    /// [`LinalgError::OtherPattern`] if the number of values or the kind of the analysis does not match;
    /// [`LinalgError::NotFinite`], [`LinalgError::Cancelled`].
    pub fn factor_roughly(
        &self,
        values: &[f64],
        precision: FactorPrecision,
        earlier: Option<RoughFactor>,
        cancel: &AtomicBool,
    ) -> Result<RoughFactor, LinalgError> {
        let Shared { pattern, symbolic } = &*self.shared;
        let Symbolic::Llt(analysis) = symbolic else { return Err(LinalgError::OtherPattern) };
        if values.len() != pattern.rows.len() {
            return Err(LinalgError::OtherPattern);
        }
        if let Some(place) = values.par_iter().position_first(|value| !value.is_finite()) {
            return Err(LinalgError::NotFinite { row: pattern.rows[place] as usize });
        }
        go_on_unless(cancel)?;
        let numeric = match (precision, earlier.map(|factor| factor.numeric)) {
            (FactorPrecision::Double, earlier) => {
                let earlier = earlier.and_then(|earlier| match earlier {
                    Numeric::Double(llt) => Some(llt),
                    Numeric::Single(..) => None,
                });
                Numeric::Double(Llt::of(analysis, &|source, _| values[source], earlier, cancel)?)
            }
            (FactorPrecision::Single, earlier) => {
                let earlier = earlier.and_then(|earlier| match earlier {
                    Numeric::Single(llt, _) => Some(llt),
                    Numeric::Double(_) => None,
                });
                let scale = scale(pattern, values)?;
                Numeric::Single(
                    in_single(analysis, &Scaled { pattern, values, scale: &scale }, earlier, cancel)?,
                    scale,
                )
            }
        };
        go_on_unless(cancel)?;
        Ok(RoughFactor { shared: Arc::clone(&self.shared), numeric })
    }
}

/// Scaled matrix S A S.
struct Scaled<'a> {
    pattern: &'a Pattern,
    values: &'a [f64],
    scale: &'a [f64],
}

/// Diagonal of S: the reciprocal root of each diagonal entry.
fn scale(pattern: &Pattern, values: &[f64]) -> Result<Vec<f64>, LinalgError> {
    let of = |row: usize| {
        let column = pattern.column(row);
        let place = column.partition_point(|&other| (other as usize) < row);
        let root = values[pattern.offsets[row] as usize + place].sqrt();
        // Also fails if the root is not a number.
        if root > 0.0 { Ok(root.recip()) } else { Err(LinalgError::NotPositiveDefinite { row }) }
    };
    (0..pattern.order()).map(of).collect()
}

fn in_single(
    analysis: &FrontAnalysis,
    Scaled { pattern, values, scale }: &Scaled<'_>,
    mut earlier: Option<Llt<f32>>,
    cancel: &AtomicBool,
) -> Result<Llt<f32>, LinalgError> {
    let mut failed = LinalgError::NotPositiveDefinite { row: 0 };
    for shift in SHIFTS {
        let value = |source: usize, column: usize| {
            let row = pattern.rows[source] as usize;
            let scaled = rounded(values[source] * scale[row] * scale[column]);
            if row == column { scaled + shift } else { scaled }
        };
        match Llt::of(analysis, &value, earlier.take(), cancel) {
            Err(error @ LinalgError::NotPositiveDefinite { .. }) => failed = error,
            other => return other,
        }
    }
    Err(failed)
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to 32 bits is what is wanted")]
fn rounded(value: f64) -> f32 {
    value as f32
}

impl RoughFactor {
    /// Solves A x = b for the matrix with the given values, which must be the factored values.
    ///
    /// # Errors
    ///
    /// [`LinalgError::ResidualTooLarge`] if factors in single precision are no good preconditioner;
    /// [`LinalgError::Cancelled`].
    ///
    /// # Panics
    ///
    /// If the length of the right-hand side is not the order of the system.
    pub fn solve(&self, values: &[f64], rhs: &[f64], cancel: &AtomicBool) -> Result<Vec<f64>, LinalgError> {
        let Shared { pattern, symbolic } = &*self.shared;
        assert_eq!(rhs.len(), pattern.order(), "one number per row");
        let Symbolic::Llt(analysis) = symbolic else { unreachable!("a factor is made by its own analysis") };
        match &self.numeric {
            Numeric::Double(llt) => {
                let mut x = rhs.to_vec();
                llt.solve_in_place(analysis, &mut x, cancel)?;
                Ok(x)
            }
            Numeric::Single(llt, scale) => {
                let precondition = |r: &[f64]| {
                    go_on_unless(cancel)?;
                    Preconditioner { analysis, llt, scale }.applied(r, cancel)
                };
                conjugate_gradients(&|x| product(pattern, values, x), &precondition, rhs)
            }
        }
    }
}

/// Preconditioner S (L Lᵀ)⁻¹ S.
struct Preconditioner<'a> {
    analysis: &'a FrontAnalysis,
    llt: &'a Llt<f32>,
    scale: &'a [f64],
}

impl Preconditioner<'_> {
    fn applied(&self, r: &[f64], cancel: &AtomicBool) -> Result<Vec<f64>, LinalgError> {
        let Self { analysis, llt, scale } = *self;
        let scaled = || r.par_iter().zip(scale).with_min_len(ROWS_PER_TASK).map(|(r, scale)| r * scale);
        // A maximum does not depend on the order.
        let largest = reduce(scaled().map(f64::abs), || 0.0, f64::max);
        if largest == 0.0 {
            return Ok(vec![0.0; r.len()]);
        }
        let mut x: Vec<f32> = scaled().map(|value| rounded(value / largest)).collect();
        llt.solve_in_place(analysis, &mut x, cancel)?;
        let wide =
            x.par_iter().zip(scale).with_min_len(ROWS_PER_TASK).map(|(&x, scale)| f64::from(x) * scale * largest);
        Ok(wide.collect())
    }
}

/// Solves A x = b by flexible conjugate gradients: a preconditioner in `f32` is not quite symmetric.
fn conjugate_gradients(
    product: &impl Fn(&[f64]) -> Vec<f64>,
    precondition: &impl Fn(&[f64]) -> Result<Vec<f64>, LinalgError>,
    rhs: &[f64],
) -> Result<Vec<f64>, LinalgError> {
    let mut x = vec![0.0; rhs.len()];
    let mut r = rhs.to_vec();
    let mut z = precondition(&r)?;
    let mut direction = z.clone();
    let first = dot(&r, &z);
    let mut size = first;
    for _ in 0..MOST_ITERATIONS {
        if size <= GOAL * GOAL * first {
            return Ok(x);
        }
        let image = product(&direction);
        let step = size / dot(&direction, &image);
        if !(step > 0.0 && step.is_finite()) {
            break;
        }
        add(&mut x, step, &direction);
        add(&mut r, -step, &image);
        z = precondition(&r)?;
        // The change of r is −step · image.
        let share = -step * dot(&image, &z) / size;
        size = dot(&r, &z);
        direction.par_iter_mut().zip(&z).with_min_len(ROWS_PER_TASK).for_each(|(d, z)| *d = z + share * *d);
    }
    Err(LinalgError::ResidualTooLarge { residual: (size / first).abs().sqrt(), limit: GOAL })
}

/// Product A x of a symmetric matrix, whose columns are its rows.
fn product(pattern: &Pattern, values: &[f64], x: &[f64]) -> Vec<f64> {
    let of = |row: usize| {
        let entries = pattern.offsets[row] as usize..pattern.offsets[row + 1] as usize;
        pattern.rows[entries.clone()]
            .iter()
            .zip(&values[entries])
            .map(|(&other, value)| value * x[other as usize])
            .sum()
    };
    (0..pattern.order()).into_par_iter().with_min_len(ROWS_PER_TASK).map(of).collect()
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    let parts = x.par_chunks(ROWS_PER_TASK).zip(y.par_chunks(ROWS_PER_TASK));
    let sums: Vec<f64> = parts.map(|(x, y)| x.iter().zip(y).map(|(x, y)| x * y).sum()).collect();
    sums.iter().sum()
}

/// Updates x ← x + share · y.
fn add(x: &mut [f64], share: f64, y: &[f64]) {
    x.par_iter_mut().zip(y).with_min_len(ROWS_PER_TASK).for_each(|(x, y)| *x += share * y);
}
