//! Products of a compressed-column matrix with a vector, norms, and inner products of many columns.

use std::sync::atomic::AtomicBool;

use crate::parallel::prelude::*;
use crate::parallel::{parallelism, reduce};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef};
use nalgebra_sparse::CscMatrix;

use super::LinalgError;
use super::pattern::go_on_unless;
use super::scalar::Scalar;

/// System of a matrix to solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operation {
    /// System A x = b.
    Plain,
    /// System Aᴴ x = b.
    Adjoint,
}

/// Rows of op(A), which threads can read independently, and the cancel flag.
#[derive(Clone, Copy)]
pub(super) struct Operator<'a, T> {
    pub(super) matrix: &'a CscMatrix<T>,
    /// Index of (j, i) for each entry (i, j), for A itself, whose pattern is symmetric. `None` for Aᴴ, whose rows are
    /// the conjugated columns of A.
    pub(super) places: Option<&'a [u32]>,
    pub(super) cancel: &'a AtomicBool,
}

/// Number of rows per task: enough to outweigh the scheduling.
const ROWS_PER_TASK: usize = 4096;

/// Euclidean norm, scaled so that it neither overflows nor underflows.
pub(super) fn norm<T: Scalar>(vector: impl Iterator<Item = T> + Clone) -> f64 {
    let largest = vector.clone().fold(0.0, |largest: f64, v| if v.size() <= largest { largest } else { v.size() });
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    // Two factors, because 1/largest overflows if `largest` is subnormal.
    let half = power_of_two_near(largest).sqrt().recip();
    let sum: f64 = vector.map(|v| v.scale(half).scale(half).modulus_squared()).sum();
    sum.sqrt() / half / half
}

/// Power of two at or just below a positive number, so that division by it does not round. For numbers below the
/// normal range, the smallest normal number.
pub(super) fn power_of_two_near(value: f64) -> f64 {
    const EXPONENT_MASK: u64 = 0x7ff0_0000_0000_0000;
    f64::from_bits(value.to_bits() & EXPONENT_MASK).max(f64::MIN_POSITIVE)
}

/// Returns an error with the first row that holds an entry which is not finite.
pub(super) fn check_finite<T: Scalar>(matrix: &CscMatrix<T>) -> Result<(), LinalgError> {
    let broken = matrix.row_indices().par_iter().zip(matrix.values()).filter(|(_, value)| !value.is_finite());
    broken.map(|(&row, _)| row).min().map_or(Ok(()), |row| Err(LinalgError::NotFinite { row }))
}

impl<T: Scalar> Operator<'_, T> {
    /// Entries of a row with their columns.
    fn row(&self, row: usize) -> impl Iterator<Item = (T, usize)> {
        let (offsets, columns, values) = self.matrix.csc_data();
        let places = self.places;
        (offsets[row]..offsets[row + 1]).map(move |k| {
            let value = places.map_or_else(|| values[k].conjugate(), |places| values[places[k] as usize]);
            (value, columns[k])
        })
    }

    /// Writes `rhs − op(A) x` into `out`.
    ///
    /// # Errors
    ///
    /// [`LinalgError::Cancelled`].
    pub(super) fn residual(&self, x: &[T], rhs: &[T], out: &mut [T]) -> Result<(), LinalgError> {
        go_on_unless(self.cancel)?;
        out.par_iter_mut().zip(rhs).with_min_len(ROWS_PER_TASK).enumerate().for_each(|(row, (out, &b))| {
            *out = b - self.row(row).fold(T::ZERO, |sum, (value, column)| sum + value * x[column]);
        });
        Ok(())
    }

    /// Writes `rhs − op(A) x` into `out` and returns the componentwise backward error maxᵢ |r|ᵢ / (|op(A)||x| + |b|)ᵢ
    /// of a solution with residual `r`. Sizes are measured by [`Scalar::size`]. A row with both 0 counts as 0.
    ///
    /// # Errors
    ///
    /// [`LinalgError::Cancelled`].
    pub(super) fn backward_error(&self, x: &[T], rhs: &[T], out: &mut [T]) -> Result<f64, LinalgError> {
        go_on_unless(self.cancel)?;
        // `max` would drop a NaN.
        let worse = |worst: f64, ratio: f64| if ratio <= worst || worst.is_nan() { worst } else { ratio };
        let ratios = out.par_iter_mut().zip(rhs).with_min_len(ROWS_PER_TASK).enumerate().map(|(row, (out, &b))| {
            let add = |(sum, size): (T, f64), (value, column): (T, usize)| {
                (sum + value * x[column], size + value.size() * x[column].size())
            };
            let (sum, size) = self.row(row).fold((T::ZERO, 0.0), add);
            *out = b - sum;
            if out.size() == 0.0 { 0.0 } else { out.size() / (b.size() + size) }
        });
        Ok(reduce(ratios, || 0.0, worse))
    }
}

/// Gram matrix Wᴴ W, column-major and Hermitian to the last bit. W is column-major with `n` rows.
pub fn gram<T: Scalar>(columns: &[T], n: usize) -> Vec<T> {
    let k = columns.len().checked_div(n).unwrap_or(0);
    let w = MatRef::from_column_major_slice(columns, n, k);
    let mut product: Mat<T> = Mat::zeros(k, k);
    matmul(product.as_mut(), Accum::Replace, w.adjoint(), w, T::ONE, parallelism());
    let entry = |i: usize, j: usize| match i.cmp(&j) {
        std::cmp::Ordering::Less => product[(i, j)],
        std::cmp::Ordering::Equal => T::from_real(product[(i, i)].real()),
        std::cmp::Ordering::Greater => product[(j, i)].conjugate(),
    };
    (0..k * k).map(|at| entry(at % k, at / k)).collect()
}
