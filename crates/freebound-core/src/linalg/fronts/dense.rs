//! Slices as column-major matrices, and the addition of a child's rows to its parent's.

use faer::{MatMut, MatRef};

use crate::linalg::scalar::Number;

/// Adds numbers to the rows `rows` of a column whose first row is `first`.
pub(in crate::linalg) fn scatter_add<T: Number>(
    target: &mut [T],
    rows: &[u32],
    first: usize,
    numbers: impl Iterator<Item = T>,
) {
    for (&row, number) in rows.iter().zip(numbers) {
        target[row as usize - first] += number;
    }
}

/// Slice as a column-major matrix.
pub(in crate::linalg) fn mat<T>(values: &[T], rows: usize, columns: usize) -> MatRef<'_, T> {
    MatRef::from_column_major_slice(values, rows, columns)
}

/// Slice as a mutable column-major matrix.
pub(in crate::linalg) fn mat_mut<T>(values: &mut [T], rows: usize, columns: usize) -> MatMut<'_, T> {
    MatMut::from_column_major_slice_mut(values, rows, columns)
}
