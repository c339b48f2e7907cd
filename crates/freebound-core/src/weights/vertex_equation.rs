//! Equation of one vertex for inspection: its neighbours with their weights, and its residual in an embedding.
//!
//! # Equation
//!
//! ```text
//! Σ kᵢ (zᵢ − z₀) + i·( d₂ (z₂−z₀)/r₂ − d₁ (z₁−z₀)/r₁ ) = 0          paper, eq. (2) inside, eq. (3) on the boundary
//! z₀ = Σ wᵢ zᵢ + o        wᵢ = kᵢ / Σ kⱼ        o = i·( … ) / Σ kⱼ
//! ```
//!
//! Neighbours 1 and 2 are the first and the last of a boundary vertex's fan, which is counter-clockwise; interior
//! vertices have no i-term. So an interior vertex lies at the barycentre of its neighbours, and a boundary vertex at
//! an *offset* o from it. Only the surroundings of the vertex are computed. The sums are those of
//! [`equations`](super::equations) and [`plane_weights`](super::plane_weights), in the units of the mesh and of the
//! embedding; shares and residual have no unit.
//!
//! # Symbols
//!
//! | paper | code            | meaning                              | unit                            |
//! |-------|-----------------|--------------------------------------|---------------------------------|
//! | kᵢ, λᵢ| `weight`        | unnormalised weight of a neighbour   | lengthᵖ⁻¹                       |
//! | dᵢ    | `offset`        | offset along the edge, rᵖ            | lengthᵖ                         |
//! | wᵢ    | `share`         | weight over the sum of all           | none                            |
//! | o     | `offset_vector` | from the barycentre to the vertex    | of the embedding                |

use glam::DVec2;

use super::corner_weights::{Corner, three_point_weights};
use super::pieces::{Piece, pieces_at};
use super::plane_weights::{corner_weights, edge_radius};
use super::shape_preserving::ring_weights;
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Embedding, Family};

/// Neighbour in the equation of a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquationTerm {
    /// The neighbour; a virtual vertex if its number is beyond the mesh's vertices.
    pub neighbour: VertexId,
    /// Weight k of the neighbour, not normalised.
    pub weight: f64,
    /// Offset d of the neighbour's edge.
    pub offset: f64,
    /// Weight of the neighbour over the sum of all weights.
    pub share: f64,
}

/// Equation of a vertex, evaluated in an embedding.
#[derive(Clone, Debug, PartialEq)]
pub struct VertexEquation {
    /// Neighbours, counter-clockwise; at a boundary vertex from one boundary edge to the other. Neighbours along
    /// diagonals of polygons follow.
    pub terms: Vec<EquationTerm>,
    /// Sum of the weights.
    pub weight_sum: f64,
    /// Barycentre of the neighbours in the embedding.
    pub barycentre: DVec2,
    /// Vector from the barycentre to the vertex position that solves eq. (3); `None` inside.
    pub offset_vector: Option<DVec2>,
    /// Residual of the equation, relative to the sizes of its terms.
    pub residual: f64,
}

/// Triangles and neighbours around a vertex.
pub(crate) struct Fan {
    vertex: VertexId,
    /// Other two corners of each triangle, and its share.
    corners: Vec<([VertexId; 2], f64)>,
    /// Neighbours along edges, counter-clockwise; then neighbours along diagonals of polygons.
    neighbours: Vec<VertexId>,
    /// Positions in `neighbours` of the first and last neighbour along edges; `None` if the fan is closed.
    ends: Option<[usize; 2]>,
}

impl Fan {
    /// Fan of the faces alone, after triangulation of the polygons.
    fn of_faces(mesh: &DiskMesh, vertex: VertexId) -> Self {
        let inner = mesh.outgoing(vertex).filter(|&h| !mesh.is_outer(h));
        Self::new(vertex, inner.map(|h| ([mesh.head(h), mesh.tail(mesh.previous(h))], 1.0)).collect())
    }

    /// Fan of the pieces, the mean over the fans of polygons, over which weights are summed.
    pub(crate) fn of_mesh(mesh: &DiskMesh, vertex: VertexId) -> Self {
        let faces = Self::of_faces(mesh, vertex);
        let around = |piece: Piece| {
            let k = piece.corners.iter().position(|&corner| corner == vertex).unwrap_or(0);
            ([1, 2].map(|ahead| piece.corners[(k + ahead) % 3]), piece.share)
        };
        let neighbours = mesh.links_from(vertex).map(|link| mesh.head(link)).collect();
        Self { corners: pieces_at(mesh, vertex).into_iter().map(around).collect(), neighbours, ..faces }
    }

    /// Fan of the faces and the `pockets` outside, which close the fan of a boundary vertex unless it lies on the
    /// hull.
    pub(crate) fn of_extended(mesh: &DiskMesh, pockets: &[[VertexId; 3]], vertex: VertexId) -> Self {
        let Self { mut corners, .. } = Self::of_faces(mesh, vertex);
        let from_pocket = |&[a, b, c]: &[VertexId; 3]| match vertex {
            v if v == a => Some([b, c]),
            v if v == b => Some([c, a]),
            v if v == c => Some([a, b]),
            _ => None,
        };
        let mut outside: Vec<[VertexId; 2]> = pockets.iter().filter_map(from_pocket).collect();
        while let Some(&([_, last], _)) = corners.last()
            && let Some(place) = outside.iter().position(|&[first, _]| first == last)
        {
            corners.push((outside.swap_remove(place), 1.0));
        }
        Self::new(vertex, corners)
    }

    /// Fan of consecutive triangles.
    fn new(vertex: VertexId, corners: Vec<([VertexId; 2], f64)>) -> Self {
        let is_closed = matches!((corners.first(), corners.last()), (Some(([a, _], _)), Some(([_, b], _))) if a == b);
        let last = corners.last().filter(|_| !is_closed).map(|&([_, last], _)| last);
        let neighbours: Vec<VertexId> = corners.iter().map(|&([first, _], _)| first).chain(last).collect();
        let ends = (!is_closed).then(|| [0, neighbours.len() - 1]);
        Self { vertex, corners, neighbours, ends }
    }

    /// Sums the contributions of each corner to its two edges.
    fn sums(&self, shares: impl Fn(VertexId, VertexId) -> [f64; 2]) -> Vec<f64> {
        let mut sums = vec![0.0; self.neighbours.len()];
        for &(ends, part) in &self.corners {
            for (end, share) in ends.into_iter().zip(shares(ends[0], ends[1])) {
                if let Some(place) = self.neighbours.iter().position(|&v| v == end) {
                    sums[place] += part * share;
                }
            }
        }
        sums
    }
}

/// Equation with weights computed on the surface.
pub(crate) fn on_surface(mesh: &DiskMesh, family: Family, embedding: &Embedding, vertex: VertexId) -> VertexEquation {
    let power = family.power();
    let fan = if power.is_some() { Fan::of_mesh(mesh, vertex) } else { Fan::of_faces(mesh, vertex) };
    let Some(power) = power else {
        let ones = vec![1.0; fan.neighbours.len()];
        let weights = match family {
            Family::ShapePreserving if fan.ends.is_none() => {
                ring_weights(&|corners| mesh.shape(corners), vertex, &fan.neighbours).0
            }
            _ => ones.clone(),
        };
        return put_together(&fan, embedding, Coefficients { weights, offsets: ones.clone(), radii: ones });
    };
    let shares = |next, previous| {
        let corner = mesh.shape([vertex, next, previous]);
        three_point_weights(&Corner::at(corner), power).shares
    };
    let radii: Vec<f64> = fan.neighbours.iter().map(|&v| mesh.length([v, vertex])).collect();
    let offsets = radii.iter().map(|r| r.powf(power)).collect();
    put_together(&fan, embedding, Coefficients { weights: fan.sums(shares), offsets, radii })
}

/// Equation with the mean-value weights of `weights_from`, evaluated in `embedding`.
pub(crate) fn in_plane(mesh: &DiskMesh, fan: &Fan, weights_from: &Embedding, embedding: &Embedding) -> VertexEquation {
    let at = |v: VertexId| weights_from[v];
    let shares = |next, previous| corner_weights([fan.vertex, next, previous].map(at));
    let weights = fan.sums(shares);
    let mut radii: Vec<f64> = fan.neighbours.iter().map(|&v| at(v).distance(at(fan.vertex))).collect();
    // The i-term takes the edge lengths of its faces.
    if let Some([first, last]) = fan.ends {
        let faces = Fan::of_faces(mesh, fan.vertex).corners;
        let corners = |face: &([VertexId; 2], f64)| [fan.vertex, face.0[0], face.0[1]].map(at);
        radii[first] = edge_radius(corners(&faces[0]), 0);
        radii[last] = edge_radius(corners(&faces[faces.len() - 1]), 2);
    }
    let offsets = vec![1.0; weights.len()];
    put_together(fan, embedding, Coefficients { weights, offsets, radii })
}

/// Coefficients of the equation, of each kind one per neighbour.
struct Coefficients {
    /// Weights k.
    weights: Vec<f64>,
    /// Offsets d.
    offsets: Vec<f64>,
    /// Lengths r.
    radii: Vec<f64>,
}

/// Builds the equation from its coefficients.
fn put_together(fan: &Fan, embedding: &Embedding, coefficients: Coefficients) -> VertexEquation {
    let Coefficients { weights, offsets, radii } = coefficients;
    let neighbours = &fan.neighbours;
    let place = embedding[fan.vertex];
    let arms: Vec<DVec2> = neighbours.iter().map(|v| embedding[v] - place).collect();
    let weight_sum: f64 = weights.iter().sum();
    let terms = neighbours
        .iter()
        .zip(weights.iter().zip(&offsets))
        .map(|(&neighbour, (&weight, &offset))| EquationTerm { neighbour, weight, offset, share: weight / weight_sum });
    let sum: DVec2 = weights.iter().zip(&arms).map(|(&k, &arm)| k * arm).sum();
    let turned = |place: usize| (offsets[place] / radii[place] * arms[place]).perp();
    let boundary_term = fan.ends.map(|[first, last]| turned(last) - turned(first));
    // A matrix entry is k; on boundary edges it is k ± i d/r.
    let size = |place: usize| {
        let is_end = fan.ends.is_some_and(|ends| ends.contains(&place));
        let turned = if is_end { offsets[place] / radii[place] } else { 0.0 };
        weights[place].hypot(turned) * arms[place].length()
    };
    let whole: f64 = (0..neighbours.len()).map(size).sum();
    VertexEquation {
        terms: terms.collect(),
        weight_sum,
        barycentre: place + sum / weight_sum,
        offset_vector: boundary_term.map(|term| term / weight_sum),
        residual: if whole > 0.0 { (sum + boundary_term.unwrap_or_default()).length() / whole } else { 0.0 },
    }
}
