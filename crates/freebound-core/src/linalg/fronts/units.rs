//! Units of work: runs of supernodes that a single thread processes in sequence.
//!
//! In a postorder a subtree is a run of supernodes. Small subtrees are gathered into units of about equal work; above
//! them, in the top of the tree, a unit is a chain. The partition depends on the pattern alone, not on the number of
//! threads. Therefore the results do not depend on the number of threads either.

use std::ops::Range;

use crate::linalg::pattern::{NONE, narrow};

/// Largest share of all work in a unit of subtrees: enough units for 16 threads, few enough that waiting updates stay
/// small.
const LARGEST_SHARE: f64 = 1.0 / 64.0;

/// Run of supernodes and the number of updates it awaits from other units.
#[derive(Clone, Debug)]
pub(in crate::linalg) struct Unit {
    pub(in crate::linalg) range: Range<usize>,
    pub(in crate::linalg) awaited: usize,
}

/// Partitions the supernodes into units. Returns the units, and the unit of every supernode.
pub(super) fn units(parent: &[u32], work: &[f64]) -> (Vec<Unit>, Vec<u32>) {
    let begins = cut(parent, work);
    let mut unit_of = Vec::with_capacity(parent.len());
    let mut units: Vec<Unit> = Vec::with_capacity(begins.len());
    for (unit, &begin) in begins.iter().enumerate() {
        let end = begins.get(unit + 1).copied().unwrap_or(parent.len());
        unit_of.resize(end, narrow(unit));
        units.push(Unit { range: begin..end, awaited: 0 });
    }
    for (node, &above) in parent.iter().enumerate().filter(|(_, above)| **above != NONE) {
        let target = unit_of[above as usize];
        units[target as usize].awaited += usize::from(target != unit_of[node]);
    }
    (units, unit_of)
}

fn cut(parent: &[u32], work: &[f64]) -> Vec<usize> {
    let mut subtree = work.to_vec();
    let mut first_child = vec![NONE; parent.len()];
    for (node, &above) in parent.iter().enumerate().filter(|(_, above)| **above != NONE) {
        subtree[above as usize] += subtree[node];
        first_child[above as usize] = first_child[above as usize].min(narrow(node));
    }
    let limit = LARGEST_SHARE * work.iter().sum::<f64>();
    let is_top = |node: usize| subtree[node] > limit;
    // Whole subtree below the top that a node belongs to, identified by its root.
    let mut root: Vec<usize> = (0..parent.len()).collect();
    for node in (0..parent.len()).rev() {
        if parent[node] != NONE && !is_top(parent[node] as usize) {
            root[node] = root[parent[node] as usize];
        }
    }
    let mut begins = Vec::new();
    let (mut gathered, mut after_top) = (0.0, true);
    for node in 0..parent.len() {
        let begin = begins.last().copied().unwrap_or(0);
        let continues = if is_top(node) {
            // A chain continues unless it must wait for a child outside of it.
            after_top && first_child[node] as usize >= begin
        } else if node > 0 && root[node] == root[node - 1] {
            true
        } else {
            gathered += subtree[root[node]];
            !after_top && gathered <= limit
        };
        if !continues || node == 0 {
            begins.push(node);
            gathered = if is_top(node) { 0.0 } else { subtree[root[node]] };
        }
        after_top = is_top(node);
    }
    begins
}
