//! Forward and backward substitution through the fronts.
//!
//! Up to [`TOGETHER`] right-hand sides are solved together, so that the numbers of the factors are read only once for
//! all of them. Such groups run in parallel. Large blocks use the dense kernels of faer, small blocks plain loops.

use std::sync::atomic::AtomicBool;

use crate::parallel::prelude::*;
use faer::Par;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place, solve_unit_upper_triangular_in_place,
    solve_upper_triangular_in_place,
};

use super::factor::Lu;
use crate::linalg::LinalgError;
use crate::linalg::fronts::{
    FrontAnalysis, FrontNumbers, LARGE_PANEL, Part, Shape, Substitution, TOGETHER, dot, mat, split_panel, substitute,
    subtract_product,
};
use crate::linalg::pattern::go_on_unless;
use crate::linalg::scalar::Scalar;
use crate::linalg::sparse::Operation;

/// Part of the factors of a supernode.
struct Block<'a, T> {
    left: &'a [T],
    right: &'a [T],
    swaps: &'a [u32],
}

impl<T: Scalar> Lu<T> {
    /// Solves op(A) x = b in place for each column of `columns` (column-major).
    ///
    /// # Errors
    ///
    /// [`LinalgError::Cancelled`].
    pub(crate) fn solve_in_place(
        &self,
        analysis: &FrontAnalysis,
        operation: Operation,
        columns: &mut [T],
        cancel: &AtomicBool,
    ) -> Result<(), LinalgError> {
        let n = self.row_scale.len();
        if n == 0 {
            return Ok(());
        }
        columns
            .par_chunks_mut(TOGETHER * n)
            .try_for_each(|columns| self.solve_group(analysis, operation, columns, cancel))
    }

    fn solve_group(
        &self,
        analysis: &FrontAnalysis,
        operation: Operation,
        columns: &mut [T],
        cancel: &AtomicBool,
    ) -> Result<(), LinalgError> {
        let n = self.row_scale.len();
        let conjugate = |x: T| if operation == Operation::Adjoint { x.conjugate() } else { x };
        let (before, after) = match operation {
            Operation::Plain => (Some(&self.row_scale), None),
            Operation::Adjoint => (None, Some(&self.row_scale)),
        };
        let factor = |scale: Option<&Vec<f64>>, row: usize| scale.map_or(1.0, |scale| scale[row]);
        let order = &analysis.order.new_to_old;
        let mut x = Vec::with_capacity(columns.len());
        for column in columns.chunks_exact(n) {
            go_on_unless(cancel)?;
            x.extend(order.iter().map(|&old| {
                let row = old as usize;
                conjugate(column[row]).scale(factor(before, row))
            }));
        }
        let blocks = Blocks { analysis, factor: self };
        if operation == Operation::Plain {
            substitute(analysis, &Plain(blocks), &mut x, cancel)?;
        } else {
            substitute(analysis, &Transposed(blocks), &mut x, cancel)?;
        }
        for (x, column) in x.chunks_exact(n).zip(columns.chunks_exact_mut(n)) {
            for (&x, &old) in x.iter().zip(order) {
                let row = old as usize;
                column[row] = conjugate(x).scale(factor(after, row));
            }
        }
        Ok(())
    }
}

/// Blocks of all fronts.
struct Blocks<'a, T: Scalar> {
    analysis: &'a FrontAnalysis,
    factor: &'a Lu<T>,
}

/// Substitution for L U x = b.
struct Plain<'a, T: Scalar>(Blocks<'a, T>);

/// Substitution for Uᵀ Lᵀ x = b.
struct Transposed<'a, T: Scalar>(Blocks<'a, T>);

impl<T: Scalar> Blocks<'_, T> {
    /// Applies a front's block to its part of the right-hand sides, in full numbers or by parts.
    fn act(&self, act: Act, supernode: usize, part: Part<'_, T>) {
        let (analysis, shape) = (self.analysis, part.shape);
        let unit = analysis.unit_of[supernode] as usize;
        let factor = &self.factor.units[unit];
        let first = (analysis.begin[supernode] - analysis.begin[analysis.units[unit].range.start]) as usize;
        let swaps = &factor.swaps[first..][..shape.columns];
        match self.factor.places.numbers_of(analysis, supernode, &factor.values) {
            FrontNumbers::Full(numbers) => Block::new(numbers, shape, swaps).act(act, part),
            FrontNumbers::Real(numbers) => part.by_parts(|part| Block::new(numbers, shape, swaps).act(act, part)),
        }
    }
}

/// Operation of a block on right-hand sides.
#[derive(Clone, Copy)]
enum Act {
    Forward,
    Backward,
    ForwardTranspose,
    BackwardTranspose,
}

impl<T: Scalar> Substitution<T> for Plain<'_, T> {
    fn up(&self, supernode: usize, part: Part<'_, T>) {
        self.0.act(Act::Forward, supernode, part);
    }
    fn down(&self, supernode: usize, part: Part<'_, T>) {
        self.0.act(Act::Backward, supernode, part);
    }
}

impl<T: Scalar> Substitution<T> for Transposed<'_, T> {
    fn up(&self, supernode: usize, part: Part<'_, T>) {
        self.0.act(Act::ForwardTranspose, supernode, part);
    }
    fn down(&self, supernode: usize, part: Part<'_, T>) {
        self.0.act(Act::BackwardTranspose, supernode, part);
    }
}

impl<'a, T> Block<'a, T> {
    /// Block of the numbers of the L panel followed by the numbers of the U panel.
    fn new(numbers: &'a [T], shape: Shape, swaps: &'a [u32]) -> Self {
        let (left, right) = numbers.split_at(shape.left_len());
        Self { left, right, swaps }
    }
}

impl<T: Scalar> Block<'_, T> {
    fn act(&self, act: Act, part: Part<'_, T>) {
        match act {
            Act::Forward => self.forward(part),
            Act::Backward => self.backward(part),
            Act::ForwardTranspose => self.forward_transpose(part),
            Act::BackwardTranspose => self.backward_transpose(part),
        }
    }

    fn is_large(&self) -> bool {
        self.left.len() >= LARGE_PANEL
    }

    /// Solves L y = P b.
    fn forward(&self, mut part: Part<'_, T>) {
        let shape = part.shape;
        for (own, _) in part.each() {
            for (k, &row) in self.swaps.iter().enumerate() {
                own.swap(k, row as usize);
            }
        }
        if self.is_large() {
            let (diagonal, lower) = split_panel(self.left, shape);
            let (mut own, outer) = part.matrices();
            solve_unit_lower_triangular_in_place(diagonal, own.as_mut(), Par::Seq);
            subtract_product(outer, lower, own.as_ref());
            return;
        }
        for (own, outer) in part.each() {
            for (k, column) in self.left.chunks_exact(shape.height()).enumerate() {
                let value = own[k];
                let (diagonal, below) = column.split_at(shape.columns);
                own[k + 1..].iter_mut().zip(&diagonal[k + 1..]).for_each(|(x, &l)| *x -= l * value);
                outer.iter_mut().zip(below).for_each(|(x, &l)| *x -= l * value);
            }
        }
    }

    /// Solves U x = y.
    fn backward(&self, mut part: Part<'_, T>) {
        let shape = part.shape;
        if self.is_large() {
            let (diagonal, _) = split_panel(self.left, shape);
            let right = mat(self.right, shape.columns, shape.below);
            let (mut own, outer) = part.matrices();
            subtract_product(own.as_mut(), right, outer.as_ref());
            solve_upper_triangular_in_place(diagonal, own, Par::Seq);
            return;
        }
        for (own, outer) in part.each() {
            for (column, &value) in self.right.chunks_exact(shape.columns).zip(&*outer) {
                own.iter_mut().zip(column).for_each(|(x, &u)| *x -= u * value);
            }
            for (k, column) in self.left.chunks_exact(shape.height()).enumerate().rev() {
                let value = own[k] / column[k];
                own[k] = value;
                own[..k].iter_mut().zip(column).for_each(|(x, &u)| *x -= u * value);
            }
        }
    }

    /// Solves Uᵀ y = b.
    fn forward_transpose(&self, mut part: Part<'_, T>) {
        let shape = part.shape;
        if self.is_large() {
            let (diagonal, _) = split_panel(self.left, shape);
            let right = mat(self.right, shape.columns, shape.below);
            let (mut own, outer) = part.matrices();
            solve_lower_triangular_in_place(diagonal.transpose(), own.as_mut(), Par::Seq);
            subtract_product(outer, right.transpose(), own.as_ref());
            return;
        }
        for (own, outer) in part.each() {
            for (k, column) in self.left.chunks_exact(shape.height()).enumerate() {
                let sum = dot(&own[..k], column);
                own[k] = (own[k] - sum) / column[k];
            }
            for (column, x) in self.right.chunks_exact(shape.columns).zip(outer) {
                *x -= dot(own, column);
            }
        }
    }

    /// Solves Lᵀ x = y and undoes the swaps.
    fn backward_transpose(&self, mut part: Part<'_, T>) {
        let shape = part.shape;
        if self.is_large() {
            let (diagonal, lower) = split_panel(self.left, shape);
            let (mut own, outer) = part.matrices();
            subtract_product(own.as_mut(), lower.transpose(), outer.as_ref());
            solve_unit_upper_triangular_in_place(diagonal.transpose(), own, Par::Seq);
        } else {
            for (own, outer) in part.each() {
                for (k, column) in self.left.chunks_exact(shape.height()).enumerate().rev() {
                    let (diagonal, below) = column.split_at(shape.columns);
                    own[k] -= dot(&own[k + 1..], &diagonal[k + 1..]) + dot(outer, below);
                }
            }
        }
        for (own, _) in part.each() {
            for (k, &row) in self.swaps.iter().enumerate().rev() {
                own.swap(k, row as usize);
            }
        }
    }
}
