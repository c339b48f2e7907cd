//! Elimination tree of a pattern in a given order, number of entries of each column of its factor, and a postorder.
//!
//! A postorder of the elimination tree changes neither fill nor flops. It numbers every subtree contiguously, which
//! supernodes and parallel subtrees need. (Liu 1990, "The role of elimination trees in sparse factorization".)

use std::sync::atomic::AtomicBool;

use super::LinalgError;
use super::pattern::{COLUMNS_AT_ONCE, NONE, Order, Pattern, go_on_unless, narrow, running_sum};

/// Elimination order with its tree: `parent[j]` is the first row below the diagonal of column j of the factor, and
/// `counts[j]` the number of entries of that column, diagonal included.
pub(super) struct Elimination {
    pub(super) order: Order,
    pub(super) parent: Vec<u32>,
    pub(super) counts: Vec<u32>,
    /// Pattern of pairs, if unknowns form pairs: then all other fields refer to pairs.
    pub(super) pairs: Option<Pattern>,
}

impl Elimination {
    /// Computes a postorder of the elimination tree of a pattern in the order `degree`.
    ///
    /// # Errors
    ///
    /// [`LinalgError::Cancelled`].
    pub(super) fn new(
        pattern: &Pattern,
        pairs: Option<Pattern>,
        degree: &Order,
        cancel: &AtomicBool,
    ) -> Result<Self, LinalgError> {
        let graph = pairs.as_ref().unwrap_or(pattern);
        let parent = parents(graph, degree, cancel)?;
        let children = children(&parent);
        let roots = (0..).zip(&parent).filter(|&(_, &above)| above == NONE).map(|(node, _)| node).collect();
        let post = postorder(roots, |node| children.column(node as usize).iter().copied());
        let mut position = vec![0u32; parent.len()];
        for (new, &old) in post.iter().enumerate() {
            position[old as usize] = narrow(new);
        }
        let renamed = |above: u32| if above == NONE { NONE } else { position[above as usize] };
        let parent: Vec<u32> = post.iter().map(|&old| renamed(parent[old as usize])).collect();
        let order = degree.then(&post);
        go_on_unless(cancel)?;
        let counts = column_counts(graph, &order, &parent, cancel)?;
        Ok(Self { order, parent, counts, pairs })
    }

    /// Order of the unknowns themselves.
    pub(super) fn order(self) -> Order {
        if self.pairs.is_some() { self.order.of_pairs() } else { self.order }
    }
}

/// Parent of every column, with path compression (Liu 1986, "A compact row storage scheme for Cholesky factors using
/// elimination trees").
fn parents(pattern: &Pattern, order: &Order, cancel: &AtomicBool) -> Result<Vec<u32>, LinalgError> {
    let n = pattern.order();
    let (mut parent, mut ancestor) = (vec![NONE; n], vec![NONE; n]);
    for column in 0..n {
        if column % COLUMNS_AT_ONCE == 0 {
            go_on_unless(cancel)?;
        }
        let own = narrow(column);
        for mut node in pattern.renumbered(order, column).filter(|&row| row < own) {
            while node != own {
                let above = std::mem::replace(&mut ancestor[node as usize], own);
                if above == NONE {
                    parent[node as usize] = own;
                    break;
                }
                node = above;
            }
        }
    }
    Ok(parent)
}

/// Number of entries of every column of the factor, from the leaves of row subtrees and their meeting points, in
/// nearly linear time. The order is a postorder of the tree. (Gilbert, Ng and Peyton 1994, "An efficient algorithm to
/// compute row and column counts for sparse Cholesky factorization".)
fn column_counts(
    pattern: &Pattern,
    order: &Order,
    parent: &[u32],
    cancel: &AtomicBool,
) -> Result<Vec<u32>, LinalgError> {
    let n = parent.len();
    let first = first_descendants(parent);
    // Difference between the count of a column and the sum of the counts of its children.
    let mut counts: Vec<i32> = (0..).zip(&first).map(|(column, &first)| i32::from(first == column)).collect();
    let mut ways = Ways { ancestor: (0..narrow(n)).collect() };
    let mut rows = vec![RowSubtree { last_first: NONE, last_leaf: NONE }; n];
    for column in 0..n {
        if column % COLUMNS_AT_ONCE == 0 {
            go_on_unless(cancel)?;
        }
        let (own, above) = (narrow(column), parent[column]);
        if above != NONE {
            counts[above as usize] -= 1;
        }
        for row in pattern.renumbered(order, column).filter(|&row| row > own) {
            let subtree = &mut rows[row as usize];
            // Otherwise a descendant had an entry in this row, and the column is no leaf of the row's subtree.
            if subtree.last_first == NONE || first[column] > subtree.last_first {
                subtree.last_first = first[column];
                let before = std::mem::replace(&mut subtree.last_leaf, own);
                counts[column] += 1;
                if before != NONE {
                    counts[ways.up_from(before) as usize] -= 1;
                }
            }
        }
        if above != NONE {
            ways.ancestor[column] = above;
        }
    }
    for column in 0..n {
        if parent[column] != NONE {
            counts[parent[column] as usize] += counts[column];
        }
    }
    Ok(counts.into_iter().map(i32::cast_unsigned).collect())
}

/// Last leaf of a row's subtree: its first descendant and its number.
#[derive(Clone)]
struct RowSubtree {
    last_first: u32,
    last_leaf: u32,
}

/// Compressed paths up the visited part of the tree.
struct Ways {
    ancestor: Vec<u32>,
}

impl Ways {
    /// Highest ancestor so far; compresses the path to it.
    fn up_from(&mut self, node: u32) -> u32 {
        let mut top = node;
        while self.ancestor[top as usize] != top {
            top = self.ancestor[top as usize];
        }
        let mut at = node;
        while at != top {
            at = std::mem::replace(&mut self.ancestor[at as usize], top);
        }
        top
    }
}

/// First node of the subtree below each node of a tree in postorder.
fn first_descendants(parent: &[u32]) -> Vec<u32> {
    let mut first: Vec<u32> = (0..narrow(parent.len())).collect();
    for (node, &above) in parent.iter().enumerate().filter(|(_, above)| **above != NONE) {
        first[above as usize] = first[above as usize].min(first[node]);
    }
    first
}

/// Postorder of a forest: children before parents, subtrees contiguous, siblings in their given order.
pub(super) fn postorder<I: Iterator<Item = u32>>(roots: Vec<u32>, children: impl Fn(u32) -> I) -> Vec<u32> {
    // Parents first and siblings last to first: the reverse is the postorder.
    let (mut sequence, mut stack) = (Vec::new(), roots);
    while let Some(node) = stack.pop() {
        sequence.push(node);
        stack.extend(children(node));
    }
    sequence.reverse();
    sequence
}

/// Children of every node, ascending.
pub(super) fn children(parent: &[u32]) -> Pattern {
    let mut counts = vec![0u32; parent.len()];
    parent.iter().filter(|&&above| above != NONE).for_each(|&above| counts[above as usize] += 1);
    let offsets = running_sum(&counts);
    let mut next = offsets.clone();
    let mut rows = vec![0u32; offsets[parent.len()] as usize];
    for (node, &above) in parent.iter().enumerate().filter(|(_, above)| **above != NONE) {
        rows[next[above as usize] as usize] = narrow(node);
        next[above as usize] += 1;
    }
    Pattern { offsets, rows }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::linalg::order::in_order;

    /// Pattern of n unknowns with entries scattered by a linear congruence, and its diagonal.
    fn strewn(n: usize, pairs: usize, seed: usize) -> Pattern {
        let mut columns: Vec<BTreeSet<u32>> = (0..n).map(|k| BTreeSet::from([narrow(k)])).collect();
        let mut state = seed;
        let mut next = || {
            state = (state * 1_103_515_245 + 12_345) % (1 << 31);
            (state >> 8) % n
        };
        for _ in 0..pairs {
            let [a, b] = [next(), next()];
            columns[a].insert(narrow(b));
            columns[b].insert(narrow(a));
        }
        let counts: Vec<u32> = columns.iter().map(|column| narrow(column.len())).collect();
        Pattern { offsets: running_sum(&counts), rows: columns.into_iter().flatten().collect() }
    }

    /// Columns of the factor by definition: each column adds its rows to the column of its first row.
    fn columns_of_factor(pattern: &Pattern, order: &Order) -> Vec<BTreeSet<u32>> {
        let below = |k: usize| pattern.renumbered(order, k).filter(|&row| row as usize > k).collect();
        let mut columns: Vec<BTreeSet<u32>> = (0..pattern.order()).map(below).collect();
        for k in 0..columns.len() {
            if let Some(first) = columns[k].first().copied() {
                let rows: Vec<u32> = columns[k].iter().copied().skip(1).collect();
                columns[first as usize].extend(rows);
            }
        }
        columns
    }

    #[test]
    fn tree_and_counts_are_those_of_the_factor_that_elimination_fills() {
        for (n, pairs) in [(1, 0), (7, 0), (40, 30), (40, 60), (120, 110), (120, 300)] {
            for seed in 1..20 {
                let pattern = strewn(n, pairs, seed);
                let given = Order::from_new_to_old((0..narrow(n)).rev().collect());
                let found = in_order(&pattern, &given, &AtomicBool::new(false)).expect("nobody stops it");
                let columns = columns_of_factor(&pattern, &found.order);
                let counts: Vec<u32> = columns.iter().map(|rows| narrow(rows.len()) + 1).collect();
                let parents: Vec<u32> = columns.iter().map(|rows| rows.first().copied().unwrap_or(NONE)).collect();
                assert_eq!(found.counts, counts, "{n} unknowns, {pairs} pairs, seed {seed}");
                assert_eq!(found.parent, parents, "{n} unknowns, {pairs} pairs, seed {seed}");
                let firsts = first_descendants(&found.parent);
                let sizes = (0..).zip(&firsts).map(|(node, &first)| node - first + 1);
                assert!(sizes.zip(subtree_sizes(&found.parent)).all(|(is, wanted)| is == wanted), "no postorder");
            }
        }
    }

    fn subtree_sizes(parent: &[u32]) -> Vec<u32> {
        let mut sizes = vec![1; parent.len()];
        for (node, &above) in parent.iter().enumerate().filter(|(_, above)| **above != NONE) {
            sizes[above as usize] += sizes[node];
        }
        sizes
    }
}
