//! A factored matrix: solves, and how good they are.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::parallel::prelude::*;
use nalgebra_sparse::CscMatrix;

use super::analysis::{Shared, Symbolic};
use super::ldlt::Ldlt;
use super::llt::Llt;
use super::lu::Lu;
use super::pattern::go_on_unless;
use super::refine::{Accept, Solved, System, refined};
use super::scalar::Scalar;
use super::sparse::{Operation, Operator};
use super::{FactorStats, LinalgError};

/// A factored matrix. It keeps what it needs of its [`Analysis`](super::Analysis), but not the matrix.
#[derive(Debug)]
pub struct Factor<T: Scalar> {
    pub(super) shared: Arc<Shared>,
    pub(super) numeric: Numeric<T>,
}

/// How a factor answers: [`Factor::solve`], [`Factor::solve_correction`], [`Factor::solve_columns`].
pub type SolveFunction<T> = fn(&Factor<T>, &CscMatrix<T>, &[T], &AtomicBool) -> Result<Solved<T>, LinalgError>;

/// What a factor is asked.
#[derive(Clone, Copy)]
struct Ask<'a, T> {
    matrix: &'a CscMatrix<T>,
    rhs: &'a [T],
    operation: Operation,
    accept: Accept,
}

#[derive(Debug)]
pub(super) enum Numeric<T: Scalar> {
    Llt(Llt<T>),
    Ldlt(Ldlt<T>),
    Lu(Lu<T>),
}

impl<T: Scalar> Factor<T> {
    /// Solves A X = B with iterative refinement against `matrix`, which must be the matrix that was factored. Several
    /// right-hand sides are stored one after another; so is the answer. The residual is that of the worst column. Looks at
    /// `cancel` all the way.
    ///
    /// # Errors
    ///
    /// [`LinalgError::ResidualTooLarge`] when neither refinement nor GMRES makes the residual good;
    /// [`LinalgError::NotFinite`] for a broken right-hand side; [`LinalgError::WrongLength`],
    /// [`LinalgError::OtherPattern`], [`LinalgError::Cancelled`].
    pub fn solve(&self, matrix: &CscMatrix<T>, rhs: &[T], cancel: &AtomicBool) -> Result<Solved<T>, LinalgError> {
        self.run(Ask { matrix, rhs, operation: Operation::Plain, accept: Accept::Residual }, cancel)
    }

    /// Solves Aᴴ X = B, otherwise as [`Factor::solve`]. The adjoint systems of this project have single rows on their
    /// right, and answers larger than those by up to the condition number: so an answer with a backward error of some
    /// units of rounding is accepted whatever its residual, and no more refined.
    ///
    /// # Errors
    ///
    /// Those of [`Factor::solve`].
    pub fn solve_adjoint(
        &self,
        matrix: &CscMatrix<T>,
        rhs: &[T],
        cancel: &AtomicBool,
    ) -> Result<Solved<T>, LinalgError> {
        self.run(Ask { matrix, rhs, operation: Operation::Adjoint, accept: Accept::SmallBackwardError }, cancel)
    }

    /// Size of the factors and number of replaced pivots.
    pub fn stats(&self) -> FactorStats {
        match &self.numeric {
            Numeric::Llt(llt) => llt.stats(),
            Numeric::Ldlt(ldlt) => ldlt.stats(),
            Numeric::Lu(lu) => lu.stats(),
        }
    }

    /// Solves A X = B for corrections of answers whose residuals are B: accepted as those of [`Factor::solve_adjoint`], but refined
    /// as far as it goes.
    ///
    /// # Errors
    ///
    /// Those of [`Factor::solve`].
    pub fn solve_correction(
        &self,
        matrix: &CscMatrix<T>,
        rhs: &[T],
        cancel: &AtomicBool,
    ) -> Result<Solved<T>, LinalgError> {
        self.run(Ask { matrix, rhs, operation: Operation::Plain, accept: Accept::BackwardError }, cancel)
    }

    /// Solves A X = B for columns that answers are made of: accepted as those of [`Factor::solve_adjoint`].
    ///
    /// # Errors
    ///
    /// Those of [`Factor::solve`].
    pub fn solve_columns(
        &self,
        matrix: &CscMatrix<T>,
        rhs: &[T],
        cancel: &AtomicBool,
    ) -> Result<Solved<T>, LinalgError> {
        self.run(Ask { matrix, rhs, operation: Operation::Plain, accept: Accept::SmallBackwardError }, cancel)
    }

    /// Solves A x = b by substitution alone, without refinement: good enough for directions of descent.
    ///
    /// # Errors
    ///
    /// [`LinalgError::Cancelled`].
    ///
    /// # Panics
    ///
    /// If the right-hand side has another length than the system.
    pub fn substitute(&self, rhs: &[T], cancel: &AtomicBool) -> Result<Vec<T>, LinalgError> {
        assert_eq!(rhs.len(), self.shared.pattern.order(), "one number per row");
        let mut x = rhs.to_vec();
        self.solve_in_place(Operation::Plain, &mut x, cancel)?;
        Ok(x)
    }

    /// Solves Aᴴ X = B in place by substitution alone, without refinement: good enough to know sizes. Columns are stored one
    /// after another.
    ///
    /// # Errors
    ///
    /// [`LinalgError::Cancelled`]: the columns are then of no use.
    ///
    /// # Panics
    ///
    /// If the columns do not have the length of the system.
    pub fn substitute_adjoint(&self, columns: &mut [T], cancel: &AtomicBool) -> Result<(), LinalgError> {
        let order = self.shared.pattern.order();
        assert_eq!(columns.len().checked_rem(order).unwrap_or(columns.len()), 0, "one number per row of each column");
        self.solve_in_place(Operation::Adjoint, columns, cancel)
    }

    fn run(&self, ask: Ask<'_, T>, cancel: &AtomicBool) -> Result<Solved<T>, LinalgError> {
        let Ask { matrix, rhs, operation, accept } = ask;
        let order = self.shared.pattern.order();
        if matrix.nrows() != order || matrix.nnz() != self.shared.pattern.rows.len() {
            return Err(LinalgError::OtherPattern);
        }
        if rhs.len().checked_rem(order).unwrap_or(rhs.len()) != 0 {
            return Err(LinalgError::WrongLength { order, found: rhs.len() });
        }
        if let Some(place) = rhs.par_iter().position_first(|value| !value.is_finite()) {
            return Err(LinalgError::NotFinite { row: place % order });
        }
        let solve = |columns: &mut [T]| self.solve_in_place(operation, columns, cancel);
        // Where A = Aᴴ, the rows of either are its columns.
        let (row_scale, places) = match (&self.numeric, &self.shared.symbolic, operation) {
            (Numeric::Lu(lu), Symbolic::Lu { transposed, .. }, Operation::Plain) => {
                (Some(lu.row_scale.as_slice()), Some(transposed.as_slice()))
            }
            _ => (None, None),
        };
        let is_faithful = self.stats().replaced_pivots == 0;
        let operator = Operator { matrix, places, cancel };
        refined(&System { operator, row_scale, is_faithful, accept, solve: &solve }, rhs)
    }

    fn solve_in_place(&self, operation: Operation, columns: &mut [T], cancel: &AtomicBool) -> Result<(), LinalgError> {
        match (&self.shared.symbolic, &self.numeric) {
            (Symbolic::Llt(analysis), Numeric::Llt(llt)) => {
                // A = Aᴴ: both operations are one.
                llt.solve_in_place(analysis, columns, cancel)
            }
            (Symbolic::Ldlt(analysis), Numeric::Ldlt(ldlt)) => {
                go_on_unless(cancel)?;
                analysis.solve_in_place(ldlt, columns);
                Ok(())
            }
            (Symbolic::Lu { analysis, .. }, Numeric::Lu(lu)) => lu.solve_in_place(analysis, operation, columns, cancel),
            _ => unreachable!("a factor is made by its own analysis"),
        }
    }

    /// Where pivots were replaced, tells a singular matrix from one that only wanted another order of elimination: a
    /// right-hand side with a part in every direction has a solution only if the matrix is regular.
    pub(super) fn check_regular(&self, matrix: &CscMatrix<T>, cancel: &AtomicBool) -> Result<(), LinalgError> {
        let (row, scales) = match &self.numeric {
            Numeric::Llt(_) => return Ok(()),
            Numeric::Ldlt(ldlt) => (ldlt.replaced_row, None),
            Numeric::Lu(lu) => (lu.replaced_rows.first().map(|&row| row as usize), Some(&lu.row_scale)),
        };
        let Some(row) = row else { return Ok(()) };
        let probe = |index: usize| T::from_real((0.5 + spread(index)) / scales.map_or(1.0, |scales| scales[index]));
        let rhs: Vec<T> = (0..self.shared.pattern.order()).map(probe).collect();
        match self.solve(matrix, &rhs, cancel) {
            Err(LinalgError::ResidualTooLarge { .. }) => Err(LinalgError::Singular { row }),
            other => other.map(|_| ()),
        }
    }
}

/// A number in [0, 1) that looks random: multiples of the golden ratio, modulo one (Weyl's sequence).
fn spread(index: usize) -> f64 {
    const GOLDEN_RATIO: f64 = 0.618_033_988_749_894_9;
    (index as f64 * GOLDEN_RATIO).fract()
}
