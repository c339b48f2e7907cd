//! Supernodes: runs of columns of L that share one pattern, relaxed so that few of them are tiny.
//!
//! A child is merged into its parent when the explicit zeros this stores are few for the size of the result (Ashcraft
//! and Grimes 1989, "The influence of relaxed supernode partitions on the multifrontal method").

use crate::linalg::order::{Elimination, NONE, narrow, postorder};

/// Columns up to which a merged supernode may hold the given share of zeros. The steps are those of CHOLMOD and faer.
const RELAXATION: [(u64, f64); 4] = [(4, 1.0), (16, 0.8), (48, 0.1), (u64::MAX, 0.05)];

/// A partition of the columns into supernodes, numbered in a postorder of their tree.
pub(super) struct Supernodes {
    /// First column of each supernode, and the order of the matrix last.
    pub(super) begin: Vec<u32>,
    pub(super) parent: Vec<u32>,
    /// Rows below the diagonal block.
    pub(super) below: Vec<u32>,
    /// The elimination order's columns, renumbered: new column `k` was `columns[k]`.
    pub(super) columns: Vec<u32>,
}

/// A supernode while it may still be merged.
struct Group {
    columns: u64,
    below: u64,
    zeros: u64,
}

impl Group {
    /// The parent after it swallowed `child`, if that stores few enough zeros.
    fn merged(&self, child: &Self) -> Option<Self> {
        let columns = self.columns + child.columns;
        // The child's columns grow to the parent's pattern.
        let zeros = self.zeros + child.zeros + child.columns * (self.columns + self.below - child.below);
        let stored = columns * (columns + 1) / 2 + columns * self.below;
        let allowed = |&(limit, share): &(u64, f64)| columns <= limit && zeros as f64 <= share * stored as f64;
        RELAXATION.iter().any(allowed).then_some(Self { columns, below: self.below, zeros })
    }
}

/// Finds the relaxed supernodes of an elimination tree and an order of them that keeps few updates waiting.
pub(super) fn supernodes(elimination: &Elimination) -> Supernodes {
    let (first, mut parent, mut groups) = maximal(elimination);
    let merged_into = relax(&mut parent, &mut groups);
    let children_first = order_for_memory(&parent, &groups, &merged_into);
    number(&first, &merged_into, &parent, &groups, &children_first)
}

/// Runs of columns where each is the parent of the one before and has just its pattern.
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

/// Merges children into parents, bottom up. Returns for every supernode the one it ended in (itself if it stands).
fn relax(parent: &mut [u32], groups: &mut [Group]) -> Vec<u32> {
    let count = groups.len();
    let mut children: Vec<Vec<u32>> = vec![Vec::new(); count];
    let mut merged_into: Vec<u32> = (0..count).map(narrow).collect();
    for node in 0..count {
        // The child nearest in size comes last in postorder, and wastes least.
        let mut kept = Vec::new();
        for child in std::mem::take(&mut children[node]).into_iter().rev() {
            match groups[node].merged(&groups[child as usize]) {
                Some(merged) => {
                    groups[node] = merged;
                    merged_into[child as usize] = narrow(node);
                    kept.append(&mut children[child as usize]);
                }
                None => kept.push(child),
            }
        }
        for &child in &kept {
            parent[child as usize] = narrow(node);
        }
        kept.sort_unstable();
        children[node] = kept;
        if parent[node] != NONE {
            children[parent[node] as usize].push(narrow(node));
        }
    }
    // Parents have higher numbers, so from the top every chain is followed in one step.
    for node in (0..count).rev() {
        merged_into[node] = merged_into[merged_into[node] as usize];
    }
    merged_into
}

/// The standing supernodes in a postorder that visits first the child that needs most room beyond its
/// update (Liu 1986, "On the storage requirement in the out-of-core multifrontal method").
fn order_for_memory(parent: &[u32], groups: &[Group], merged_into: &[u32]) -> Vec<u32> {
    let count = groups.len();
    let standing: Vec<u32> = (0..narrow(count)).filter(|&node| merged_into[node as usize] == node).collect();
    let mut children: Vec<Vec<u32>> = vec![Vec::new(); count];
    let mut peak = vec![0u64; count];
    let update_len = |node: u32| groups[node as usize].below.pow(2);
    for &node in &standing {
        let brood = &mut children[node as usize];
        brood.sort_by_key(|&child| (std::cmp::Reverse(peak[child as usize] - update_len(child)), child));
        let (mut waiting, mut highest) = (0, 0);
        for &child in brood.iter() {
            highest = highest.max(waiting + peak[child as usize]);
            waiting += update_len(child);
        }
        peak[node as usize] = highest.max(waiting + update_len(node));
        if parent[node as usize] != NONE {
            children[parent[node as usize] as usize].push(node);
        }
    }
    let roots = standing.into_iter().filter(|&node| parent[node as usize] == NONE).collect();
    postorder(roots, |node| &children[node as usize])
}

/// Renumbers the standing supernodes, `first` being the first columns of all.
fn number(first: &[u32], merged_into: &[u32], parent: &[u32], groups: &[Group], sequence: &[u32]) -> Supernodes {
    // The columns of every standing supernode, in elimination order.
    let mut members = vec![Vec::new(); merged_into.len()];
    for (node, pair) in first.windows(2).enumerate() {
        members[merged_into[node] as usize].extend(pair[0]..pair[1]);
    }
    let mut position = vec![NONE; groups.len()];
    for (place, &node) in sequence.iter().enumerate() {
        position[node as usize] = narrow(place);
    }
    let mut this = Supernodes { begin: vec![0], parent: Vec::new(), below: Vec::new(), columns: Vec::new() };
    for &node in sequence {
        this.columns.extend(&members[node as usize]);
        this.begin.push(narrow(this.columns.len()));
        this.below.push(u32::try_from(groups[node as usize].below).expect("at most the order of the matrix"));
        let above = parent[node as usize];
        this.parent.push(if above == NONE { NONE } else { position[above as usize] });
    }
    this
}
