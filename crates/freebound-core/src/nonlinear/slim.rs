//! SLIM: minimises the symmetric Dirichlet energy by reweighted local and global steps, like the published method.
//!
//! # Energy
//!
//! J is the map of a face from its shape in space to the plane, σ₁ ≥ σ₂ > 0 its singular values, A its area:
//!
//! ```text
//! E(z) = Σ A · ½ (|J|² + |J⁻¹|²) = Σ A · ½ Σᵢ (σᵢ² + σᵢ⁻²)          J = U diag(σ₁, σ₂) Vᵀ
//! ```
//!
//! # Local step
//!
//! The rotation nearest to J is R = U Vᵀ. A weight matrix W = U diag(√m(σ₁), √m(σ₂)) Uᵀ makes the gradient of a
//! quadratic *proxy* equal to the energy's gradient at the present z. The global step then finds the minimiser of the
//! proxy:
//!
//! ```text
//! P(z) = Σ A · ½ |W (J − R)|²          ∂P/∂J = W² (J − R) = U diag(σᵢ − σᵢ⁻³) Vᵀ = ∂E/∂J
//! m(σ) = (σ − σ⁻³) / (σ − 1) = (1 + σ)(1 + σ²) / σ³          4 where nothing is stretched
//! ```
//!
//! # Global step
//!
//! P is a quadratic of z with the Hessian blocks A (gᵢ·gⱼ) W², with gᵢ the gradients of the hat functions. The Hessian
//! is real, 2n × 2n, and positive definite once a vertex is held, which fixes the translation that P leaves open. A
//! line search follows. Its first step is at most 0.8 of the distance to the first face without area, the smallest
//! positive root of the faces' quadratics. The step is halved until the energy falls.
//!
//! # In complex numbers
//!
//! With the notation of the module `foldover_energy`, J is α w + β w̄, with |α| > |β| if a face is not folded. Then R
//! is α/|α|, and the singular values are |α| ± |β|. With e = αβ/|αβ|, the square of U's first column,
//! `W² v = ½ (m₁ + m₂) v + ½ (m₁ − m₂) e v̄`.
//!
//! # Guarantee
//!
//! No face folds. The start is Tutte's map on a circle. If rounding folds that map for every choice of weights, the
//! start is the flattener's first planar map. The boundary is free and may cross itself: SLIM does not check it. The
//! module `relaxing` prevents crossings by a triangulated outside.
//!
//! Source: M. Rabinovich, R. Poranne, D. Panozzo, O. Sorkine-Hornung, "Scalable Locally Injective Mappings", 2017. The
//! line search is that of J. Smith, S. Schaefer, "Bijective parameterization with free boundaries", 2015.

use crate::parallel::prelude::*;
use glam::DVec2;

use super::energy_problem::{EnergyProblem, Planning};
use super::foldover_energy::{Element, EnergyModel, Stiffness, conjugate, flat};
use crate::geom::{Orientation, double_area, orientation};
use crate::mesh::{DiskMesh, FaceId, THINNEST, VertexId};
use crate::problem::{Control, Embedding, Progress, SolveError};
use crate::weights::equations::length_scale;

/// Weight of the filling of holes, relative to weight 1 of the surface for equal areas: the filling only has to stay
/// unfolded.
const FILLING_WEIGHT: f64 = 0.002;

/// Quadratic proxy of an element's energy near a point.
#[derive(Clone, Copy, Debug)]
pub struct Proxy {
    /// Coefficient ½ (m₁ + m₂).
    mean: f64,
    /// Coefficient ½ (m₁ − m₂) e.
    along: DVec2,
    /// Rotation R, as a complex number of length 1.
    rotation: DVec2,
}

impl Proxy {
    /// Builds the proxy of an unfolded element with corners at `z`.
    pub fn at(element: &Element, z: [DVec2; 3]) -> Self {
        let (alpha, beta) = element.derivatives(z);
        let greater = alpha.length() + beta.length();
        // Avoids the difference of the two lengths, which cancels.
        let lesser = element.determinant(z) / greater;
        let [first, second] = [greater, lesser].map(|sigma| (1.0 + sigma) * (1.0 + sigma * sigma) / sigma.powi(3));
        let direction = |z: DVec2| z.try_normalize().unwrap_or(DVec2::X);
        let rotation = direction(alpha);
        let along = 0.5 * (first - second) * rotation.rotate(direction(beta));
        Self { mean: 0.5 * (first + second), along, rotation }
    }

    /// Builds the proxy ½ |J − R|² with weights of 1, for a rotation R as a complex number of length 1.
    pub(crate) fn rigid(rotation: DVec2) -> Self {
        Self { mean: 1.0, along: DVec2::ZERO, rotation }
    }

    /// Product W² v.
    fn weighted(&self, v: DVec2) -> DVec2 {
        self.mean * v + self.along.rotate(conjugate(v))
    }

    /// Value of the proxy with the element's corners at `z`, times the element's weight.
    pub fn value(&self, element: &Element, z: [DVec2; 3]) -> f64 {
        let (alpha, beta) = element.derivatives(z);
        let off = alpha - self.rotation;
        // ½ tr((J − R)ᵀ W² (J − R)) over the columns (α − u) + β and i ((α − u) − β).
        let columns = [off + beta, (off - beta).perp()];
        0.5 * element.weight() * columns.iter().map(|column| column.dot(self.weighted(*column))).sum::<f64>()
    }

    /// Gradient and Hessian of the proxy at the point for which it was built, by the coordinates x and y of each
    /// corner in turn.
    pub fn model(&self, element: &Element, z: [DVec2; 3]) -> EnergyModel {
        let (alpha, beta) = element.derivatives(z);
        let off = alpha - self.rotation;
        let gradients = element.gradients();
        let weight = element.weight();
        let gradient = gradients.map(|g| weight * self.weighted(off.rotate(g) + beta.rotate(conjugate(g))));
        let [[xx, xy], [yx, yy]] = [DVec2::X, DVec2::Y].map(|axis| self.weighted(axis).to_array());
        let mut hessian = [[0.0; 6]; 6];
        for (i, g) in gradients.iter().enumerate() {
            for (j, h) in gradients.iter().enumerate() {
                let share = weight * g.dot(*h);
                let block = [[xx, yx], [xy, yy]].map(|row| row.map(|entry| share * entry));
                for (row, entries) in block.into_iter().enumerate() {
                    hessian[2 * i + row][2 * j..2 * j + 2].copy_from_slice(&entries);
                }
            }
        }
        EnergyModel { gradient: flat(gradient), hessian }
    }
}

/// True if every face is counter-clockwise in the plane.
pub(crate) fn is_unfolded(mesh: &DiskMesh, embedding: &Embedding) -> bool {
    (0..mesh.face_count()).into_par_iter().all(|face| {
        let [a, b, c] = embedding.corners(mesh, FaceId::from_index(face));
        orientation(a, b, c) == Some(Orientation::CounterClockwise)
    })
}

/// State of a SLIM iteration on a mesh.
#[derive(Debug)]
pub struct Slim {
    pub(super) problem: EnergyProblem,
    /// Positions of the vertices, in units of about one mesh edge.
    pub(super) z: Vec<DVec2>,
    /// Scale from mesh units to these units, a power of two.
    pub(super) scale: f64,
    real_faces: usize,
    /// Twice the area of the surface, in units of `z`.
    area: f64,
}

impl Slim {
    /// Starts at an embedding, scaled to the area of the surface.
    ///
    /// # Errors
    ///
    /// [`SolveError::NotPlanar`] if a face of the embedding is folded or has no area. Also fails if the system is too
    /// large or the caller cancels.
    pub fn new(mesh: &DiskMesh, start: &Embedding, control: Control<'_>) -> Result<Self, SolveError> {
        if !is_unfolded(mesh, start) {
            return Err(SolveError::NotPlanar);
        }
        let map = Self::at_origin(mesh, mesh.face_count(), control)?;
        let in_plane: f64 = mesh.real_faces().map(|face| double_area(start.corners(mesh, face))).sum();
        let size = (map.area / in_plane).sqrt();
        Ok(Self { z: start.iter().map(|z| size * *z).collect(), ..map })
    }

    /// Problem of the first `count` faces of a surface, with all positions at the origin.
    pub(super) fn at_origin(mesh: &DiskMesh, count: usize, control: Control<'_>) -> Result<Self, SolveError> {
        let scale = length_scale(mesh);
        let flat = |face: usize| mesh.rest_shape(mesh.face(FaceId::from_index(face)), scale);
        let shapes: Vec<[DVec2; 3]> = control.each(count, flat)?;
        let real_faces = mesh.mesh().real_face_count();
        let on_surface: f64 = shapes[..real_faces].iter().copied().map(double_area).sum();
        let z = vec![DVec2::ZERO; mesh.vertex_count()];
        let element = |face: usize| {
            let kind = if face < real_faces { 1.0 } else { FILLING_WEIGHT };
            let weight = kind * double_area(shapes[face]) / on_surface;
            Element::new(
                mesh.face(FaceId::from_index(face)).map(VertexId::number),
                shapes[face],
                Stiffness { weight, thinnest: THINNEST },
            )
        };
        let elements = control.each(count, element)?;
        let held = mesh.boundary_loop()[0].number();
        let planning = Planning { order: None, control };
        let problem = EnergyProblem::new(z.len(), elements, Vec::new(), |point| point == held, planning)?;
        Ok(Self { problem, z, scale, real_faces, area: on_surface })
    }

    /// Performs one iteration. Returns the relative decrease of the energy, or `None` if no step lowers the energy.
    ///
    /// # Errors
    ///
    /// Fails if a system cannot be factored or the caller cancels. The embedding then stays unchanged.
    pub fn step(&mut self, control: Control<'_>) -> Result<Option<f64>, SolveError> {
        let energies = self.problem.reweighted_step(&mut self.z, control)?;
        Ok(energies.map(|[before, after]| 1.0 - after / before))
    }

    /// Present positions of all vertices, in units of the surface.
    pub fn embedding(&self) -> Embedding {
        self.z.iter().map(|z| *z / self.scale).collect()
    }

    /// Energy per area of the surface, and least determinant, at equal total areas.
    pub fn progress(&self) -> Progress {
        let size = (self.area / self.problem.double_area(&self.z, self.real_faces)).sqrt();
        let z: Vec<DVec2> = self.z.iter().map(|z| size * *z).collect();
        self.problem.standing(&z, self.real_faces)
    }
}
