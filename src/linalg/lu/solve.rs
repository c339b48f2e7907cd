//! Forward and backward substitution through the fronts.
//!
//! Several right-hand sides are taken [`LANES`] at a time, interleaved, so that each number of the factors is read once
//! for all of them; groups of lanes run side by side.

use rayon::prelude::*;

use super::factor::Lu;
use super::symbolic::{LuAnalysis, Shape};
use crate::linalg::scalar::Scalar;
use crate::linalg::sparse::Operation;

/// Right-hand sides solved together by one thread.
const LANES: usize = 4;

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
        columns.par_chunks_mut(LANES * n).for_each(|columns| {
            if columns.len() == n {
                self.solve_lanes::<1>(analysis, operation, columns);
            } else {
                self.solve_lanes::<LANES>(analysis, operation, columns);
            }
        });
    }

    /// Solves for at most `W` columns.
    fn solve_lanes<const W: usize>(&self, analysis: &LuAnalysis, operation: Operation, columns: &mut [T]) {
        let n = self.row_scale.len();
        let conjugate = |x: T| if operation == Operation::Adjoint { x.conjugated() } else { x };
        let (before, after) = match operation {
            Operation::Plain => (Some(&self.row_scale), None),
            Operation::Transpose | Operation::Adjoint => (None, Some(&self.row_scale)),
        };
        let factor = |scale: Option<&Vec<f64>>, row: usize| scale.map_or(1.0, |scale| scale[row]);
        let mut work = vec![[T::ZERO; W]; n];
        for (x, &old) in work.iter_mut().zip(&analysis.order.new_to_old) {
            let row = old as usize;
            let values = columns.chunks_exact(n).map(|column| conjugate(column[row]).scaled(factor(before, row)));
            x.iter_mut().zip(values).for_each(|(x, value)| *x = value);
        }
        if operation == Operation::Plain {
            self.blocks(analysis).for_each(|block| block.forward(&mut work));
            self.blocks(analysis).rev().for_each(|block| block.backward(&mut work));
        } else {
            self.blocks(analysis).for_each(|block| block.forward_transpose(&mut work));
            self.blocks(analysis).rev().for_each(|block| block.backward_transpose(&mut work));
        }
        for (lane, column) in columns.chunks_exact_mut(n).enumerate() {
            for (x, &old) in work.iter().zip(&analysis.order.new_to_old) {
                let row = old as usize;
                column[row] = conjugate(x[lane]).scaled(factor(after, row));
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
    fn forward<const W: usize>(&self, x: &mut [[T; W]]) {
        let columns = self.shape.columns;
        let (own, later) = x[self.begin..].split_at_mut(columns);
        let offset = self.begin + columns;
        for (k, &row) in self.swaps.iter().enumerate() {
            own.swap(k, row as usize);
        }
        for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate() {
            let value = own[k];
            let (diagonal, below) = column.split_at(columns);
            own[k + 1..].iter_mut().zip(&diagonal[k + 1..]).for_each(|(x, &l)| subtract(x, l, &value));
            for (&row, &l) in self.rows.iter().zip(below) {
                subtract(&mut later[row as usize - offset], l, &value);
            }
        }
    }

    /// U x = y.
    fn backward<const W: usize>(&self, x: &mut [[T; W]]) {
        let columns = self.shape.columns;
        let (own, later) = x[self.begin..].split_at_mut(columns);
        let offset = self.begin + columns;
        for (column, &row) in self.right.chunks_exact(columns).zip(self.rows) {
            let value = later[row as usize - offset];
            own.iter_mut().zip(column).for_each(|(x, &u)| subtract(x, u, &value));
        }
        for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate().rev() {
            let value = own[k].map(|x| x / column[k]);
            own[k] = value;
            own[..k].iter_mut().zip(column).for_each(|(x, &u)| subtract(x, u, &value));
        }
    }

    /// Uᵀ y = b.
    fn forward_transpose<const W: usize>(&self, x: &mut [[T; W]]) {
        let columns = self.shape.columns;
        let (own, later) = x[self.begin..].split_at_mut(columns);
        let offset = self.begin + columns;
        for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate() {
            let mut rest = own[k];
            own[..k].iter().zip(column).for_each(|(x, &u)| subtract(&mut rest, u, x));
            own[k] = rest.map(|x| x / column[k]);
        }
        for (column, &row) in self.right.chunks_exact(columns).zip(self.rows) {
            let rest = &mut later[row as usize - offset];
            own.iter().zip(column).for_each(|(x, &u)| subtract(rest, u, x));
        }
    }

    /// Lᵀ x = y, then the swaps undone.
    fn backward_transpose<const W: usize>(&self, x: &mut [[T; W]]) {
        let columns = self.shape.columns;
        let (own, later) = x[self.begin..].split_at_mut(columns);
        let offset = self.begin + columns;
        for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate().rev() {
            let (diagonal, below) = column.split_at(columns);
            let mut rest = own[k];
            own[k + 1..].iter().zip(&diagonal[k + 1..]).for_each(|(x, &l)| subtract(&mut rest, l, x));
            for (&row, &l) in self.rows.iter().zip(below) {
                subtract(&mut rest, l, &later[row as usize - offset]);
            }
            own[k] = rest;
        }
        for (k, &row) in self.swaps.iter().enumerate().rev() {
            own.swap(k, row as usize);
        }
    }
}

/// x ← x − factor·value, lane by lane.
#[inline]
fn subtract<T: Scalar, const W: usize>(x: &mut [T; W], factor: T, value: &[T; W]) {
    for (x, &value) in x.iter_mut().zip(value) {
        *x -= factor * value;
    }
}
