//! Real positive definite systems of which a few digits are enough, such as those of a direction of descent.
//!
//! In double precision the answer is that of the substitution alone. In single precision the factor takes half the memory
//! and half the time, and it is a preconditioner:
//!
//! ```text
//! S A S + δ I ≈ L Lᵀ  in f32,     S = diag(A)^−½,     δ = 0 where that can be factored
//! A x = b             by conjugate gradients in f64, preconditioned by S (L Lᵀ)⁻¹ S
//! ```
//!
//! S brings all entries to at most 1, whatever their size. What rounding makes of the softest modes, or δ, costs an
//! iteration or two for each of them. Sums run over parts of fixed length, so that they are the same for any number of
//! threads.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::parallel::prelude::*;
use crate::parallel::reduce;

use super::analysis::{Shared, Symbolic};
use super::fronts::FrontAnalysis;
use super::llt::Llt;
use super::pattern::{Pattern, go_on_unless};
use super::{Analysis, LinalgError};

/// Multiples of the diagonal that are added where rounding to `f32` has made the matrix indefinite.
const SHIFTS: [f32; 3] = [0.0, 1e-6, 1e-5];

/// The error that is left of an answer, in the norm of the matrix, by that of x = 0: a direction of descent promises less
/// energy than the best one by the square of it. One iteration is the rule, which leaves 1e-4 to 3e-3.
const GOAL: f64 = 1e-2;

/// Iterations after which a factor in double precision costs less.
const MOST_ITERATIONS: usize = 30;

/// Rows that share the work of one task, and are summed by it.
const ROWS_PER_TASK: usize = 4096;

/// What a factor is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FactorPrecision {
    /// `f64`: answers by substitution.
    Double,
    /// `f32`: answers by conjugate gradients against the matrix in `f64`.
    Single,
}

/// A factored matrix. It keeps what it needs of its [`Analysis`], but not the matrix.
#[derive(Debug)]
pub struct RoughFactor {
    shared: Arc<Shared>,
    numeric: Numeric,
}

#[derive(Debug)]
enum Numeric {
    Double(Llt<f64>),
    /// The factor, and S.
    Single(Llt<f32>, Vec<f64>),
}

impl Analysis {
    /// Factors the positive definite matrix with these values, which stand in the order of the analysed pattern, in the
    /// memory of a factor that is no longer needed: new memory costs a good part of the time of a factorization.
    ///
    /// # Errors
    ///
    /// [`LinalgError::NotPositiveDefinite`]: in single precision that may be rounding's doing.
    /// [`LinalgError::OtherPattern`] where the number of values is another, or the analysis is of another kind;
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

/// S A S.
struct Scaled<'a> {
    pattern: &'a Pattern,
    values: &'a [f64],
    scale: &'a [f64],
}

/// S, one over the root of each entry of the diagonal.
fn scale(pattern: &Pattern, values: &[f64]) -> Result<Vec<f64>, LinalgError> {
    let of = |row: usize| {
        let column = pattern.column(row);
        let place = column.partition_point(|&other| (other as usize) < row);
        let root = values[pattern.offsets[row] as usize + place].sqrt();
        // Also where the root is not a number.
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
    /// Solves A x = b for the matrix with these values, which must be those that were factored.
    ///
    /// # Errors
    ///
    /// [`LinalgError::ResidualTooLarge`] where factors in single precision are no good preconditioner;
    /// [`LinalgError::Cancelled`].
    ///
    /// # Panics
    ///
    /// If the right-hand side has another length than the system.
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

/// S (L Lᵀ)⁻¹ S.
struct Preconditioner<'a> {
    analysis: &'a FrontAnalysis,
    llt: &'a Llt<f32>,
    scale: &'a [f64],
}

impl Preconditioner<'_> {
    fn applied(&self, r: &[f64], cancel: &AtomicBool) -> Result<Vec<f64>, LinalgError> {
        let Self { analysis, llt, scale } = *self;
        let scaled = || r.par_iter().zip(scale).with_min_len(ROWS_PER_TASK).map(|(r, scale)| r * scale);
        // The same maximum in any order.
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

/// Solves A x = b by conjugate gradients; flexible ones, for a preconditioner in `f32` is not quite symmetric.
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
        // What is new of r is −step · image.
        let share = -step * dot(&image, &z) / size;
        size = dot(&r, &z);
        direction.par_iter_mut().zip(&z).with_min_len(ROWS_PER_TASK).for_each(|(d, z)| *d = z + share * *d);
    }
    Err(LinalgError::ResidualTooLarge { residual: (size / first).abs().sqrt(), limit: GOAL })
}

/// A x of a symmetric matrix: its columns are its rows.
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

/// x ← x + share · y.
fn add(x: &mut [f64], share: f64, y: &[f64]) {
    x.par_iter_mut().zip(y).with_min_len(ROWS_PER_TASK).for_each(|(x, y)| *x += share * y);
}
