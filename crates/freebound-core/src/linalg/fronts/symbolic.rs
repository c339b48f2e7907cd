//! Symbolic factorization: the pattern of every front, and the position of each number.
//!
//! Everything that depends on the pattern alone is computed here once, so that the numeric factorization neither
//! searches nor sorts. `relative` holds the positions of the rows of an update in the parent's front, `entries` the
//! positions of the entries of A in their fronts.

use std::sync::atomic::AtomicBool;

use crate::parallel::parallelism;
use crate::parallel::prelude::*;
use faer::Par;

use super::supernodes::{Supernodes, supernodes};
use super::units::{Unit, units};
use crate::linalg::LinalgError;
use crate::linalg::elimination::{Elimination, children};
use crate::linalg::pattern::{COLUMNS_AT_ONCE, NONE, Order, Pattern, go_on_unless, in_pairs, narrow, running_sum};

/// Number of multiplications below which a single thread is used.
const PARALLEL_WORK: f64 = 2e6;

/// Entry of the caller's matrix and its position in the stored part of a front.
#[derive(Clone, Copy, Debug)]
pub(in crate::linalg) struct Entry {
    /// Index among the values of the matrix.
    pub(in crate::linalg) source: u32,
    /// Index in the supernode's block: L panel first, then the U panel if it is stored.
    pub(in crate::linalg) target: u32,
}

/// Sizes of a front.
#[derive(Clone, Copy, Debug)]
pub(in crate::linalg) struct Shape {
    /// Number of columns that the supernode eliminates.
    pub(in crate::linalg) columns: usize,
    /// Number of rows, and of columns, that the supernode passes to its parent.
    pub(in crate::linalg) below: usize,
}

impl Shape {
    pub(in crate::linalg) fn height(self) -> usize {
        self.columns + self.below
    }
    /// Number of entries of the L panel, diagonal block included.
    pub(in crate::linalg) fn left_len(self) -> usize {
        self.height() * self.columns
    }
    pub(in crate::linalg) fn update_len(self) -> usize {
        self.below * self.below
    }
    /// Threads for its dense operations.
    pub(in crate::linalg) fn threads(self) -> Par {
        threads_for(self.work())
    }
    /// Number of multiplications of an LU, to leading order.
    pub(in crate::linalg) fn work(self) -> f64 {
        let (c, p) = (self.columns as f64, self.below as f64);
        c * (c * c / 3.0 + c * p + p * p)
    }
}

/// Threads for a number of multiplications.
pub(in crate::linalg) fn threads_for(work: f64) -> Par {
    if work < PARALLEL_WORK { Par::Seq } else { parallelism() }
}

/// Panels of a front that are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::linalg) enum Sides {
    /// L alone, with lower triangles of diagonal blocks and updates: the matrix is Hermitian.
    Lower,
    /// L and U.
    Both,
}

/// Pattern of L and U, supernode by supernode, in a postorder of the supernode tree.
#[derive(Debug)]
pub(in crate::linalg) struct FrontAnalysis {
    sides: Sides,
    pub(in crate::linalg) order: Order,
    /// First column of each supernode, followed by the order of the matrix.
    pub(in crate::linalg) begin: Vec<u32>,
    pub(in crate::linalg) parent: Vec<u32>,
    /// Rows of each supernode below its diagonal block, ascending, in the order of elimination.
    pub(in crate::linalg) rows: Pattern,
    /// Positions of `rows` in the fronts of the parents.
    relative: Vec<u32>,
    entry_offsets: Vec<u32>,
    entries: Vec<Entry>,
    pub(in crate::linalg) children: Pattern,
    pub(in crate::linalg) units: Vec<Unit>,
    pub(in crate::linalg) unit_of: Vec<u32>,
}

impl FrontAnalysis {
    /// Analyses a pattern in an order of elimination, which may be an order of pairs (see [`Pattern::of_pairs`]).
    pub(in crate::linalg) fn new(
        pattern: &Pattern,
        elimination: &Elimination,
        sides: Sides,
        cancel: &AtomicBool,
    ) -> Result<Self, LinalgError> {
        let Plan { order, begin, parent, rows } = match &elimination.pairs {
            Some(pairs) => Plan::new(pairs, elimination, cancel)?.of_pairs(),
            None => Plan::new(pattern, elimination, cancel)?,
        };
        go_on_unless(cancel)?;
        let children = children(&parent);
        let mut this = Self {
            sides,
            order,
            begin,
            parent,
            rows,
            relative: Vec::new(),
            entry_offsets: Vec::new(),
            entries: Vec::new(),
            children,
            units: Vec::new(),
            unit_of: Vec::new(),
        };
        // Positions inside a front have 32 bits: the order of a front is at most 65,535.
        let too_large = |s| u32::try_from(this.shape(s).height().pow(2)).is_err();
        if (0..this.count()).any(too_large) {
            return Err(LinalgError::TooLarge { order: pattern.order() });
        }
        this.relative = this.relative_rows(cancel)?;
        this.place_entries(pattern, cancel)?;
        let work: Vec<f64> = (0..this.count()).map(|s| this.shape(s).work()).collect();
        (this.units, this.unit_of) = units(&this.parent, &work);
        Ok(this)
    }

    pub(in crate::linalg) fn count(&self) -> usize {
        self.parent.len()
    }

    pub(in crate::linalg) fn shape(&self, supernode: usize) -> Shape {
        let columns = (self.begin[supernode + 1] - self.begin[supernode]) as usize;
        Shape { columns, below: self.rows.column(supernode).len() }
    }

    /// Number of multiplications of all fronts.
    pub(in crate::linalg) fn work(&self) -> f64 {
        (0..self.count()).map(|supernode| self.shape(supernode).work()).sum()
    }

    /// Number of stored numbers of a front.
    pub(in crate::linalg) fn kept_len(&self, supernode: usize) -> usize {
        let shape = self.shape(supernode);
        match self.sides {
            Sides::Lower => shape.left_len(),
            Sides::Both => shape.left_len() + shape.columns * shape.below,
        }
    }

    /// Positions of the rows of a supernode below its diagonal block in the parent's front.
    pub(in crate::linalg) fn relative(&self, supernode: usize) -> &[u32] {
        &self.relative[self.rows.offsets[supernode] as usize..self.rows.offsets[supernode + 1] as usize]
    }

    pub(in crate::linalg) fn entries(&self, supernode: usize) -> &[Entry] {
        &self.entries[self.entry_offsets[supernode] as usize..self.entry_offsets[supernode + 1] as usize]
    }

    fn relative_rows(&self, cancel: &AtomicBool) -> Result<Vec<u32>, LinalgError> {
        let parts = in_tasks(self.count(), cancel, |supernodes| {
            let mut relative = Vec::new();
            for supernode in supernodes.filter(|&supernode| self.parent[supernode] != NONE) {
                let parent = self.parent[supernode] as usize;
                let (begin, end) = (self.begin[parent], self.begin[parent + 1]);
                let mut parents_rows = self.rows.column(parent).iter().zip(end - begin..);
                for &row in self.rows.column(supernode) {
                    relative.push(if row < end {
                        row - begin
                    } else {
                        let found = parents_rows.by_ref().find(|&(&other, _)| other == row);
                        found.expect("a child's rows lie in its parent's front").1
                    });
                }
            }
            relative
        });
        Ok(parts?.concat())
    }

    fn place_entries(&mut self, pattern: &Pattern, cancel: &AtomicBool) -> Result<(), LinalgError> {
        let mirror = if self.sides == Sides::Both { pattern.transposed() } else { Vec::new() };
        go_on_unless(cancel)?;
        let parts = in_tasks(self.count(), cancel, |supernodes| {
            let mut local = vec![0u32; pattern.order()];
            let (mut counts, mut entries) = (Vec::with_capacity(supernodes.len()), Vec::new());
            for supernode in supernodes {
                let before = entries.len();
                self.place_entries_of(supernode, Source { pattern, mirror: &mirror }, &mut local, &mut entries);
                counts.push(narrow(entries.len() - before));
            }
            (counts, entries)
        });
        let (counts, entries): (Vec<_>, Vec<_>) = parts?.into_iter().unzip();
        (self.entry_offsets, self.entries) = (running_sum(&counts.concat()), entries.concat());
        go_on_unless(cancel)
    }

    /// Appends the entries of a front. `local` is scratch memory for all rows.
    fn place_entries_of(&self, supernode: usize, from: Source<'_>, local: &mut [u32], entries: &mut Vec<Entry>) {
        let Shape { columns, below } = self.shape(supernode);
        let (begin, end) = (self.begin[supernode], self.begin[supernode + 1]);
        let height = narrow(columns + below);
        for (&row, place) in self.rows.column(supernode).iter().zip(0..) {
            local[row as usize] = place;
        }
        for column in begin..end {
            let old = self.order.new_to_old[column as usize] as usize;
            let place = column - begin;
            for source in from.pattern.offsets[old]..from.pattern.offsets[old + 1] {
                let row = self.order.old_to_new[from.pattern.rows[source as usize] as usize];
                if row >= end {
                    let below = local[row as usize];
                    let target = height * place + narrow(columns) + below;
                    entries.push(Entry { source, target });
                    if self.sides == Sides::Both {
                        let target = height * narrow(columns) + narrow(columns) * below + place;
                        entries.push(Entry { source: from.mirror[source as usize], target });
                    }
                } else if row >= if self.sides == Sides::Both { begin } else { column } {
                    entries.push(Entry { source, target: height * place + row - begin });
                }
            }
        }
    }
}

/// Source of entries: a pattern, and the index of the mirror image of each entry if both sides are stored.
#[derive(Clone, Copy)]
struct Source<'a> {
    pattern: &'a Pattern,
    mirror: &'a [u32],
}

/// Number of supernodes per task.
const SUPERNODES_PER_TASK: usize = 8192;

/// Results of runs of supernodes, in their order.
fn in_tasks<T: Send>(
    count: usize,
    cancel: &AtomicBool,
    of: impl Fn(std::ops::Range<usize>) -> T + Sync,
) -> Result<Vec<T>, LinalgError> {
    let of_task = |task: usize| {
        go_on_unless(cancel)?;
        Ok(of(task * SUPERNODES_PER_TASK..count.min((task + 1) * SUPERNODES_PER_TASK)))
    };
    (0..count.div_ceil(SUPERNODES_PER_TASK)).into_par_iter().map(of_task).collect()
}

/// Supernodes with the rows of their fronts.
struct Plan {
    order: Order,
    begin: Vec<u32>,
    parent: Vec<u32>,
    rows: Pattern,
}

impl Plan {
    fn new(pattern: &Pattern, elimination: &Elimination, cancel: &AtomicBool) -> Result<Self, LinalgError> {
        let Supernodes { begin, parent, below, columns } = supernodes(elimination);
        go_on_unless(cancel)?;
        let order = elimination.order.then(&columns);
        let rows = front_rows(Renumbered { pattern, order: &order }, &begin, &parent, &below, cancel)?;
        Ok(Self { order, begin, parent, rows })
    }

    /// Plan of the matrix whose unknowns form the pairs 2k and 2k + 1 of the unknowns k of this plan.
    fn of_pairs(self) -> Self {
        let doubled = |list: &[u32]| list.iter().map(|&k| 2 * k).collect();
        Self {
            order: self.order.of_pairs(),
            begin: doubled(&self.begin),
            parent: self.parent,
            rows: Pattern { offsets: doubled(&self.rows.offsets), rows: in_pairs(&self.rows.rows) },
        }
    }
}

/// Pattern in an order of elimination.
#[derive(Clone, Copy)]
struct Renumbered<'a> {
    pattern: &'a Pattern,
    order: &'a Order,
}

/// Rows of every front below its diagonal block; `below` holds their numbers. Row k lies in several fronts. For each
/// entry (k, i), i < k, of A, these are the fronts on the path up the tree from column i to the supernode of k.
fn front_rows(
    of: Renumbered<'_>,
    begin: &[u32],
    parent: &[u32],
    below: &[u32],
    cancel: &AtomicBool,
) -> Result<Pattern, LinalgError> {
    let n = of.pattern.order();
    let mut owner = Vec::with_capacity(n);
    for (supernode, pair) in begin.windows(2).enumerate() {
        owner.resize(pair[1] as usize, narrow(supernode));
    }
    let offsets = running_sum(below);
    let mut next = offsets.clone();
    let mut rows = vec![0u32; next[parent.len()] as usize];
    let mut seen = vec![NONE; parent.len()];
    for row in 0..n {
        if row % COLUMNS_AT_ONCE == 0 {
            go_on_unless(cancel)?;
        }
        let own = narrow(row);
        for column in of.pattern.renumbered(of.order, row).filter(|&column| column < own) {
            let mut supernode = owner[column as usize] as usize;
            while supernode != owner[row] as usize && seen[supernode] != own {
                seen[supernode] = own;
                rows[next[supernode] as usize] = own;
                next[supernode] += 1;
                supernode = parent[supernode] as usize;
            }
        }
    }
    debug_assert!(next[..parent.len()] == offsets[1..], "counts and patterns agree");
    Ok(Pattern { offsets, rows })
}
