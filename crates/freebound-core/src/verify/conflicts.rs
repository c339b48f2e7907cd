//! Constraints that no embedding of the given mesh can meet together, found before any solve.
//!
//! In a planar embedding every face is positive, and two edges meet only at a shared end. If all ends of such
//! elements have hard pins, the targets alone decide:
//!
//! ```text
//! turned face      a face with three pinned corners, its targets not counter-clockwise
//! crossing edges   two edges with pinned ends whose segments between the targets meet, or fold onto each other
//! too near         two targets nearer to each other than 10⁻⁹ of the extent of all
//! ```
//!
//! Turned faces and crossing edges need new vertices: a split edge can go around. Near targets leave no numbers in
//! between. Constraints without any of these conflicts may still need new vertices; only a solve decides.
//!
//! # Method
//!
//! Exact predicates. Pinned edges are found by walking around the pins, crossings among them by a tree of their
//! boxes, and near targets by a grid. The cost is near linear in the number of pins.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use crate::geom::{Bounds, BoxTree, Orientation, folds_back, orientation, place_along_curve, segments_meet};
use crate::mesh::{DiskMesh, EdgeId, FaceId, VertexId};
use crate::problem::units::Units;
use crate::problem::{GaugeSize, PinPositions, Pins};

/// Largest number of listed conflicts of each kind: more than a user resolves.
pub const CONFLICTS_LISTED: usize = 1000;

/// Targets nearer than this share of their extent leave too few numbers in between.
const TOO_NEAR: f64 = 1e-9;

/// Constraints that no embedding of the given mesh can meet together.
#[derive(Clone, Debug, PartialEq)]
pub enum Conflict {
    /// Face whose targets are clockwise or collinear.
    TurnedFace {
        /// Face with three pinned corners.
        face: FaceId,
        /// Corners of the face.
        vertices: [VertexId; 3],
    },
    /// Two edges whose targets cross, touch or overlap.
    CrossingEdges {
        /// Ends of both edges, the lower number first, the lower edge first.
        edges: [[VertexId; 2]; 2],
    },
    /// Two targets so near that numbers between them run out.
    NearCoincidentTargets {
        /// Vertices, the lower number first.
        vertices: [VertexId; 2],
    },
}

impl Conflict {
    /// Vertices of the constraints in the conflict, each once.
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

    /// Description in one line.
    pub fn words(&self) -> String {
        self.words_with(|vertex| vertex.to_string())
    }

    /// Description in one line, with vertices as `name` writes them.
    pub fn words_with(&self, name: impl Fn(VertexId) -> String) -> String {
        match self {
            Self::TurnedFace { vertices: [a, b, c], .. } => {
                let [a, b, c] = [a, b, c].map(|vertex| name(*vertex));
                format!("vertices {a}, {b}, {c}: their face would flip: needs new vertices")
            }
            Self::CrossingEdges { edges: [[a, b], [c, d]] } => {
                let [a, b, c, d] = [a, b, c, d].map(|vertex| name(*vertex));
                format!("edges {a}–{b} and {c}–{d} would cross: needs new vertices")
            }
            Self::NearCoincidentTargets { vertices: [a, b] } => {
                let [a, b] = [a, b].map(|vertex| name(*vertex));
                format!("vertices {a} and {b}: targets closer than {TOO_NEAR:e} of the extent of all: move one of them")
            }
        }
    }

    /// Conflict with renumbered vertices.
    #[must_use]
    pub fn renumbered(self, number: impl Fn(VertexId) -> VertexId) -> Self {
        match self {
            Self::TurnedFace { face, vertices } => Self::TurnedFace { face, vertices: vertices.map(number) },
            Self::CrossingEdges { edges } => Self::CrossingEdges { edges: edges.map(|ends| ends.map(&number)) },
            Self::NearCoincidentTargets { vertices } => Self::NearCoincidentTargets { vertices: vertices.map(number) },
        }
    }

    /// True if new vertices resolve the conflict.
    pub const fn needs_new_vertices(&self) -> bool {
        !matches!(self, Self::NearCoincidentTargets { .. })
    }
}

/// Finds the constraints that contradict each other: turned faces by number, then crossing edges, then near targets,
/// at most [`CONFLICTS_LISTED`] of each. Only hard pins count. Pins without a vertex of the mesh or without a finite
/// target are left out.
pub fn conflicts(mesh: &DiskMesh, pins: &Pins) -> Vec<Conflict> {
    // Scaled so that differences of targets neither underflow nor overflow.
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
    /// True if two edges have more in common than a shared end.
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
    // In units of the extent, so that nothing underflows.
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
