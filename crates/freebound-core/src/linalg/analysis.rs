//! The one interface of the layer: analyse a pattern, factor a matrix; `factor.rs` solves.

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

/// What is known of the values of a matrix. The pattern is symmetric, diagonal included, in every case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A or −A is Hermitian positive definite; both triangles are stored.
    Hermitian,
    /// Hermitian `[−E A; Aᴴ F]` with E positive definite and F positive semidefinite; both triangles are stored. The
    /// first `pairs` rows of E and all of F stand in turn (e₀, f₀, e₁, f₁, …), the rows of a pair with one pattern, then
    /// the other rows of E.
    Augmented {
        /// How many rows F has.
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

/// An order of elimination, for patterns that differ in a few places.
#[derive(Clone, Debug)]
pub struct EliminationOrder {
    order: Order,
    /// Multiplications of a factorization in it.
    work: f64,
}

/// An order that takes so many times the work for a pattern that it was not found for is given up for a new one.
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
        /// For each entry of the pattern the place of its mirror image.
        transposed: Vec<u32>,
    },
}

impl Analysis {
    /// Orders the pattern and finds the pattern of its factors. Looks at `cancel` all the way.
    ///
    /// # Errors
    ///
    /// [`LinalgError::NotSquare`], [`LinalgError::PatternNotSymmetric`] (which includes a missing diagonal entry)
    /// [`LinalgError::TooLarge`] and [`LinalgError::Cancelled`].
    pub fn new(kind: Kind, pattern: &SparsityPattern, cancel: &AtomicBool) -> Result<Self, LinalgError> {
        Self::of(kind, Arc::new(Pattern::checked(pattern, cancel)?), cancel)
    }

    /// The same of a pattern that is known to be symmetric, with its diagonal; it is shared, not copied.
    ///
    /// # Errors
    ///
    /// [`LinalgError::TooLarge`] and [`LinalgError::Cancelled`].
    pub(crate) fn of(kind: Kind, pattern: Arc<Pattern>, cancel: &AtomicBool) -> Result<Self, LinalgError> {
        // faer keeps a sign bit to itself.
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

    /// Analyses the pattern of a Hermitian matrix in an order of elimination: for patterns that differ from that which it was
    /// found for in a few places. One of another size is ordered anew, and one that takes much more work in that order.
    ///
    /// # Errors
    ///
    /// Those of [`Analysis::new`].
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

    /// The order of elimination of a Hermitian matrix; none of others.
    pub fn order(&self) -> Option<EliminationOrder> {
        match &self.shared.symbolic {
            Symbolic::Llt(llt) => Some(EliminationOrder { order: llt.order.clone(), work: llt.work() }),
            Symbolic::Ldlt(_) | Symbolic::Lu { .. } => None,
        }
    }

    /// Factors a matrix of the analysed pattern. LU and Cholesky look at `cancel` at every supernode, and at every few
    /// columns of it, the augmented factorization only before and after.
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
