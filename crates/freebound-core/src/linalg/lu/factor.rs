//! Numeric factorization of all fronts of the tree.

use std::convert::identity;
use std::sync::atomic::AtomicBool;

use nalgebra_sparse::CscMatrix;

use super::front::Front;
use super::pivot::Pivots;
use crate::linalg::fronts::{
    FrontAnalysis, Kept, Kernel, Numbers, Places, Room, Tree, Update, append_zeros, gather_in_full, gather_real,
};
use crate::linalg::pattern::{Pattern, go_on_unless, narrow};
use crate::linalg::scalar::{Number, Scalar};
use crate::linalg::sparse::power_of_two_near;
use crate::linalg::{FactorStats, LinalgError};

/// Ratio √ε of a pivot to the largest entry of its row below which the pivot is replaced.
const TINY_PIVOT: f64 = 1.490_116_119_384_765_6e-8;

#[derive(Debug)]
pub(crate) struct Lu<T: Number> {
    pub(super) units: Vec<UnitFactor<T>>,
    pub(super) places: Places,
    /// Diagonal of R⁻¹, in the order of the caller's rows.
    pub(crate) row_scale: Vec<f64>,
    /// Rows of the caller whose pivot was replaced, in the order of elimination.
    pub(crate) replaced_rows: Vec<u32>,
    peak_bytes: usize,
}

/// Consecutive blocks of a unit's supernodes, and the row swaps inside each.
#[derive(Debug)]
pub(super) struct UnitFactor<T: Number> {
    pub(super) values: Kept<T>,
    pub(super) swaps: Vec<u32>,
    replaced: Vec<u32>,
}

/// Data shared by the threads of a factorization.
struct Job<'a, T> {
    analysis: &'a FrontAnalysis,
    pattern: &'a Pattern,
    values: &'a [T],
    row_scale: &'a [f64],
    /// Smallest accepted pivot, in the order of the caller's rows.
    thresholds: &'a [f64],
    cancel: &'a AtomicBool,
}

impl<T: Scalar> Lu<T> {
    pub(crate) fn new(
        analysis: &FrontAnalysis,
        pattern: &Pattern,
        matrix: &CscMatrix<T>,
        cancel: &AtomicBool,
    ) -> Result<Self, LinalgError> {
        let (row_scale, thresholds) = equilibrate(pattern, matrix.values())?;
        go_on_unless(cancel)?;
        let values = matrix.values();
        let job = Job { analysis, pattern, values, row_scale: &row_scale, thresholds: &thresholds, cancel };
        let places = Places::new(analysis, |source| values[source]);
        let (units, peak_bytes) = Tree::run(analysis, &places, &job, cancel)?;
        let replaced = units.iter().flat_map(|unit| &unit.replaced);
        let replaced_rows = replaced.map(|&row| analysis.order.new_to_old[row as usize]).collect();
        Ok(Self { units, places, row_scale, replaced_rows, peak_bytes })
    }
}

impl<T: Scalar> Kernel<T> for Job<'_, T> {
    type Kept = UnitFactor<T>;

    fn room(&self, _: usize, room: Room, columns: usize) -> UnitFactor<T> {
        UnitFactor { values: Kept::with_room(room), swaps: Vec::with_capacity(columns), replaced: Vec::new() }
    }

    fn eliminate(
        &self,
        supernode: usize,
        children: &[Update<T>],
        factor: &mut UnitFactor<T>,
        update: &mut Numbers<T>,
    ) -> Result<(), LinalgError> {
        let analysis = self.analysis;
        let length = analysis.kept_len(supernode);
        let first = factor.swaps.len();
        factor.swaps.resize(first + analysis.shape(supernode).columns, 0);
        let swaps = &mut factor.swaps[first..];
        let replaced = match update {
            Numbers::Full(update) => {
                let block = append_zeros(&mut factor.values.full, length);
                self.eliminate_in(supernode, Target { block, update, swaps }, identity, |front| {
                    gather_in_full(analysis, children, front);
                })
            }
            Numbers::Real(update) => {
                let block = append_zeros(&mut factor.values.real, length);
                self.eliminate_in(
                    supernode,
                    Target { block, update, swaps },
                    |number| number.parts()[0],
                    |front| gather_real(analysis, children, front),
                )
            }
        };
        factor.replaced.extend(replaced?.iter().map(|&k| analysis.begin[supernode] + narrow(k)));
        Ok(())
    }
}

/// Destination of a front.
struct Target<'a, N> {
    block: &'a mut [N],
    update: &'a mut [N],
    swaps: &'a mut [u32],
}

impl<T: Scalar> Job<'_, T> {
    /// Assembles and eliminates a front, in full numbers or real parts. Returns the columns whose pivots were
    /// replaced.
    fn eliminate_in<N: Scalar>(
        &self,
        supernode: usize,
        Target { block, update, swaps }: Target<'_, N>,
        number: impl Fn(T) -> N,
        add_children: impl FnOnce(&mut Front<'_, N>),
    ) -> Result<Vec<usize>, LinalgError> {
        let analysis = self.analysis;
        let shape = analysis.shape(supernode);
        for entry in analysis.entries(supernode) {
            let source = entry.source as usize;
            let scale = self.row_scale[self.pattern.rows[source] as usize];
            block[entry.target as usize] = number(self.values[source].scale(scale));
        }
        let (left, right) = block.split_at_mut(shape.left_len());
        let mut front = Front { shape, left, right, update };
        add_children(&mut front);
        let begin = analysis.begin[supernode] as usize;
        let rows = &analysis.order.new_to_old[begin..begin + shape.columns];
        let mut thresholds: Vec<f64> = rows.iter().map(|&row| self.thresholds[row as usize]).collect();
        let mut pivots = Pivots { thresholds: &mut thresholds, swaps, replaced: Vec::new() };
        front.eliminate(&mut pivots, shape.threads(), self.cancel)?;
        Ok(pivots.replaced)
    }
}

impl<T: Number> Lu<T> {
    pub(crate) fn stats(&self) -> FactorStats {
        let factor_bytes = self.units.iter().map(|unit| unit.values.bytes()).sum();
        FactorStats { replaced_pivots: self.replaced_rows.len(), factor_bytes, peak_bytes: self.peak_bytes }
    }
}

/// Factor of every row, a power of two near 1/|aᵢᵢ|, so that scaling does not round; and √ε times the largest entry
/// of the scaled row. If the diagonal is tiny relative to its row, the largest entry of the row replaces it.
fn equilibrate<T: Scalar>(pattern: &Pattern, values: &[T]) -> Result<(Vec<f64>, Vec<f64>), LinalgError> {
    let n = pattern.order();
    let (mut largest, mut diagonal, mut column_largest) = (vec![0.0f64; n], vec![0.0; n], vec![0.0f64; n]);
    for (column, column_largest) in column_largest.iter_mut().enumerate() {
        let entries = pattern.offsets[column] as usize..pattern.offsets[column + 1] as usize;
        for (&row, &value) in pattern.rows[entries.clone()].iter().zip(&values[entries]) {
            let (row, size) = (row as usize, value.size());
            largest[row] = largest[row].max(size);
            *column_largest = column_largest.max(size);
            if row == column {
                diagonal[row] = size;
            }
        }
    }
    if let Some(row) = (0..n).find(|&row| largest[row] == 0.0 || column_largest[row] == 0.0) {
        return Err(LinalgError::Singular { row });
    }
    let scale = |row: usize| {
        let reference = if diagonal[row] > TINY_PIVOT * largest[row] { diagonal[row] } else { largest[row] };
        power_of_two_near(reference).recip()
    };
    let row_scale: Vec<f64> = (0..n).map(scale).collect();
    let thresholds = row_scale.iter().zip(&largest).map(|(scale, largest)| TINY_PIVOT * scale * largest).collect();
    Ok((row_scale, thresholds))
}
