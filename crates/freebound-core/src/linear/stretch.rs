//! Stretch minimising by modified weights: a convex boundary stays, and weights of the inside are divided by stretch.
//!
//! # Equations
//!
//! Of a triangle the L² stretch σ is the root mean square length on the surface of unit vectors of the plane
//! (see the module `distortion`). A vertex has that of the faces around it, which count by their areas A on the surface:
//!
//! ```text
//! σⱼ = √( Σ_T∋j A(T) σ(T)² / Σ_T∋j A(T) )          local stretch of vertex j
//! wᵢⱼ ← wᵢⱼ / σⱼ                                    after each solve of  Σⱼ wᵢⱼ (zⱼ − zᵢ) = 0
//! ```
//!
//! A neighbour that is stretched pulls less, so that what lies around it may spread. Only the ratios of a vertex's
//! weights matter: so σⱼ is taken relative to the stretch of the whole, and no weight runs out of range. The L² stretch of
//! the whole falls from solve to solve, until one does not fall: the embedding before that is the answer. There is no proof
//! that it falls, nor that the end is the least there is; each solve says what it has come to.
//!
//! The first weights are mean values. All weights stay positive, so that every solve is planar by the theorem of Tutte and
//! Floater, wherever a mesh of triangles has no dividing edge along a side of the boundary's shape; the verdict of each
//! says so of what rounding has left of it.
//!
//! # Symbols
//!
//! | paper | code                | meaning                                 | shape, unit            |
//! |-------|---------------------|-----------------------------------------|------------------------|
//! | wᵢⱼ   | `weights`           | coefficient of the link from i to j     | one per link, 1/length |
//! | σⱼ    | `local`             | stretch around a vertex, by the whole's | one per vertex, none   |
//! | σ(T)  | `FaceDistortion`    | stretch of a face                       | one per real face      |
//!
//! Source: S. Yoshizawa, A. Belyaev, H.-P. Seidel, "A Fast and Simple Stretch-Minimizing Mesh Parameterization", 2004,
//! with their exponent η = 1. What fills holes has no stretch: vertices of it alone count as 1.

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

/// The power of the offsets d = rᵖ of mean-value weights.
const MEAN_VALUE_POWER: f64 = 0.0;

/// The boundary on its shape, and the system of the inside. Its pattern never changes: it is analysed once for all solves.
#[derive(Debug)]
pub struct StretchMinimising {
    /// The boundary vertices, and where they lie.
    pub(crate) places: PinPositions,
    system: FreeSystem,
    analysis: Analysis,
    /// Seconds that the analysis took.
    pub(crate) analyze_seconds: f64,
}

/// One solve, with its weights.
#[derive(Clone, Debug)]
pub struct LessStretched {
    /// One position per vertex, the boundary on its shape.
    pub embedding: Embedding,
    /// The numbers of the solve.
    pub linear: LinearSolve,
    /// Where its time went.
    pub seconds: PhaseSeconds,
    /// L² stretch of the whole, 1 at best; infinite where a face has no area in the plane.
    pub stretch: f64,
    weights: Equations<f64>,
    /// Stretch of each vertex relative to the whole, which its weights are divided by next: positive.
    local: Vec<f64>,
}

impl LessStretched {
    /// For each link of the mesh its weight in the equation of the vertex that it leaves.
    pub fn weights(&self) -> &[f64] {
        &self.weights.coefficients
    }
}

impl StretchMinimising {
    /// Lays the boundary on its shape and analyses the system of the vertices within.
    ///
    /// # Errors
    ///
    /// A boundary that does not go with the shape, or the caller's wish to stop.
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

    /// The first solve, with mean-value weights.
    ///
    /// # Errors
    ///
    /// A weight that is not finite, a system that cannot be solved, or the caller's wish to stop.
    pub fn first(&self, mesh: &DiskMesh, control: Control<'_>) -> Result<LessStretched, SolveError> {
        control.enter(Phase::Assemble)?;
        let start = Instant::now();
        let weights = barycentric(mesh, MEAN_VALUE_POWER, control)?;
        self.solved(mesh, weights, PhaseSeconds { assemble: start.elapsed().as_secs_f64(), ..self.seconds() }, control)
    }

    /// The solve that follows another, its weights divided by the stretch of that.
    ///
    /// # Errors
    ///
    /// Those of [`StretchMinimising::first`].
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
        // What the next weights come from counts as assembling.
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

/// The stretch around each vertex, relative to that of the whole; 1 where nothing is measured.
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
