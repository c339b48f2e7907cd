//! Factorization of an augmented matrix: faer's supernodal `LDLᴴ`, without a search for pivots.
//!
//! ```text
//! P ⎡ −E  A ⎤ Pᵀ = L D Lᴴ,   D real and diagonal
//!   ⎣ Aᴴ  F ⎦
//! ```
//!
//! With E and F positive definite the factorization exists for every order of elimination (Vanderbei 1995, "Symmetric
//! quasi-definite matrices"). F may also be singular here. Each row of F is eliminated right after its partner in E:
//! the partner's pivot makes the row's own pivot positive through the coefficient that joins them. If that
//! coefficient is zero, the row has no positive pivot yet. Pivots with a wrong sign are replaced, and refinement
//! repairs the effect. The factors take half the memory of an LU.

use crate::parallel::parallelism;
use crate::parallel::prelude::*;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::{LdltError, LdltRegularization};
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::{Conj, MatMut, Par, Side, Spec};
use nalgebra_sparse::CscMatrix;

use super::fronts::TOGETHER;
use super::pattern::{Order, Pattern};
use super::scalar::Scalar;
use super::{FactorStats, LinalgError};

/// Pivot size relative to the largest entry below which a pivot has no sign and is replaced.
const NO_PIVOT: f64 = f64::EPSILON;

/// Size of a replacement pivot, relative to the largest entry.
const REPLACED: f64 = 1e-8;

/// Symbolic factorization with the rows of each pair in turn.
#[derive(Debug)]
pub(super) struct LdltAnalysis {
    symbolic: SymbolicCholesky<u32>,
    pairs: usize,
}

/// Values of L and D.
#[derive(Debug)]
pub(super) struct Ldlt<T> {
    values: Vec<T>,
    peak_bytes: usize,
    /// First row whose pivot was replaced, if any.
    pub(super) replaced_row: Option<usize>,
}

impl LdltAnalysis {
    pub(super) fn new(pattern: &Pattern, order: Order, pairs: usize) -> Result<Self, LinalgError> {
        Ok(Self { symbolic: symbolic(pattern, &order.with_pairs_in_turn(pairs))?, pairs })
    }

    pub(super) fn factor<T: Scalar>(&self, pattern: &Pattern, matrix: &CscMatrix<T>) -> Result<Ldlt<T>, LinalgError> {
        let mut ldlt = Ldlt { values: vec![T::ZERO; self.symbolic.len_val()], peak_bytes: 0, replaced_row: None };
        if let Some(row) = self.run(pattern, matrix, LdltRegularization::default(), &mut ldlt)? {
            let largest = matrix.values().iter().map(|value| value.size()).fold(0.0, f64::max);
            let is_move = |row: usize| row < 2 * self.pairs && row % 2 == 1;
            let signs: Vec<i8> = (0..pattern.order()).map(|row| if is_move(row) { 1 } else { -1 }).collect();
            let replacing = LdltRegularization {
                dynamic_regularization_signs: Some(&signs),
                dynamic_regularization_delta: REPLACED * largest,
                dynamic_regularization_epsilon: NO_PIVOT * largest,
            };
            ldlt.replaced_row = Some(row);
            ldlt.values.fill(T::ZERO);
            self.run(pattern, matrix, replacing, &mut ldlt)?;
        }
        Ok(ldlt)
    }

    /// Factors once. Returns the row whose zero pivot stopped the factorization, if any.
    fn run<T: Scalar>(
        &self,
        pattern: &Pattern,
        matrix: &CscMatrix<T>,
        regularization: LdltRegularization<'_, f64>,
        ldlt: &mut Ldlt<T>,
    ) -> Result<Option<usize>, LinalgError> {
        let par = parallelism();
        let scratch = self.symbolic.factorize_numeric_ldlt_scratch::<T>(par, Spec::default());
        let too_large = |_| LinalgError::TooLarge { order: pattern.order() };
        let mut memory = MemBuffer::try_new(scratch).map_err(too_large)?;
        ldlt.peak_bytes = size_of_val(ldlt.values.as_slice()) + memory.len();
        let factored = self.symbolic.factorize_numeric_ldlt(
            &mut ldlt.values,
            SparseColMatRef::new(pattern.as_faer(), matrix.values()),
            Side::Lower,
            regularization,
            par,
            MemStack::new(&mut memory),
            Spec::default(),
        );
        let row_of = |index: usize| self.symbolic.perm().map_or(index, |perm| perm.arrays().0[index] as usize);
        Ok(factored.err().map(|LdltError::ZeroPivot { index }| row_of(index)))
    }

    /// Solves A X = B in place; `columns` is column-major.
    pub(super) fn solve_in_place<T: Scalar>(&self, factor: &Ldlt<T>, columns: &mut [T]) {
        let ldlt = LdltRef::new(&self.symbolic, &factor.values);
        by_groups(&self.symbolic, columns, |group, stack| {
            ldlt.solve_in_place_with_conj(Conj::No, group, Par::Seq, stack);
        });
    }
}

impl<T> Ldlt<T> {
    pub(super) fn stats(&self) -> FactorStats {
        FactorStats {
            replaced_pivots: usize::from(self.replaced_row.is_some()),
            factor_bytes: size_of_val(self.values.as_slice()),
            peak_bytes: self.peak_bytes,
        }
    }
}

/// Symbolic factorization in a given order.
fn symbolic(pattern: &Pattern, order: &Order) -> Result<SymbolicCholesky<u32>, LinalgError> {
    let params = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
        ..Default::default()
    };
    let ordering = SymmetricOrdering::Custom(order.as_faer());
    factorize_symbolic_cholesky(pattern.as_faer(), Side::Lower, ordering, params)
        .map_err(|_| LinalgError::TooLarge { order: pattern.order() })
}

/// Solves for groups of columns in parallel.
fn by_groups<T: Scalar>(
    symbolic: &SymbolicCholesky<u32>,
    columns: &mut [T],
    solve: impl Fn(MatMut<'_, T>, &mut MemStack) + Sync,
) {
    let n = symbolic.nrows();
    if n == 0 {
        return;
    }
    let scratch = symbolic.solve_in_place_scratch::<T>(TOGETHER, Par::Seq);
    columns.par_chunks_mut(TOGETHER * n).for_each(|columns| {
        let mut memory = MemBuffer::new(scratch);
        let count = columns.len() / n;
        solve(MatMut::from_column_major_slice_mut(columns, n, count), MemStack::new(&mut memory));
    });
}
