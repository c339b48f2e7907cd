//! Paths on the mesh, one for each edge of the target graph, in its order around each vertex.
//!
//! First a tree that grows from the frame: a path joins an end that is connected with one that has no path yet, so that
//! the rest stays in one piece and there always is a way. Then all others: each joins two corners of a region without
//! holes, and cuts it in two. Either time the shortest comes first (Kraevoy, Sheffer, Gotsman 2003, "Matchmaker:
//! constructing constrained texture maps").

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::router::{Length, Move, Router, Sector, Terminal, Way};
use super::subdivision::{Role, Subdivision};
use super::target_graph::TargetGraph;
use crate::solver::SolveError;

#[derive(Debug)]
pub(super) struct Paths<'a> {
    pub(super) cells: Subdivision,
    graph: &'a TargetGraph,
    /// Vertices of the graph before the frame's.
    target_count: usize,
    /// The vertex of the subdivision for each vertex of the graph.
    vertices: Vec<u32>,
    /// For each directed edge of the graph that has a path the halfedge by which it leaves.
    departures: BTreeMap<[u32; 2], u32>,
    /// For each edge the vertices of its path, from the first end to the second.
    pub(super) lines: Vec<Vec<u32>>,
}

/// An edge that waits for its path, by a bound of the path's length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Waiting {
    bound: Length,
    edge: u32,
}

impl<'a> Paths<'a> {
    /// The frame's sides, which are edges of the subdivision, and no other path. `frame` counts the frame's corners.
    pub(super) fn new(mut cells: Subdivision, graph: &'a TargetGraph, vertices: Vec<u32>, frame: usize) -> Self {
        for (end, &vertex) in (0..).zip(&vertices) {
            cells.roles[vertex as usize] = Role::End(end);
        }
        let lines = vec![Vec::new(); graph.edges.len()];
        let target_count = graph.points.len() - frame;
        let mut paths = Self { cells, graph, target_count, vertices, departures: BTreeMap::new(), lines };
        let corners: Vec<u32> = (0..).take(graph.points.len()).skip(target_count).collect();
        for (k, &from) in corners.iter().enumerate() {
            let to = corners[(k + 1) % frame];
            let [tail, head] = [from, to].map(|end| paths.vertices[end as usize]);
            let side = paths.cells.around(tail).find(|&h| paths.cells.head(h) == head).expect("the frame is closed");
            let edge = graph.edge_between(from, to).expect("the frame is the hull of the graph");
            paths.lay(edge, from, &[Move::Along(side)]);
        }
        paths
    }

    /// Lays the paths of all edges, with at most so many new points.
    pub(super) fn lay_all(&mut self, router: &mut Router<'_>, most: usize) -> Result<(), SolveError> {
        let check = |paths: &Self| {
            let is_enough = paths.cells.point_count() > most;
            if is_enough { Err(SolveError::TooManyNewVertices { most }) } else { Ok(()) }
        };
        let mut is_connected: Vec<bool> = (0..self.graph.points.len()).map(|end| end >= self.target_count).collect();
        let mut waiting = BinaryHeap::new();
        for end in (0..).take(is_connected.len()).filter(|&end| is_connected[end as usize]) {
            self.wait_at(end, &is_connected, &mut waiting);
        }
        while let Some(Reverse(Waiting { edge, .. })) = waiting.peek().copied() {
            let [a, b] = self.graph.edges[edge as usize];
            let [from, to] = if is_connected[a as usize] { [a, b] } else { [b, a] };
            if is_connected[to as usize] {
                waiting.pop();
            } else if self.lay_or_wait(edge, from, router, &mut waiting)? {
                check(self)?;
                is_connected[to as usize] = true;
                self.wait_at(to, &is_connected, &mut waiting);
            }
        }
        for edge in (0..).take(self.lines.len()).filter(|&edge| self.lines[edge as usize].is_empty()) {
            waiting.push(self.waiting(edge));
        }
        while let Some(Reverse(Waiting { edge, .. })) = waiting.peek().copied() {
            self.lay_or_wait(edge, self.graph.edges[edge as usize][0], router, &mut waiting)?;
            check(self)?;
        }
        Ok(())
    }

    /// The edges from a connected end to others wait.
    fn wait_at(&self, end: u32, is_connected: &[bool], waiting: &mut BinaryHeap<Reverse<Waiting>>) {
        for (edge, [a, b]) in (0..).zip(&self.graph.edges) {
            let other = if *a == end { *b } else { *a };
            if (*a == end || *b == end) && !is_connected[other as usize] {
                waiting.push(self.waiting(edge));
            }
        }
    }

    /// An edge of which nothing is known but how far its ends are from each other.
    fn waiting(&self, edge: u32) -> Reverse<Waiting> {
        let [a, b] = self.graph.edges[edge as usize].map(|end| self.cells.places[self.vertices[end as usize] as usize]);
        Reverse(Waiting { bound: Length(a.distance(b)), edge })
    }

    /// Lays the path of the first edge that waits, if no longer than the next may be: paths in its way only add to it.
    fn lay_or_wait(
        &mut self,
        edge: u32,
        from: u32,
        router: &mut Router<'_>,
        waiting: &mut BinaryHeap<Reverse<Waiting>>,
    ) -> Result<bool, SolveError> {
        waiting.pop();
        let to = self.other_end(edge, from);
        let Way { length, moves } = router.way(&self.cells, &self.terminal(from, to), &self.terminal(to, from))?;
        let is_shortest = waiting.peek().is_none_or(|Reverse(next)| length <= next.bound.0);
        if is_shortest {
            self.lay(edge, from, &moves);
        } else {
            waiting.push(Reverse(Waiting { bound: Length(length), edge }));
        }
        Ok(is_shortest)
    }

    /// The other end of an edge.
    fn other_end(&self, edge: u32, end: u32) -> u32 {
        let [a, b] = self.graph.edges[edge as usize];
        if end == a { b } else { a }
    }

    /// Where a path from one end to another may leave it: between its neighbours in the order of the graph.
    fn terminal(&self, from: u32, to: u32) -> Terminal {
        let vertex = self.vertices[from as usize];
        let departure = |other: u32| self.departures.get(&[from, other]).copied();
        let after = self.graph.neighbours_after(from, to).find_map(departure);
        let before = self.graph.neighbours_after(from, to).rev().find_map(departure);
        let sector = match (before, after) {
            (Some(begin), Some(end)) => Sector::between(&self.cells, begin, end),
            _ => Sector::around(&self.cells, vertex),
        };
        Terminal { vertex, sector }
    }

    /// Lays a path: splits what it crosses.
    fn lay(&mut self, edge: u32, from: u32, moves: &[Move]) {
        let role = Role::Within(edge);
        let mut vertex = self.vertices[from as usize];
        let mut line = vec![vertex];
        // The corner of the present cell from which the path goes on; none at a vertex, where the next move says.
        let mut corner: Option<u32> = None;
        let mut pieces = Vec::with_capacity(moves.len());
        for &step in moves {
            let cells = &mut self.cells;
            let piece = match step {
                Move::Along(h) => {
                    corner = None;
                    h
                }
                Move::Cross(h) => {
                    let at_vertex = || cells.cell(h).find(|&other| cells[other].tail == vertex);
                    let begin = corner.or_else(at_vertex).expect("the way goes on from a corner");
                    cells.split_edge(h, role);
                    corner = Some(cells[h].twin);
                    cells.split_cell(begin, cells[h].next)
                }
                Move::Reach(h) => {
                    let begin = corner.take().expect("a vertex is reached through a cell");
                    cells.split_cell(begin, h)
                }
            };
            let twin = cells[piece].twin;
            (cells[piece].path, cells[twin].path) = (edge, edge);
            vertex = cells.head(piece);
            if cells.roles[vertex as usize] == Role::Free {
                cells.roles[vertex as usize] = role;
            }
            line.push(vertex);
            pieces.push(piece);
        }
        let to = self.other_end(edge, from);
        self.departures.insert([from, to], pieces[0]);
        self.departures.insert([to, from], self.cells[pieces[pieces.len() - 1]].twin);
        if from != self.graph.edges[edge as usize][0] {
            line.reverse();
        }
        self.lines[edge as usize] = line;
    }
}
