//! The least separator in a band around a cut.
//!
//! By Menger's theorem the fewest vertices that part two sets are as many as there are paths between these without a common
//! vertex. The paths are found as a greatest flow (Dinic 1970) in the graph in which every vertex of the band is two, with
//! an arc of capacity 1 from one to the other.

use super::Cut;
use crate::linalg::order::{NONE, Pattern, narrow, running_sum};

/// Layers of vertices on either side of the cut among which the separator is sought: a patch is less than twice as wide.
const LAYERS: usize = 5;

/// The most of a band, in vertices beside the cut: thin parts have few layers, and are not taken up whole.
const MOST_TIMES: usize = 2 * LAYERS;

/// More than any flow.
const ENDLESS: u32 = 1 << 30;

/// A vertex of a band, and the side that it is on now; none where it belongs to the separator.
#[derive(Clone, Copy)]
pub(super) struct Moved {
    pub(super) vertex: u32,
    pub(super) side: Option<usize>,
}

/// The vertices of a band around a cut with their sides: no vertex of one is beside one of the other.
pub(super) fn least_separator(graph: &Pattern, labels: &[u32], cut: &Cut) -> Vec<Moved> {
    let band = Band::around(graph, labels, cut);
    let mut network = Network::of(graph, &band);
    while network.level_up() {
        network.augment();
    }
    let side = |place: usize| match [2 * place, 2 * place + 1].map(|node| network.level[node] != NONE) {
        [true, false] => None,
        [_, true] => Some(0),
        [false, false] => Some(1),
    };
    let vertices = band.vertices.iter().enumerate();
    vertices.map(|(place, &vertex)| Moved { vertex, side: side(place) }).collect()
}

/// Vertices around a cut.
struct Band {
    vertices: Vec<u32>,
    /// The place of a vertex of the graph among them, from 1; 0 elsewhere.
    place: Vec<u32>,
    /// Whether it is one of the outermost layer of either side: it stays there.
    rim: Vec<Option<usize>>,
}

impl Band {
    fn around(graph: &Pattern, labels: &[u32], cut: &Cut) -> Self {
        let mut band = Self { vertices: Vec::new(), place: vec![0; graph.order()], rim: Vec::new() };
        for (side, beside) in cut.beside.iter().enumerate() {
            let mut layer = beside.clone();
            for &vertex in &layer {
                band.push(vertex);
            }
            let mut taken = layer.len();
            for _ in 1..LAYERS {
                let mut next = Vec::new();
                for &vertex in &layer {
                    for &other in graph.column(vertex as usize) {
                        if band.place[other as usize] == 0 && cut.side(labels[other as usize]) == Some(side) {
                            band.push(other);
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

    fn push(&mut self, vertex: u32) {
        self.vertices.push(vertex);
        self.place[vertex as usize] = narrow(self.vertices.len());
    }
}

/// An arc, with the place of its reverse.
#[derive(Clone, Copy, Default)]
struct Arc {
    head: u32,
    capacity: u32,
    reverse: u32,
}

/// The band's vertices as pairs of nodes, 2k where paths come in and 2k + 1 where they leave, with a source and a sink.
struct Network {
    /// Those of one tail after another: both ways are gone through again and again.
    arcs: Vec<Arc>,
    /// Where the arcs of each node begin, and the end of the last.
    begin: Vec<u32>,
    /// The arc of each node that comes next.
    at: Vec<u32>,
    /// Arcs from the source; none for nodes that no path reaches.
    level: Vec<u32>,
    source: usize,
    sink: usize,
}

impl Network {
    fn of(graph: &Pattern, band: &Band) -> Self {
        let nodes = 2 * band.vertices.len() + 2;
        let (source, sink) = (nodes - 2, nodes - 1);
        let mut edges: Vec<Edge> = Vec::new();
        for (k, &vertex) in band.vertices.iter().enumerate() {
            let rim = band.rim[k];
            edges.push(Edge::new(2 * k, 2 * k + 1, if rim.is_some() { ENDLESS } else { 1 }));
            match rim {
                Some(0) => edges.push(Edge::new(source, 2 * k, ENDLESS)),
                Some(_) => edges.push(Edge::new(2 * k + 1, sink, ENDLESS)),
                None => {}
            }
            for &other in graph.column(vertex as usize).iter().filter(|&&other| other != vertex) {
                if let Some(other) = band.place[other as usize].checked_sub(1) {
                    edges.push(Edge::new(2 * k + 1, 2 * other as usize, ENDLESS));
                }
            }
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
        Self { arcs, at: begin[..nodes].to_vec(), begin, level: vec![NONE; nodes], source, sink }
    }

    /// Finds the level of every node that a shortest way to the sink may go through; of all that are reached, where the sink
    /// is not. Whether it is.
    fn level_up(&mut self) -> bool {
        self.level.fill(NONE);
        self.level[self.source] = 0;
        let mut queue = vec![self.source];
        let mut next = 0;
        while let Some(&node) = queue.get(next).filter(|&&node| self.level[node] < self.level[self.sink]) {
            next += 1;
            for &Arc { head, capacity, .. } in &self.arcs[self.begin[node] as usize..self.begin[node + 1] as usize] {
                if capacity > 0 && self.level[head as usize] == NONE {
                    self.level[head as usize] = self.level[node] + 1;
                    queue.push(head as usize);
                }
            }
        }
        self.at.copy_from_slice(&self.begin[..self.level.len()]);
        self.level[self.sink] != NONE
    }

    /// Sends paths from level to level as long as there are any.
    fn augment(&mut self) {
        let mut path: Vec<u32> = Vec::new();
        let mut node = self.source;
        loop {
            if node == self.sink {
                for &arc in &path {
                    let Arc { reverse, .. } = self.arcs[arc as usize];
                    self.arcs[arc as usize].capacity -= 1;
                    self.arcs[reverse as usize].capacity += 1;
                }
                path.clear();
                node = self.source;
            }
            if let Some(arc) = self.onward(node) {
                path.push(arc);
                node = self.arcs[arc as usize].head as usize;
            } else if let Some(arc) = path.pop() {
                let Arc { reverse, .. } = self.arcs[arc as usize];
                node = self.arcs[reverse as usize].head as usize;
                self.at[node] += 1;
            } else {
                return;
            }
        }
    }

    /// The next arc of a node that leads on.
    fn onward(&mut self, node: usize) -> Option<u32> {
        while self.at[node] < self.begin[node + 1] {
            let Arc { head, capacity, .. } = self.arcs[self.at[node] as usize];
            if capacity > 0 && self.level[head as usize] == self.level[node] + 1 {
                return Some(self.at[node]);
            }
            self.at[node] += 1;
        }
        None
    }
}

/// An arc before the arcs are in their order, from the first end to the second.
struct Edge {
    ends: [u32; 2],
    capacity: u32,
}

impl Edge {
    fn new(tail: usize, head: usize, capacity: u32) -> Self {
        Self { ends: [tail, head].map(narrow), capacity }
    }
}
