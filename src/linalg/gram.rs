//! Inner products of many columns.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par};

use super::Scalar;

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
