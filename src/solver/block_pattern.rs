//! The pattern of a membrane's Hessian: a 2×2 block for every pair of unknowns that share an element.

use nalgebra_sparse::pattern::SparsityPattern;

/// A point without an unknown of its own, and an entry that the matrix does not have.
pub(super) const HELD: u32 = u32::MAX;

pub(super) fn number(count: usize) -> u32 {
    u32::try_from(count).expect("entries fit")
}

/// For each unknown the unknowns that share an element with it, itself included, ascending.
pub(super) struct Neighbours {
    /// Where the neighbours of each unknown begin in `list`, and where the last ones end.
    starts: Vec<usize>,
    list: Vec<u32>,
}

impl Neighbours {
    /// Neighbours of so many unknowns. Of each element its corners' unknowns, or [`HELD`].
    pub(super) fn new(of_corners: &[[u32; 3]], count: usize) -> Self {
        let mut starts = vec![0_usize; count + 1];
        for &unknown in of_corners.as_flattened().iter().filter(|&&u| u != HELD) {
            starts[unknown as usize + 1] += 3;
        }
        for i in 0..count {
            starts[i + 1] += starts[i];
        }
        let mut list = vec![HELD; starts[count]];
        let mut next = starts.clone();
        for &unknowns in of_corners {
            for column in unknowns.into_iter().filter(|&u| u != HELD) {
                for row in unknowns {
                    list[next[column as usize]] = row;
                    next[column as usize] += 1;
                }
            }
        }
        let mut packed = Self { starts: Vec::with_capacity(count + 1), list: Vec::with_capacity(list.len() / 2) };
        packed.starts.push(0);
        for pair in starts.windows(2) {
            let column = &mut list[pair[0]..pair[1]];
            column.sort_unstable();
            let distinct = column.chunk_by(|a, b| a == b).map(|same| same[0]);
            packed.list.extend(distinct.filter(|&row| row != HELD));
            packed.starts.push(packed.list.len());
        }
        packed
    }

    pub(super) fn column_lengths(&self) -> Vec<u32> {
        self.starts.windows(2).map(|pair| number(2 * (pair[1] - pair[0]))).collect()
    }

    /// The place among the matrix's values of the first entry of the block of two unknowns that share an element.
    pub(super) fn slot(&self, row: u32, column: u32) -> u32 {
        let (from, to) = (self.starts[column as usize], self.starts[column as usize + 1]);
        let at = self.list[from..to].binary_search(&row).expect("corners of one element are neighbours");
        number(4 * from + 2 * at)
    }

    /// The pattern with a 2×2 block for every pair of neighbours.
    pub(super) fn block_pattern(&self) -> SparsityPattern {
        let count = self.starts.len() - 1;
        let mut offsets = Vec::with_capacity(2 * count + 1);
        let mut rows = Vec::with_capacity(4 * self.list.len());
        offsets.push(0);
        for pair in self.starts.windows(2) {
            for _ in 0..2 {
                let of_column = &self.list[pair[0]..pair[1]];
                rows.extend(of_column.iter().flat_map(|&row| [2 * row as usize, 2 * row as usize + 1]));
                offsets.push(rows.len());
            }
        }
        SparsityPattern::try_from_offsets_and_indices(2 * count, 2 * count, offsets, rows).expect("sorted and distinct")
    }
}
