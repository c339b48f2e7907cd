//! Minimum separator in a band around a cut.
//!
//! By Menger's theorem, the size of a minimum vertex separator of two sets is the number of paths between them
//! without a common vertex. A maximum flow (Ford and Fulkerson 1956) finds the paths. In its graph every vertex of
//! the band is two nodes, with an arc of capacity 1 from the first to the second. The separator consists of the
//! vertices at which the nodes reachable from the source end: identical for all maximum flows.

use std::cmp::Reverse;
use std::sync::atomic::AtomicBool;

use super::Cut;
use crate::linalg::LinalgError;
use crate::linalg::pattern::{Pattern, go_on_unless, narrow, running_sum};

/// Number of layers of vertices on either side of the cut in which the separator is sought: a patch is less than
/// twice as wide.
const LAYERS: i8 = 5;

/// Largest size of a band relative to the vertices beside the cut: thin parts have few layers and must not be
/// consumed entirely.
const MOST_TIMES: usize = 2 * LAYERS as usize;

/// Capacity greater than any flow.
const ENDLESS: u32 = 1 << 30;

/// Vertex of a band with its new side; `None` if it belongs to the separator.
#[derive(Clone, Copy)]
pub(super) struct Moved {
    pub(super) vertex: u32,
    pub(super) side: Option<usize>,
}

/// Vertices of a band around a cut with their sides: no vertex of either side is adjacent to the other side.
///
/// # Errors
///
/// [`LinalgError::Cancelled`].
pub(super) fn least_separator(
    graph: &Pattern,
    labels: &[u32],
    cut: &Cut,
    cancel: &AtomicBool,
) -> Result<Vec<Moved>, LinalgError> {
    let band = Band::around(graph, labels, cut);
    let Some(mut network) = Network::of(graph, &band) else {
        // There is no band between the sides.
        let [first, second] = &cut.beside;
        let narrower = if first.len() <= second.len() { first } else { second };
        return Ok(narrower.iter().map(|&vertex| Moved { vertex, side: None }).collect());
    };
    while network.send_paths() {
        go_on_unless(cancel)?;
    }
    let side = |place: usize| match [2 * place, 2 * place + 1].map(|node| network.is_reached[node]) {
        [true, false] => None,
        [_, true] => Some(0),
        [false, false] => Some(1),
    };
    let vertices = band.vertices.iter().enumerate();
    Ok(vertices.map(|(place, &vertex)| Moved { vertex, side: side(place) }).collect())
}

/// Vertices around a cut.
struct Band {
    vertices: Vec<u32>,
    /// Index of each vertex of the graph in `vertices`, plus 1; 0 for other vertices.
    place: Vec<u32>,
    /// Layer of each vertex, counted from the cut; negative on the first side, the side of the source.
    layer: Vec<i8>,
    /// Side of a vertex of the outermost layer: such a vertex stays on its side. `None` for other vertices.
    rim: Vec<Option<usize>>,
}

impl Band {
    fn around(graph: &Pattern, labels: &[u32], cut: &Cut) -> Self {
        let mut band = Self { vertices: Vec::new(), place: vec![0; graph.order()], layer: Vec::new(), rim: Vec::new() };
        for (side, beside) in cut.beside.iter().enumerate() {
            let away = if side == 0 { -1 } else { 1 };
            let mut layer = beside.clone();
            for &vertex in &layer {
                band.push(vertex, away);
            }
            let mut taken = layer.len();
            for number in 2..=LAYERS {
                let mut next = Vec::new();
                for &vertex in &layer {
                    for &other in graph.column(vertex as usize) {
                        if band.place[other as usize] == 0 && cut.side(labels[other as usize]) == Some(side) {
                            band.push(other, away * number);
                            next.push(other);
                        }
                    }
                }
                taken += next.len();
                if next.is_empty() || taken > MOST_TIMES * beside.len() {
                    layer.extend(next);
                    break;
                }
                layer = next;
            }
            band.rim.resize(band.vertices.len(), None);
            for vertex in layer {
                band.rim[band.place[vertex as usize] as usize - 1] = Some(side);
            }
        }
        band
    }

    fn push(&mut self, vertex: u32, layer: i8) {
        self.vertices.push(vertex);
        self.layer.push(layer);
        self.place[vertex as usize] = narrow(self.vertices.len());
    }
}

/// Arc, with the index of its reverse.
#[derive(Clone, Copy, Default)]
struct Arc {
    head: u32,
    capacity: u32,
    reverse: u32,
}

/// Flow network: each vertex k of the band is a pair of nodes, with an in-node 2k and an out-node 2k + 1. A source
/// and a sink are added.
struct Network {
    /// Arcs grouped by tail: the search visits the arcs of a node, forward and reverse, again and again.
    arcs: Vec<Arc>,
    /// Start of the arcs of each node, followed by the end of the last.
    begin: Vec<u32>,
    /// Next arc of each node to visit.
    at: Vec<u32>,
    /// True for nodes reached by the last search.
    is_reached: Vec<bool>,
    source: usize,
    sink: usize,
}

impl Network {
    /// Builds the network of a band. `None` if the rims of both sides are adjacent: no removable vertex cuts such a
    /// path.
    fn of(graph: &Pattern, band: &Band) -> Option<Self> {
        let nodes = 2 * band.vertices.len() + 2;
        let (source, sink) = (nodes - 2, nodes - 1);
        let mut edges: Vec<Edge> = Vec::new();
        let mut around: Vec<u32> = Vec::new();
        for (k, &vertex) in band.vertices.iter().enumerate() {
            let rim = band.rim[k];
            edges.push(Edge::new(2 * k, 2 * k + 1, if rim.is_some() { ENDLESS } else { 1 }));
            match rim {
                Some(0) => edges.push(Edge::new(source, 2 * k, ENDLESS)),
                Some(_) => edges.push(Edge::new(2 * k + 1, sink, ENDLESS)),
                None => {}
            }
            around.clear();
            let others = graph.column(vertex as usize).iter().filter(|&&other| other != vertex);
            around.extend(others.filter_map(|&other| band.place[other as usize].checked_sub(1)));
            if rim == Some(0) && around.iter().any(|&other| band.rim[other as usize] == Some(1)) {
                return None;
            }
            // Neighbours nearer to the sink come first, so that most paths lead straight there.
            around.sort_by_key(|&other| Reverse(band.layer[other as usize]));
            edges.extend(around.iter().map(|&other| Edge::new(2 * k + 1, 2 * other as usize, ENDLESS)));
        }
        let mut counts = vec![0; nodes];
        for end in edges.iter().flat_map(|edge| edge.ends) {
            counts[end as usize] += 1;
        }
        let begin = running_sum(&counts);
        let mut next = begin.clone();
        let mut arcs = vec![Arc::default(); 2 * edges.len()];
        for Edge { ends: [tail, head], capacity } in edges {
            let [forth, back] = [tail, head].map(|end| {
                next[end as usize] += 1;
                next[end as usize] - 1
            });
            arcs[forth as usize] = Arc { head, capacity, reverse: back };
            arcs[back as usize] = Arc { head: tail, capacity: 0, reverse: forth };
        }
        Some(Self { arcs, at: begin[..nodes].to_vec(), begin, is_reached: vec![false; nodes], source, sink })
    }

    /// Sends paths as long as a search that visits each node once finds any. Returns true if it found a path. If not,
    /// the search has visited all nodes that the source reaches.
    fn send_paths(&mut self) -> bool {
        self.is_reached.fill(false);
        self.is_reached[self.source] = true;
        self.at.copy_from_slice(&self.begin[..self.is_reached.len()]);
        let (mut path, mut node, mut found): (Vec<u32>, usize, bool) = (Vec::new(), self.source, false);
        loop {
            if node == self.sink {
                found = true;
                for arc in path.drain(..) {
                    let Arc { reverse, .. } = self.arcs[arc as usize];
                    self.arcs[arc as usize].capacity -= 1;
                    self.arcs[reverse as usize].capacity += 1;
                }
                self.is_reached[self.sink] = false;
                node = self.source;
            }
            if let Some(arc) = self.onward(node) {
                path.push(arc);
                node = self.arcs[arc as usize].head as usize;
                self.is_reached[node] = true;
            } else if let Some(arc) = path.pop() {
                let Arc { reverse, .. } = self.arcs[arc as usize];
                node = self.arcs[reverse as usize].head as usize;
            } else {
                return found;
            }
        }
    }

    /// Next arc of a node to a node that the search has not visited.
    fn onward(&mut self, node: usize) -> Option<u32> {
        while self.at[node] < self.begin[node + 1] {
            let Arc { head, capacity, .. } = self.arcs[self.at[node] as usize];
            if capacity > 0 && !self.is_reached[head as usize] {
                return Some(self.at[node]);
            }
            self.at[node] += 1;
        }
        None
    }
}

/// Arc before sorting, from the first end to the second.
struct Edge {
    ends: [u32; 2],
    capacity: u32,
}

impl Edge {
    fn new(tail: usize, head: usize, capacity: u32) -> Self {
        Self { ends: [tail, head].map(narrow), capacity }
    }
}
