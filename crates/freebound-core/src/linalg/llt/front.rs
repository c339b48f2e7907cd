//! Assembly, elimination and update of a front; lower triangles alone.

use std::sync::atomic::AtomicBool;

use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, Par};
use nalgebra::ComplexField as _;

use crate::linalg::LinalgError;
use crate::linalg::fronts::{Gather, Shape, mat, mat_mut, scatter_add, threads_for};
use crate::linalg::pattern::go_on_unless;
use crate::linalg::scalar::Number;

/// Number of columns eliminated individually before a matrix product updates the rest of the block.
const BLOCK: usize = 32;

/// Dense front during factorization. The panel is memory of the factor.
pub(super) struct Front<'a, T> {
    pub(super) shape: Shape,
    /// L panel, `height` × `columns`; its upper triangle is unused.
    pub(super) left: &'a mut [T],
    /// Update, `below` × `below`; its upper triangle is unused.
    pub(super) update: &'a mut [T],
}

impl<T: Number> Gather<T> for Front<'_, T> {
    fn extend_add<S: Copy>(&mut self, update: &[S], relative: &[u32], number: impl Fn(S) -> T + Copy) {
        let Shape { columns, below } = self.shape;
        let height = self.shape.height();
        if relative.is_empty() {
            return;
        }
        for (k, (source, &column)) in update.chunks_exact(relative.len()).zip(relative).enumerate() {
            let (column, rows) = (column as usize, &relative[k..]);
            let source = source[k..].iter().copied().map(number);
            if column < columns {
                scatter_add(&mut self.left[column * height..][..height], rows, 0, source);
            } else {
                scatter_add(&mut self.update[(column - columns) * below..][..below], rows, columns, source);
            }
        }
    }
}

impl<T: Number> Front<'_, T> {
    /// Eliminates the front's columns and leaves the Schur complement in `update`. The row of an error is the first
    /// column without a positive pivot.
    pub(super) fn eliminate(&mut self, par: Par, cancel: &AtomicBool) -> Result<(), LinalgError> {
        let Shape { columns, below } = self.shape;
        let height = self.shape.height();
        factor_block(self.left, height, columns, cancel)?;
        if below == 0 {
            return Ok(());
        }
        go_on_unless(cancel)?;
        let (block, mut lower) = mat_mut(self.left, height, columns).split_at_row_mut(columns);
        // L₂₁ L₁₁ᴴ = A₂₁ as conj(L₁₁) L₂₁ᵀ = A₂₁ᵀ.
        solve_lower_triangular_in_place(block.as_ref().conjugate(), lower.as_mut().transpose_mut(), par);
        go_on_unless(cancel)?;
        subtract_product(mat_mut(self.update, below, below), lower.as_ref(), par);
        Ok(())
    }
}

/// Subtracts L Lᴴ from the lower triangle of a square.
fn subtract_product<T: Number>(square: faer::MatMut<'_, T>, lower: faer::MatRef<'_, T>, par: Par) {
    let (whole, triangle) = (BlockStructure::Rectangular, BlockStructure::TriangularLower);
    matmul(square, triangle, Accum::Add, lower, whole, lower.adjoint(), whole, -T::ONE, par);
}

/// Factors the lower triangle of the top `columns` × `columns` block of a panel (leading dimension `height`).
fn factor_block<T: Number>(
    panel: &mut [T],
    height: usize,
    columns: usize,
    cancel: &AtomicBool,
) -> Result<(), LinalgError> {
    for first in (0..columns).step_by(BLOCK) {
        go_on_unless(cancel)?;
        let last = (first + BLOCK).min(columns);
        for k in first..last {
            eliminate_column(panel, height, k, last..columns)?;
        }
        if last < columns {
            let (done, rest) = panel.split_at_mut(last * height);
            let lower = mat(done, height, last).submatrix(last, first, columns - last, last - first);
            let rest = mat_mut(&mut rest[..height * (columns - last)], height, columns - last);
            let par = threads_for(lower.nrows().pow(2) as f64 * lower.ncols() as f64);
            subtract_product(rest.subrows_mut(last, columns - last), lower, par);
        }
    }
    Ok(())
}

/// Divides column `k` by the root of its pivot and updates the columns before `rest`, within the block's rows.
fn eliminate_column<T: Number>(
    panel: &mut [T],
    height: usize,
    k: usize,
    rest: std::ops::Range<usize>,
) -> Result<(), LinalgError> {
    let (done, later) = panel.split_at_mut((k + 1) * height);
    let column = &mut done[k * height..][k..rest.end];
    let pivot = column[0].real();
    if !(pivot > T::ZERO.real() && pivot.is_finite()) {
        return Err(LinalgError::NotPositiveDefinite { row: k });
    }
    let root = pivot.sqrt();
    column[0] = T::from_real(root);
    let multipliers = &mut column[1..];
    for value in &mut *multipliers {
        *value = value.unscale(root);
    }
    for (j, target) in (0..).zip(later.chunks_exact_mut(height).take(rest.start - k - 1)) {
        let factor = multipliers[j].conjugate();
        for (value, &multiplier) in target[k + 1 + j..rest.end].iter_mut().zip(&multipliers[j..]) {
            *value -= multiplier * factor;
        }
    }
    Ok(())
}
