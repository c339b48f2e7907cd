//! Stretch minimisation by modified weights: a convex boundary stays fixed, and weights of inner vertices are
//! divided by stretch.
//!
//! # Equations
//!
//! The L² stretch σ of a triangle is the root mean square length on the surface of unit vectors of the plane (module
//! `distortion`). The stretch of a vertex averages over the faces around it, weighted by their areas A on the
//! surface:
//!
//! ```text
//! σⱼ = √( Σ_T∋j A(T) σ(T)² / Σ_T∋j A(T) )          local stretch of vertex j
//! wᵢⱼ ← wᵢⱼ / σⱼ                                    after each solve of  Σⱼ wᵢⱼ (zⱼ − zᵢ) = 0
//! ```
//!
//! A stretched neighbour pulls less, so that the faces around it can spread. Only the ratios of the weights of a
//! vertex matter: so σⱼ is taken relative to the stretch of the whole map, and no weight overflows. The L² stretch
//! of the whole map falls from solve to solve. The iteration ends when it does not fall: the embedding before that
//! is the result. There is no proof that it falls, nor that the result is a minimum. Each solve reports the stretch
//! it reached.
//!
//! The first weights are mean-value weights. All weights stay positive, so every solve is planar by the theorem of
//! Tutte and Floater. The exception is a mesh with a dividing edge along a side of the boundary's shape. The verdict
//! of each solve checks the effect of rounding.
//!
//! # Symbols
//!
//! | paper | code                | meaning                                 | shape, unit            |
//! |-------|---------------------|-----------------------------------------|------------------------|
//! | wᵢⱼ   | `weights`           | coefficient of the link from i to j     | one per link, 1/length |
//! | σⱼ    | `local`             | stretch around a vertex, by the whole's | one per vertex, none   |
//! | σ(T)  | `FaceDistortion`    | stretch of a face                       | one per real face      |
//!
//! Source: S. Yoshizawa, A. Belyaev, H.-P. Seidel, "A Fast and Simple Stretch-Minimizing Mesh Parameterization",
//! 2004, with exponent η = 1. Faces that fill holes have no stretch: vertices of such faces alone count as 1.

use std::time::Instant;

use super::convex::convex_boundary;
use super::fixed_solve::FixedSolve;
use super::system::{FreeSystem, Site};
use crate::linalg::{Analysis, Kind};
use crate::mesh::{DiskMesh, HalfedgeId};
use crate::problem::{
    BoundaryShape, Control, Embedding, LinearSolve, Phase, PhaseSeconds, PinPositions, SolveError, Spacing,
};
use crate::verify::{Distortion, distortion};
use crate::weights::equations::{Equations, barycentric};

/// Power of the offsets d = rᵖ of mean-value weights.
const MEAN_VALUE_POWER: f64 = 0.0;

/// Boundary on its shape, and the system of the inner vertices. The pattern never changes: it is analysed once for
/// all solves.
#[derive(Debug)]
pub struct StretchMinimising {
    /// Boundary vertices with their positions.
    pub(crate) places: PinPositions,
    system: FreeSystem,
    analysis: Analysis,
    /// Seconds of the analysis.
    pub(crate) analyze_seconds: f64,
}

/// Result of a solve, with its weights.
#[derive(Clone, Debug)]
pub struct LessStretched {
    /// Position of each vertex, the boundary on its shape.
    pub embedding: Embedding,
    /// Statistics of the solve.
    pub linear: LinearSolve,
    /// Seconds of each phase.
    pub seconds: PhaseSeconds,
    /// L² stretch of the whole map, at best 1; infinite if a face has no area in the plane.
    pub stretch: f64,
    weights: Equations<f64>,
    /// Stretch of each vertex relative to the whole map: the positive divisor of its weights in the next solve.
    local: Vec<f64>,
}

impl LessStretched {
    /// Weight of each link of the mesh in the equation of its tail.
    pub fn weights(&self) -> &[f64] {
        &self.weights.coefficients
    }
}

impl StretchMinimising {
    /// Places the boundary on its shape and analyses the system of the inner vertices.
    ///
    /// # Errors
    ///
    /// Returns an error if the boundary does not fit the shape; [`SolveError::Cancelled`].
    pub fn new(
        mesh: &DiskMesh,
        shape: &BoundaryShape,
        spacing: Spacing,
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        control.enter(Phase::Analyze)?;
        let start = Instant::now();
        let places = convex_boundary(mesh, shape, spacing)?;
        let system = FreeSystem::new(mesh, |v| places.contains_key(&v), control)?;
        let analysis = system.analysis(Kind::General, control)?;
        Ok(Self { places, system, analysis, analyze_seconds: start.elapsed().as_secs_f64() })
    }

    /// First solve, with mean-value weights.
    ///
    /// # Errors
    ///
    /// Returns an error if a weight is not finite or the system cannot be solved; [`SolveError::Cancelled`].
    pub fn first(&self, mesh: &DiskMesh, control: Control<'_>) -> Result<LessStretched, SolveError> {
        control.enter(Phase::Assemble)?;
        let start = Instant::now();
        let weights = barycentric(mesh, MEAN_VALUE_POWER, control)?;
        self.solved(mesh, weights, PhaseSeconds { assemble: start.elapsed().as_secs_f64(), ..self.seconds() }, control)
    }

    /// Next solve: the weights of `before` are divided by its stretch.
    ///
    /// # Errors
    ///
    /// Errors of [`StretchMinimising::first`].
    pub fn after(
        &self,
        before: &LessStretched,
        mesh: &DiskMesh,
        control: Control<'_>,
    ) -> Result<LessStretched, SolveError> {
        control.enter(Phase::Assemble)?;
        let start = Instant::now();
        let divided = |(link, weight): (HalfedgeId, &f64)| weight / before.local[mesh.head(link).index()];
        let coefficients = mesh.links().zip(before.weights()).map(divided).collect();
        let weights = Equations { coefficients, ..before.weights };
        let assemble = start.elapsed().as_secs_f64();
        self.solved(mesh, weights, PhaseSeconds { assemble, ..PhaseSeconds::default() }, control)
    }

    fn solved(
        &self,
        mesh: &DiskMesh,
        weights: Equations<f64>,
        seconds: PhaseSeconds,
        control: Control<'_>,
    ) -> Result<LessStretched, SolveError> {
        let site = Site { mesh, system: &self.system };
        control.enter(Phase::Factor)?;
        let start = Instant::now();
        let solve = FixedSolve::new(site, weights, &self.analysis, control)?;
        let factor = start.elapsed().as_secs_f64();
        control.enter(Phase::Solve)?;
        let start = Instant::now();
        let (mut embedding, residual) = solve.solve(site, &self.places, control)?;
        embedding.gather_unused(mesh);
        let linear = solve.numbers(site, &embedding, residual, control)?;
        let solve_seconds = start.elapsed().as_secs_f64();
        // Work for the next weights counts as assembly.
        let start = Instant::now();
        let distortion = distortion(mesh, &embedding);
        let local = local_stretches(mesh, &distortion);
        let stretch = distortion.summary.stretch_l2;
        let assemble = seconds.assemble + start.elapsed().as_secs_f64();
        let seconds = PhaseSeconds { assemble, factor, solve: solve_seconds, ..seconds };
        Ok(LessStretched { embedding, linear, seconds, stretch, weights: solve.into_equations(), local })
    }

    fn seconds(&self) -> PhaseSeconds {
        PhaseSeconds { analyze: self.analyze_seconds, ..PhaseSeconds::default() }
    }
}

/// Stretch around each vertex, relative to the whole map; 1 if nothing is measured there.
fn local_stretches(mesh: &DiskMesh, distortion: &Distortion) -> Vec<f64> {
    let whole = distortion.summary.stretch_l2;
    let mut sums = vec![[0.0; 2]; mesh.vertex_count()];
    for (face, measured) in mesh.real_faces().zip(&distortion.faces) {
        let [a, b, c] = mesh.shape(mesh.face(face));
        let area = (b - a).cross(c - a).length();
        let share = measured.stretch_l2 / whole;
        for vertex in mesh.face(face) {
            let [stretch, weight] = &mut sums[vertex.index()];
            *stretch += area * share * share;
            *weight += area;
        }
    }
    let local = |[stretch, weight]: [f64; 2]| (stretch / weight).sqrt();
    sums.into_iter().map(local).map(|local| if local > 0.0 && local.is_finite() { local } else { 1.0 }).collect()
}
