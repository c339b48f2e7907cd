//! Right-hand sides while they are substituted into, front by front.

use faer::MatMut;

use super::symbolic::Shape;
use crate::linalg::scalar::Scalar;

/// Right-hand sides solved together by one thread.
pub(in crate::linalg) const TOGETHER: usize = 4;

/// A panel with at least so many entries is worth the call of a dense kernel.
pub(in crate::linalg) const LARGE_PANEL: usize = 256;

/// Right-hand sides on their way to solutions, in the order of elimination.
pub(in crate::linalg) struct Work<T> {
    /// Column-major.
    x: Vec<T>,
    /// Length of a column.
    order: usize,
    /// A block's rows below its own, gathered; column-major.
    outer: Vec<T>,
}

impl<T: Scalar> Work<T> {
    /// Right-hand sides of a system of this order, one after another.
    pub(in crate::linalg) fn new(x: Vec<T>, order: usize) -> Self {
        Self { x, order, outer: Vec::new() }
    }

    pub(in crate::linalg) fn columns(&self) -> impl Iterator<Item = &[T]> {
        self.x.chunks_exact(self.order)
    }

    fn count(&self) -> usize {
        self.x.len() / self.order
    }

    pub(in crate::linalg) fn gather(&mut self, rows: &[u32]) {
        self.outer.clear();
        for column in self.x.chunks_exact(self.order) {
            self.outer.extend(rows.iter().map(|&row| column[row as usize]));
        }
    }

    pub(in crate::linalg) fn scatter_subtract(&mut self, rows: &[u32]) {
        if rows.is_empty() {
            return;
        }
        for (column, outer) in self.x.chunks_exact_mut(self.order).zip(self.outer.chunks_exact(rows.len())) {
            for (&row, &value) in rows.iter().zip(outer) {
                column[row as usize] -= value;
            }
        }
    }

    /// The block's own rows and its outer ones.
    pub(in crate::linalg) fn views(&mut self, begin: usize, shape: Shape) -> (MatMut<'_, T>, MatMut<'_, T>) {
        let (count, Shape { columns, below }) = (self.count(), shape);
        self.outer.resize(below * count, T::ZERO);
        let own = MatMut::from_column_major_slice_mut(&mut self.x, self.order, count);
        let outer = MatMut::from_column_major_slice_mut(&mut self.outer, below, count);
        (own.subrows_mut(begin, columns), outer)
    }

    /// The block's own rows and all that follow, for each right-hand side.
    pub(in crate::linalg) fn split(
        &mut self,
        begin: usize,
        shape: Shape,
    ) -> impl Iterator<Item = (&mut [T], &mut [T])> {
        let columns = shape.columns;
        self.x.chunks_exact_mut(self.order).map(move |column| column[begin..].split_at_mut(columns))
    }
}

/// Σ xᵢ yᵢ over the shorter of both, without conjugation.
pub(in crate::linalg) fn dot<T: Scalar>(x: &[T], y: &[T]) -> T {
    x.iter().zip(y).fold(T::ZERO, |sum, (&x, &y)| sum + x * y)
}
