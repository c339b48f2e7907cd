//! Products of a compressed-column matrix with a vector, norms, and inner products of many columns.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par};
use nalgebra_sparse::CscMatrix;
use rayon::prelude::*;

use super::LinalgError;
use super::scalar::Scalar;

/// Which of the two systems of a matrix is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operation {
    /// A x = b.
    Plain,
    /// Aᴴ x = b.
    Adjoint,
}

/// Writes `rhs − op(A) x` into `out`.
pub(super) fn residual<T: Scalar>(matrix: &CscMatrix<T>, operation: Operation, x: &[T], rhs: &[T], out: &mut [T]) {
    let (offsets, rows, values) = matrix.csc_data();
    out.copy_from_slice(rhs);
    let columns = offsets.windows(2).map(|pair| (&rows[pair[0]..pair[1]], &values[pair[0]..pair[1]]));
    match operation {
        Operation::Plain => {
            for ((rows, values), &xj) in columns.zip(x) {
                for (&row, &value) in rows.iter().zip(values) {
                    out[row] -= value * xj;
                }
            }
        }
        Operation::Adjoint => {
            out.par_iter_mut().with_min_len(ROWS_PER_TASK).enumerate().for_each(|(column, out)| {
                let entries = offsets[column]..offsets[column + 1];
                let entries = rows[entries.clone()].iter().zip(&values[entries]);
                *out -= entries.fold(T::ZERO, |sum, (&row, &value)| sum + value.conjugate() * x[row]);
            });
        }
    }
}

/// Rows that share the work of one task: enough to outweigh the handing out.
const ROWS_PER_TASK: usize = 4096;

/// The Euclidean norm, scaled so that it neither overflows nor underflows.
pub(super) fn norm<T: Scalar>(vector: impl Iterator<Item = T> + Clone) -> f64 {
    let largest = vector.clone().fold(0.0, |largest: f64, v| if v.size() <= largest { largest } else { v.size() });
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    // Two factors, because 1/largest overflows where `largest` is subnormal.
    let half = power_of_two_near(largest).sqrt().recip();
    let sum: f64 = vector.map(|v| v.scale(half).scale(half).modulus_squared()).sum();
    sum.sqrt() / half / half
}

/// The power of two at or just below a positive number, so that dividing by it rounds nothing. For numbers below the
/// normal range it is the smallest normal number.
pub(super) fn power_of_two_near(value: f64) -> f64 {
    const EXPONENT_MASK: u64 = 0x7ff0_0000_0000_0000;
    f64::from_bits(value.to_bits() & EXPONENT_MASK).max(f64::MIN_POSITIVE)
}

/// The first row that holds an entry which is not finite, as an error.
pub(super) fn check_finite<T: Scalar>(matrix: &CscMatrix<T>) -> Result<(), LinalgError> {
    let broken = matrix.row_indices().iter().zip(matrix.values()).filter(|(_, value)| !value.is_finite());
    broken.map(|(&row, _)| row).min().map_or(Ok(()), |row| Err(LinalgError::NotFinite { row }))
}

/// The componentwise backward error maxᵢ |r|ᵢ / (|op(A)||x| + |b|)ᵢ of an answer with residual `r`, sizes measured by
/// [`Scalar::size`]. A row with both 0 counts as 0.
pub(super) fn backward_error<T: Scalar>(
    matrix: &CscMatrix<T>,
    operation: Operation,
    x: &[T],
    rhs: &[T],
    r: &[T],
) -> f64 {
    let (offsets, rows, values) = matrix.csc_data();
    // `max` would drop a NaN.
    let worse = |worst: f64, ratio: f64| if ratio <= worst || worst.is_nan() { worst } else { ratio };
    let ratio = |r: T, scale: f64| if r.size() == 0.0 { 0.0 } else { r.size() / scale };
    if operation == Operation::Adjoint {
        let ratios = r.par_iter().with_min_len(ROWS_PER_TASK).enumerate().map(|(column, &r)| {
            let entries = offsets[column]..offsets[column + 1];
            let entries = rows[entries.clone()].iter().zip(&values[entries]);
            let sum: f64 = entries.map(|(&row, value)| value.size() * x[row].size()).sum();
            ratio(r, rhs[column].size() + sum)
        });
        return ratios.reduce(|| 0.0, worse);
    }
    let mut scale: Vec<f64> = rhs.iter().map(|b| b.size()).collect();
    for (column, pair) in offsets.windows(2).enumerate() {
        let size = x[column].size();
        let entries = rows[pair[0]..pair[1]].iter().zip(&values[pair[0]..pair[1]]);
        entries.for_each(|(&row, value)| scale[row] += value.size() * size);
    }
    r.iter().zip(scale).map(|(&r, scale)| ratio(r, scale)).fold(0.0, worse)
}

/// Wᴴ W of the columns of W, `n` entries each, one after another: Hermitian to the last bit, column by column.
pub fn gram<T: Scalar>(columns: &[T], n: usize) -> Vec<T> {
    let k = columns.len().checked_div(n).unwrap_or(0);
    let w = MatRef::from_column_major_slice(columns, n, k);
    let mut product: Mat<T> = Mat::zeros(k, k);
    matmul(product.as_mut(), Accum::Replace, w.adjoint(), w, T::ONE, Par::rayon(0));
    let entry = |i: usize, j: usize| match i.cmp(&j) {
        std::cmp::Ordering::Less => product[(i, j)],
        std::cmp::Ordering::Equal => T::from_real(product[(i, i)].real()),
        std::cmp::Ordering::Greater => product[(j, i)].conjugate(),
    };
    (0..k * k).map(|at| entry(at % k, at / k)).collect()
}
