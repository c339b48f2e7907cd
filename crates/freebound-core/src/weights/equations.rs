//! Vertex equations, stored as one coefficient per link.
//!
//! The equation of vertex v is `Σ a_h (z_head(h) − z_v) = 0` over the links h that leave it: its halfedges, and
//! diagonals of polygons. Every method of this project has that form. Coefficients are real if the boundary is
//! prescribed, and complex if it is free.
//!
//! If all corners of a larger polygon are convex, their weights are the mean over the polygon's fans (see the module
//! `pieces`). So the weights do not depend on its triangulation. Equal weights belong to the graph of the
//! triangulation, because Tutte's theorem needs a planar graph.

use std::ops::Mul;

use crate::parallel::prelude::*;
use glam::DVec3;
use num_complex::Complex;

use super::corner_weights::{Corner, CornerWeights, three_point_weights};
use super::pieces::{Fans, Piece};
use crate::geom::power_of_two_near;
use crate::linalg::Scalar;
use crate::mesh::{DiskMesh, FaceId, HalfedgeId, VertexId};
use crate::problem::{Control, Embedding, Family, SolveError};

/// Coefficients of all vertex equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Equations<T> {
    /// Coefficient of `z_head − z_tail` for each link of the mesh, in the equation of the link's tail.
    pub coefficients: Vec<T>,
    /// Number of degenerate corners whose weight was bounded.
    pub bounded_corners: usize,
}

impl Equations<f64> {
    /// Converts the coefficients to complex numbers.
    pub fn to_complex(&self) -> Equations<Complex<f64>> {
        let coefficients = self.coefficients.par_iter().map(|&a| Complex::new(a, 0.0)).collect();
        Equations { coefficients, bounded_corners: self.bounded_corners }
    }
}

impl<T> Equations<T>
where
    T: Copy + Mul<Complex<f64>, Output = Complex<f64>>,
{
    /// Residual of a vertex's equation: `Σ a_h (z_head(h) − z_v)`.
    pub fn residual_of(&self, mesh: &DiskMesh, embedding: &Embedding, vertex: VertexId) -> Complex<f64> {
        let term = |h: HalfedgeId| {
            let along = embedding[mesh.head(h)] - embedding[vertex];
            self.coefficients[h.index()] * Complex::new(along.x, along.y)
        };
        mesh.links_from(vertex).map(term).sum()
    }
}

impl Equations<Complex<f64>> {
    /// Adds the i-terms of the natural boundary: d/r of every boundary edge. `offset_share` takes its inner halfedge.
    pub(crate) fn add_boundary_terms(&mut self, mesh: &DiskMesh, offset_share: impl Fn(HalfedgeId) -> f64) {
        for outer in (3 * mesh.face_count()..mesh.halfedge_count()).map(HalfedgeId::from_index) {
            let inner = mesh.twin(outer);
            let share = offset_share(inner);
            // A fan begins with the inner side of one boundary edge and ends with the outer side of another.
            self.coefficients[inner.index()].im -= share;
            self.coefficients[outer.index()].im += share;
        }
    }

    /// Residual ‖A z‖ over the vertices that `has_equation`, relative to ‖ |A| |z| ‖, the sizes of the terms that
    /// should cancel.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub fn residual(
        &self,
        mesh: &DiskMesh,
        embedding: &Embedding,
        has_equation: impl Fn(VertexId) -> bool + Sync,
        control: Control<'_>,
    ) -> Result<f64, SolveError> {
        let of_vertex = |vertex: usize| {
            let vertex = VertexId::from_index(vertex);
            if !has_equation(vertex) {
                return (0.0, 0.0);
            }
            let add = |(sum, size): (Complex<f64>, f64), h: HalfedgeId| {
                let along = embedding[mesh.head(h)] - embedding[vertex];
                let term = self.coefficients[h.index()] * Complex::new(along.x, along.y);
                (sum + term, size + modulus(term))
            };
            let (sum, size) = mesh.links_from(vertex).fold((Complex::ZERO, 0.0), add);
            (sum.norm_sqr(), size * size)
        };
        let of_vertices: Vec<(f64, f64)> = control.each(mesh.vertex_count(), of_vertex)?;
        let add = |(residual, whole), &(sum, size): &(f64, f64)| (residual + sum, whole + size);
        let (residual, whole) = of_vertices.iter().fold((0.0, 0.0), add);
        Ok(if whole > 0.0 { f64::sqrt(residual / whole) } else { 0.0 })
    }
}

/// |z|, several times faster than by a hypotenuse unless squares overflow or underflow.
pub(crate) fn modulus(z: Complex<f64>) -> f64 {
    let square = z.norm_sqr();
    if square.is_normal() { square.sqrt() } else { z.norm() }
}

/// Three-point weights with offset d = rᵖ, without the boundary's i-terms: paper eq. (2).
///
/// # Errors
///
/// [`SolveError::NotFinite`] if a weight overflows; [`SolveError::Cancelled`].
pub fn barycentric(mesh: &DiskMesh, power: f64, control: Control<'_>) -> Result<Equations<f64>, SolveError> {
    if power == Family::CONFORMAL_POWER {
        return cotangents(mesh, control);
    }
    let scale = length_scale(mesh);
    let weights = |corner: [DVec3; 3]| {
        let scaled = Corner::at(corner.map(|x| x * scale));
        three_point_weights(&scaled, power)
    };
    sum_corners(mesh, weights, control)
}

/// Conformal weights. Each cotangent is computed once for both directions of the link it faces. So the matrix is
/// Hermitian to the last bit, and refinement measures exactly the matrix that Cholesky factored.
fn cotangents(mesh: &DiskMesh, control: Control<'_>) -> Result<Equations<f64>, SolveError> {
    let scale = length_scale(mesh);
    let of_piece = |piece: &Piece| {
        let corners = mesh.shape(piece.corners).map(|x| x * scale);
        // Cotangent at the corner opposite each side.
        let cotangents = [2, 0, 1].map(|k| Corner::at(from_corner(corners, k)).cotangent());
        let along = cotangents.map(|(cotangent, _)| cotangent);
        Sides { along, back: along, bounded_corners: cotangents.map(|(_, bounded)| u8::from(bounded)).iter().sum() }
    };
    sum_of_sides(mesh, of_piece, control)
}

/// Natural boundary equations for offset d = rᵖ: paper eq. (2) inside and eq. (3) on the boundary.
///
/// # Errors
///
/// [`SolveError::NotFinite`] if a weight overflows; [`SolveError::Cancelled`].
pub fn natural(mesh: &DiskMesh, power: f64, control: Control<'_>) -> Result<Equations<Complex<f64>>, SolveError> {
    let scale = length_scale(mesh);
    let mut equations = barycentric(mesh, power, control)?.to_complex();
    control.go_on()?;
    equations.add_boundary_terms(mesh, |inner| {
        let length = mesh.length([mesh.head(inner), mesh.tail(inner)]) * scale;
        length.powf(power - 1.0)
    });
    Ok(equations)
}

/// Lévy's corner equations `(r₁/r₂)(z₂−z₀) − e^{iα}(z₁−z₀) = 0`, summed around each vertex (paper §3.2).
///
/// # Errors
///
/// [`SolveError::NotFinite`] if an edge has no length; [`SolveError::Cancelled`].
pub fn levy(mesh: &DiskMesh, control: Control<'_>) -> Result<Equations<Complex<f64>>, SolveError> {
    let scale = length_scale(mesh);
    let weights = |corner: [DVec3; 3]| {
        let Corner { radii: [r1, r2], cross, dot, .. } = Corner::at(corner.map(|x| x * scale));
        let rotation = Complex::new(dot, cross) / (r1 * r2);
        CornerWeights { shares: [-rotation, Complex::new(r1 / r2, 0.0)], bounded: false }
    };
    sum_corners(mesh, weights, control)
}

/// Least-squares conformal maps (Lévy et al. 2002, eq. 4): the normal equations of `Σ |W₀z₀ + W₁z₁ + W₂z₂|²/2T`.
///
/// `W₀` is the edge opposite corner 0 as a complex number in the triangle's own plane, and T its area. Derived from
/// this energy, not from cotangents, so that it can check [`natural`] with conformal weights.
///
/// # Errors
///
/// [`SolveError::NotFinite`] if a triangle has no area; [`SolveError::Cancelled`].
#[expect(clippy::many_single_char_names, reason = "corners and edges as the equation names them")]
pub fn lscm(mesh: &DiskMesh, control: Control<'_>) -> Result<Equations<Complex<f64>>, SolveError> {
    let scale = length_scale(mesh);
    let weights = |corner: [DVec3; 3]| {
        let [a, b, c] = corner.map(|x| x * scale);
        let (u, w) = (b - a, c - a);
        let (base, height) = (u.length(), u.cross(w).length() / u.length());
        let local = [Complex::ZERO, Complex::new(base, 0.0), Complex::new(w.dot(u) / base, height)];
        let opposite = [local[2] - local[1], local[0] - local[2], local[1] - local[0]];
        // The energy's matrix is WᴴW/2T. Its rows sum to zero, so the off-diagonal entries determine it.
        let share = |j: usize| -opposite[0].conj() * opposite[j] / (base * height);
        CornerWeights { shares: [share(1), share(2)], bounded: false }
    };
    sum_corners(mesh, weights, control)
}

/// Equal weights on all edges (Tutte 1963).
pub fn uniform(mesh: &DiskMesh) -> Equations<f64> {
    let mut coefficients = vec![1.0; mesh.halfedge_count()];
    coefficients.resize(mesh.link_count(), 0.0);
    Equations { coefficients, bounded_corners: 0 }
}

/// Sums the weights of all corners on the two links that leave each corner.
fn sum_corners<T: Scalar>(
    mesh: &DiskMesh,
    weights: impl Fn([DVec3; 3]) -> CornerWeights<T> + Sync,
    control: Control<'_>,
) -> Result<Equations<T>, SolveError> {
    sum_corners_of(mesh, |corners| mesh.shape(corners), weights, control)
}

/// Sums the weights of all corners, with `shape` in place of the triangles in space.
pub(crate) fn sum_corners_of<T: Scalar>(
    mesh: &DiskMesh,
    shape: impl Fn([VertexId; 3]) -> [DVec3; 3] + Sync,
    weights: impl Fn([DVec3; 3]) -> CornerWeights<T> + Sync,
    control: Control<'_>,
) -> Result<Equations<T>, SolveError> {
    let of_piece = |piece: &Piece| {
        let corners = shape(piece.corners);
        let at = [0, 1, 2].map(|k| weights(from_corner(corners, k)));
        Sides {
            along: [0, 1, 2].map(|k| at[k].shares[0]),
            back: [1, 2, 0].map(|k| at[k].shares[1]),
            bounded_corners: at.iter().map(|weights| u8::from(weights.bounded)).sum(),
        }
    };
    sum_of_sides(mesh, of_piece, control)
}

/// Corners of a triangle, starting at corner k.
fn from_corner(x: [DVec3; 3], k: usize) -> [DVec3; 3] {
    [x[k], x[(k + 1) % 3], x[(k + 2) % 3]]
}

/// Contribution of a piece to the links of its sides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sides<T> {
    /// Contributions to the links from each corner to the next.
    pub(crate) along: [T; 3],
    /// Contributions to the links in the reverse direction.
    pub(crate) back: [T; 3],
    /// Number of corners whose weight was bounded.
    pub(crate) bounded_corners: u8,
}

impl<T: Scalar> Sides<T> {
    /// Contribution of a face that is not a piece.
    const NONE: Self = Self { along: [T::ZERO; 3], back: [T::ZERO; 3], bounded_corners: 0 };

    fn are_finite(&self) -> bool {
        self.along.iter().chain(&self.back).all(nalgebra::ComplexField::is_finite)
    }
}

/// Sums the contributions of all pieces to every link.
///
/// A link is a side of at most two faces. Its sum is gathered from them instead of scattered by them, so all links are
/// computed in parallel. The fans of averaged polygons are then added in their order.
///
/// # Errors
///
/// [`SolveError::NotFinite`] for the first piece with a contribution that is not finite; [`SolveError::Cancelled`].
pub(crate) fn sum_of_sides<T: Scalar>(
    mesh: &DiskMesh,
    of_piece: impl Fn(&Piece) -> Sides<T> + Sync,
    control: Control<'_>,
) -> Result<Equations<T>, SolveError> {
    let fans = Fans::of(mesh);
    let of_face = |face: usize| {
        if fans.has_face(face) { Sides::NONE } else { of_piece(&Piece::of_face(mesh, FaceId::from_index(face))) }
    };
    let of_faces: Vec<Sides<T>> = control.each(mesh.face_count(), of_face)?;
    if let Some(face) = of_faces.par_iter().position_first(|sides| !sides.are_finite()) {
        return Err(SolveError::NotFinite { face: FaceId::from_index(face) });
    }
    let mut bounded_corners = of_faces.par_iter().map(|sides| usize::from(sides.bounded_corners)).sum();
    let side =
        |link: usize, of: fn(&Sides<T>) -> &[T; 3]| of_faces.get(link / 3).map_or(T::ZERO, |sides| of(sides)[link % 3]);
    let of_link = |link: usize| {
        let twin = mesh.twin(HalfedgeId::from_index(link));
        side(link, |sides| &sides.along) + side(twin.index(), |sides| &sides.back)
    };
    let mut coefficients: Vec<T> = control.each(mesh.halfedge_count(), of_link)?;
    coefficients.resize(mesh.link_count(), T::ZERO);
    drop(of_faces);
    fans.in_pieces(mesh, |pieces| {
        control.go_on()?;
        let found: Vec<Sides<T>> = pieces.par_iter().map(&of_piece).collect();
        for (piece, sides) in pieces.iter().zip(found) {
            if !sides.are_finite() {
                return Err(SolveError::NotFinite { face: piece.face });
            }
            for (k, &link) in piece.links.iter().enumerate() {
                coefficients[link.index()] += sides.along[k].scale(piece.share);
                coefficients[mesh.twin(link).index()] += sides.back[k].scale(piece.share);
            }
            bounded_corners += usize::from(sides.bounded_corners);
        }
        Ok(())
    })?;
    Ok(Equations { coefficients, bounded_corners })
}

/// Factor that scales the mesh to edges of length about 1, so that no power of a length overflows. A power of two:
/// scaling rounds nothing, and differences of neighbouring positions stay exact.
pub(crate) fn length_scale(mesh: &DiskMesh) -> f64 {
    let positions = &mesh.mesh().positions;
    let extent = positions.iter().fold(0.0_f64, |m, x| m.max((*x - positions[0]).abs().max_element()));
    let per_edge = extent / (mesh.face_count() as f64).sqrt();
    power_of_two_near(per_edge).recip()
}

/// Mean length of the edges after scaling by [`length_scale`].
pub(crate) fn mean_edge_length(mesh: &DiskMesh) -> f64 {
    let scale = length_scale(mesh);
    mean_length(mesh, |[a, b]| (mesh.position(a) * scale).distance(mesh.position(b) * scale))
}

/// Mean of `length` over all halfedges, from tail to head.
pub(crate) fn mean_length(mesh: &DiskMesh, length: impl Fn([VertexId; 2]) -> f64 + Sync) -> f64 {
    let of = |h: usize| length([mesh.tail(HalfedgeId::from_index(h)), mesh.head(HalfedgeId::from_index(h))]);
    let lengths: Vec<f64> = (0..mesh.halfedge_count()).into_par_iter().map(of).collect();
    lengths.iter().sum::<f64>() / mesh.halfedge_count() as f64
}
