//! Dense LU of a diagonal block, with partial pivoting inside it.

use std::sync::atomic::AtomicBool;

use faer::{Accum, linalg};

use crate::linalg::LinalgError;
use crate::linalg::fronts::{mat, mat_mut, threads_for};
use crate::linalg::pattern::{go_on_unless, narrow};
use crate::linalg::scalar::Scalar;

/// Share of the largest candidate from which the diagonal entry is the pivot. Systems with positive weights need no
/// pivoting: elimination on their diagonal subtracts no numbers of similar size.
const DIAGONAL_PREFERENCE: f64 = 0.1;

/// Number of columns eliminated individually before a matrix product updates the rest of the block.
const BLOCK: usize = 32;

/// Row data of a block that pivoting uses and records.
pub(super) struct Pivots<'a> {
    /// Smallest accepted pivot of every row; swapped along with the rows.
    pub(super) thresholds: &'a mut [f64],
    /// Row `swaps[k]` was swapped with row `k`, in the order of `k`.
    pub(super) swaps: &'a mut [u32],
    /// Columns whose pivot was replaced.
    pub(super) replaced: Vec<usize>,
}

/// Factors the top `columns` × `columns` block of `panel` (leading dimension `height`); the rows of `right` are
/// swapped along.
pub(super) fn factor_block<T: Scalar>(
    panel: &mut [T],
    height: usize,
    right: &mut [T],
    pivots: &mut Pivots<'_>,
    cancel: &AtomicBool,
) -> Result<(), LinalgError> {
    let columns = pivots.swaps.len();
    for first in (0..columns).step_by(BLOCK) {
        go_on_unless(cancel)?;
        let last = (first + BLOCK).min(columns);
        for k in first..last {
            let row = choose(panel, height, k, pivots);
            pivots.swaps[k] = narrow(row);
            pivots.thresholds.swap(k, row);
            if row != k {
                panel.chunks_exact_mut(height).for_each(|column| column.swap(k, row));
                right.chunks_exact_mut(columns).for_each(|column| column.swap(k, row));
            }
            replace_if_tiny(panel, height, k, pivots);
            eliminate(panel, height, k, last, columns);
        }
        if last < columns {
            update_rest(panel, height, first..last, columns);
        }
    }
    Ok(())
}

fn choose<T: Scalar>(panel: &[T], height: usize, k: usize, pivots: &Pivots<'_>) -> usize {
    let candidates = &panel[k * height..][k..pivots.swaps.len()];
    let (mut best, mut largest) = (0, candidates[0].size());
    let diagonal = largest;
    for (row, value) in candidates.iter().enumerate().skip(1) {
        if value.size() > largest {
            (best, largest) = (row, value.size());
        }
    }
    if diagonal >= DIAGONAL_PREFERENCE * largest { k } else { k + best }
}

/// Static pivoting (Li and Demmel 1998, "Making sparse Gaussian elimination scalable by static pivoting").
fn replace_if_tiny<T: Scalar>(panel: &mut [T], height: usize, k: usize, pivots: &mut Pivots<'_>) {
    let pivot = &mut panel[k * height + k];
    let (size, threshold) = (pivot.size(), pivots.thresholds[k]);
    if size >= threshold {
        return;
    }
    // A NaN is replaced, too.
    *pivot = if size > 0.0 { pivot.scale(threshold / size) } else { T::from_real(threshold) };
    pivots.replaced.push(k);
}

/// Divides column `k` by its pivot and updates the columns up to `last`, within the block's rows.
fn eliminate<T: Scalar>(panel: &mut [T], height: usize, k: usize, last: usize, columns: usize) {
    let (done, rest) = panel.split_at_mut((k + 1) * height);
    let column = &mut done[k * height..][k..columns];
    let inverse = T::ONE / column[0];
    let multipliers = &mut column[1..];
    for value in &mut *multipliers {
        *value *= inverse;
    }
    for target in rest.chunks_exact_mut(height).take(last - k - 1) {
        let factor = target[k];
        if factor != T::ZERO {
            for (value, &multiplier) in target[k + 1..columns].iter_mut().zip(&*multipliers) {
                *value -= multiplier * factor;
            }
        }
    }
}

/// Updates the block's columns to the right of `done`.
fn update_rest<T: Scalar>(panel: &mut [T], height: usize, done: std::ops::Range<usize>, columns: usize) {
    let (left, rest) = panel.split_at_mut(done.end * height);
    let left = mat(left, height, done.end);
    let lower = left.submatrix(done.start, done.start, done.len(), done.len());
    let below = left.submatrix(done.end, done.start, columns - done.end, done.len());
    let rest = mat_mut(&mut rest[..height * (columns - done.end)], height, columns - done.end);
    let (_, rest) = rest.split_at_row_mut(done.start);
    let (mut top, rest) = rest.split_at_row_mut(done.len());
    let par = threads_for(below.nrows().pow(2) as f64 * below.ncols() as f64);
    linalg::triangular_solve::solve_unit_lower_triangular_in_place(lower, top.as_mut(), par);
    let (rest, _) = rest.split_at_row_mut(columns - done.end);
    linalg::matmul::matmul(rest, Accum::Add, below, top.as_ref(), -T::ONE, par);
}
