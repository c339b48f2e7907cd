//! The mean-value iteration: solve again with weights from the embedding at hand (paper §4).
//!
//! `x_{k+1} = A(x_k)⁻¹ b`, where A(x) holds the mean-value equations of the planar geometry x, angles unsigned. The
//! pins stay what they are. A planar embedding is a fixed point; a fixed point with turning number 1 that meets *all*
//! equations is planar (Theorem 2). Nothing is solved for such an embedding. It is solved for the move `x_{k+1} − x_k`, so that rounding dies away with it. The pattern never changes, so it is ordered and analysed once a run.

use std::time::Instant;

use glam::DVec2;
use num_complex::Complex;

use super::free_solve::{FreeSolve, Site};
use super::plane_weights::{left_over_in_plane, natural_in_plane};
use super::system::FreeSystem;
use super::{Control, Phase, PhaseSeconds, Pins, Solution, SolveError, Treatment, check_pins};
use crate::linalg::{Analysis, Kind};
use crate::mesh::{DiskMesh, VertexId};

/// An iteration made ready: the layout of the system and its analysis, for a mesh and its pinned vertices.
#[derive(Debug)]
pub struct Iteration {
    system: FreeSystem,
    analysis: Analysis,
    pinned: Vec<VertexId>,
    treatment: Treatment,
    analyze_seconds: f64,
}

impl Iteration {
    /// Lays out and analyses the system of the vertices that `pins` leaves free.
    ///
    /// # Errors
    ///
    /// Pins that cannot be, or the caller's wish to stop.
    pub fn new(mesh: &DiskMesh, pins: &Pins, treatment: Treatment, control: Control<'_>) -> Result<Self, SolveError> {
        check_pins(mesh, pins)?;
        control.enter(Phase::Analyze)?;
        let start = Instant::now();
        let system = FreeSystem::new(mesh, |v| pins.contains_key(&v));
        let analysis = Analysis::new(Kind::General, system.pattern())
            .map_err(|error| SolveError::Linear { reason: error.to_string() })?;
        let pinned = pins.keys().copied().collect();
        Ok(Self { system, analysis, pinned, treatment, analyze_seconds: start.elapsed().as_secs_f64() })
    }

    /// One step: the embedding that solves the mean-value equations of `embedding`. Its pinned vertices stay where they
    /// are, and must be those that the iteration was made for.
    ///
    /// # Errors
    ///
    /// A singular matrix, a residual that refinement cannot bring down, or the caller's wish to stop.
    pub fn step(&self, mesh: &DiskMesh, embedding: &[DVec2], control: Control<'_>) -> Result<Solution, SolveError> {
        control.enter(Phase::Assemble)?;
        let start = Instant::now();
        let pins: Pins = self.pinned.iter().map(|&v| (v, embedding[v.index()])).collect();
        let site = Site { mesh, system: &self.system, pinned: &self.pinned };
        let equations = natural_in_plane(mesh, embedding);
        let left = left_over_in_plane(mesh, embedding);
        if left.iter().all(|left| *left == Complex::ZERO) {
            return Ok(self.unmoved(embedding, start.elapsed().as_secs_f64()));
        }
        let mut seconds = PhaseSeconds { assemble: start.elapsed().as_secs_f64(), ..PhaseSeconds::default() };
        let solve = FreeSolve::new(site, equations, (&self.analysis, self.treatment), &mut seconds, control)?;
        control.enter(Phase::Solve)?;
        let start = Instant::now();
        let (embedding, residual) = solve.solve_from(site, (embedding, &left), &pins)?;
        let stats = solve.stats();
        let equation_residual = solve.equation_residual(mesh, &embedding);
        seconds.solve = start.elapsed().as_secs_f64();
        Ok(Solution {
            embedding,
            pins,
            gauge_completed: false,
            residual,
            equation_residual,
            replaced_pivots: stats.replaced_pivots,
            bounded_corners: solve.bounded_corners(),
            factor_bytes: stats.factor_bytes,
            seconds,
        })
    }

    /// The answer to an embedding that leaves nothing of its equations: itself.
    fn unmoved(&self, embedding: &[DVec2], seconds: f64) -> Solution {
        Solution {
            embedding: embedding.to_vec(),
            pins: self.pinned.iter().map(|&v| (v, embedding[v.index()])).collect(),
            gauge_completed: false,
            residual: 0.0,
            equation_residual: 0.0,
            replaced_pivots: 0,
            bounded_corners: 0,
            factor_bytes: 0,
            seconds: PhaseSeconds { assemble: seconds, ..PhaseSeconds::default() },
        }
    }

    /// Whether this iteration serves pins on these vertices.
    pub fn serves(&self, pins: &Pins) -> bool {
        self.pinned.iter().eq(pins.keys())
    }

    /// Seconds that the analysis took, once for all steps.
    pub fn analyze_seconds(&self) -> f64 {
        self.analyze_seconds
    }
}
