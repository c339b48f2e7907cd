//! Numeric factorization: every front of the tree.

use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use nalgebra_sparse::CscMatrix;

use super::front::Front;
use crate::linalg::fronts::{FrontAnalysis, Kernel, Tree, Update};
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
    /// Memory of an earlier factor's units.
    spare: Vec<Mutex<Vec<T>>>,
}

impl<T: Scalar> Llt<T> {
    /// Factors A, or −A where the diagonal is negative; in the memory of an earlier factor, where there is one.
    pub(crate) fn new(
        analysis: &FrontAnalysis,
        matrix: &CscMatrix<T>,
        earlier: Option<Self>,
        cancel: &AtomicBool,
    ) -> Result<Self, LinalgError> {
        let values = matrix.values();
        // The diagonal's first entry is the first of column 0, since no row comes before it.
        let sign = values.first().map_or(1.0, |value| value.real().signum());
        let spare = earlier.into_iter().flat_map(|earlier| earlier.units).map(Mutex::new).collect();
        let (units, peak_bytes) = Tree::run(analysis, &Job { analysis, values, sign, spare }, cancel)?;
        Ok(Self { units, sign, peak_bytes })
    }
}

impl<T: Scalar> Kernel<T> for Job<'_, T> {
    type Kept = Vec<T>;

    fn room(&self, unit: usize, numbers: usize, _: usize) -> Vec<T> {
        let spare = self.spare.get(unit).map(|spare| spare.lock().expect("no task panics while it holds this"));
        let mut room = spare.map_or_else(Vec::new, |mut spare| std::mem::take(&mut *spare));
        room.clear();
        room.reserve_exact(numbers);
        room
    }

    fn eliminate(
        &self,
        supernode: usize,
        children: &[Update<T>],
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
            front.extend_add(childs_update, analysis.relative(*child as usize));
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
