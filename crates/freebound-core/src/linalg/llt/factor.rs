//! Numeric factorization of all fronts of the tree.

use std::convert::identity;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use super::front::Front;
use crate::linalg::fronts::{
    FrontAnalysis, Kept, Kernel, Numbers, Places, Room, Tree, Update, append_zeros, gather_in_full, gather_real,
};
use crate::linalg::scalar::Number;
use crate::linalg::{FactorStats, LinalgError};

/// L panels of every unit's supernodes, and the sign that makes the matrix positive.
#[derive(Debug)]
pub(crate) struct Llt<T: Number> {
    pub(super) units: Vec<Kept<T>>,
    pub(super) places: Places,
    pub(super) sign: T,
    peak_bytes: usize,
}

/// Data shared by the threads of a factorization.
struct Job<'a, T: Number, V> {
    analysis: &'a FrontAnalysis,
    /// Function that returns an entry, from its index among the values of the matrix and its column.
    value: &'a V,
    /// Memory of the units of an earlier factor.
    spare: Vec<Mutex<Kept<T>>>,
    cancel: &'a AtomicBool,
}

impl<T: Number> Llt<T> {
    /// Factors A, or −A if the diagonal is negative. The values are those of the analysed pattern.
    pub(crate) fn new(analysis: &FrontAnalysis, values: &[T], cancel: &AtomicBool) -> Result<Self, LinalgError> {
        // The first entry of column 0 is the diagonal entry, since no row comes before it.
        let is_negative = values.first().is_some_and(|value| value.real() < T::ZERO.real());
        let sign = if is_negative { -T::ONE } else { T::ONE };
        let value = |source: usize, _: usize| values[source].scale(sign.real());
        let places = Places::new(analysis, |source| values[source]);
        let factor = Job { analysis, value: &value, spare: Vec::new(), cancel }.run(places)?;
        Ok(Self { sign, ..factor })
    }

    /// Factors a positive real matrix. `value` returns an entry from its index in the analysed pattern and its
    /// column. Reuses the memory of an earlier factor, if any: allocating new memory costs a considerable part of the
    /// time of a factorization.
    pub(crate) fn of(
        analysis: &FrontAnalysis,
        value: &(impl Fn(usize, usize) -> T + Sync),
        earlier: Option<Self>,
        cancel: &AtomicBool,
    ) -> Result<Self, LinalgError> {
        let spare = earlier.into_iter().flat_map(|earlier| earlier.units).map(Mutex::new).collect();
        Job { analysis, value, spare, cancel }.run(Places::all_full(analysis))
    }
}

/// Destination of a front.
struct Target<'a, N> {
    left: &'a mut [N],
    update: &'a mut [N],
}

impl<T: Number, V: Fn(usize, usize) -> T + Sync> Job<'_, T, V> {
    fn run(self, places: Places) -> Result<Llt<T>, LinalgError> {
        let (units, peak_bytes) = Tree::run(self.analysis, &places, &self, self.cancel)?;
        Ok(Llt { units, places, sign: T::ONE, peak_bytes })
    }

    /// Assembles and eliminates a front, in full numbers or real parts, into its stored numbers and its update.
    fn eliminate_in<N: Number>(
        &self,
        supernode: usize,
        Target { left, update }: Target<'_, N>,
        number: impl Fn(T) -> N,
        add_children: impl FnOnce(&mut Front<'_, N>),
    ) -> Result<(), LinalgError> {
        let analysis = self.analysis;
        let shape = analysis.shape(supernode);
        let begin = analysis.begin[supernode] as usize;
        let columns = &analysis.order.new_to_old[begin..begin + shape.columns];
        for entry in analysis.entries(supernode) {
            let (source, target) = (entry.source as usize, entry.target as usize);
            left[target] = number((self.value)(source, columns[target / shape.height()] as usize));
        }
        let mut front = Front { shape, left, update };
        add_children(&mut front);
        front.eliminate(shape.threads(), self.cancel).map_err(|error| match error {
            LinalgError::NotPositiveDefinite { row } => LinalgError::NotPositiveDefinite { row: columns[row] as usize },
            other => other,
        })
    }
}

impl<T: Number, V: Fn(usize, usize) -> T + Sync> Kernel<T> for Job<'_, T, V> {
    type Kept = Kept<T>;

    fn room(&self, unit: usize, room: Room, _: usize) -> Kept<T> {
        let Some(spare) = self.spare.get(unit) else { return Kept::with_room(room) };
        let mut spare = spare.lock().expect("no task panics while it holds this");
        let mut kept = std::mem::take(&mut *spare);
        kept.full.clear();
        kept.full.reserve_exact(room.full);
        kept.real.clear();
        kept.real.reserve_exact(room.real);
        kept
    }

    fn eliminate(
        &self,
        supernode: usize,
        children: &[Update<T>],
        kept: &mut Kept<T>,
        update: &mut Numbers<T>,
    ) -> Result<(), LinalgError> {
        let length = self.analysis.kept_len(supernode);
        match update {
            Numbers::Full(update) => {
                let left = append_zeros(&mut kept.full, length);
                self.eliminate_in(supernode, Target { left, update }, identity, |front| {
                    gather_in_full(self.analysis, children, front);
                })
            }
            Numbers::Real(update) => {
                let left = append_zeros(&mut kept.real, length);
                self.eliminate_in(
                    supernode,
                    Target { left, update },
                    |number| number.parts()[0],
                    |front| gather_real(self.analysis, children, front),
                )
            }
        }
    }
}

impl<T: Number> Llt<T> {
    pub(crate) fn stats(&self) -> FactorStats {
        let factor_bytes = self.units.iter().map(Kept::bytes).sum();
        FactorStats { replaced_pivots: 0, factor_bytes, peak_bytes: self.peak_bytes }
    }
}
