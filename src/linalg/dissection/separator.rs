//! The least separator in a band around a cut.
//!
//! By Menger's theorem the fewest vertices that part two sets are as many as there are paths between these without a common
//! vertex. The paths are found as a greatest flow (Dinic 1970) in the graph in which every vertex of the band is two, with
//! an arc of capacity 1 from one to the other.

use super::Cut;
use crate::linalg::order::{NONE, Pattern, narrow};

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

/// An arc; its reverse stands beside it, at the place with the last bit changed.
#[derive(Clone, Copy)]
struct Arc {
    head: u32,
    capacity: u32,
    /// The next arc with its tail.
    next: u32,
}

/// The band's vertices as pairs of nodes, 2k where paths come in and 2k + 1 where they leave, with a source and a sink.
struct Network {
    arcs: Vec<Arc>,
    /// The first arc of each node.
    first: Vec<u32>,
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
        let mut this = Self {
            arcs: Vec::new(),
            first: vec![NONE; nodes],
            at: Vec::new(),
            level: vec![NONE; nodes],
            source: nodes - 2,
            sink: nodes - 1,
        };
        for (k, &vertex) in band.vertices.iter().enumerate() {
            let rim = band.rim[k];
            this.add(2 * k, 2 * k + 1, if rim.is_some() { ENDLESS } else { 1 });
            match rim {
                Some(0) => this.add(this.source, 2 * k, ENDLESS),
                Some(_) => this.add(2 * k + 1, this.sink, ENDLESS),
                None => {}
            }
            for &other in graph.column(vertex as usize).iter().filter(|&&other| other != vertex) {
                if let Some(other) = band.place[other as usize].checked_sub(1) {
                    this.add(2 * k + 1, 2 * other as usize, ENDLESS);
                }
            }
        }
        this
    }

    fn add(&mut self, tail: usize, head: usize, capacity: u32) {
        for (tail, head, capacity) in [(tail, head, capacity), (head, tail, 0)] {
            let next = std::mem::replace(&mut self.first[tail], narrow(self.arcs.len()));
            self.arcs.push(Arc { head: narrow(head), capacity, next });
        }
    }

    /// Finds the level of every node. Whether the sink has one.
    fn level_up(&mut self) -> bool {
        self.level.fill(NONE);
        self.level[self.source] = 0;
        let mut queue = vec![self.source];
        let mut next = 0;
        while let Some(&node) = queue.get(next) {
            next += 1;
            // No path that is as short as can be goes on behind the sink's level.
            if self.level[node] >= self.level[self.sink] {
                break;
            }
            let mut arc = self.first[node];
            while arc != NONE {
                let Arc { head, capacity, next } = self.arcs[arc as usize];
                if capacity > 0 && self.level[head as usize] == NONE {
                    self.level[head as usize] = self.level[node] + 1;
                    queue.push(head as usize);
                }
                arc = next;
            }
        }
        self.at.clone_from(&self.first);
        self.level[self.sink] != NONE
    }

    /// Sends paths from level to level as long as there are any.
    fn augment(&mut self) {
        let mut path: Vec<u32> = Vec::new();
        let mut node = self.source;
        loop {
            if node == self.sink {
                for &arc in &path {
                    self.arcs[arc as usize].capacity -= 1;
                    self.arcs[arc as usize ^ 1].capacity += 1;
                }
                path.clear();
                node = self.source;
            }
            if let Some(arc) = self.onward(node) {
                path.push(arc);
                node = self.arcs[arc as usize].head as usize;
            } else if let Some(arc) = path.pop() {
                node = self.arcs[arc as usize ^ 1].head as usize;
                self.at[node] = self.arcs[arc as usize].next;
            } else {
                return;
            }
        }
    }

    /// The next arc of a node that leads on.
    fn onward(&mut self, node: usize) -> Option<u32> {
        while self.at[node] != NONE {
            let Arc { head, capacity, next } = self.arcs[self.at[node] as usize];
            if capacity > 0 && self.level[head as usize] == self.level[node] + 1 {
                return Some(self.at[node]);
            }
            self.at[node] = next;
        }
        None
    }
}
