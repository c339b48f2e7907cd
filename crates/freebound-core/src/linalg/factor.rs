//! Factored matrix: solves, and their accuracy.

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

/// Factored matrix. Holds the required data of its [`Analysis`](super::Analysis), but not the matrix.
#[derive(Debug)]
pub struct Factor<T: Scalar> {
    pub(super) shared: Arc<Shared>,
    pub(super) numeric: Numeric<T>,
}

/// Function that solves with a factor: [`Factor::solve`], [`Factor::solve_correction`], [`Factor::solve_columns`].
pub type SolveFunction<T> = fn(&Factor<T>, &CscMatrix<T>, &[T], &AtomicBool) -> Result<Solved<T>, LinalgError>;

/// Request to solve with a factor.
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
    /// Solves A X = B with iterative refinement against `matrix`, which must be the factored matrix. Right-hand sides
    /// are consecutive columns, and so are the solutions. The residual is that of the worst column. Checks `cancel`
    /// throughout.
    ///
    /// # Errors
    ///
    /// [`LinalgError::ResidualTooLarge`] if neither refinement nor GMRES reduces the residual enough;
    /// [`LinalgError::NotFinite`] for a right-hand side that is not finite; [`LinalgError::WrongLength`],
    /// [`LinalgError::OtherPattern`], [`LinalgError::Cancelled`].
    pub fn solve(&self, matrix: &CscMatrix<T>, rhs: &[T], cancel: &AtomicBool) -> Result<Solved<T>, LinalgError> {
        self.run(Ask { matrix, rhs, operation: Operation::Plain, accept: Accept::Residual }, cancel)
    }

    /// Solves Aᴴ X = B, otherwise like [`Factor::solve`]. The adjoint systems of this project have single rows as
    /// right-hand sides, and solutions larger than these by up to the condition number. So a solution with a backward
    /// error of a few units of rounding is accepted with any residual, and not refined further.
    ///
    /// # Errors
    ///
    /// Errors of [`Factor::solve`].
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

    /// Solves A X = B for corrections of solutions whose residuals are B. Accepted like solutions of
    /// [`Factor::solve_adjoint`], but refined as far as possible.
    ///
    /// # Errors
    ///
    /// Errors of [`Factor::solve`].
    pub fn solve_correction(
        &self,
        matrix: &CscMatrix<T>,
        rhs: &[T],
        cancel: &AtomicBool,
    ) -> Result<Solved<T>, LinalgError> {
        self.run(Ask { matrix, rhs, operation: Operation::Plain, accept: Accept::BackwardError }, cancel)
    }

    /// Solves A X = B for columns that other solutions are composed of. Accepted like solutions of
    /// [`Factor::solve_adjoint`].
    ///
    /// # Errors
    ///
    /// Errors of [`Factor::solve`].
    pub fn solve_columns(
        &self,
        matrix: &CscMatrix<T>,
        rhs: &[T],
        cancel: &AtomicBool,
    ) -> Result<Solved<T>, LinalgError> {
        self.run(Ask { matrix, rhs, operation: Operation::Plain, accept: Accept::SmallBackwardError }, cancel)
    }

    /// Solves A x = b by substitution alone, without refinement: accurate enough for directions of descent.
    ///
    /// # Errors
    ///
    /// [`LinalgError::Cancelled`].
    ///
    /// # Panics
    ///
    /// If the length of the right-hand side is not the order of the system.
    pub fn substitute(&self, rhs: &[T], cancel: &AtomicBool) -> Result<Vec<T>, LinalgError> {
        assert_eq!(rhs.len(), self.shared.pattern.order(), "one number per row");
        let mut x = rhs.to_vec();
        self.solve_in_place(Operation::Plain, &mut x, cancel)?;
        Ok(x)
    }

    /// Solves Aᴴ X = B in place by substitution alone, without refinement: accurate enough for magnitudes. Columns
    /// are stored consecutively.
    ///
    /// # Errors
    ///
    /// [`LinalgError::Cancelled`]: the columns are then unusable.
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
        // If A = Aᴴ, its rows are its conjugated columns.
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
                // Since A = Aᴴ, both operations are identical.
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

    /// Distinguishes a singular matrix from one that only needed another order of elimination, if pivots were
    /// replaced. A right-hand side with a component in every direction has a solution only if the matrix is regular.
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

/// Pseudo-random number in [0, 1): multiples of the golden ratio, modulo one (Weyl's sequence).
fn spread(index: usize) -> f64 {
    const GOLDEN_RATIO: f64 = 0.618_033_988_749_894_9;
    (index as f64 * GOLDEN_RATIO).fract()
}
