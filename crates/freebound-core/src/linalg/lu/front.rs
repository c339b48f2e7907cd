//! Assembly, elimination and update of a front.

use std::sync::atomic::AtomicBool;

use faer::{Accum, Par, linalg};

use super::pivot::{Pivots, factor_block};
use crate::linalg::LinalgError;
use crate::linalg::fronts::{Gather, Shape, mat_mut, scatter_add};
use crate::linalg::pattern::go_on_unless;
use crate::linalg::scalar::Scalar;

/// Dense front during factorization. Both panels are memory of the factor.
pub(super) struct Front<'a, T> {
    pub(super) shape: Shape,
    /// L panel, `height` × `columns`.
    pub(super) left: &'a mut [T],
    /// U panel, `columns` × `below`.
    pub(super) right: &'a mut [T],
    /// Update, `below` × `below`.
    pub(super) update: &'a mut [T],
}

impl<T: Scalar> Gather<T> for Front<'_, T> {
    fn extend_add<S: Copy>(&mut self, update: &[S], relative: &[u32], number: impl Fn(S) -> T + Copy) {
        let Shape { columns, below } = self.shape;
        let height = self.shape.height();
        if relative.is_empty() {
            return;
        }
        let inside = relative.partition_point(|&row| (row as usize) < columns);
        let (upper_rows, lower_rows) = relative.split_at(inside);
        for (source, &column) in update.chunks_exact(relative.len()).zip(relative) {
            let column = column as usize;
            if column < columns {
                scatter_add(
                    &mut self.left[column * height..][..height],
                    relative,
                    0,
                    source.iter().copied().map(number),
                );
            } else {
                let column = column - columns;
                let (upper, lower) = source.split_at(inside);
                let [upper, lower] = [upper, lower].map(|some| some.iter().copied().map(number));
                scatter_add(&mut self.right[column * columns..][..columns], upper_rows, 0, upper);
                scatter_add(&mut self.update[column * below..][..below], lower_rows, columns, lower);
            }
        }
    }
}

impl<T: Scalar> Front<'_, T> {
    /// Eliminates the front's columns and leaves the Schur complement in `update`.
    pub(super) fn eliminate(
        &mut self,
        pivots: &mut Pivots<'_>,
        par: Par,
        cancel: &AtomicBool,
    ) -> Result<(), LinalgError> {
        let Shape { columns, below } = self.shape;
        let height = self.shape.height();
        factor_block(self.left, height, self.right, pivots, cancel)?;
        if below == 0 {
            return Ok(());
        }
        go_on_unless(cancel)?;
        let (block, mut lower) = mat_mut(self.left, height, columns).split_at_row_mut(columns);
        let block = block.as_ref();
        let mut right = mat_mut(self.right, columns, below);
        linalg::triangular_solve::solve_unit_lower_triangular_in_place(block, right.as_mut(), par);
        go_on_unless(cancel)?;
        // L₂₁ U₁₁ = A₂₁ as U₁₁ᵀ L₂₁ᵀ = A₂₁ᵀ.
        linalg::triangular_solve::solve_lower_triangular_in_place(
            block.transpose(),
            lower.as_mut().transpose_mut(),
            par,
        );
        go_on_unless(cancel)?;
        let update = mat_mut(self.update, below, below);
        linalg::matmul::matmul(update, Accum::Add, lower.as_ref(), right.as_ref(), -T::ONE, par);
        Ok(())
    }
}
