//! Constraints that cannot all be met on the mesh as it is, named before anything is solved.
//!
//! In a planar embedding every face is positive and no two edges meet but at a shared end. Where all ends of such
//! elements are pinned exactly, the targets alone decide:
//!
//! ```text
//! turned face      a face with three pinned corners, its targets not counter-clockwise
//! crossing edges   two edges with pinned ends whose segments between the targets meet, or fold onto each other
//! too near         two targets nearer to each other than 10⁻⁹ of the extent of all
//! ```
//!
//! The first two need new vertices: an edge that is split can go around. The third leaves no numbers in between. A set
//! of constraints without any of them may still need new vertices; only the work itself tells.
//!
//! # Method
//!
//! Exact predicates. Pinned edges are found by walking around the pins, crossings among them by a tree of
//! their boxes, near targets by a grid: near linear in the number of pins.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use crate::geom::{Bounds, BoxTree, Orientation, folds_back, orientation, place_along_curve, segments_meet};
use crate::mesh::{DiskMesh, EdgeId, FaceId, VertexId};
use crate::problem::units::Units;
use crate::problem::{GaugeSize, PinPositions, Pins};

/// The greatest number of conflicts of each kind that are listed: more than anybody mends by hand.
pub const CONFLICTS_LISTED: usize = 1000;

/// Targets nearer than this part of their extent leave too few numbers in between.
const TOO_NEAR: f64 = 1e-9;

/// Constraints that cannot be met together by an embedding of the mesh as it is.
#[derive(Clone, Debug, PartialEq)]
pub enum Conflict {
    /// A face whose corners' targets are clockwise or on a line.
    TurnedFace {
        /// The face.
        face: FaceId,
        /// Its corners.
        vertices: [VertexId; 3],
    },
    /// Two edges whose targets cross, touch or overlap.
    CrossingEdges {
        /// Their ends, the lower number first, the lower edge first.
        edges: [[VertexId; 2]; 2],
    },
    /// Two targets between which numbers run out.
    NearCoincidentTargets {
        /// The vertices, the lower number first.
        vertices: [VertexId; 2],
    },
}

impl Conflict {
    /// The constraints that take part, each once.
    pub fn vertices(&self) -> Vec<VertexId> {
        match self {
            Self::TurnedFace { vertices, .. } => vertices.to_vec(),
            Self::CrossingEdges { edges } => {
                let distinct: BTreeSet<VertexId> = edges.as_flattened().iter().copied().collect();
                distinct.into_iter().collect()
            }
            Self::NearCoincidentTargets { vertices } => vertices.to_vec(),
        }
    }

    /// What is the matter, in one line.
    pub fn words(&self) -> String {
        match self {
            Self::TurnedFace { vertices: [a, b, c], .. } => {
                format!("vertices {a}, {b}, {c}: this face would be turned over: needs new vertices")
            }
            Self::CrossingEdges { edges: [[a, b], [c, d]] } => {
                format!("vertices {a}–{b} and {c}–{d}: these edges would cross: needs new vertices")
            }
            Self::NearCoincidentTargets { vertices: [a, b] } => {
                format!("vertices {a} and {b}: their targets are nearer than {TOO_NEAR:e} of all targets' extent")
            }
        }
    }

    /// The same with other numbers for the vertices.
    #[must_use]
    pub fn renumbered(self, number: impl Fn(VertexId) -> VertexId) -> Self {
        match self {
            Self::TurnedFace { face, vertices } => Self::TurnedFace { face, vertices: vertices.map(number) },
            Self::CrossingEdges { edges } => Self::CrossingEdges { edges: edges.map(|ends| ends.map(&number)) },
            Self::NearCoincidentTargets { vertices } => Self::NearCoincidentTargets { vertices: vertices.map(number) },
        }
    }

    /// Whether new vertices resolve it.
    pub const fn needs_new_vertices(&self) -> bool {
        !matches!(self, Self::NearCoincidentTargets { .. })
    }
}

/// Finds the constraints that contradict each other: turned faces by number, then crossing edges, then targets that
/// are too near, at most [`CONFLICTS_LISTED`] of each. Only exact pins count; those without a vertex or a finite
/// target are left out.
pub fn conflicts(mesh: &DiskMesh, pins: &Pins) -> Vec<Conflict> {
    // At a size where differences of targets are numbers.
    let targets: PinPositions = Units::of(pins, GaugeSize::TrueArea)
        .pins(pins)
        .iter()
        .filter(|(vertex, pin)| pin.kind.is_hard() && vertex.index() < mesh.vertex_count() && pin.target.is_finite())
        .map(|(&vertex, pin)| (vertex, pin.target))
        .collect();
    let mut found = turned_faces(mesh, &targets);
    found.extend(crossing_edges(mesh, &targets));
    found.extend(near_targets(&targets));
    found
}

fn turned_faces(mesh: &DiskMesh, targets: &PinPositions) -> Vec<Conflict> {
    let pinned: BTreeSet<FaceId> = targets
        .keys()
        .flat_map(|&v| mesh.outgoing(v))
        .filter_map(|side| mesh.face_of(side))
        .filter(|&face| !mesh.is_virtual(face))
        .collect();
    let turned = |face: FaceId| {
        let vertices = mesh.face(face);
        let [a, b, c] = vertices.map(|v| targets.get(&v).copied());
        let turn = orientation(a?, b?, c?);
        (turn != Some(Orientation::CounterClockwise)).then_some(Conflict::TurnedFace { face, vertices })
    };
    pinned.into_iter().filter_map(turned).take(CONFLICTS_LISTED).collect()
}

struct PinnedEdge {
    ends: [VertexId; 2],
    segment: [DVec2; 2],
    bounds: Bounds,
}

impl PinnedEdge {
    /// Whether two edges have more in common than a shared end.
    fn conflicts_with(&self, other: &Self) -> bool {
        let Some(shared) = self.ends.iter().position(|end| other.ends.contains(end)) else {
            return segments_meet(self.segment, other.segment);
        };
        let [apex, a] = [self.segment[shared], self.segment[1 - shared]];
        let b = other.segment[usize::from(other.ends[0] == self.ends[shared])];
        folds_back(a, apex, b)
    }
}

fn crossing_edges(mesh: &DiskMesh, targets: &PinPositions) -> Vec<Conflict> {
    let pinned: BTreeSet<EdgeId> = targets
        .keys()
        .flat_map(|&v| mesh.outgoing(v))
        .map(|side| mesh.edge_of(side))
        .filter(|&edge| !mesh.is_virtual_edge(edge))
        .collect();
    let edge = |edge: EdgeId| {
        let [a, b] = mesh.ends(edge);
        let ends = [a.min(b), a.max(b)];
        let segment = [*targets.get(&ends[0])?, *targets.get(&ends[1])?];
        Some(PinnedEdge { ends, segment, bounds: Bounds::of(segment) })
    };
    let mut edges: Vec<PinnedEdge> = pinned.into_iter().filter_map(edge).collect();
    let whole = edges.iter().fold(Bounds::EMPTY, |whole, edge| whole.union(edge.bounds));
    edges.sort_by_cached_key(|edge| (place_along_curve(whole, edge.bounds.middle()), edge.ends));
    let tree = BoxTree::new(edges.iter().map(|edge| edge.bounds));
    let edges = &edges;
    let pairs = (0..edges.len()).flat_map(|first| tree.later(first).map(move |later| [&edges[first], &edges[later]]));
    let found = pairs.filter(|[first, second]| first.conflicts_with(second)).take(CONFLICTS_LISTED);
    let mut pairs: Vec<[[VertexId; 2]; 2]> =
        found.map(|[first, second]| [first.ends.min(second.ends), first.ends.max(second.ends)]).collect();
    pairs.sort_unstable();
    pairs.into_iter().map(|edges| Conflict::CrossingEdges { edges }).collect()
}

fn near_targets(targets: &PinPositions) -> Vec<Conflict> {
    let bounds = Bounds::of(targets.values().copied());
    let extent = bounds.size().max_element();
    // In parts of the extent, so that nothing underflows.
    let relative = |target: DVec2| if extent > 0.0 { (target - bounds.low) / extent } else { DVec2::ZERO };
    let cell_of = |place: DVec2| (place / TOO_NEAR).floor().as_i64vec2();
    let mut cells: BTreeMap<[i64; 2], Vec<(VertexId, DVec2)>> = BTreeMap::new();
    let mut found = Vec::new();
    for (&vertex, &target) in targets {
        let place = relative(target);
        let cell = cell_of(place);
        let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [cell.x + dx, cell.y + dy]));
        for &(other, there) in around.filter_map(|cell| cells.get(&cell)).flatten() {
            if there.distance(place) <= TOO_NEAR {
                found.push(Conflict::NearCoincidentTargets { vertices: [other, vertex] });
            }
            if found.len() == CONFLICTS_LISTED {
                return found;
            }
        }
        cells.entry(cell.to_array()).or_default().push((vertex, place));
    }
    found
}
