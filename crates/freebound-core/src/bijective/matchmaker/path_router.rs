//! Shortest path between two ends that crosses no other path.
//!
//! A path runs along old edges through free old vertices. It also crosses cells, from the middle of one piece of an
//! edge to that of another. The search is A* (Hart, Nilsson, Raphael 1968): all costs are lengths in the plane plus
//! charges. A straight line through a cell is never longer than a detour, so no cell is crossed twice.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use glam::DVec2;

use super::subdivision::{NONE, Role, Subdivision};
use crate::problem::{Control, Phase, SolveError};

/// Nodes expanded between two checks for cancellation.
const NODES_BETWEEN_LOOKS: usize = 4096;

/// Part of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Move {
    /// Out of a cell through this halfedge.
    Cross(u32),
    /// Through a cell to the tail of this halfedge.
    Reach(u32),
    /// Along a halfedge.
    Along(u32),
}

/// Directions in which a path may leave one of its ends, or reach it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Sector {
    /// Halfedges from the end whose cells may be entered there.
    pub(super) corners: Vec<u32>,
    /// Halfedges from the end along which a path may run.
    pub(super) edges: Vec<u32>,
}

impl Sector {
    pub(super) fn around(cells: &Subdivision, vertex: u32) -> Self {
        let all: Vec<u32> = cells.around(vertex).collect();
        Self { corners: all.clone(), edges: all }
    }

    /// Sector from one halfedge counter-clockwise to another. The whole circle if both are equal.
    pub(super) fn between(cells: &Subdivision, begin: u32, end: u32) -> Self {
        let mut corners = vec![begin];
        let mut h = cells.rotated(begin);
        while h != end {
            corners.push(h);
            h = cells.rotated(h);
        }
        let edges = corners[1..].to_vec();
        Self { corners, edges }
    }
}

/// End of a path: a vertex and the sector in which a path may leave it.
#[derive(Clone, Debug)]
pub(super) struct Terminal {
    pub(super) vertex: u32,
    pub(super) sector: Sector,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Way {
    pub(super) length: f64,
    pub(super) moves: Vec<Move>,
}

/// Length with a total order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Length(pub(super) f64);

impl Eq for Length {}

impl Ord for Length {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Length {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Open node of the search; the least bound comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Reached {
    /// Length so far plus a lower bound of the length to the goal.
    bound: Length,
    node: u32,
    length: Length,
}

/// Label of a node: run in which it was set, length, predecessor, and last move.
#[derive(Clone, Copy, Debug)]
struct Known {
    run: u32,
    length: f64,
    from: u32,
    by: Move,
}

#[derive(Clone, Copy, Debug)]
struct Link {
    node: u32,
    from: u32,
    by: Move,
}

/// Search for paths. Nodes are crossings (twice the halfedge) and vertices (twice the vertex plus one).
#[derive(Debug)]
pub(super) struct PathRouter<'a> {
    control: Control<'a>,
    known: Vec<Known>,
    run: u32,
    heap: BinaryHeap<Reverse<Reached>>,
    /// Length charged for a crossing of an edge that no path crosses yet.
    crossing: f64,
}

impl<'a> PathRouter<'a> {
    /// Router that charges this length for a new point.
    pub(super) fn new(crossing: f64, control: Control<'a>) -> Self {
        Self { control, known: Vec::new(), run: 0, heap: BinaryHeap::new(), crossing }
    }

    /// Shortest path between two ends of one region, which is connected.
    ///
    /// # Errors
    ///
    /// If the caller cancels. [`SolveError::TooFine`] if targets are so nearly collinear, relative to their distances,
    /// that rounding disconnects a region.
    pub(super) fn way(&mut self, cells: &Subdivision, start: &Terminal, goal: &Terminal) -> Result<Way, SolveError> {
        self.run += 1;
        self.heap.clear();
        let size = 2 * cells.halfedge_count().max(cells.vertex_count());
        self.known.resize(size, Known { run: 0, length: 0.0, from: NONE, by: Move::Along(NONE) });
        let begin = 2 * start.vertex + 1;
        self.reach(cells, goal, Link { node: begin, from: begin, by: Move::Along(NONE) });
        for count in 0_usize.. {
            if count.is_multiple_of(NODES_BETWEEN_LOOKS) {
                self.control.enter(Phase::Solve)?;
            }
            let Reverse(reached) = self.heap.pop().ok_or(SolveError::TooFine)?;
            let Reached { length: Length(length), node, .. } = reached;
            if node == 2 * goal.vertex + 1 {
                return Ok(Way { length, moves: self.moves(begin, node) });
            }
            if length > self.known[node as usize].length {
                continue;
            }
            if node.is_multiple_of(2) {
                self.leave_crossing(cells, node / 2, goal);
            } else if node == begin {
                self.run_along(cells, node, start.sector.edges.iter().copied(), goal);
                self.enter_cells(cells, node, start.sector.corners.iter().copied(), goal);
            } else {
                self.run_along(cells, node, cells.around(node / 2), goal);
                self.enter_cells(cells, node, cells.around(node / 2), goal);
            }
        }
        unreachable!("the count has no end")
    }

    /// Continues from a vertex along edges that leave it.
    fn run_along(&mut self, cells: &Subdivision, node: u32, edges: impl Iterator<Item = u32>, goal: &Terminal) {
        for h in edges.filter(|&h| cells.path(h).is_none()) {
            let head = cells.head(h);
            let is_open = if head == goal.vertex {
                goal.sector.edges.contains(&cells[h].twin)
            } else {
                cells.roles[head as usize] == Role::Free
            };
            if is_open {
                self.reach(cells, goal, Link { node: 2 * head + 1, from: node, by: Move::Along(h) });
            }
        }
    }

    /// Continues from a vertex through the cells at halfedges that leave it.
    fn enter_cells(&mut self, cells: &Subdivision, node: u32, corners: impl Iterator<Item = u32>, goal: &Terminal) {
        for corner in corners {
            let across = cells.cell(cells[corner].next).take_while(|&h| h != cells[corner].previous);
            for h in across.filter(|&h| cells.path(h).is_none()) {
                self.reach(cells, goal, Link { node: 2 * h, from: node, by: Move::Cross(h) });
            }
        }
    }

    /// Continues from the far side of a crossed halfedge.
    fn leave_crossing(&mut self, cells: &Subdivision, crossed: u32, goal: &Terminal) {
        let (node, entry) = (2 * crossed, cells[crossed].twin);
        for h in cells.cell(entry).skip(1) {
            if cells.path(h).is_none() {
                self.reach(cells, goal, Link { node: 2 * h, from: node, by: Move::Cross(h) });
            }
            let tail = cells[h].tail;
            let is_open = if tail == goal.vertex {
                goal.sector.corners.contains(&h)
            } else {
                cells.roles[tail as usize] == Role::Free
            };
            // The ends of the entry are collinear with it.
            if is_open && h != cells[entry].next {
                self.reach(cells, goal, Link { node: 2 * tail + 1, from: node, by: Move::Reach(h) });
            }
        }
    }

    /// Labels a node reached from another, if that is shorter.
    fn reach(&mut self, cells: &Subdivision, goal: &Terminal, link: Link) {
        let Link { node, from, by } = link;
        let (here, there) = (position(cells, node), position(cells, from));
        let cost = if node.is_multiple_of(2) { self.crossing * (1 + cells.crowd(node / 2)) as f64 } else { 0.0 };
        let before = if node == from { 0.0 } else { self.known[from as usize].length };
        let length = before + here.distance(there) + cost;
        let known = &mut self.known[node as usize];
        if known.run == self.run && known.length <= length {
            return;
        }
        *known = Known { run: self.run, length, from, by };
        let bound = Length(length + here.distance(cells.places[goal.vertex as usize]));
        self.heap.push(Reverse(Reached { bound, node, length: Length(length) }));
    }

    fn moves(&self, begin: u32, mut node: u32) -> Vec<Move> {
        let mut moves = Vec::new();
        while node != begin {
            let known = &self.known[node as usize];
            moves.push(known.by);
            node = known.from;
        }
        moves.reverse();
        moves
    }
}

/// Position of a node: a vertex, or the middle of a piece of an edge.
fn position(cells: &Subdivision, node: u32) -> DVec2 {
    let (at, half) = (|v: u32| cells.places[v as usize], node / 2);
    if node.is_multiple_of(2) { at(cells[half].tail).midpoint(at(cells.head(half))) } else { at(half) }
}
