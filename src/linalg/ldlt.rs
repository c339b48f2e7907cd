//! Factorization of an augmented matrix: faer's supernodal `LDLᴴ`, without a search for pivots.
//!
//! ```text
//! P ⎡ −E  A ⎤ Pᵀ = L D Lᴴ,   D real and diagonal
//!   ⎣ Aᴴ  F ⎦
//! ```
//!
//! With E and F positive definite it exists for every order of elimination (Vanderbei 1995, "Symmetric quasi-definite
//! matrices"). F may also be singular here: each row of F is then eliminated right after its partner in E, whose pivot
//! has made a positive number of the coefficient that joins them. Half the memory of an LU.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::{LdltError, LdltRegularization};
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::cholesky::{LdltRef, SymbolicCholesky};
use faer::{Conj, Par, Side, Spec};
use nalgebra_sparse::CscMatrix;

use super::llt::{by_groups, symbolic};
use super::order::{Order, Pattern};
use super::scalar::Scalar;
use super::{FactorStats, LinalgError};

/// Symbolic factorization, the rows of each pair in turn.
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
}

impl LdltAnalysis {
    pub(super) fn new(pattern: &Pattern, order: Order, pairs: usize) -> Result<Self, LinalgError> {
        Ok(Self { symbolic: symbolic(pattern, &order.with_pairs_in_turn(pairs))?, pairs })
    }

    pub(super) fn pairs(&self) -> usize {
        self.pairs
    }

    pub(super) fn factor<T: Scalar>(&self, pattern: &Pattern, matrix: &CscMatrix<T>) -> Result<Ldlt<T>, LinalgError> {
        let mut values = vec![T::ZERO; self.symbolic.len_val()];
        let par = Par::rayon(0);
        let scratch = self.symbolic.factorize_numeric_ldlt_scratch::<T>(par, Spec::default());
        let too_large = |_| LinalgError::TooLarge { order: pattern.order() };
        let mut memory = MemBuffer::try_new(scratch).map_err(too_large)?;
        let factored = self.symbolic.factorize_numeric_ldlt(
            &mut values,
            SparseColMatRef::new(pattern.as_faer(), matrix.values()),
            Side::Lower,
            LdltRegularization::default(),
            par,
            MemStack::new(&mut memory),
            Spec::default(),
        );
        if let Err(LdltError::ZeroPivot { index }) = factored {
            let row = self.symbolic.perm().map_or(index, |perm| perm.arrays().0[index] as usize);
            return Err(LinalgError::Singular { row });
        }
        let peak_bytes = size_of_val(values.as_slice()) + memory.len();
        Ok(Ldlt { values, peak_bytes })
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
            replaced_pivots: 0,
            factor_bytes: size_of_val(self.values.as_slice()),
            peak_bytes: self.peak_bytes,
        }
    }
}
