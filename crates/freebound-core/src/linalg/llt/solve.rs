//! Forward and backward substitution through the fronts.
//!
//! Several right-hand sides are solved together, so that the numbers of the factors are read only once for all of
//! them. Such groups run in parallel. Large blocks use the dense kernels of faer, small blocks plain loops.

use std::sync::atomic::AtomicBool;

use crate::parallel::prelude::*;
use faer::Par;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};

use super::factor::Llt;
use crate::linalg::LinalgError;
use crate::linalg::fronts::{
    FrontAnalysis, FrontNumbers, LARGE_PANEL, Part, Substitution, TOGETHER, split_panel, substitute, subtract_product,
};
use crate::linalg::pattern::go_on_unless;
use crate::linalg::scalar::Number;

impl<T: Number> Llt<T> {
    /// Solves A x = b in place for each column of `columns` (column-major).
    ///
    /// # Errors
    ///
    /// [`LinalgError::Cancelled`].
    pub(crate) fn solve_in_place(
        &self,
        analysis: &FrontAnalysis,
        columns: &mut [T],
        cancel: &AtomicBool,
    ) -> Result<(), LinalgError> {
        let n = analysis.order.new_to_old.len();
        if n == 0 {
            return Ok(());
        }
        columns.par_chunks_mut(TOGETHER * n).try_for_each(|columns| self.solve_group(analysis, columns, cancel))
    }

    fn solve_group(&self, analysis: &FrontAnalysis, columns: &mut [T], cancel: &AtomicBool) -> Result<(), LinalgError> {
        let order = &analysis.order.new_to_old;
        let n = order.len();
        let mut x = Vec::with_capacity(columns.len());
        for column in columns.chunks_exact(n) {
            go_on_unless(cancel)?;
            x.extend(order.iter().map(|&old| column[old as usize].scale(self.sign.real())));
        }
        substitute(analysis, &Panels { analysis, factor: self }, &mut x, cancel)?;
        for (x, column) in x.chunks_exact(n).zip(columns.chunks_exact_mut(n)) {
            for (&x, &old) in x.iter().zip(order) {
                column[old as usize] = x;
            }
        }
        Ok(())
    }
}

/// L panels of all fronts.
struct Panels<'a, T: Number> {
    analysis: &'a FrontAnalysis,
    factor: &'a Llt<T>,
}

impl<T: Number> Panels<'_, T> {
    fn left(&self, supernode: usize) -> FrontNumbers<'_, T> {
        let unit = self.analysis.unit_of[supernode] as usize;
        self.factor.places.numbers_of(self.analysis, supernode, &self.factor.units[unit])
    }
}

impl<T: Number> Substitution<T> for Panels<'_, T> {
    fn up(&self, supernode: usize, part: Part<'_, T>) {
        match self.left(supernode) {
            FrontNumbers::Full(left) => forward(left, part),
            FrontNumbers::Real(left) => part.by_parts(|part| forward(left, part)),
        }
    }

    fn down(&self, supernode: usize, part: Part<'_, T>) {
        match self.left(supernode) {
            FrontNumbers::Full(left) => backward(left, part),
            FrontNumbers::Real(left) => part.by_parts(|part| backward(left, part)),
        }
    }
}

/// Solves L y = b.
fn forward<T: Number>(left: &[T], mut part: Part<'_, T>) {
    let shape = part.shape;
    if left.len() >= LARGE_PANEL {
        let (diagonal, lower) = split_panel(left, shape);
        let (mut own, outer) = part.matrices();
        solve_lower_triangular_in_place(diagonal, own.as_mut(), Par::Seq);
        subtract_product(outer, lower, own.as_ref());
        return;
    }
    for (own, outer) in part.each() {
        for (k, column) in left.chunks_exact(shape.height()).enumerate() {
            let value = own[k].unscale(column[k].real());
            own[k] = value;
            let (diagonal, below) = column.split_at(shape.columns);
            own[k + 1..].iter_mut().zip(&diagonal[k + 1..]).for_each(|(x, &l)| *x -= l * value);
            outer.iter_mut().zip(below).for_each(|(x, &l)| *x -= l * value);
        }
    }
}

/// Solves Lᴴ x = y.
fn backward<T: Number>(left: &[T], mut part: Part<'_, T>) {
    let shape = part.shape;
    if left.len() >= LARGE_PANEL {
        let (diagonal, lower) = split_panel(left, shape);
        let (mut own, outer) = part.matrices();
        subtract_product(own.as_mut(), lower.adjoint(), outer.as_ref());
        solve_upper_triangular_in_place(diagonal.adjoint(), own, Par::Seq);
        return;
    }
    for (own, outer) in part.each() {
        for (k, column) in left.chunks_exact(shape.height()).enumerate().rev() {
            let inside = own[k + 1..].iter().zip(&column[k + 1..shape.columns]);
            let inside = inside.fold(T::ZERO, |sum, (&x, &l)| sum + l.conjugate() * x);
            let outside = outer.iter().zip(&column[shape.columns..]);
            let sum = outside.fold(inside, |sum, (&x, &l)| sum + l.conjugate() * x);
            own[k] = (own[k] - sum).unscale(column[k].real());
        }
    }
}
