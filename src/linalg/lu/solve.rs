//! Forward and backward substitution through the fronts.

use super::factor::Lu;
use super::symbolic::{LuAnalysis, Shape};
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
    pub(crate) fn solve_in_place(&self, analysis: &LuAnalysis, operation: Operation, columns: &mut [T]) {
        let n = self.row_scale.len();
        if n == 0 {
            return;
        }
        let mut work = vec![T::ZERO; n];
        for column in columns.chunks_exact_mut(n) {
            let gathered = analysis.order.new_to_old.iter().map(|&old| old as usize);
            match operation {
                Operation::Plain => {
                    let scaled = gathered.clone().map(|old| column[old].scaled(self.row_scale[old]));
                    work.iter_mut().zip(scaled).for_each(|(x, b)| *x = b);
                    self.blocks(analysis).for_each(|block| block.forward(&mut work));
                    self.blocks(analysis).rev().for_each(|block| block.backward(&mut work));
                    work.iter().zip(gathered).for_each(|(&x, old)| column[old] = x);
                }
                Operation::Transpose | Operation::Adjoint => {
                    let conjugate = |x: T| if operation == Operation::Adjoint { x.conjugated() } else { x };
                    work.iter_mut().zip(gathered.clone()).for_each(|(x, old)| *x = conjugate(column[old]));
                    self.blocks(analysis).for_each(|block| block.forward_transpose(&mut work));
                    self.blocks(analysis).rev().for_each(|block| block.backward_transpose(&mut work));
                    let scaled = work.iter().zip(gathered);
                    scaled.for_each(|(&x, old)| column[old] = conjugate(x).scaled(self.row_scale[old]));
                }
            }
        }
    }

    fn blocks<'a>(&'a self, analysis: &'a LuAnalysis) -> impl DoubleEndedIterator<Item = Block<'a, T>> {
        self.units.iter().zip(&analysis.units).flat_map(move |(factor, unit)| {
            let first_column = analysis.begin[unit.range.start] as usize;
            let mut starts = Vec::with_capacity(unit.range.len());
            let mut start = 0;
            for supernode in unit.range.clone() {
                starts.push(start);
                start += analysis.shape(supernode).kept_len();
            }
            unit.range.clone().zip(starts).map(move |(supernode, start)| {
                let shape = analysis.shape(supernode);
                let begin = analysis.begin[supernode] as usize;
                let (left, right) = factor.values[start..start + shape.kept_len()].split_at(shape.left_len());
                let swaps = &factor.swaps[begin - first_column..][..shape.columns];
                Block { shape, begin, rows: analysis.rows(supernode), left, right, swaps }
            })
        })
    }
}

impl<T: Scalar> Block<'_, T> {
    /// L y = P b.
    fn forward(&self, x: &mut [T]) {
        let (own, later) = x[self.begin..].split_at_mut(self.shape.columns);
        for (k, &row) in self.swaps.iter().enumerate() {
            own.swap(k, row as usize);
        }
        let offset = self.begin + self.shape.columns;
        for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate() {
            let value = own[k];
            let (diagonal, below) = column.split_at(self.shape.columns);
            own[k + 1..].iter_mut().zip(&diagonal[k + 1..]).for_each(|(x, &l)| *x -= l * value);
            self.rows.iter().zip(below).for_each(|(&row, &l)| later[row as usize - offset] -= l * value);
        }
    }

    /// U x = y.
    fn backward(&self, x: &mut [T]) {
        let columns = self.shape.columns;
        let (own, later) = x[self.begin..].split_at_mut(columns);
        let offset = self.begin + columns;
        for (column, &row) in self.right.chunks_exact(columns).zip(self.rows) {
            let value = later[row as usize - offset];
            own.iter_mut().zip(column).for_each(|(x, &u)| *x -= u * value);
        }
        for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate().rev() {
            let value = own[k] / column[k];
            own[k] = value;
            own[..k].iter_mut().zip(column).for_each(|(x, &u)| *x -= u * value);
        }
    }

    /// Uᵀ y = b.
    fn forward_transpose(&self, x: &mut [T]) {
        let columns = self.shape.columns;
        let (own, later) = x[self.begin..].split_at_mut(columns);
        let offset = self.begin + columns;
        for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate() {
            let sum = own[..k].iter().zip(column).fold(T::ZERO, |sum, (&x, &u)| sum + u * x);
            own[k] = (own[k] - sum) / column[k];
        }
        for (column, &row) in self.right.chunks_exact(columns).zip(self.rows) {
            let sum = own.iter().zip(column).fold(T::ZERO, |sum, (&x, &u)| sum + u * x);
            later[row as usize - offset] -= sum;
        }
    }

    /// Lᵀ x = y, then the swaps undone.
    fn backward_transpose(&self, x: &mut [T]) {
        let columns = self.shape.columns;
        let (own, later) = x[self.begin..].split_at_mut(columns);
        let offset = self.begin + columns;
        for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate().rev() {
            let (diagonal, below) = column.split_at(columns);
            let inside = own[k + 1..].iter().zip(&diagonal[k + 1..]).fold(T::ZERO, |sum, (&x, &l)| sum + l * x);
            let outside = self.rows.iter().zip(below);
            own[k] -= outside.fold(inside, |sum, (&row, &l)| sum + l * later[row as usize - offset]);
        }
        for (k, &row) in self.swaps.iter().enumerate().rev() {
            own.swap(k, row as usize);
        }
    }
}
