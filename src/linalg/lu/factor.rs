//! Numeric factorization: the tree of fronts.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};

use faer::Par;
use nalgebra_sparse::CscMatrix;
use rayon::Scope;

use super::front::Front;
use super::pivot::Pivots;
use super::symbolic::LuAnalysis;
use crate::linalg::order::{NONE, Pattern, narrow};
use crate::linalg::scalar::Scalar;
use crate::linalg::sparse::power_of_two_near;
use crate::linalg::{FactorStats, LinalgError};

/// √ε: a pivot smaller than this against its row's largest entry is replaced.
const TINY_PIVOT: f64 = 1.490_116_119_384_765_6e-8;

/// Fronts with less work than this, in multiplications, are not worth more than one thread.
const PARALLEL_WORK: f64 = 2e6;

#[derive(Debug)]
pub(crate) struct Lu<T> {
    pub(super) units: Vec<UnitFactor<T>>,
    /// 1/R, by the caller's rows.
    pub(crate) row_scale: Vec<f64>,
    /// The caller's rows whose pivot was replaced, in the order of elimination.
    pub(crate) replaced_rows: Vec<u32>,
    peak_bytes: usize,
}

/// The blocks of a unit's supernodes, one after another, and the row swaps inside each.
#[derive(Debug, Default)]
pub(super) struct UnitFactor<T> {
    pub(super) values: Vec<T>,
    pub(super) swaps: Vec<u32>,
    replaced: Vec<u32>,
}

/// A supernode's update on its way to the parent.
type Update<T> = (u32, Vec<T>);

/// What the threads of one factorization share.
struct Job<'a, T> {
    analysis: &'a LuAnalysis,
    pattern: &'a Pattern,
    values: &'a [T],
    row_scale: &'a [f64],
    /// Smallest pivot accepted, by the caller's rows.
    thresholds: &'a [f64],
    cancel: &'a AtomicBool,
    done: Vec<OnceLock<UnitFactor<T>>>,
    inboxes: Vec<Mutex<Vec<Update<T>>>>,
    awaited: Vec<AtomicUsize>,
    memory: Memory,
}

#[derive(Default)]
struct Memory {
    now: AtomicUsize,
    peak: AtomicUsize,
}

impl Memory {
    fn take(&self, bytes: usize) {
        let now = self.now.fetch_add(bytes, Ordering::Relaxed) + bytes;
        self.peak.fetch_max(now, Ordering::Relaxed);
    }
    fn give_back(&self, bytes: usize) {
        self.now.fetch_sub(bytes, Ordering::Relaxed);
    }
}

impl LuAnalysis {
    pub(crate) fn factor<T: Scalar>(
        &self,
        pattern: &Pattern,
        matrix: &CscMatrix<T>,
        cancel: &AtomicBool,
    ) -> Result<Lu<T>, LinalgError> {
        let (row_scale, thresholds) = equilibrate(pattern, matrix.values())?;
        let job = Job {
            analysis: self,
            pattern,
            values: matrix.values(),
            row_scale: &row_scale,
            thresholds: &thresholds,
            cancel,
            done: self.units.iter().map(|_| OnceLock::new()).collect(),
            inboxes: self.units.iter().map(|_| Mutex::default()).collect(),
            awaited: self.units.iter().map(|unit| AtomicUsize::new(unit.awaited)).collect(),
            memory: Memory::default(),
        };
        rayon::scope(|scope| {
            // A thread takes its newest task first, so the last spawned here is the first unit in postorder.
            for unit in (0..self.units.len()).rev().filter(|&unit| self.units[unit].awaited == 0) {
                let job = &job;
                scope.spawn(move |scope| job.run(unit, scope));
            }
        });
        let peak_bytes = job.memory.peak.into_inner();
        let units: Option<Vec<_>> = job.done.into_iter().map(OnceLock::into_inner).collect();
        let units = units.ok_or(LinalgError::Cancelled)?;
        let replaced = units.iter().flat_map(|unit| &unit.replaced);
        let replaced_rows = replaced.map(|&row| self.order.new_to_old[row as usize]).collect();
        Ok(Lu { units, row_scale, replaced_rows, peak_bytes })
    }
}

impl<T: Scalar> Job<'_, T> {
    fn run<'scope>(&'scope self, unit: usize, scope: &Scope<'scope>) {
        let range = self.analysis.units[unit].range.clone();
        let kept: usize = range.clone().map(|s| self.analysis.shape(s).kept_len()).sum();
        let columns = self.analysis.begin[range.end] - self.analysis.begin[range.start];
        self.memory.take(kept * size_of::<T>());
        let mut factor = UnitFactor {
            values: Vec::with_capacity(kept),
            swaps: Vec::with_capacity(columns as usize),
            replaced: Vec::new(),
        };
        let mut arrived = std::mem::take(&mut *self.inboxes[unit].lock().expect("no task panics while it holds this"));
        arrived.sort_unstable_by_key(|&(child, _)| child);
        let mut waiting: Vec<Option<Vec<T>>> = range.clone().map(|_| None).collect();
        for supernode in range.clone() {
            if self.cancel.load(Ordering::Relaxed) {
                return;
            }
            let children = self.analysis.children.column(supernode).iter().map(|&child| {
                let update = if (child as usize) < range.start {
                    let place = arrived.binary_search_by_key(&child, |&(child, _)| child);
                    place.ok().map(|place| std::mem::take(&mut arrived[place].1))
                } else {
                    waiting[child as usize - range.start].take()
                };
                (child, update.expect("children come before their parent"))
            });
            let update = self.front(supernode, children, &mut factor);
            match self.analysis.parent[supernode] {
                NONE => {}
                parent if (parent as usize) < range.end => waiting[supernode - range.start] = Some(update),
                parent => self.send(supernode, parent, update, scope),
            }
        }
        let fresh = self.done[unit].set(factor).is_ok();
        debug_assert!(fresh, "a unit runs once");
    }

    /// Hands an update to another unit, and starts that unit if this was the last it waited for.
    fn send<'scope>(&'scope self, supernode: usize, parent: u32, update: Vec<T>, scope: &Scope<'scope>) {
        let unit = self.analysis.unit_of[parent as usize] as usize;
        self.inboxes[unit].lock().expect("no task panics while it holds this").push((narrow(supernode), update));
        if self.awaited[unit].fetch_sub(1, Ordering::AcqRel) == 1 {
            scope.spawn(move |scope| self.run(unit, scope));
        }
    }

    /// Assembles and eliminates one front; its panels are appended to the unit's factor.
    fn front(
        &self,
        supernode: usize,
        children: impl Iterator<Item = (u32, Vec<T>)>,
        factor: &mut UnitFactor<T>,
    ) -> Vec<T> {
        let analysis = self.analysis;
        let shape = analysis.shape(supernode);
        let start = factor.values.len();
        factor.values.resize(start + shape.kept_len(), T::ZERO);
        let block = &mut factor.values[start..];
        for entry in analysis.entries(supernode) {
            let source = entry.source as usize;
            let scale = self.row_scale[self.pattern.rows[source] as usize];
            block[entry.target as usize] = self.values[source].scale(scale);
        }
        self.memory.take(shape.update_len() * size_of::<T>());
        let mut update = vec![T::ZERO; shape.update_len()];
        let (left, right) = block.split_at_mut(shape.left_len());
        let mut front = Front { shape, left, right, update: &mut update };
        for (child, childs_update) in children {
            front.extend_add(&childs_update, analysis.relative(child as usize));
            self.memory.give_back(childs_update.len() * size_of::<T>());
        }
        let begin = analysis.begin[supernode] as usize;
        let rows = &analysis.order.new_to_old[begin..begin + shape.columns];
        let mut thresholds: Vec<f64> = rows.iter().map(|&row| self.thresholds[row as usize]).collect();
        let first = factor.swaps.len();
        factor.swaps.resize(first + shape.columns, 0);
        let swaps = &mut factor.swaps[first..];
        let mut pivots = Pivots { thresholds: &mut thresholds, swaps, replaced: Vec::new() };
        let par = if shape.work() < PARALLEL_WORK { Par::Seq } else { Par::rayon(0) };
        front.eliminate(&mut pivots, par);
        factor.replaced.extend(pivots.replaced.iter().map(|&k| analysis.begin[supernode] + narrow(k)));
        update
    }
}

impl<T> Lu<T> {
    pub(crate) fn stats(&self) -> FactorStats {
        let factor_bytes = self.units.iter().map(|unit| size_of_val(unit.values.as_slice())).sum();
        FactorStats { replaced_pivots: self.replaced_rows.len(), factor_bytes, peak_bytes: self.peak_bytes }
    }
}

/// The factor of every row, a power of two near 1/|aᵢᵢ|, so that scaling rounds nothing; and √ε of the scaled row's
/// largest entry. Where the diagonal is tiny against its row, the row's largest entry stands in.
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
