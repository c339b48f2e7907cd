//! Supernodes: runs of columns of L that share a pattern, relaxed so that few of them are tiny.
//!
//! A child is merged into its parent if this stores few explicit zeros for the size of the result (Ashcraft and
//! Grimes 1989, "The influence of relaxed supernode partitions on the multifrontal method").

use std::cmp::Reverse;

use crate::linalg::elimination::{Elimination, postorder};
use crate::linalg::pattern::{NONE, narrow};

/// Largest number of columns of a merged supernode, with its accepted share of explicit zeros. The values are those
/// of CHOLMOD and faer.
const RELAXATION: [(u64, f64); 4] = [(4, 1.0), (16, 0.8), (48, 0.1), (u64::MAX, 0.05)];

/// Partition of the columns into supernodes, numbered in a postorder of their tree.
pub(super) struct Supernodes {
    /// First column of each supernode, followed by the order of the matrix.
    pub(super) begin: Vec<u32>,
    pub(super) parent: Vec<u32>,
    /// Number of rows below the diagonal block.
    pub(super) below: Vec<u32>,
    /// Renumbered columns of the elimination order: new column `k` was `columns[k]`.
    pub(super) columns: Vec<u32>,
}

/// Supernode that may still be merged.
struct Group {
    columns: u64,
    below: u64,
    zeros: u64,
}

impl Group {
    /// Parent merged with `child`, if that stores few enough zeros.
    fn merged(&self, child: &Self) -> Option<Self> {
        let columns = self.columns + child.columns;
        // The child's columns grow to the parent's pattern.
        let zeros = self.zeros + child.zeros + child.columns * (self.columns + self.below - child.below);
        let stored = columns * (columns + 1) / 2 + columns * self.below;
        let allowed = |&(limit, share): &(u64, f64)| columns <= limit && zeros as f64 <= share * stored as f64;
        RELAXATION.iter().any(allowed).then_some(Self { columns, below: self.below, zeros })
    }
}

/// Finds the relaxed supernodes of an elimination tree, in an order that keeps few updates waiting.
pub(super) fn supernodes(elimination: &Elimination) -> Supernodes {
    let (first, mut parent, mut groups) = maximal(elimination);
    let merged_into = relax(&mut parent, &mut groups);
    let children_first = order_for_memory(&parent, &groups, &merged_into);
    number(&first, &merged_into, &parent, &groups, &children_first)
}

/// Runs of columns in which each column is the parent of the previous and has exactly its pattern without that
/// column.
fn maximal(elimination: &Elimination) -> (Vec<u32>, Vec<u32>, Vec<Group>) {
    let Elimination { parent, counts, .. } = elimination;
    let n = parent.len();
    let mut first: Vec<u32> = Vec::new();
    let mut owner = vec![0u32; n];
    for column in 0..n {
        let continues = column > 0 && parent[column - 1] == narrow(column) && counts[column - 1] == counts[column] + 1;
        if !continues {
            first.push(narrow(column));
        }
        owner[column] = narrow(first.len() - 1);
    }
    first.push(narrow(n));
    let group = |pair: &[u32]| Group {
        columns: u64::from(pair[1] - pair[0]),
        below: u64::from(counts[pair[1] as usize - 1] - 1),
        zeros: 0,
    };
    let parent_of = |pair: &[u32]| match parent[pair[1] as usize - 1] {
        NONE => NONE,
        column => owner[column as usize],
    };
    let parents = first.windows(2).map(parent_of).collect();
    let groups = first.windows(2).map(group).collect();
    (first, parents, groups)
}

/// Children of every supernode, in linked lists that change without allocation.
struct Broods {
    first: Vec<u32>,
    /// Next sibling of each.
    next: Vec<u32>,
}

impl Broods {
    fn new(count: usize) -> Self {
        Self { first: vec![NONE; count], next: vec![NONE; count] }
    }

    fn of(&self, parent: u32) -> impl Iterator<Item = u32> {
        let some = |node: u32| (node != NONE).then_some(node);
        std::iter::successors(some(self.first[parent as usize]), move |&child| some(self.next[child as usize]))
    }

    /// Inserts a child before the others.
    fn push(&mut self, parent: u32, child: u32) {
        self.next[child as usize] = std::mem::replace(&mut self.first[parent as usize], child);
    }

    /// Replaces the children of a parent, in the given order.
    fn set(&mut self, parent: u32, children: impl DoubleEndedIterator<Item = u32>) {
        self.first[parent as usize] = NONE;
        children.rev().for_each(|child| self.push(parent, child));
    }
}

/// Merges children into parents, bottom up. Returns for every supernode the supernode that contains it, itself if it
/// was not merged.
fn relax(parent: &mut [u32], groups: &mut [Group]) -> Vec<u32> {
    let count = groups.len();
    let mut broods = Broods::new(count);
    let mut merged_into: Vec<u32> = (0..narrow(count)).collect();
    let (mut brood, mut kept) = (Vec::new(), Vec::new());
    for node in 0..narrow(count) {
        // Children descend here: the last in postorder is nearest in size and wastes least.
        brood.clear();
        brood.extend(broods.of(node));
        kept.clear();
        for &child in &brood {
            match groups[node as usize].merged(&groups[child as usize]) {
                Some(merged) => {
                    groups[node as usize] = merged;
                    merged_into[child as usize] = node;
                    kept.extend(broods.of(child));
                }
                None => kept.push(child),
            }
        }
        for &child in &kept {
            parent[child as usize] = node;
        }
        kept.sort_unstable();
        broods.set(node, kept.iter().copied().rev());
        if parent[node as usize] != NONE {
            broods.push(parent[node as usize], node);
        }
    }
    // Parents have higher numbers, so a single pass from the top resolves every chain.
    for node in (0..count).rev() {
        merged_into[node] = merged_into[merged_into[node] as usize];
    }
    merged_into
}

/// Remaining supernodes in a postorder that visits first the child that needs most memory beyond its update (Liu
/// 1986, "On the storage requirement in the out-of-core multifrontal method").
fn order_for_memory(parent: &[u32], groups: &[Group], merged_into: &[u32]) -> Vec<u32> {
    let count = groups.len();
    let standing = || (0..narrow(count)).filter(|&node| merged_into[node as usize] == node);
    let mut broods = Broods::new(count);
    let mut peak = vec![0u64; count];
    let update_len = |node: u32| groups[node as usize].below.pow(2);
    let mut brood: Vec<u32> = Vec::new();
    for node in standing() {
        brood.clear();
        brood.extend(broods.of(node));
        brood.sort_unstable_by_key(|&child| (Reverse(peak[child as usize] - update_len(child)), child));
        let (mut waiting, mut highest) = (0, 0);
        for &child in &brood {
            highest = highest.max(waiting + peak[child as usize]);
            waiting += update_len(child);
        }
        peak[node as usize] = highest.max(waiting + update_len(node));
        broods.set(node, brood.iter().copied());
        if parent[node as usize] != NONE {
            broods.push(parent[node as usize], node);
        }
    }
    let roots = standing().filter(|&node| parent[node as usize] == NONE).collect();
    postorder(roots, |node| broods.of(node))
}

/// Renumbers the remaining supernodes; `first` holds the first columns of all supernodes before merging.
fn number(first: &[u32], merged_into: &[u32], parent: &[u32], groups: &[Group], sequence: &[u32]) -> Supernodes {
    let mut position = vec![NONE; groups.len()];
    // New number of the next column of each remaining supernode.
    let mut next = vec![0; groups.len()];
    let mut total = 0;
    let mut this = Supernodes { begin: vec![0], parent: Vec::new(), below: Vec::new(), columns: Vec::new() };
    for (place, &node) in (0..).zip(sequence) {
        let Group { columns, below, .. } = groups[node as usize];
        position[node as usize] = place;
        next[node as usize] = total;
        total += u32::try_from(columns).expect("at most the order of the matrix");
        this.begin.push(total);
        this.below.push(u32::try_from(below).expect("at most the order of the matrix"));
    }
    let above = |&node: &u32| parent[node as usize];
    this.parent
        .extend(sequence.iter().map(above).map(|above| if above == NONE { NONE } else { position[above as usize] }));
    this.columns.resize(total as usize, 0);
    for (node, pair) in first.windows(2).enumerate() {
        let next = &mut next[merged_into[node] as usize];
        for column in pair[0]..pair[1] {
            this.columns[*next as usize] = column;
            *next += 1;
        }
    }
    this
}
