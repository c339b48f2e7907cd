//! Cut graph: the seams that open a surface to a disk, as short as local search makes them.
//!
//! # Topology
//!
//! The complement of the graph is one disk, once small holes are filled. Handles need 2g loops (Erickson and
//! Whittlesey 2005, see `mesh/repair/cut.rs`). Each cone and each long boundary loop is connected to the rest by a
//! path: the shortest-path heuristic for Steiner trees (Takahashi and Matsuyama 1980).
//!
//! # Shortening
//!
//! A *chain* runs between cones, junctions and boundary vertices. If the graph falls apart without a chain, the
//! cheapest path between the two components replaces the chain. The complement stays a disk: without the chain it is
//! an annulus, and the path joins the annulus' two boundaries. Repeat until no chain can be replaced.

use std::collections::BTreeSet;

use super::surface::{CutSurface, Nearby};
use crate::mesh::union::DisjointSets;
use crate::problem::{Control, SolveError};

/// Most passes of shortening over all chains.
const PASSES: usize = 8;

/// Relative decrease of a chain's cost that counts.
const SHORTER: f64 = 1e-9;

/// Seams on a surface.
#[derive(Clone, Debug)]
pub(super) struct CutGraph<'a> {
    surface: &'a CutSurface<'a>,
    /// True for each edge that is a seam. Boundary edges are none.
    pub(super) is_seam: Vec<bool>,
    /// Number of seams at each vertex.
    degree: Vec<u32>,
    /// True for each vertex that the graph has to reach.
    pub(super) is_cone: Vec<bool>,
    /// Chains that no cheaper path could replace: lowest and highest edge, and number of edges.
    settled: BTreeSet<[u32; 3]>,
}

/// Seams from one end to another, without a cone, junction or boundary vertex between them.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub(super) ends: [u32; 2],
    pub(super) edges: Vec<u32>,
    pub(super) cost: f64,
}

impl<'a> CutGraph<'a> {
    /// Seams without which the surface has handles, or long boundary loops apart from each other.
    pub(super) fn topological(surface: &'a CutSurface<'a>, control: Control<'_>) -> Result<Self, SolveError> {
        let (edges, vertices) = (surface.edges.len(), surface.vertex_count());
        let mut graph = Self {
            surface,
            is_seam: vec![false; edges],
            degree: vec![0; vertices],
            is_cone: vec![false; vertices],
            settled: BTreeSet::new(),
        };
        if surface.genus() > 0 {
            graph.open_handles();
        }
        control.go_on()?;
        graph.join_loops(control)?;
        Ok(graph)
    }

    /// Loops around the handles, by the shortest paths from the long boundary loops, or from one vertex.
    fn open_handles(&mut self) {
        let surface = self.surface;
        // No cone has been added yet: these are the vertices of the long boundary loops.
        let required = self.anchors();
        let paths =
            if required.is_empty() { surface.paths(&surface.edges[0].ends[..1]) } else { surface.paths(&required) };
        let mut is_of_tree = vec![false; surface.edges.len()];
        for vertex in (0..).take(surface.vertex_count()) {
            if let Some(edge) = paths.last_edge(vertex) {
                is_of_tree[edge as usize] = true;
            }
        }
        let loop_cost = |edge: u32| {
            let edge = surface.edges[edge as usize];
            edge.cost + edge.ends.iter().map(|&v| paths.far[v as usize]).sum::<f64>()
        };
        let mut crossed: Vec<(u32, [u32; 2])> = surface.faces_beside();
        crossed.retain(|(edge, _)| !is_of_tree[*edge as usize]);
        crossed.sort_by(|(a, _), (b, _)| loop_cost(*b).total_cmp(&loop_cost(*a)).then(a.cmp(b)));
        let mut faces = DisjointSets::new(surface.part().polygons().face_count() + surface.is_required.len());
        let left: Vec<u32> =
            crossed.into_iter().filter(|(_, [a, b])| !faces.join(*a, *b)).map(|(edge, _)| edge).collect();
        for edge in left {
            self.open(edge);
            for end in surface.edges[edge as usize].ends {
                for edge in paths.to(surface, end) {
                    self.open(edge);
                }
            }
        }
        self.prune((0..).take(self.degree.len()).collect());
    }

    /// Opens an edge. Boundary edges are open already.
    fn open(&mut self, edge: u32) {
        let at = &self.surface.edges[edge as usize];
        if !at.is_boundary && !std::mem::replace(&mut self.is_seam[edge as usize], true) {
            at.ends.iter().for_each(|&v| self.degree[v as usize] += 1);
        }
    }

    fn open_all(&mut self, edges: impl IntoIterator<Item = u32>) {
        for edge in edges {
            self.open(edge);
        }
    }

    fn close(&mut self, edge: u32) {
        if std::mem::replace(&mut self.is_seam[edge as usize], false) {
            self.surface.edges[edge as usize].ends.iter().for_each(|&v| self.degree[v as usize] -= 1);
        }
    }

    /// Removes dangling ends that lie on no boundary and are no cones, starting at the given vertices.
    fn prune(&mut self, mut ends: Vec<u32>) {
        while let Some(vertex) = ends.pop() {
            if self.degree[vertex as usize] != 1 || self.is_cone[vertex as usize] || self.is_held_by_loop(vertex) {
                continue;
            }
            let seam = self.surface.at(vertex).iter().copied().find(|&edge| self.is_seam[edge as usize]);
            if let Some(edge) = seam {
                self.close(edge);
                ends.push(self.surface.other_end(edge, vertex));
            }
        }
    }

    /// True if a seam may end at a vertex because of its boundary loop: a long loop, or a hole that is a cone or that
    /// another seam reaches too.
    fn is_held_by_loop(&self, vertex: u32) -> bool {
        let Some(of) = self.surface.loop_of[vertex as usize] else { return false };
        let mut around = self.around_loop(of);
        self.surface.is_required[of as usize]
            || around.clone().any(|v| self.is_cone[v as usize])
            || around.try_fold(0, |seams, v| Some(seams + self.degree[v as usize]).filter(|&seams| seams < 2)).is_none()
    }

    /// Vertices of a boundary loop.
    fn around_loop(&self, of: u32) -> impl Iterator<Item = u32> + Clone + '_ {
        (0..).zip(&self.surface.loop_of).filter(move |(_, other)| **other == Some(of)).map(|(vertex, _)| vertex)
    }

    /// Connects the long boundary loops with the rest.
    fn join_loops(&mut self, control: Control<'_>) -> Result<(), SolveError> {
        let surface = self.surface;
        let is_required = |v: u32| surface.is_on_required_loop(v);
        loop {
            control.go_on()?;
            let required: Vec<u32> =
                (0..).take(surface.vertex_count()).filter(|&v| self.is_in(v) || is_required(v)).collect();
            let Some(&first) = required.iter().find(|&&v| self.degree[v as usize] > 0).or(required.first()) else {
                return Ok(());
            };
            let reached = self.component(first);
            if required.iter().all(|&v| reached[v as usize]) {
                return Ok(());
            }
            let from: Vec<u32> = required.iter().copied().filter(|&v| reached[v as usize]).collect();
            let is_goal = |v: u32| !reached[v as usize] && (self.degree[v as usize] > 0 || is_required(v));
            let Some(path) = surface.path(&from, is_goal) else { return Ok(()) };
            self.open_all(path);
        }
    }

    /// True if a vertex is a cone or has a seam.
    fn is_in(&self, vertex: u32) -> bool {
        self.degree[vertex as usize] > 0 || self.is_cone[vertex as usize]
    }

    /// True if the map is free at a vertex: at seams, cones and long boundary loops.
    pub(super) fn is_free(&self, vertex: u32) -> bool {
        self.is_in(vertex) || self.surface.is_on_required_loop(vertex)
    }

    /// Cones, and vertices of long boundary loops.
    pub(super) fn anchors(&self) -> Vec<u32> {
        let is_anchor = |&v: &u32| self.is_cone[v as usize] || self.surface.is_on_required_loop(v);
        (0..).take(self.degree.len()).filter(is_anchor).collect()
    }

    /// Vertices where the map is free.
    pub(super) fn free_vertices(&self) -> Vec<u32> {
        (0..).take(self.degree.len()).filter(|&v| self.is_free(v)).collect()
    }

    /// True if the seams open the surface. Without a boundary that they reach, a surface without handles needs two
    /// seams or more: along one, the boundary would have two vertices.
    pub(super) fn has_enough(&self) -> bool {
        let is_at_loop =
            |edge: usize| self.surface.edges[edge].ends.iter().any(|&end| self.surface.loop_of[end as usize].is_some());
        self.surface.is_required.contains(&true) || self.seams().nth(1).is_some() || self.seams().any(is_at_loop)
    }

    /// Cost of all seams.
    pub(super) fn cost(&self) -> f64 {
        self.seams().map(|edge| self.surface.edges[edge].cost).sum()
    }

    fn seams(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.is_seam.len()).filter(|&edge| self.is_seam[edge])
    }

    /// Vertices connected with one by seams and boundary edges.
    fn component(&self, from: u32) -> Vec<bool> {
        let mut is_reached = vec![false; self.degree.len()];
        is_reached[from as usize] = true;
        let mut stack = vec![from];
        while let Some(vertex) = stack.pop() {
            for &edge in self.surface.at(vertex) {
                let is_open = self.is_seam[edge as usize] || self.surface.edges[edge as usize].is_boundary;
                let other = self.surface.other_end(edge, vertex);
                if is_open && !std::mem::replace(&mut is_reached[other as usize], true) {
                    stack.push(other);
                }
            }
        }
        is_reached
    }

    /// Makes a vertex a cone, connected by the given path.
    pub(super) fn add_cone(&mut self, vertex: u32, path: impl IntoIterator<Item = u32>) {
        self.is_cone[vertex as usize] = true;
        self.open_all(path);
    }

    /// Connects cones with the graph, the nearest first.
    pub(super) fn connect(&mut self, cones: &[u32]) {
        let mut is_left = vec![false; self.degree.len()];
        for &cone in cones.iter().filter(|&&cone| !self.is_free(cone)) {
            is_left[cone as usize] = true;
        }
        let surface = self.surface;
        let from = self.free_vertices();
        let mut seams = Vec::new();
        surface.paths_through(
            &from,
            |v| is_left[v as usize],
            |_, path| {
                seams.extend(path);
                true
            },
        );
        self.open_all(seams);
        for &cone in cones {
            self.is_cone[cone as usize] = true;
        }
    }

    /// Removes a cone, and the seam that leads to it if the cone is its end.
    pub(super) fn remove_cone(&mut self, vertex: u32) {
        self.is_cone[vertex as usize] = false;
        // The seams of a hole may end at any of its vertices.
        let hole = self.surface.loop_of[vertex as usize].map(|of| self.around_loop(of).collect());
        self.prune(hole.unwrap_or_else(|| vec![vertex]));
    }

    /// Vertices that the graph has to reach.
    pub(super) fn cones(&self) -> Vec<u32> {
        (0..).take(self.is_cone.len()).filter(|&v| self.is_cone[v as usize]).collect()
    }

    /// All chains, in the order of their first edges.
    pub(super) fn chains(&self) -> Vec<Chain> {
        let is_end = |v: u32| {
            self.degree[v as usize] != 2 || self.is_cone[v as usize] || self.surface.loop_of[v as usize].is_some()
        };
        let mut is_seen = vec![false; self.is_seam.len()];
        let mut chains = Vec::new();
        for vertex in (0..).take(self.degree.len()).filter(|&v| self.degree[v as usize] > 0 && is_end(v)) {
            for &first in self.surface.at(vertex) {
                if !self.is_seam[first as usize] || is_seen[first as usize] {
                    continue;
                }
                let mut edges = Vec::new();
                let (mut at, mut edge) = (vertex, first);
                loop {
                    is_seen[edge as usize] = true;
                    edges.push(edge);
                    at = self.surface.other_end(edge, at);
                    if is_end(at) {
                        break;
                    }
                    let next = self.surface.at(at).iter().copied();
                    let Some(next) = next.into_iter().find(|&next| self.is_seam[next as usize] && next != edge) else {
                        break;
                    };
                    edge = next;
                }
                let cost = edges.iter().map(|&edge| self.surface.edges[edge as usize].cost).sum();
                chains.push(Chain { ends: [vertex, at], edges, cost });
            }
        }
        chains
    }

    /// Replaces chains by cheaper paths until none is left that can be. Chains that could not be replaced before are
    /// skipped.
    pub(super) fn shorten(&mut self, control: Control<'_>) -> Result<(), SolveError> {
        let mut search = ChainSearch::new(self.surface);
        for _ in 0..PASSES {
            let mut chains = self.chains();
            chains.retain(|chain| !self.settled.contains(&chain.key()));
            chains.sort_by(|a, b| b.cost.total_cmp(&a.cost).then(a.edges.cmp(&b.edges)));
            let mut is_shorter = false;
            for chain in chains {
                control.go_on()?;
                is_shorter |= self.replace(&chain, &mut search);
            }
            if !is_shorter {
                break;
            }
        }
        Ok(())
    }

    /// Shortens all chains, also those that could not be replaced before.
    pub(super) fn shorten_all(&mut self, control: Control<'_>) -> Result<(), SolveError> {
        self.settled.clear();
        self.shorten(control)
    }

    /// Replaces a chain by a cheaper path, if there is one. Earlier replacements may have changed the chain.
    fn replace(&mut self, chain: &Chain, search: &mut ChainSearch) -> bool {
        let is_inner = |pair: &[u32]| {
            let [a, b] = [pair[0], pair[1]].map(|edge| self.surface.edges[edge as usize].ends);
            let shared = if a.contains(&b[0]) { b[0] } else { b[1] };
            self.degree[shared as usize] == 2
        };
        let is_whole =
            chain.edges.iter().all(|&edge| self.is_seam[edge as usize]) && chain.edges.windows(2).all(is_inner);
        if !is_whole {
            return false;
        }
        for &edge in &chain.edges {
            self.close(edge);
        }
        let path = search.path_instead(self, chain);
        let is_replaced = path.is_some();
        if let Some(path) = path {
            self.open_all(path);
            self.prune(chain.ends.to_vec());
        } else {
            self.open_all(chain.edges.iter().copied());
            self.settled.insert(chain.key());
        }
        is_replaced
    }
}

impl Chain {
    fn key(&self) -> [u32; 3] {
        let ends = [self.edges.iter().min(), self.edges.iter().max()].map(|edge| edge.copied().unwrap_or_default());
        [ends[0], ends[1], u32::try_from(self.edges.len()).expect("edges fit")]
    }
}

/// Working memory of the search for cheaper paths.
struct ChainSearch {
    /// Component of each vertex: 1 and 2 at the ends of the chain, 0 elsewhere.
    component: Vec<u8>,
    nearby: Nearby,
}

impl ChainSearch {
    fn new(surface: &CutSurface<'_>) -> Self {
        Self { component: vec![0; surface.vertex_count()], nearby: Nearby::new(surface) }
    }

    /// Path that is cheaper than a chain and connects the two components that are left without it. `None` if there
    /// is none, or if the chain is part of a loop.
    fn path_instead(&mut self, graph: &CutGraph<'_>, chain: &Chain) -> Option<Vec<u32>> {
        let first = self.flood(graph, chain.ends[0], 1);
        let path = if self.component[chain.ends[1] as usize] == 1 {
            None
        } else {
            let second = self.flood(graph, chain.ends[1], 2);
            let (from, goal) = if first.len() <= second.len() { (&first, 2) } else { (&second, 1) };
            let component = &self.component;
            let most = chain.cost * (1.0 - SHORTER);
            let path = self.nearby.path(graph.surface, from, most, |v| component[v as usize] == goal);
            self.unmark(&second);
            path
        };
        self.unmark(&first);
        path
    }

    fn unmark(&mut self, vertices: &[u32]) {
        for &vertex in vertices {
            self.component[vertex as usize] = 0;
        }
    }

    /// Marks the vertices that are connected with one by seams and boundary edges, and lists them.
    fn flood(&mut self, graph: &CutGraph<'_>, from: u32, mark: u8) -> Vec<u32> {
        self.component[from as usize] = mark;
        let mut found = vec![from];
        let mut at = 0;
        while at < found.len() {
            let vertex = found[at];
            at += 1;
            for &edge in graph.surface.at(vertex) {
                let is_open = graph.is_seam[edge as usize] || graph.surface.edges[edge as usize].is_boundary;
                let other = graph.surface.other_end(edge, vertex);
                if is_open && self.component[other as usize] == 0 {
                    self.component[other as usize] = mark;
                    found.push(other);
                }
            }
        }
        found
    }
}
