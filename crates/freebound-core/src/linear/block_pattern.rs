//! Sparsity pattern of the Hessian of an energy over elements: a 2×2 block for every pair of unknowns that share an
//! element.

use crate::parallel::prelude::*;
use nalgebra_sparse::pattern::SparsityPattern;

use crate::problem::{Control, SolveError};

/// Marker of a point without an unknown, and of an entry that the matrix does not have.
pub(crate) const HELD: u32 = u32::MAX;

/// Number of unknowns per task.
const PART: usize = 2048;

pub(crate) fn number(count: usize) -> u32 {
    u32::try_from(count).expect("entries fit")
}

/// Unknowns that share an element with each unknown, itself included, ascending.
pub(crate) struct Neighbours {
    /// Start of the neighbours of each unknown in `list`, followed by the end of the last.
    starts: Vec<usize>,
    list: Vec<u32>,
}

impl Neighbours {
    /// Finds the neighbours of `count` unknowns. `of_corners` holds the unknown of each corner of each element, or
    /// [`HELD`].
    pub(crate) fn new(of_corners: &[[u32; 3]], count: usize) -> Self {
        // Elements at each unknown.
        let mut firsts = vec![0_u32; count + 1];
        for &unknown in of_corners.as_flattened().iter().filter(|&&u| u != HELD) {
            firsts[unknown as usize + 1] += 1;
        }
        for unknown in 0..count {
            firsts[unknown + 1] += firsts[unknown];
        }
        let mut next = firsts.clone();
        let mut around = vec![0_u32; firsts[count] as usize];
        for (element, unknowns) in of_corners.iter().enumerate() {
            for &unknown in unknowns.iter().filter(|&&u| u != HELD) {
                around[next[unknown as usize] as usize] = number(element);
                next[unknown as usize] += 1;
            }
        }
        let of_part = |part: &[u32]| {
            let (mut lengths, mut list, mut column) =
                (Vec::with_capacity(PART), Vec::with_capacity(8 * PART), Vec::new());
            for pair in part.windows(2) {
                column.clear();
                let elements = &around[pair[0] as usize..pair[1] as usize];
                column.extend(elements.iter().flat_map(|&element| of_corners[element as usize]).filter(|&u| u != HELD));
                column.sort_unstable();
                column.dedup();
                lengths.push(column.len());
                list.extend_from_slice(&column);
            }
            (lengths, list)
        };
        // Consecutive parts share a boundary entry.
        let parts: Vec<&[u32]> = (0..count).step_by(PART).map(|k| &firsts[k..=(k + PART).min(count)]).collect();
        let of_parts: Vec<(Vec<usize>, Vec<u32>)> = parts.into_par_iter().map(of_part).collect();
        let total = of_parts.iter().map(|(_, list)| list.len()).sum();
        let mut packed = Self { starts: Vec::with_capacity(count + 1), list: Vec::with_capacity(total) };
        packed.starts.push(0);
        for (lengths, list) in of_parts {
            for length in lengths {
                packed.starts.push(packed.starts[packed.starts.len() - 1] + length);
            }
            packed.list.extend(list);
        }
        packed
    }

    pub(crate) fn column_lengths(&self) -> Vec<u32> {
        self.starts.windows(2).map(|pair| number(2 * (pair[1] - pair[0]))).collect()
    }

    /// Start of the columns of each unknown among the values of the matrix, followed by the end of the last.
    pub(crate) fn columns(&self) -> Vec<u32> {
        self.starts.iter().map(|start| number(4 * start)).collect()
    }

    /// Index among the values of the matrix of the first entry of a block. The two unknowns must share an element.
    pub(crate) fn slot(&self, row: u32, column: u32) -> u32 {
        let (from, to) = (self.starts[column as usize], self.starts[column as usize + 1]);
        let at = self.list[from..to].binary_search(&row).expect("corners of one element are neighbours");
        number(4 * from + 2 * at)
    }

    /// Pattern with a 2×2 block for every pair of neighbours.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] if cancelled.
    pub(crate) fn block_pattern(&self, control: Control<'_>) -> Result<SparsityPattern, SolveError> {
        let count = self.starts.len() - 1;
        let mut offsets = Vec::with_capacity(2 * count + 1);
        let mut rows = Vec::with_capacity(4 * self.list.len());
        offsets.push(0);
        for unknowns in control.runs(count) {
            let unknowns = unknowns?;
            for pair in self.starts[unknowns.start..=unknowns.end].windows(2) {
                for _ in 0..2 {
                    let of_column = &self.list[pair[0]..pair[1]];
                    rows.extend(of_column.iter().flat_map(|&row| [2 * row as usize, 2 * row as usize + 1]));
                    offsets.push(rows.len());
                }
            }
        }
        control.go_on()?;
        let pattern = SparsityPattern::try_from_offsets_and_indices(2 * count, 2 * count, offsets, rows);
        control.go_on()?;
        Ok(pattern.expect("sorted and distinct"))
    }
}
