//! Numeric factorization: every front of the tree.

use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use super::front::Front;
use crate::linalg::fronts::{FrontAnalysis, Kernel, Tree, Update};
use crate::linalg::scalar::Number;
use crate::linalg::{FactorStats, LinalgError};

/// The L panels of every unit's supernodes, and the sign that made the matrix positive.
#[derive(Debug)]
pub(crate) struct Llt<T> {
    pub(super) units: Vec<Vec<T>>,
    pub(super) sign: T,
    peak_bytes: usize,
}

/// What the threads of one factorization share.
struct Job<'a, T, V> {
    analysis: &'a FrontAnalysis,
    /// An entry by its place among the matrix's values, and its column.
    value: &'a V,
    /// Memory of an earlier factor's units.
    spare: Vec<Mutex<Vec<T>>>,
    cancel: &'a AtomicBool,
}

impl<T: Number> Llt<T> {
    /// Factors A, or −A where the diagonal is negative. The values are those of the analysed pattern.
    pub(crate) fn new(analysis: &FrontAnalysis, values: &[T], cancel: &AtomicBool) -> Result<Self, LinalgError> {
        // The diagonal's first entry is the first of column 0, since no row comes before it.
        let is_negative = values.first().is_some_and(|value| value.real() < T::ZERO.real());
        let sign = if is_negative { -T::ONE } else { T::ONE };
        let value = |source: usize, _: usize| values[source].scale(sign.real());
        Ok(Self { sign, ..Self::of(analysis, &value, None, cancel)? })
    }

    /// Factors a positive matrix whose entries `value` gives by their places in the analysed pattern, and their columns; in
    /// the memory of an earlier factor, where there is one: new memory costs a good part of the time of a factorization.
    pub(crate) fn of(
        analysis: &FrontAnalysis,
        value: &(impl Fn(usize, usize) -> T + Sync),
        earlier: Option<Self>,
        cancel: &AtomicBool,
    ) -> Result<Self, LinalgError> {
        let spare = earlier.into_iter().flat_map(|earlier| earlier.units).map(Mutex::new).collect();
        let (units, peak_bytes) = Tree::run(analysis, &Job { analysis, value, spare, cancel }, cancel)?;
        Ok(Self { units, sign: T::ONE, peak_bytes })
    }
}

impl<T: Number, V: Fn(usize, usize) -> T + Sync> Kernel<T> for Job<'_, T, V> {
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
        let begin = analysis.begin[supernode] as usize;
        let columns = &analysis.order.new_to_old[begin..begin + shape.columns];
        for entry in analysis.entries(supernode) {
            let (source, target) = (entry.source as usize, entry.target as usize);
            left[target] = (self.value)(source, columns[target / shape.height()] as usize);
        }
        let mut front = Front { shape, left, update };
        for (child, childs_update) in children {
            front.extend_add(childs_update, analysis.relative(*child as usize));
        }
        front.eliminate(shape.threads(), self.cancel).map_err(|error| match error {
            LinalgError::NotPositiveDefinite { row } => LinalgError::NotPositiveDefinite { row: columns[row] as usize },
            other => other,
        })
    }
}

impl<T> Llt<T> {
    pub(crate) fn stats(&self) -> FactorStats {
        let factor_bytes = self.units.iter().map(|unit| size_of_val(unit.as_slice())).sum();
        FactorStats { replaced_pivots: 0, factor_bytes, peak_bytes: self.peak_bytes }
    }
}
