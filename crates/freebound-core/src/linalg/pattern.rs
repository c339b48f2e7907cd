//! Sparsity patterns and orders of elimination.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::parallel::prelude::*;
use faer::perm::PermRef;
use faer::sparse::SymbolicSparseColMatRef;
use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;

use super::LinalgError;

/// Number of columns of a pattern between two checks of the cancel flag.
pub(super) const COLUMNS_AT_ONCE: usize = 16_384;

/// Marker of "no parent" in a tree of `u32`.
pub(super) const NONE: u32 = u32::MAX;

/// Consecutive lists of 32-bit indices: the sorted columns of a symmetric pattern, the children of a tree's nodes.
#[derive(Clone, Debug)]
pub(crate) struct Pattern {
    /// Start of each list, followed by the end of the last.
    pub(crate) offsets: Vec<u32>,
    pub(crate) rows: Vec<u32>,
}

impl Pattern {
    /// Copies a pattern after checking that it is square and symmetric and has its diagonal.
    pub(super) fn checked(pattern: &SparsityPattern, cancel: &AtomicBool) -> Result<Self, LinalgError> {
        let order = pattern.major_dim();
        if pattern.minor_dim() != order {
            return Err(LinalgError::NotSquare { rows: pattern.minor_dim(), columns: order });
        }
        // faer reserves the sign bit.
        if i32::try_from(pattern.nnz()).is_err() {
            return Err(LinalgError::TooLarge { order });
        }
        let narrowed = |indices: &[usize]| indices.iter().map(|&index| narrow(index)).collect();
        let this = Self { offsets: narrowed(pattern.major_offsets()), rows: narrowed(pattern.minor_indices()) };
        this.check_symmetric(cancel)?;
        go_on_unless(cancel)?;
        Ok(this)
    }

    /// Converts the pattern to indices of matrices (`usize`).
    pub(crate) fn widened(&self) -> SparsityPattern {
        let wide = |indices: &[u32]| indices.par_iter().map(|&index| index as usize).collect();
        SparsityPattern::try_from_offsets_and_indices(self.order(), self.order(), wide(&self.offsets), wide(&self.rows))
            .expect("columns are sorted, and have no row twice")
    }

    pub(super) fn order(&self) -> usize {
        self.offsets.len() - 1
    }

    pub(super) fn column(&self, column: usize) -> &[u32] {
        &self.rows[self.offsets[column] as usize..self.offsets[column + 1] as usize]
    }

    pub(super) fn as_faer(&self) -> SymbolicSparseColMatRef<'_, u32> {
        let n = self.order();
        SymbolicSparseColMatRef::new_checked(n, n, &self.offsets, None, &self.rows)
    }

    /// True if a matrix has exactly the entries of this pattern.
    pub(super) fn is_that_of<T>(&self, matrix: &CscMatrix<T>) -> bool {
        let same = |narrow: &[u32], wide: &[usize]| {
            narrow.len() == wide.len() && narrow.par_iter().zip(wide).all(|(&narrow, &wide)| narrow as usize == wide)
        };
        matrix.nrows() == self.order()
            && same(&self.offsets, matrix.pattern().major_offsets())
            && same(&self.rows, matrix.pattern().minor_indices())
    }

    /// Pattern of pairs of unknowns, if unknowns form pairs 2k and 2k + 1 and all entries form blocks of 2 × 2.
    pub(super) fn of_pairs(&self) -> Option<Self> {
        let n = self.order();
        let are_pairs =
            |rows: &[u32]| rows.chunks(2).all(|pair| pair[0] % 2 == 0 && pair.get(1) == Some(&(pair[0] + 1)));
        let is_pair = |k: usize| self.column(2 * k) == self.column(2 * k + 1) && are_pairs(self.column(2 * k));
        if n == 0 || !n.is_multiple_of(2) || !(0..n / 2).all(is_pair) {
            return None;
        }
        let rows = (0..n / 2).flat_map(|k| self.column(2 * k).iter().step_by(2).map(|&row| row / 2)).collect();
        let offsets = self.offsets.iter().step_by(2).map(|&offset| offset / 4).collect();
        Some(Self { offsets, rows })
    }

    /// Checks symmetry in a single pass over the columns. Entry (i, j) of column j must be the next unread entry of
    /// row j in column i.
    pub(super) fn check_symmetric(&self, cancel: &AtomicBool) -> Result<(), LinalgError> {
        let mut next: Vec<u32> = self.offsets[..self.order()].to_vec();
        for column in 0..self.order() {
            if column % COLUMNS_AT_ONCE == 0 {
                go_on_unless(cancel)?;
            }
            let fault = |row: u32| LinalgError::PatternNotSymmetric { row: row as usize, column };
            let rows = self.column(column);
            if rows.binary_search(&narrow(column)).is_err() {
                return Err(fault(narrow(column)));
            }
            for &row in rows {
                let position = &mut next[row as usize];
                if *position >= self.offsets[row as usize + 1] || self.rows[*position as usize] != narrow(column) {
                    return Err(fault(row));
                }
                *position += 1;
            }
        }
        Ok(())
    }

    /// Index of the entry (j, i) for each entry (i, j).
    pub(super) fn transposed(&self) -> Vec<u32> {
        let mut next: Vec<u32> = self.offsets[..self.order()].to_vec();
        let place = |&row: &u32| {
            next[row as usize] += 1;
            next[row as usize] - 1
        };
        self.rows.iter().map(place).collect()
    }

    /// Rows of a column of the pattern renumbered by `order`, unsorted.
    pub(super) fn renumbered(&self, order: &Order, column: usize) -> impl Iterator<Item = u32> {
        let rows = self.column(order.new_to_old[column] as usize);
        rows.iter().map(|&old| order.old_to_new[old as usize])
    }
}

/// Converts an index that [`Pattern::checked`] has found to fit.
pub(super) fn narrow(index: usize) -> u32 {
    u32::try_from(index).expect("orders and positions were checked to fit 32 bits")
}

/// Renumbering of both rows and columns.
#[derive(Clone, Debug)]
pub(super) struct Order {
    pub(super) new_to_old: Vec<u32>,
    pub(super) old_to_new: Vec<u32>,
}

impl Order {
    /// Order whose new index `k` stands for `new_to_old[k]`.
    pub(super) fn from_new_to_old(new_to_old: Vec<u32>) -> Self {
        let mut old_to_new = vec![0; new_to_old.len()];
        for (new, &old) in new_to_old.iter().enumerate() {
            old_to_new[old as usize] = narrow(new);
        }
        Self { new_to_old, old_to_new }
    }

    /// Order that applies `self` and then `later`.
    pub(super) fn then(&self, later: &[u32]) -> Self {
        Self::from_new_to_old(later.iter().map(|&middle| self.new_to_old[middle as usize]).collect())
    }

    /// Order of the unknowns of a matrix, if the unknowns of this order stand for pairs: 2k and 2k + 1 for k.
    pub(super) fn of_pairs(&self) -> Self {
        Self::from_new_to_old(in_pairs(&self.new_to_old))
    }

    /// Order with 2k before 2k + 1 for k below `pairs`. Fill does not change if both have equal patterns.
    pub(super) fn with_pairs_in_turn(mut self, pairs: usize) -> Self {
        for (first, second) in (0..pairs).map(|k| (2 * k, 2 * k + 1)) {
            let [first_at, second_at] = [first, second].map(|old| self.old_to_new[old] as usize);
            if second_at < first_at {
                self.new_to_old.swap(first_at, second_at);
                self.old_to_new.swap(first, second);
            }
        }
        self
    }

    pub(super) fn as_faer(&self) -> PermRef<'_, u32> {
        PermRef::new_checked(&self.new_to_old, &self.old_to_new, self.new_to_old.len())
    }
}

/// Returns [`LinalgError::Cancelled`] if the caller cancelled.
pub(super) fn go_on_unless(cancel: &AtomicBool) -> Result<(), LinalgError> {
    if cancel.load(Ordering::Relaxed) { Err(LinalgError::Cancelled) } else { Ok(()) }
}

/// List of 2k and 2k + 1 for every k of a list.
pub(super) fn in_pairs(list: &[u32]) -> Vec<u32> {
    list.iter().flat_map(|&k| [2 * k, 2 * k + 1]).collect()
}

/// Starts of consecutive lists of the given lengths, followed by the end of the last.
pub(super) fn running_sum(counts: &[u32]) -> Vec<u32> {
    let mut total = 0usize;
    let later = counts.iter().map(|&count| {
        total += count as usize;
        narrow(total)
    });
    std::iter::once(0).chain(later).collect()
}
