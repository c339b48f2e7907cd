//! Interface of the layer: analysis of a pattern, factorization of a matrix. `factor.rs` solves.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;

use super::LinalgError;
use super::factor::{Factor, Numeric};
use super::fronts::{FrontAnalysis, Sides};
use super::ldlt::LdltAnalysis;
use super::llt::Llt;
use super::lu::Lu;
use super::order::{dissected, in_order, order};
use super::pattern::{Order, Pattern, go_on_unless};
use super::scalar::Scalar;
use super::sparse::check_finite;

/// Known properties of the values of a matrix. The pattern is always symmetric, diagonal included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Hermitian positive definite A or −A; both triangles are stored.
    Hermitian,
    /// Hermitian `[−E A; Aᴴ F]` with E positive definite and F positive semidefinite; both triangles are stored. The
    /// first `pairs` rows of E alternate with all rows of F (e₀, f₀, e₁, f₁, …). The rows of a pair have equal
    /// patterns. The other rows of E follow.
    Augmented {
        /// Number of rows of F.
        pairs: usize,
    },
    /// Any values.
    General,
}

/// Ordering and symbolic factorization of a pattern, for any number of matrices of either scalar. Clones share it.
#[derive(Clone, Debug)]
pub struct Analysis {
    pub(super) shared: Arc<Shared>,
}

/// Order of elimination, reusable for patterns that differ in a few places.
#[derive(Clone, Debug)]
pub struct EliminationOrder {
    order: Order,
    /// Number of multiplications of a factorization in this order.
    work: f64,
}

/// Largest accepted ratio of the work in a reused order to the work for the pattern that it was found for.
const TOO_MUCH_WORK: f64 = 1.25;

#[derive(Debug)]
pub(super) struct Shared {
    pub(super) pattern: Arc<Pattern>,
    pub(super) symbolic: Symbolic,
}

#[derive(Debug)]
pub(super) enum Symbolic {
    Llt(FrontAnalysis),
    Ldlt(LdltAnalysis),
    Lu {
        analysis: FrontAnalysis,
        /// Index of the mirror image of each entry of the pattern.
        transposed: Vec<u32>,
    },
}

impl Analysis {
    /// Orders the pattern and finds the pattern of its factors. Checks `cancel` throughout.
    ///
    /// # Errors
    ///
    /// [`LinalgError::NotSquare`], [`LinalgError::PatternNotSymmetric`] (also for a missing diagonal entry),
    /// [`LinalgError::TooLarge`] and [`LinalgError::Cancelled`].
    pub fn new(kind: Kind, pattern: &SparsityPattern, cancel: &AtomicBool) -> Result<Self, LinalgError> {
        Self::of(kind, Arc::new(Pattern::checked(pattern, cancel)?), cancel)
    }

    /// Analyses a pattern that is known to be symmetric, with its diagonal; the pattern is shared, not copied.
    ///
    /// # Errors
    ///
    /// [`LinalgError::TooLarge`] and [`LinalgError::Cancelled`].
    pub(crate) fn of(kind: Kind, pattern: Arc<Pattern>, cancel: &AtomicBool) -> Result<Self, LinalgError> {
        // faer reserves the sign bit.
        if i32::try_from(pattern.rows.len()).is_err() {
            return Err(LinalgError::TooLarge { order: pattern.order() });
        }
        debug_assert!(
            pattern.check_symmetric(&AtomicBool::new(false)).is_ok(),
            "the caller knows that it is symmetric"
        );
        let elimination = match kind {
            Kind::Augmented { .. } => order(&pattern, cancel)?,
            Kind::Hermitian | Kind::General => dissected(&pattern, cancel)?,
        };
        go_on_unless(cancel)?;
        let symbolic = match kind {
            Kind::Hermitian => Symbolic::Llt(FrontAnalysis::new(&pattern, &elimination, Sides::Lower, cancel)?),
            Kind::Augmented { pairs } => Symbolic::Ldlt(LdltAnalysis::new(&pattern, elimination.order(), pairs)?),
            Kind::General => {
                let analysis = FrontAnalysis::new(&pattern, &elimination, Sides::Both, cancel)?;
                Symbolic::Lu { analysis, transposed: pattern.transposed() }
            }
        };
        Ok(Self { shared: Arc::new(Shared { pattern, symbolic }) })
    }

    /// Analyses the pattern of a Hermitian matrix in a given order of elimination. The pattern may differ in a few
    /// places from the pattern of that order. A pattern of another size is ordered anew, and so is a pattern that
    /// takes much more work in that order.
    ///
    /// # Errors
    ///
    /// Errors of [`Analysis::new`].
    pub fn in_order(
        order: &EliminationOrder,
        pattern: &SparsityPattern,
        cancel: &AtomicBool,
    ) -> Result<Self, LinalgError> {
        let EliminationOrder { order, work } = order;
        let pattern = Arc::new(Pattern::checked(pattern, cancel)?);
        if order.new_to_old.len() == pattern.order() {
            let elimination = in_order(&pattern, order, cancel)?;
            let analysis = FrontAnalysis::new(&pattern, &elimination, Sides::Lower, cancel)?;
            if analysis.work() <= TOO_MUCH_WORK * work {
                let symbolic = Symbolic::Llt(analysis);
                return Ok(Self { shared: Arc::new(Shared { pattern, symbolic }) });
            }
        }
        Self::of(Kind::Hermitian, pattern, cancel)
    }

    /// Order of elimination of a Hermitian matrix; `None` for other kinds.
    pub fn order(&self) -> Option<EliminationOrder> {
        match &self.shared.symbolic {
            Symbolic::Llt(llt) => Some(EliminationOrder { order: llt.order.clone(), work: llt.work() }),
            Symbolic::Ldlt(_) | Symbolic::Lu { .. } => None,
        }
    }

    /// Factors a matrix of the analysed pattern. LU and Cholesky check `cancel` at every supernode and at every few
    /// columns of it; the augmented factorization checks it only before and after.
    ///
    /// # Errors
    ///
    /// [`LinalgError::OtherPattern`], [`LinalgError::NotFinite`], [`LinalgError::NotPositiveDefinite`] for a Hermitian
    /// matrix, [`LinalgError::Singular`] for others, [`LinalgError::TooLarge`], [`LinalgError::Cancelled`].
    pub fn factor<T: Scalar>(&self, matrix: &CscMatrix<T>, cancel: &AtomicBool) -> Result<Factor<T>, LinalgError> {
        let Shared { pattern, symbolic } = &*self.shared;
        if !pattern.is_that_of(matrix) {
            return Err(LinalgError::OtherPattern);
        }
        go_on_unless(cancel)?;
        check_finite(matrix)?;
        go_on_unless(cancel)?;
        let numeric = match symbolic {
            Symbolic::Llt(analysis) => Numeric::Llt(Llt::new(analysis, matrix.values(), cancel)?),
            Symbolic::Ldlt(analysis) => Numeric::Ldlt(analysis.factor(pattern, matrix)?),
            Symbolic::Lu { analysis, .. } => Numeric::Lu(Lu::new(analysis, pattern, matrix, cancel)?),
        };
        go_on_unless(cancel)?;
        let factor = Factor { shared: Arc::clone(&self.shared), numeric };
        factor.check_regular(matrix, cancel)?;
        Ok(factor)
    }
}
