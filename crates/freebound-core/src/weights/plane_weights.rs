//! Mean-value weights of a planar embedding: the matrix A(x) of the iteration (paper §4) and of the virtual boundary
//! (§5).
//!
//! # Equation
//!
//! Every corner with the angle α between edges of the lengths r₁, r₂ adds `tan(α/2)/r` to both. Angles are unsigned,
//! as the paper requires: a flipped face counts like its mirror image, so all weights are positive. A planar embedding
//! satisfies its own equations (2D reproduction), and only planar embeddings do (Theorem 1).
//!
//! # Residuals of an embedding
//!
//! At a corner of a positive face eq. (1) holds, and its share of A(x) x is zero. At a corner of a flipped face the
//! unsigned angle reverses the sign of one side: its share is `2i(û₂ − û₁)`, with û₁, û₂ the directions of its edges.
//! So A(x) x is a sum over the flipped faces alone, and exactly zero for a planar embedding: see
//! [`residuals_in_plane`]. For averaged polygons, faces here include the triangles of all their fans.
//!
//! # Degenerate faces
//!
//! A face without area has a corner of 0 or π, or an edge of length 0. Its weight would be infinite and would freeze
//! the face. So it is treated as a thin face, with a height of a thousandth of its longest edge, and its corners are
//! counted.

use crate::parallel::prelude::*;
use glam::DVec2;
use num_complex::Complex;

use super::corner_weights::bounded;
use super::equations::{Equations, Sides, mean_length, sum_of_sides};
use super::pieces::{Piece, in_pieces};
use crate::geom::{Orientation, orientation, power_of_two_near};
use crate::mesh::{DiskMesh, FaceId};
use crate::problem::{Control, Embedding, SolveError};

/// Height of a degenerate face, and smallest length of its edges, relative to its longest edge. Thin enough to leave
/// its surroundings unaffected, thick enough that the next solve can open it.
const THIN: f64 = 1e-3;

/// Shares of a face's edges: `at_corner[k]` has the shares of the edges from corner k to the next and to the previous
/// corner.
struct FaceWeights {
    at_corner: [[f64; 2]; 3],
    degenerate: bool,
    /// Number of corners whose weight differs from the geometry.
    bounded_corners: u8,
}

/// Positive lengths of a face's edges, `radii[k]` from corner k to the next, and true if an edge had length 0.
fn radii_of(edges: [DVec2; 3], mean_length: f64) -> ([f64; 3], bool) {
    let lengths = edges.map(DVec2::length);
    let longest = lengths[0].max(lengths[1]).max(lengths[2]);
    if longest == 0.0 {
        return ([mean_length; 3], true);
    }
    let shortest = lengths[0].min(lengths[1]).min(lengths[2]);
    (lengths.map(|r| if r > 0.0 { r } else { THIN * longest }), shortest == 0.0)
}

/// Edges of a face, from each corner to the next.
fn edges_of([a, b, c]: [DVec2; 3]) -> [DVec2; 3] {
    [b - a, c - b, a - c]
}

fn face_weights(corners: [DVec2; 3], mean_length: f64) -> FaceWeights {
    let edges = edges_of(corners);
    let (radii, has_short_edge) = radii_of(edges, mean_length);
    let longest = radii[0].max(radii[1]).max(radii[2]);
    let exact = edges[0].perp_dot(-edges[2]).abs();
    let degenerate = has_short_edge || exact == 0.0;
    let cross = if degenerate { exact.max(THIN * longest * longest) } else { exact };
    let mut bounded_corners = 0;
    let at_corner = [0, 1, 2].map(|k| {
        let (to_next, to_previous) = (radii[k], radii[(k + 2) % 3]);
        let product = to_next * to_previous;
        let dot = -edges[k].dot(edges[(k + 2) % 3]);
        // Form of tan(α/2) without cancellation.
        let tan_half = if dot > 0.0 { cross / (product + dot) } else { (product - dot) / cross };
        let (tan_half, is_bounded) = bounded(tan_half);
        bounded_corners += u8::from(is_bounded || degenerate);
        [tan_half / to_next, tan_half / to_previous]
    });
    FaceWeights { at_corner, degenerate, bounded_corners }
}

/// Contribution of the first corner of a face to its edges to the next and to the previous corner, in units of the
/// embedding.
pub(crate) fn corner_weights(corners: [DVec2; 3]) -> [f64; 2] {
    face_weights(corners, 1.0).at_corner[0]
}

/// Length of a face's edge from corner k to the next as used by the weights: always positive.
pub(crate) fn edge_radius(corners: [DVec2; 3], k: usize) -> f64 {
    radii_of(edges_of(corners), 1.0).0[k]
}

/// Factor that scales an embedding to edges of length about 1. A power of two: scaling rounds nothing.
fn scale_of(embedding: &Embedding, face_count: usize) -> f64 {
    let first = embedding.first().copied().unwrap_or_default();
    let extent = embedding.iter().fold(0.0_f64, |m, z| m.max((*z - first).abs().max_element()));
    let mean_length = extent / (face_count.max(1) as f64).sqrt();
    power_of_two_near(mean_length).recip()
}

/// Mean length of the edges of an embedding, scaled like its equations.
pub(crate) fn mean_edge_length_in_plane(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    let scale = scale_of(embedding, mesh.face_count());
    mean_length(mesh, |[a, b]| (embedding[a] * scale).distance(embedding[b] * scale))
}

/// A(x) x: residual of every vertex's equation, the natural boundary's i-terms included. Positive faces contribute
/// exactly 0, without rounding.
///
/// # Errors
///
/// [`SolveError::Cancelled`].
pub fn residuals_in_plane(
    mesh: &DiskMesh,
    embedding: &Embedding,
    control: Control<'_>,
) -> Result<Vec<Complex<f64>>, SolveError> {
    let scale = scale_of(embedding, mesh.face_count());
    let is_folded = |piece: &Piece| {
        let [a, b, c] = piece.corners.map(|v| embedding[v]);
        orientation(a, b, c) != Some(Orientation::CounterClockwise)
    };
    let mut residuals = vec![Complex::ZERO; mesh.vertex_count()];
    in_pieces(mesh, |pieces| {
        control.go_on()?;
        let folded: Vec<&Piece> = pieces.par_iter().filter(|piece| is_folded(piece)).collect();
        for piece in folded {
            let corners = piece.corners.map(|v| embedding[v] * scale);
            for (vertex, share) in piece.corners.iter().zip(residual_shares(corners)) {
                residuals[vertex.index()] += piece.share * share / scale;
            }
        }
        Ok::<_, SolveError>(())
    })?;
    Ok(residuals)
}

/// Shares of a flipped or degenerate face in the residuals of its corners.
fn residual_shares(corners: [DVec2; 3]) -> [Complex<f64>; 3] {
    let edges = edges_of(corners);
    let (radii, _) = radii_of(edges, 1.0);
    let FaceWeights { at_corner, degenerate, .. } = face_weights(corners, 1.0);
    [0, 1, 2].map(|k| {
        let previous = (k + 2) % 3;
        let (to_next, to_previous) = (edges[k], -edges[previous]);
        let turned = (to_previous / radii[previous] - to_next / radii[k]).perp();
        let share =
            if degenerate { at_corner[k][0] * to_next + at_corner[k][1] * to_previous + turned } else { 2.0 * turned };
        Complex::new(share.x, share.y)
    })
}

/// Mean-value equations of an embedding without the boundary's i-terms: paper eq. (2) with d = 1.
///
/// # Errors
///
/// [`SolveError::NotFinite`] if the embedding is not finite; [`SolveError::Cancelled`].
pub fn mean_value_in_plane(
    mesh: &DiskMesh,
    embedding: &Embedding,
    control: Control<'_>,
) -> Result<Equations<f64>, SolveError> {
    let scale = scale_of(embedding, mesh.face_count());
    let of_piece = |piece: &Piece| {
        let weights = face_weights(piece.corners.map(|v| embedding[v] * scale), 1.0);
        Sides {
            along: weights.at_corner.map(|[to_next, _]| to_next),
            back: [1, 2, 0].map(|k| weights.at_corner[k][1]),
            bounded_corners: weights.bounded_corners,
        }
    };
    sum_of_sides(mesh, of_piece, control)
}

/// Mean-value equations of an embedding with its natural boundary: paper eq. (2) and (3) with d = 1.
///
/// # Errors
///
/// [`SolveError::NotFinite`] if the embedding is not finite; [`SolveError::Cancelled`].
pub fn natural_in_plane(
    mesh: &DiskMesh,
    embedding: &Embedding,
    control: Control<'_>,
) -> Result<Equations<Complex<f64>>, SolveError> {
    let scale = scale_of(embedding, mesh.face_count());
    let mut equations = mean_value_in_plane(mesh, embedding, control)?.to_complex();
    control.go_on()?;
    equations.add_boundary_terms(mesh, |inner| {
        let corners = mesh.face(FaceId::from_index(inner.index() / 3)).map(|v| embedding[v] * scale);
        1.0 / radii_of(edges_of(corners), 1.0).0[inner.index() % 3]
    });
    Ok(equations)
}
