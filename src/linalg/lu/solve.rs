//! Forward and backward substitution through the fronts.
//!
//! Several right-hand sides are taken [`TOGETHER`] at a time, so that the numbers of the factors are read once for all of
//! them; such groups run side by side. Large blocks go through faer's dense kernels, small ones through plain loops.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place, solve_unit_upper_triangular_in_place,
    solve_upper_triangular_in_place,
};
use faer::{Accum, MatRef, Par};
use rayon::prelude::*;

use super::factor::Lu;
use crate::linalg::fronts::{FrontAnalysis, LARGE_PANEL, Shape, TOGETHER, Work, dot, mat};
use crate::linalg::scalar::Scalar;
use crate::linalg::sparse::Operation;

/// One supernode's part of the factors.
struct Block<'a, T> {
    shape: Shape,
    begin: usize,
    rows: &'a [u32],
    left: &'a [T],
    right: &'a [T],
    swaps: &'a [u32],
}

impl<T: Scalar> Lu<T> {
    /// Solves op(A) x = b in place for each column of `columns` (column-major).
    pub(crate) fn solve_in_place(&self, analysis: &FrontAnalysis, operation: Operation, columns: &mut [T]) {
        let n = self.row_scale.len();
        if n == 0 {
            return;
        }
        columns.par_chunks_mut(TOGETHER * n).for_each(|columns| self.solve_group(analysis, operation, columns));
    }

    fn solve_group(&self, analysis: &FrontAnalysis, operation: Operation, columns: &mut [T]) {
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
            x.extend(order.iter().map(|&old| {
                let row = old as usize;
                conjugate(column[row]).scale(factor(before, row))
            }));
        }
        let mut work = Work::new(x, n);
        if operation == Operation::Plain {
            self.blocks(analysis).for_each(|block| block.forward(&mut work));
            self.blocks(analysis).rev().for_each(|block| block.backward(&mut work));
        } else {
            self.blocks(analysis).for_each(|block| block.forward_transpose(&mut work));
            self.blocks(analysis).rev().for_each(|block| block.backward_transpose(&mut work));
        }
        for (x, column) in work.columns().zip(columns.chunks_exact_mut(n)) {
            for (&x, &old) in x.iter().zip(order) {
                let row = old as usize;
                column[row] = conjugate(x).scale(factor(after, row));
            }
        }
    }

    fn blocks<'a>(&'a self, analysis: &'a FrontAnalysis) -> impl DoubleEndedIterator<Item = Block<'a, T>> {
        self.units.iter().zip(&analysis.units).flat_map(move |(factor, unit)| {
            let first_column = analysis.begin[unit.range.start] as usize;
            let mut starts = Vec::with_capacity(unit.range.len());
            let mut start = 0;
            for supernode in unit.range.clone() {
                starts.push(start);
                start += analysis.kept_len(supernode);
            }
            unit.range.clone().zip(starts).map(move |(supernode, start)| {
                let shape = analysis.shape(supernode);
                let begin = analysis.begin[supernode] as usize;
                let (left, right) =
                    factor.values[start..start + analysis.kept_len(supernode)].split_at(shape.left_len());
                let swaps = &factor.swaps[begin - first_column..][..shape.columns];
                Block { shape, begin, rows: analysis.rows.column(supernode), left, right, swaps }
            })
        })
    }
}

impl<'a, T: Scalar> Block<'a, T> {
    fn is_large(&self) -> bool {
        self.left.len() >= LARGE_PANEL
    }

    /// L₁₁\U₁₁, L₂₁ and U₁₂.
    fn parts(&self) -> (MatRef<'a, T>, MatRef<'a, T>, MatRef<'a, T>) {
        let Shape { columns, below } = self.shape;
        let (diagonal, lower) = mat(self.left, columns + below, columns).split_at_row(columns);
        (diagonal, lower, mat(self.right, columns, below))
    }

    /// The place of an outer row among the rows that follow the block's own.
    fn place(&self, row: u32) -> usize {
        row as usize - self.begin - self.shape.columns
    }

    /// L y = P b.
    fn forward(&self, work: &mut Work<T>) {
        for (own, _) in work.split(self.begin, self.shape) {
            for (k, &row) in self.swaps.iter().enumerate() {
                own.swap(k, row as usize);
            }
        }
        if self.is_large() {
            let (diagonal, lower, _) = self.parts();
            let (mut own, outer) = work.views(self.begin, self.shape);
            solve_unit_lower_triangular_in_place(diagonal, own.as_mut(), Par::Seq);
            matmul(outer, Accum::Replace, lower, own.as_ref(), T::ONE, Par::Seq);
            work.scatter_subtract(self.rows);
            return;
        }
        for (own, later) in work.split(self.begin, self.shape) {
            for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate() {
                let value = own[k];
                let (diagonal, below) = column.split_at(self.shape.columns);
                own[k + 1..].iter_mut().zip(&diagonal[k + 1..]).for_each(|(x, &l)| *x -= l * value);
                self.rows.iter().zip(below).for_each(|(&row, &l)| later[self.place(row)] -= l * value);
            }
        }
    }

    /// U x = y.
    fn backward(&self, work: &mut Work<T>) {
        if self.is_large() {
            let (diagonal, _, right) = self.parts();
            work.gather(self.rows);
            let (mut own, outer) = work.views(self.begin, self.shape);
            matmul(own.as_mut(), Accum::Add, right, outer.as_ref(), -T::ONE, Par::Seq);
            solve_upper_triangular_in_place(diagonal, own, Par::Seq);
            return;
        }
        for (own, later) in work.split(self.begin, self.shape) {
            for (column, &row) in self.right.chunks_exact(self.shape.columns).zip(self.rows) {
                let value = later[self.place(row)];
                own.iter_mut().zip(column).for_each(|(x, &u)| *x -= u * value);
            }
            for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate().rev() {
                let value = own[k] / column[k];
                own[k] = value;
                own[..k].iter_mut().zip(column).for_each(|(x, &u)| *x -= u * value);
            }
        }
    }

    /// Uᵀ y = b.
    fn forward_transpose(&self, work: &mut Work<T>) {
        if self.is_large() {
            let (diagonal, _, right) = self.parts();
            let (mut own, outer) = work.views(self.begin, self.shape);
            solve_lower_triangular_in_place(diagonal.transpose(), own.as_mut(), Par::Seq);
            matmul(outer, Accum::Replace, right.transpose(), own.as_ref(), T::ONE, Par::Seq);
            work.scatter_subtract(self.rows);
            return;
        }
        for (own, later) in work.split(self.begin, self.shape) {
            for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate() {
                let sum = dot(&own[..k], column);
                own[k] = (own[k] - sum) / column[k];
            }
            for (column, &row) in self.right.chunks_exact(self.shape.columns).zip(self.rows) {
                later[self.place(row)] -= dot(own, column);
            }
        }
    }

    /// Lᵀ x = y, then the swaps undone.
    fn backward_transpose(&self, work: &mut Work<T>) {
        if self.is_large() {
            let (diagonal, lower, _) = self.parts();
            work.gather(self.rows);
            let (mut own, outer) = work.views(self.begin, self.shape);
            matmul(own.as_mut(), Accum::Add, lower.transpose(), outer.as_ref(), -T::ONE, Par::Seq);
            solve_unit_upper_triangular_in_place(diagonal.transpose(), own, Par::Seq);
        } else {
            for (own, later) in work.split(self.begin, self.shape) {
                for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate().rev() {
                    let (diagonal, below) = column.split_at(self.shape.columns);
                    let inside = dot(&own[k + 1..], &diagonal[k + 1..]);
                    let outside = self.rows.iter().zip(below);
                    own[k] -= outside.fold(inside, |sum, (&row, &l)| sum + l * later[self.place(row)]);
                }
            }
        }
        for (own, _) in work.split(self.begin, self.shape) {
            for (k, &row) in self.swaps.iter().enumerate().rev() {
                own.swap(k, row as usize);
            }
        }
    }
}
