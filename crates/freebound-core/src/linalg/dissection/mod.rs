//! Shallow nested dissection of large graphs: a few levels of separators, and minimum degree in the parts between
//! them.
//!
//! Patches of some dozen vertices are grown, and their quotient graph is bisected recursively. Cuts run along level
//! lines of differences of distances from far vertices, and so are about as straight as the surface allows. A maximum
//! flow then minimises each cut, in a band of vertices around it. The parts between the separators are independent in
//! all later phases and are ordered by minimum degree in parallel. (George 1973, "Nested dissection of a regular
//! finite element mesh"; patches as in Zarebavani et al. 2026, "Fast sparse matrix permutation for mesh-based direct
//! solvers".)
//!
//! The parts depend on the graph alone, not on the number of threads.
//!
//! | file | contents |
//! |---|---|
//! | `mod.rs` | tree of separators and parts |
//! | `patches.rs` | patches, bisection of their quotient graph |
//! | `separator.rs` | minimum separator in a band around a cut |

mod patches;
mod separator;

use std::sync::atomic::AtomicBool;

use crate::parallel::prelude::*;

use self::patches::Quotient;
use self::separator::{Moved, least_separator};
use super::LinalgError;
use super::pattern::{Pattern, go_on_unless, narrow};

/// Number of vertices of a part, up to twice as many: graphs of fewer than twice this number are not cut. In a
/// measurement at 30 k vertices, order, factor and solve together took equally long with and without dissection. From
/// 50 k on they took less time with dissection.
const PART: usize = 10_000;

/// Largest number of levels: more parts than there may be threads.
const MOST_LEVELS: u32 = 6;

/// Largest accepted separator, in roots of the number of vertices. Surfaces have smaller separators; a larger
/// separator gains nothing.
const MOST_OF_ROOT: f64 = 4.0;

/// Number of vertices per task.
const VERTICES_PER_TASK: usize = 16_384;

/// Bit that marks the node number of a separator, in contrast to the number of a part.
const SEPARATOR: u32 = 1 << 31;

/// Dissection of a graph: a complete binary tree with a separator at every node and a part at every leaf.
#[derive(Debug)]
pub(super) struct Dissection {
    /// Vertices of every part, ascending.
    pub(super) parts: Vec<Vec<u32>>,
    /// Vertices of the separator of every node: the children of node k, from 1, are 2k and 2k + 1.
    separators: Vec<Vec<u32>>,
    /// Index of each vertex in its part or separator.
    pub(super) place: Vec<u32>,
}

impl Dissection {
    /// Cuts a graph, the pattern of a symmetric matrix. `None` if the graph is small or has no cheap cuts.
    ///
    /// # Errors
    ///
    /// [`LinalgError::Cancelled`], checked at every level.
    pub(super) fn new(graph: &Pattern, cancel: &AtomicBool) -> Result<Option<Self>, LinalgError> {
        let levels = (graph.order() / PART).checked_ilog2().unwrap_or(0).min(MOST_LEVELS);
        if levels == 0 {
            return Ok(None);
        }
        let (patch, quotient) = Quotient::of_patches(graph, cancel)?;
        let part_of_patch = quotient.parts(levels, cancel)?;
        let mut labels: Vec<u32> = patch.iter().map(|&patch| part_of_patch[patch as usize]).collect();
        for level in 0..levels {
            go_on_unless(cancel)?;
            let most = MOST_OF_ROOT * (graph.order() as f64).sqrt();
            let cuts = Level { graph, labels: &labels, above: level, below: levels - level - 1 }.cuts();
            // A cut along patches is hardly more than twice as long as necessary.
            if cuts.iter().any(|cut| cut.width() as f64 > 2.0 * most) {
                return Ok(None);
            }
            let separator = |cut| {
                go_on_unless(cancel)?;
                least_separator(graph, &labels, cut, cancel)
            };
            let found: Result<Vec<Vec<Moved>>, LinalgError> = cuts.par_iter().map(separator).collect();
            for (cut, moved) in cuts.iter().zip(found?) {
                let count = moved.iter().filter(|moved| moved.side.is_none()).count();
                if count as f64 > most {
                    return Ok(None);
                }
                adopt(graph, &mut labels, cut, &moved);
            }
        }
        Ok(Some(Self::of_labels(&labels, levels)))
    }

    fn of_labels(labels: &[u32], levels: u32) -> Self {
        let mut this = Self {
            parts: vec![Vec::new(); 1 << levels],
            separators: vec![Vec::new(); 1 << levels],
            place: vec![0; labels.len()],
        };
        for (vertex, &label) in labels.iter().enumerate() {
            let list = match label & SEPARATOR {
                0 => &mut this.parts[label as usize],
                _ => &mut this.separators[(label & !SEPARATOR) as usize],
            };
            this.place[vertex] = narrow(list.len());
            list.push(narrow(vertex));
        }
        this
    }

    /// Pattern of the subgraph of a part.
    pub(super) fn pattern_of(&self, part: usize, graph: &Pattern) -> Pattern {
        let vertices = &self.parts[part];
        let is_own = |&vertex: &u32| vertices.get(self.place[vertex as usize] as usize) == Some(&vertex);
        let (mut offsets, mut rows) = (Vec::with_capacity(vertices.len() + 1), Vec::new());
        offsets.push(0);
        for &vertex in vertices {
            let own = graph.column(vertex as usize).iter().filter(|other| is_own(other));
            rows.extend(own.map(|&other| self.place[other as usize]));
            offsets.push(narrow(rows.len()));
        }
        Pattern { offsets, rows }
    }

    /// All vertices, each part in the given order. A separator follows the parts that it separates.
    pub(super) fn order(&self, of_parts: &[Vec<u32>]) -> Vec<u32> {
        let mut order = Vec::with_capacity(self.place.len());
        self.append(1, of_parts, &mut order);
        order
    }

    fn append(&self, node: usize, of_parts: &[Vec<u32>], order: &mut Vec<u32>) {
        if let Some(part) = node.checked_sub(self.parts.len()) {
            let vertices = &self.parts[part];
            order.extend(of_parts[part].iter().map(|&place| vertices[place as usize]));
            return;
        }
        self.append(2 * node, of_parts, order);
        self.append(2 * node + 1, of_parts, order);
        order.extend(&self.separators[node]);
    }
}

/// Two sides of a node of the tree, identified by the numbers of their parts.
struct Cut {
    /// Number of the node.
    node: u32,
    /// Number of levels of the tree below its sides.
    below: u32,
    /// Vertices of either side that are adjacent to the other side.
    beside: [Vec<u32>; 2],
}

impl Cut {
    /// Number of adjacent vertices of the side that has fewer.
    fn width(&self) -> usize {
        self.beside.each_ref().map(Vec::len).into_iter().min().unwrap_or(0)
    }

    /// Side of a label; `None` if the label does not belong to this node.
    fn side(&self, label: u32) -> Option<usize> {
        let is_own = label & SEPARATOR == 0 && (label >> (self.below + 1)) == self.first();
        is_own.then_some((label >> self.below & 1) as usize)
    }

    /// Index among the nodes of the level.
    fn first(&self) -> u32 {
        self.node - (1 << self.node.ilog2())
    }

    /// Label of the first part of a side.
    fn first_part(&self, side: usize) -> u32 {
        (2 * self.first() + narrow(side)) << self.below
    }
}

/// All nodes of a level of the tree.
struct Level<'a> {
    graph: &'a Pattern,
    labels: &'a [u32],
    /// Number of levels above this level.
    above: u32,
    /// Number of levels below the sides of the nodes.
    below: u32,
}

impl Level<'_> {
    fn cuts(&self) -> Vec<Cut> {
        let nodes = 1 << self.above..2 << self.above;
        let mut cuts: Vec<Cut> =
            nodes.map(|node| Cut { node, below: self.below, beside: [Vec::new(), Vec::new()] }).collect();
        let found: Vec<u32> = (0..self.labels.len())
            .into_par_iter()
            .with_min_len(VERTICES_PER_TASK)
            .filter(|&vertex| self.is_beside_other_side(vertex))
            .map(narrow)
            .collect();
        for vertex in found {
            let label = self.labels[vertex as usize];
            let cut = &mut cuts[(label >> (self.below + 1)) as usize];
            cut.beside[(label >> self.below & 1) as usize].push(vertex);
        }
        cuts
    }

    fn is_beside_other_side(&self, vertex: usize) -> bool {
        let own = self.labels[vertex];
        let is_other_side = |&other: &u32| {
            let label = self.labels[other as usize];
            label & SEPARATOR == 0 && (label >> self.below) == (own >> self.below ^ 1)
        };
        own & SEPARATOR == 0 && self.graph.column(vertex).iter().any(is_other_side)
    }
}

/// Labels the vertices of a cut's separator, and gives vertices that change sides the label of a neighbour there.
fn adopt(graph: &Pattern, labels: &mut [u32], cut: &Cut, moved: &[Moved]) {
    let mut open = Vec::new();
    for &Moved { vertex, side } in moved {
        match side {
            None => labels[vertex as usize] = SEPARATOR | cut.node,
            Some(side) if cut.side(labels[vertex as usize]) != Some(side) => open.push((vertex, side)),
            Some(_) => {}
        }
    }
    // Until then they belong to neither side.
    for &(vertex, _) in &open {
        labels[vertex as usize] = SEPARATOR;
    }
    while !open.is_empty() {
        let before = open.len();
        let label_for = |labels: &[u32], vertex: u32, side: usize| {
            let around = graph.column(vertex as usize).iter().map(|&other| labels[other as usize]);
            around.into_iter().find(|&label| cut.side(label) == Some(side))
        };
        open.retain(|&(vertex, side)| match label_for(labels, vertex, side) {
            Some(label) => {
                labels[vertex as usize] = label;
                false
            }
            None => true,
        });
        if open.len() == before {
            // Disconnected from the rest of their side.
            open.drain(..).for_each(|(vertex, side)| labels[vertex as usize] = cut.first_part(side));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Graph of `count` vertices with the given edges and all loops, like a pattern of a matrix.
    fn graph(count: usize, edges: impl Iterator<Item = [usize; 2]>) -> Pattern {
        let mut columns: Vec<Vec<u32>> = (0..count).map(|vertex| vec![narrow(vertex)]).collect();
        for [a, b] in edges {
            columns[a].push(narrow(b));
            columns[b].push(narrow(a));
        }
        let mut pattern = Pattern { offsets: vec![0], rows: Vec::new() };
        for mut column in columns {
            column.sort_unstable();
            column.dedup();
            pattern.rows.extend(column);
            pattern.offsets.push(narrow(pattern.rows.len()));
        }
        pattern
    }

    /// Grid with diagonals. Vertices are renumbered: k becomes k times `factor`, modulo their number.
    fn grid(width: usize, length: usize, factor: usize) -> Pattern {
        let count = width * length;
        let number = move |x: usize, y: usize| (y * width + x) * factor % count;
        let cells = (0..length).flat_map(move |y| (0..width).map(move |x| [x, y]));
        let edges = cells.flat_map(move |[x, y]| {
            let others = [[x + 1, y], [x, y + 1], [x + 1, y + 1]].into_iter();
            others.filter(move |&[x, y]| x < width && y < length).map(move |[u, v]| [number(x, y), number(u, v)])
        });
        graph(count, edges)
    }

    fn dissected(graph: &Pattern) -> Option<Dissection> {
        Dissection::new(graph, &AtomicBool::new(false)).expect("nobody stops it")
    }

    #[test]
    fn a_dissection_stops_when_it_is_told_to() {
        let outcome = Dissection::new(&grid(60, 400, 1), &AtomicBool::new(true));
        assert!(matches!(outcome, Err(LinalgError::Cancelled)));
    }

    #[test]
    fn a_strip_is_cut_across_by_hardly_more_vertices_than_it_is_wide() {
        // The 60 columns are paths without a common vertex: no separator is smaller (Menger).
        for factor in [1, 7919] {
            let dissection = dissected(&grid(60, 400, factor)).expect("large enough");
            let width = dissection.separators[1].len();
            assert!((60..=63).contains(&width), "{width} vertices, numbers times {factor}");
            let [a, b] = [0, 1].map(|part| dissection.parts[part].len());
            assert!(a.min(b) > 9000, "parts of {a} and {b}");
        }
    }

    #[test]
    fn no_edge_leads_from_one_part_to_another_and_each_vertex_is_ordered_once() {
        // A fan has no band between its hub and the adjacent vertices.
        let count = 41_989;
        let fan = graph(count, (1..count).flat_map(|k| [[0, k], [k, k % (count - 1) + 1]]));
        for graph in [grid(211, 199, 7919), fan] {
            assert_is_parted(&graph);
        }
    }

    fn assert_is_parted(graph: &Pattern) {
        let dissection = dissected(graph).expect("large enough");
        assert_eq!(dissection.parts.len(), 4);
        let mut part_of = vec![None; graph.order()];
        for (part, vertices) in dissection.parts.iter().enumerate() {
            for &vertex in vertices {
                part_of[vertex as usize] = Some(part);
            }
        }
        for vertex in 0..graph.order() {
            for &other in graph.column(vertex) {
                let ends = [part_of[vertex], part_of[other as usize]];
                assert!(ends[0] == ends[1] || ends.contains(&None), "an edge from {vertex} to {other}");
            }
        }
        let of_parts: Vec<Vec<u32>> =
            dissection.parts.iter().map(|vertices| (0..narrow(vertices.len())).collect()).collect();
        let mut order = dissection.order(&of_parts);
        // A separator follows both sides: the separator of the root is last.
        let root = &dissection.separators[1];
        assert_eq!(order[order.len() - root.len()..], root[..]);
        order.sort_unstable();
        assert!(order.iter().copied().eq(0..narrow(graph.order())));
    }

    #[test]
    fn a_graph_without_cheap_cuts_and_a_small_one_are_left_whole() {
        // Each vertex is joined to three others anywhere: such graphs are expanders.
        let count = 20_011;
        let edges = (0..count).flat_map(|k| [3, 7919, 12_345].map(|factor| [k, (k * factor + factor) % count]));
        assert!(dissected(&graph(count, edges)).is_none());
        assert!(dissected(&grid(99, 99, 1)).is_none());
    }
}
