//! Forward and backward substitution through the fronts.
//!
//! Several right-hand sides are taken some at a time, so that the numbers of the factors are read once for all of them;
//! such groups run side by side. Large blocks go through faer's dense kernels, small ones through plain loops.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Accum, MatRef, Par};
use rayon::prelude::*;

use super::factor::Llt;
use crate::linalg::fronts::{FrontAnalysis, LARGE_PANEL, Shape, TOGETHER, Work, mat};
use crate::linalg::scalar::Scalar;

/// One supernode's part of L.
struct Block<'a, T> {
    shape: Shape,
    begin: usize,
    rows: &'a [u32],
    left: &'a [T],
}

impl<T: Scalar> Llt<T> {
    /// Solves A x = b in place for each column of `columns` (column-major).
    pub(crate) fn solve_in_place(&self, analysis: &FrontAnalysis, columns: &mut [T]) {
        let n = analysis.order.new_to_old.len();
        if n == 0 {
            return;
        }
        columns.par_chunks_mut(TOGETHER * n).for_each(|columns| self.solve_group(analysis, columns));
    }

    fn solve_group(&self, analysis: &FrontAnalysis, columns: &mut [T]) {
        let order = &analysis.order.new_to_old;
        let n = order.len();
        let mut x = Vec::with_capacity(columns.len());
        for column in columns.chunks_exact(n) {
            x.extend(order.iter().map(|&old| column[old as usize].scale(self.sign)));
        }
        let mut work = Work::new(x, n);
        self.blocks(analysis).for_each(|block| block.forward(&mut work));
        self.blocks(analysis).rev().for_each(|block| block.backward(&mut work));
        for (x, column) in work.columns().zip(columns.chunks_exact_mut(n)) {
            for (&x, &old) in x.iter().zip(order) {
                column[old as usize] = x;
            }
        }
    }

    fn blocks<'a>(&'a self, analysis: &'a FrontAnalysis) -> impl DoubleEndedIterator<Item = Block<'a, T>> {
        self.units.iter().zip(&analysis.units).flat_map(move |(values, unit)| {
            let mut starts = Vec::with_capacity(unit.range.len());
            let mut start = 0;
            for supernode in unit.range.clone() {
                starts.push(start);
                start += analysis.kept_len(supernode);
            }
            unit.range.clone().zip(starts).map(move |(supernode, start)| Block {
                shape: analysis.shape(supernode),
                begin: analysis.begin[supernode] as usize,
                rows: analysis.rows.column(supernode),
                left: &values[start..start + analysis.kept_len(supernode)],
            })
        })
    }
}

impl<'a, T: Scalar> Block<'a, T> {
    fn is_large(&self) -> bool {
        self.left.len() >= LARGE_PANEL
    }

    /// L₁₁ and L₂₁.
    fn parts(&self) -> (MatRef<'a, T>, MatRef<'a, T>) {
        mat(self.left, self.shape.height(), self.shape.columns).split_at_row(self.shape.columns)
    }

    /// The place of an outer row among the rows that follow the block's own.
    fn place(&self, row: u32) -> usize {
        row as usize - self.begin - self.shape.columns
    }

    /// L y = b.
    fn forward(&self, work: &mut Work<T>) {
        if self.is_large() {
            let (diagonal, lower) = self.parts();
            let (mut own, outer) = work.views(self.begin, self.shape);
            solve_lower_triangular_in_place(diagonal, own.as_mut(), Par::Seq);
            matmul(outer, Accum::Replace, lower, own.as_ref(), T::ONE, Par::Seq);
            work.scatter_subtract(self.rows);
            return;
        }
        for (own, later) in work.split(self.begin, self.shape) {
            for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate() {
                let value = own[k].unscale(column[k].real());
                own[k] = value;
                let (diagonal, below) = column.split_at(self.shape.columns);
                own[k + 1..].iter_mut().zip(&diagonal[k + 1..]).for_each(|(x, &l)| *x -= l * value);
                self.rows.iter().zip(below).for_each(|(&row, &l)| later[self.place(row)] -= l * value);
            }
        }
    }

    /// Lᴴ x = y.
    fn backward(&self, work: &mut Work<T>) {
        if self.is_large() {
            let (diagonal, lower) = self.parts();
            work.gather(self.rows);
            let (mut own, outer) = work.views(self.begin, self.shape);
            matmul(own.as_mut(), Accum::Add, lower.adjoint(), outer.as_ref(), -T::ONE, Par::Seq);
            solve_upper_triangular_in_place(diagonal.adjoint(), own, Par::Seq);
            return;
        }
        for (own, later) in work.split(self.begin, self.shape) {
            for (k, column) in self.left.chunks_exact(self.shape.height()).enumerate().rev() {
                let (diagonal, below) = column.split_at(self.shape.columns);
                let inside = own[k + 1..].iter().zip(&diagonal[k + 1..]);
                let inside = inside.fold(T::ZERO, |sum, (&x, &l)| sum + l.conjugate() * x);
                let outside = self.rows.iter().zip(below);
                let sum = outside.fold(inside, |sum, (&row, &l)| sum + l.conjugate() * later[self.place(row)]);
                own[k] = (own[k] - sum).unscale(column[k].real());
            }
        }
    }
}
