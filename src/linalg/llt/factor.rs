//! Numeric factorization: every front of the tree.

use std::sync::atomic::AtomicBool;

use nalgebra_sparse::CscMatrix;

use super::front::Front;
use crate::linalg::fronts::{FrontAnalysis, Kernel, Tree};
use crate::linalg::scalar::Scalar;
use crate::linalg::{FactorStats, LinalgError};

/// The L panels of every unit's supernodes, and the sign that made the matrix positive.
#[derive(Debug)]
pub(crate) struct Llt<T> {
    pub(super) units: Vec<Vec<T>>,
    pub(super) sign: f64,
    peak_bytes: usize,
}

/// What the threads of one factorization share.
struct Job<'a, T> {
    analysis: &'a FrontAnalysis,
    values: &'a [T],
    sign: f64,
}

impl<T: Scalar> Llt<T> {
    /// Factors A, or −A where the diagonal is negative.
    pub(crate) fn new(
        analysis: &FrontAnalysis,
        matrix: &CscMatrix<T>,
        cancel: &AtomicBool,
    ) -> Result<Self, LinalgError> {
        let values = matrix.values();
        // The diagonal's first entry is the first of column 0, since no row comes before it.
        let sign = values.first().map_or(1.0, |value| value.real().signum());
        let (units, peak_bytes) = Tree::run(analysis, &Job { analysis, values, sign }, cancel)?;
        Ok(Self { units, sign, peak_bytes })
    }
}

impl<T: Scalar> Kernel<T> for Job<'_, T> {
    type Kept = Vec<T>;

    fn room(&self, numbers: usize, _: usize) -> Vec<T> {
        Vec::with_capacity(numbers)
    }

    fn eliminate(
        &self,
        supernode: usize,
        children: &mut dyn Iterator<Item = (u32, Vec<T>)>,
        factor: &mut Vec<T>,
        update: &mut [T],
    ) -> Result<(), LinalgError> {
        let analysis = self.analysis;
        let shape = analysis.shape(supernode);
        let start = factor.len();
        factor.resize(start + analysis.kept_len(supernode), T::ZERO);
        let left = &mut factor[start..];
        for entry in analysis.entries(supernode) {
            left[entry.target as usize] = self.values[entry.source as usize].scale(self.sign);
        }
        let mut front = Front { shape, left, update };
        for (child, childs_update) in children {
            front.extend_add(&childs_update, analysis.relative(child as usize));
        }
        front.eliminate(shape.threads()).map_err(|column| {
            let row = analysis.order.new_to_old[analysis.begin[supernode] as usize + column] as usize;
            LinalgError::NotPositiveDefinite { row }
        })
    }
}

impl<T> Llt<T> {
    pub(crate) fn stats(&self) -> FactorStats {
        let factor_bytes = self.units.iter().map(|unit| size_of_val(unit.as_slice())).sum();
        FactorStats { replaced_pivots: 0, factor_bytes, peak_bytes: self.peak_bytes }
    }
}
