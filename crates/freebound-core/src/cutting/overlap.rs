//! Charts of a map that overlaps itself: short seams between faces that lie over each other.
//!
//! Two faces *conflict* if their insides meet in the map. A minimum cut of the dual graph, with the costs of edges as
//! capacities, separates the faces around one conflict from those around its partner. Cuts follow until no chart has
//! conflicts. Each cut separates at least one pair, so this ends. Then neighbours without a conflict are joined again
//! (see `joining`).

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

use glam::DVec3;
use petgraph::algo::dinics;
use petgraph::graph::{DiGraph, NodeIndex};
use petgraph::visit::EdgeRef as _;

use super::surface::{CutSurface, OpenedChart};
use crate::geom;
use crate::mesh::FaceId;
use crate::problem::{Control, Embedding, SolveError};

/// Most pairs of conflicting triangles of a map that is worth cutting into charts.
const MOST_CONFLICTS: usize = 1 << 21;

/// Most charts of one part before neighbours are joined.
const MOST_CHARTS: usize = 1024;

/// Distance from one face of a conflict relative to that from the other, at most, of faces that a cut keeps on its
/// side.
const NEAR: f64 = 0.5;

/// Units of the capacity of all edges together.
const CAPACITY: f64 = (1_u64 << 44) as f64;

/// Pairs of faces of the part that lie over each other in a map of a chart, the lower face first, ascending. `None` if
/// there are too many.
pub(super) fn conflicts(chart: &OpenedChart, embedding: &Embedding) -> Option<Vec<[u32; 2]>> {
    let corners = |triangle: usize| embedding.corners(&chart.disk, FaceId::from_index(triangle));
    let triangles: Vec<_> = (0..chart.face_of.len()).map(corners).collect();
    let face_of = &chart.face_of;
    let pairs = geom::overlaps(&triangles, |a, b| face_of[a] != face_of[b], MOST_CONFLICTS);
    let faces = |pair: [usize; 2]| {
        let [a, b] = pair.map(|triangle| face_of[triangle]);
        [a.min(b), a.max(b)]
    };
    (pairs.len() < MOST_CONFLICTS).then(|| pairs.into_iter().map(faces).collect::<BTreeSet<_>>().into_iter().collect())
}

/// Edge between two faces that is no seam.
struct Hinge {
    edge: u32,
    faces: [u32; 2],
    cost: f64,
}

/// Faces of a part, to be divided into charts.
pub(super) struct Division<'a> {
    control: Control<'a>,
    hinges: Vec<Hinge>,
    /// Numbers of the hinges of each face.
    at: Vec<Vec<u32>>,
    /// Middle of each face.
    middles: Vec<DVec3>,
    /// Faces that lie over each face.
    over: Vec<Vec<u32>>,
    /// Chart of each face.
    chart_of: Vec<u32>,
    chart_count: u32,
}

impl<'a> Division<'a> {
    /// Takes seams, by the part's edge table, and conflicts between faces.
    pub(super) fn new(
        surface: &CutSurface<'_>,
        is_seam: &[bool],
        conflicts: &[[u32; 2]],
        control: Control<'a>,
    ) -> Self {
        let polygons = surface.part().polygons();
        let count = polygons.face_count();
        let mut hinges = Vec::new();
        let mut at = vec![Vec::new(); count];
        for (edge, faces) in (0..).zip(surface.part().faces_of_edges()) {
            let [a, b] = faces[..] else { continue };
            if is_seam[edge as usize] {
                continue;
            }
            let number = u32::try_from(hinges.len()).expect("edges fit");
            hinges.push(Hinge { edge, faces: [a, b], cost: surface.edges[edge as usize].cost });
            for face in [a, b] {
                at[face as usize].push(number);
            }
        }
        let middle = |face: usize| {
            let corners = polygons.face(face);
            corners.iter().map(|corner| polygons.positions[corner.index()]).sum::<DVec3>() / corners.len() as f64
        };
        let mut over = vec![Vec::new(); count];
        for &[a, b] in conflicts {
            over[a as usize].push(b);
            over[b as usize].push(a);
        }
        let middles = (0..count).map(middle).collect();
        Self { control, hinges, at, middles, over, chart_of: vec![0; count], chart_count: 1 }
    }

    /// Seams that leave no chart with a conflict, with those that were given. Neighbours that could be one chart may be
    /// apart. `None` if there would be too many charts.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub(super) fn seams(mut self, is_seam: &[bool]) -> Result<Option<Vec<bool>>, SolveError> {
        while let Some(face) = (0..).take(self.over.len()).find(|&face| self.partners(face).next().is_some()) {
            self.control.go_on()?;
            if self.chart_count as usize > MOST_CHARTS {
                return Ok(None);
            }
            self.separate(face);
        }
        let mut is_seam = is_seam.to_vec();
        self.borders().for_each(|hinge| is_seam[hinge.edge as usize] = true);
        Ok(Some(is_seam))
    }

    /// Faces of the same chart that lie over a face.
    fn partners(&self, face: u32) -> impl Iterator<Item = u32> + '_ {
        let own = self.chart_of[face as usize];
        self.over[face as usize].iter().copied().filter(move |&other| self.chart_of[other as usize] == own)
    }

    /// Faces beside a face in the same chart, each with the hinge between them.
    fn neighbours(&self, face: u32) -> impl Iterator<Item = (u32, &Hinge)> + '_ {
        let own = self.chart_of[face as usize];
        let across = move |&number: &u32| {
            let hinge = &self.hinges[number as usize];
            let other = if hinge.faces[0] == face { hinge.faces[1] } else { hinge.faces[0] };
            (other, hinge)
        };
        self.at[face as usize].iter().map(across).filter(move |(other, _)| self.chart_of[*other as usize] == own)
    }

    /// Hinges between two charts.
    fn borders(&self) -> impl Iterator<Item = &Hinge> + '_ {
        self.hinges.iter().filter(|hinge| {
            hinge.faces.map(|face| self.chart_of[face as usize]).windows(2).any(|pair| pair[0] != pair[1])
        })
    }

    /// Cuts the chart of a face that has a conflict.
    fn separate(&mut self, face: u32) {
        let around = self.conflicting_around(face);
        let farthest = |far: &BTreeMap<u32, f64>, faces: &mut dyn Iterator<Item = u32>| {
            let distance = |face: u32| far.get(&face).copied().unwrap_or(f64::MAX);
            faces.max_by(|&a, &b| distance(a).total_cmp(&distance(b)).then(b.cmp(&a))).unwrap_or(face)
        };
        let one = farthest(&self.distances(face), &mut around.iter().copied());
        let from_one = self.distances(one);
        let other = farthest(&from_one, &mut self.partners(one));
        let from_other = self.distances(other);
        let is_near = |face: u32, own: &BTreeMap<u32, f64>, far: &BTreeMap<u32, f64>| {
            let at = |distances: &BTreeMap<u32, f64>| distances.get(&face).copied().unwrap_or(f64::INFINITY);
            at(own) <= NEAR * at(far)
        };
        let sides = [(one, &from_one, &from_other), (other, &from_other, &from_one)].map(|(end, own, far)| {
            let is_of_side = |face: u32| around.contains(&face) && is_near(face, own, far);
            self.piece(end, is_of_side)
        });
        let own = self.chart_of[face as usize];
        let cut_off = self.cut_off(own, &sides);
        for &face in &cut_off {
            self.chart_of[face as usize] = u32::MAX;
        }
        self.number_pieces(cut_off.into_iter().collect());
        // The rest may have fallen apart.
        let rest: Vec<u32> = (0..).take(self.chart_of.len()).filter(|&f| self.chart_of[f as usize] == own).collect();
        for &face in &rest {
            self.chart_of[face as usize] = u32::MAX;
        }
        self.number_pieces(rest);
    }

    /// Gives a chart number to each connected piece of faces that have none.
    fn number_pieces(&mut self, faces: Vec<u32>) {
        for first in faces {
            if self.chart_of[first as usize] != u32::MAX {
                continue;
            }
            let piece = self.piece(first, |_| true);
            for face in piece {
                self.chart_of[face as usize] = self.chart_count;
            }
            self.chart_count += 1;
        }
    }

    /// Connected faces of a chart around one of them.
    fn piece(&self, first: u32, is_in: impl Fn(u32) -> bool) -> BTreeSet<u32> {
        let mut piece = BTreeSet::from([first]);
        let mut stack = vec![first];
        while let Some(face) = stack.pop() {
            for (other, _) in self.neighbours(face) {
                if is_in(other) && piece.insert(other) {
                    stack.push(other);
                }
            }
        }
        piece
    }

    /// Conflicting faces that are connected with one by conflicts, or side by side.
    fn conflicting_around(&self, face: u32) -> BTreeSet<u32> {
        let mut found = BTreeSet::from([face]);
        let mut stack = vec![face];
        while let Some(face) = stack.pop() {
            let beside = self.neighbours(face).map(|(other, _)| other);
            let beside = beside.filter(|&other| self.partners(other).next().is_some());
            for other in self.partners(face).chain(beside) {
                if found.insert(other) {
                    stack.push(other);
                }
            }
        }
        found
    }

    /// Distances over the middles of faces from one face to all faces of its chart.
    fn distances(&self, from: u32) -> BTreeMap<u32, f64> {
        let mut far = BTreeMap::from([(from, 0.0_f64)]);
        let mut queue = BinaryHeap::from([Reverse((0, from))]);
        while let Some(Reverse((bits, face))) = queue.pop() {
            if bits != far[&face].to_bits() {
                continue;
            }
            for (other, _) in self.neighbours(face) {
                let there = f64::from_bits(bits) + self.middles[face as usize].distance(self.middles[other as usize]);
                if far.get(&other).is_none_or(|&before| there < before) {
                    far.insert(other, there);
                    queue.push(Reverse((there.to_bits(), other)));
                }
            }
        }
        far
    }

    /// Faces of a chart on the first side of the cheapest cut between two sets of its faces.
    fn cut_off(&self, chart: u32, sides: &[BTreeSet<u32>; 2]) -> BTreeSet<u32> {
        let mut network: DiGraph<(), u64> = DiGraph::new();
        let [source, sink] = [0, 1].map(|_| network.add_node(()));
        let faces = (0..).take(self.chart_of.len()).filter(|&face| self.chart_of[face as usize] == chart);
        let mut node_of: BTreeMap<u32, NodeIndex> = BTreeMap::new();
        for face in faces {
            let node = match sides.each_ref().map(|side| side.contains(&face)) {
                [true, _] => source,
                [_, true] => sink,
                _ => network.add_node(()),
            };
            node_of.insert(face, node);
        }
        let total: f64 = self.hinges.iter().map(|hinge| hinge.cost).sum();
        for hinge in &self.hinges {
            let [Some(&a), Some(&b)] = hinge.faces.map(|face| node_of.get(&face)) else { continue };
            if a == b {
                continue;
            }
            let capacity = capacity(hinge.cost / total);
            network.add_edge(a, b, capacity);
            network.add_edge(b, a, capacity);
        }
        let (_, flows) = dinics(&network, source, sink);
        let mut reached = BTreeSet::from([source]);
        let mut stack = vec![source];
        while let Some(node) = stack.pop() {
            let out = network.edges_directed(node, petgraph::Outgoing);
            let onward = out.filter(|edge| flows[edge.id().index()] < *edge.weight()).map(|edge| edge.target());
            let back = network.edges_directed(node, petgraph::Incoming);
            let back = back.filter(|edge| flows[edge.id().index()] > 0).map(|edge| edge.source());
            let fresh: Vec<NodeIndex> = onward.chain(back).filter(|node| !reached.contains(node)).collect();
            stack.extend(fresh.iter().filter(|node| reached.insert(**node)));
        }
        node_of.into_iter().filter(|(_, node)| reached.contains(node)).map(|(face, _)| face).collect()
    }
}

/// Capacity of a share of all costs.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "shares are at most 2")]
fn capacity(share: f64) -> u64 {
    (share * CAPACITY).ceil().max(1.0) as u64
}
