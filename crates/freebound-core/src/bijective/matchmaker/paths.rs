//! Paths on the mesh, one for each edge of the target graph, in equal cyclic order around each vertex.
//!
//! A tree comes first: each path joins two ends that are not connected yet, so that the complement stays connected and
//! a path always exists. All other paths follow: each joins two corners of a region without holes, and cuts it in two.
//! In both phases the shortest path comes first (Kraevoy, Sheffer, Gotsman 2003, "Matchmaker: constructing constrained
//! texture maps").

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::path_router::{Length, Move, PathRouter, Sector, Terminal, Way};
use super::subdivision::{Role, Subdivision};
use super::target_graph::{TargetGraph, near_pairs};
use crate::geom::Random;
use crate::problem::SolveError;

/// Choice of the paths that form the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SearchOptions {
    pub(super) growth: Growth,
    pub(super) beginning: PathStart,
    /// Weight of the distance between targets in the cost of a path.
    pub(super) target_share: f64,
    /// Largest random factor of a cost, and the seed of the random numbers.
    pub(super) luck: (f64, u64),
}

/// Growth of the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Growth {
    /// From the frame (Prim).
    FromFrame,
    /// By the next shortest path anywhere (Kruskal).
    Anywhere,
}

/// First candidates for edges of the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PathStart {
    /// Edges of a triangulation of the targets.
    NearTargets,
    /// Edges between ends that are close on the mesh.
    NearOnMesh,
}

#[derive(Debug)]
pub(super) struct Paths {
    pub(super) cells: Subdivision,
    pub(super) graph: TargetGraph,
    /// Vertex of the subdivision for each vertex of the graph.
    vertices: Vec<u32>,
    /// First halfedge of the path of each directed edge of the graph.
    departures: BTreeMap<[u32; 2], u32>,
    /// Vertices of the path of each edge, from its first end to its second.
    pub(super) lines: Vec<Vec<u32>>,
    /// Number of the connected component, by paths, of each vertex of the graph.
    piece: Vec<u32>,
    manner: SearchOptions,
}

/// Ends of the paths.
#[derive(Clone, Debug)]
pub(super) struct Ends {
    /// Targets and frame, without edges.
    pub(super) graph: TargetGraph,
    /// Vertex of the subdivision for each vertex of the graph.
    pub(super) vertices: Vec<u32>,
    /// Number of corners of the frame.
    pub(super) frame: usize,
}

/// Pair of ends that waits for its path, ordered by a lower bound of the path's cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Waiting {
    bound: Length,
    pair: [u32; 2],
}

impl Paths {
    /// Starts with the frame's sides, which are edges of the subdivision, as the only paths.
    pub(super) fn new(mut cells: Subdivision, Ends { graph, vertices, frame }: Ends, manner: SearchOptions) -> Self {
        for (end, &vertex) in (0..).zip(&vertices) {
            cells.roles[vertex as usize] = Role::End(end);
        }
        let count = graph.points.len();
        let corners: Vec<u32> = (0..).take(count).skip(count - frame).collect();
        let piece = (0..).take(count).map(|end: u32| end.min(corners[0])).collect();
        let (departures, lines) = (BTreeMap::new(), Vec::new());
        let mut paths = Self { cells, graph, vertices, departures, lines, piece, manner };
        for (k, &from) in corners.iter().enumerate() {
            let to = corners[(k + 1) % frame];
            let [tail, head] = [from, to].map(|end| paths.vertices[end as usize]);
            let side = paths.cells.around(tail).find(|&h| paths.cells.head(h) == head).expect("the frame is closed");
            paths.lay([from, to], &[Move::Along(side)]);
        }
        paths
    }

    /// Lays the paths of all edges of a triangulation, with at most `most` new points.
    pub(super) fn lay_all(&mut self, router: &mut PathRouter<'_>, most: usize) -> Result<(), SolveError> {
        if self.manner.beginning == PathStart::NearOnMesh {
            let places: Vec<_> = self.vertices.iter().map(|&v| self.cells.places[v as usize]).collect();
            self.lay_tree(&near_pairs(&places), router, most)?;
        }
        let missing = self.graph.missing_edges().ok_or(SolveError::TooFine)?;
        self.lay_tree(&missing, router, most)?;
        let mut waiting: BinaryHeap<_> = missing
            .iter()
            .filter(|[a, b]| self.graph.edge_between(*a, *b).is_none())
            .map(|&pair| Reverse(self.waiting(pair)))
            .collect();
        while let Some(Reverse(Waiting { pair, .. })) = waiting.pop() {
            self.lay_or_wait(pair, router, &mut waiting)?;
            self.check(most)?;
        }
        Ok(())
    }

    /// Lays paths between pairs of ends that are not connected yet, unless edges of the graph would cross.
    fn lay_tree(&mut self, pairs: &[[u32; 2]], router: &mut PathRouter<'_>, most: usize) -> Result<(), SolveError> {
        let growth = self.manner.growth;
        let frame = self.piece[self.piece.len() - 1];
        let mut pairs_at: Vec<Vec<[u32; 2]>> = vec![Vec::new(); self.piece.len()];
        for &[a, b] in pairs {
            pairs_at[a as usize].push([a, b]);
            pairs_at[b as usize].push([a, b]);
        }
        let is_at_frame = |paths: &Self, [a, b]: [u32; 2]| {
            growth == Growth::Anywhere || [a, b].iter().any(|&end| paths.piece[end as usize] == frame)
        };
        let mut waiting: BinaryHeap<_> =
            pairs.iter().filter(|&&pair| is_at_frame(self, pair)).map(|&pair| Reverse(self.waiting(pair))).collect();
        while let Some(Reverse(Waiting { pair, .. })) = waiting.pop() {
            let [one, other] = pair.map(|end| self.piece[end as usize]);
            if one == other || self.graph.bars(pair) || !self.lay_or_wait(pair, router, &mut waiting)? {
                continue;
            }
            self.check(most)?;
            let (kept, lost) = if one == frame { (one, other) } else { (other, one) };
            for (end, pairs) in pairs_at.iter().enumerate() {
                if self.piece[end] == lost {
                    self.piece[end] = kept;
                    if growth == Growth::FromFrame {
                        waiting.extend(pairs.iter().map(|&pair| Reverse(self.waiting(pair))));
                    }
                }
            }
        }
        Ok(())
    }

    fn check(&self, most: usize) -> Result<(), SolveError> {
        if self.cells.point_count() > most { Err(SolveError::TooManyNewVertices { most }) } else { Ok(()) }
    }

    /// Pair with the distance of its ends as the bound.
    fn waiting(&self, pair: [u32; 2]) -> Waiting {
        let [a, b] = pair.map(|end| self.cells.places[self.vertices[end as usize] as usize]);
        Waiting { bound: Length(self.counted(a.distance(b), pair)), pair }
    }

    /// Cost of a path of some length.
    fn counted(&self, length: f64, [a, b]: [u32; 2]) -> f64 {
        let [from, to] = [a, b].map(|end| self.graph.points[end as usize]);
        let SearchOptions { target_share, luck: (most, seed), .. } = self.manner;
        let number = (u64::from(a.min(b)) << 32) | u64::from(a.max(b));
        let chance = Random::of_run(seed, number).unit();
        (length + target_share * from.distance(to)) * (1.0 + (most - 1.0) * chance)
    }

    /// Lays a path unless another may be shorter. Costs only grow as further paths are laid.
    fn lay_or_wait(
        &mut self,
        pair: [u32; 2],
        router: &mut PathRouter<'_>,
        waiting: &mut BinaryHeap<Reverse<Waiting>>,
    ) -> Result<bool, SolveError> {
        let [from, to] = pair;
        let Way { length, moves } = router.way(&self.cells, &self.terminal(from, to), &self.terminal(to, from))?;
        let length = self.counted(length, pair);
        let is_shortest = waiting.peek().is_none_or(|Reverse(next)| length <= next.bound.0);
        if is_shortest {
            self.lay(pair, &moves);
        } else {
            waiting.push(Reverse(Waiting { bound: Length(length), pair }));
        }
        Ok(is_shortest)
    }

    /// Start of a path from one end to another: the sector between its neighbours in the order of the graph.
    fn terminal(&self, from: u32, to: u32) -> Terminal {
        let vertex = self.vertices[from as usize];
        let departure = |other: u32| self.departures[&[from, other]];
        let sector = match self.graph.beside(from, to) {
            Some([before, after]) => Sector::between(&self.cells, departure(before), departure(after)),
            None => Sector::around(&self.cells, vertex),
        };
        Terminal { vertex, sector }
    }

    /// Lays a path and splits the edges and cells that it crosses.
    fn lay(&mut self, [from, to]: [u32; 2], moves: &[Move]) {
        let edge = self.graph.add([from, to]);
        let role = Role::Within(edge);
        let mut vertex = self.vertices[from as usize];
        let mut line = vec![vertex];
        // Corner of the present cell from which the path continues. None at a vertex: the next move determines the
        // cell.
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
        self.departures.insert([from, to], pieces[0]);
        self.departures.insert([to, from], self.cells[pieces[pieces.len() - 1]].twin);
        self.lines.push(line);
    }
}
