//! Mean-value iteration: repeated solves with weights from the latest embedding (paper §4).
//!
//! Each step solves `x_{k+1} = A(x_k)⁻¹ b`, where A(x) holds the mean-value equations of the planar geometry x,
//! angles unsigned. The pins do not change. A planar embedding is a fixed point and needs no solve. A fixed point
//! with turning number 1 that meets *all* equations is planar (Theorem 2). The unknown of a solve is the move
//! `x_{k+1} − x_k`, so that its rounding error shrinks with the move. The pattern never changes: it is ordered and
//! analysed once per run.

use std::time::Instant;

use glam::DVec2;
use num_complex::Complex;

use super::free_layout::{LaidOut, Numbers, Unanalysed, Way};
use super::free_solve::{FreeSolve, SolveStart, Unsolved};
use super::left_kernel::gauge_of;
use super::system::Site;
use crate::linalg::Kind;
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::pins::targets_of;
use crate::problem::{
    Control, Embedding, LinearSolve, Phase, PhaseSeconds, Pin, Pins, Solution, SolveError, Treatment, are_held_alike,
    check_pins,
};
use crate::weights::plane_weights::{mean_edge_length_in_plane, natural_in_plane, residuals_in_plane};

/// Prepared iteration: layout and analysis of the system for a mesh and its pinned vertices.
#[derive(Debug)]
pub struct Iteration {
    pins: Pins,
    laid_out: LaidOut,
}

impl Iteration {
    /// Lays out and analyses the system for steps from `embedding` with `pins`. Hard pins hold their vertices at
    /// their current positions; soft pins pull their vertices to their targets.
    ///
    /// # Errors
    ///
    /// Returns an error for invalid pins, and [`SolveError::Cancelled`].
    pub fn new(
        mesh: &DiskMesh,
        embedding: &Embedding,
        pins: &Pins,
        treatment: Treatment,
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        check_pins(mesh, &held_in(embedding, pins))?;
        let way = Way { treatment, gauge: None };
        let laid_out = Unanalysed::new(mesh, pins, way, Kind::General, control)?.analysed_now(mesh, control)?;
        Ok(Self { pins: pins.clone(), laid_out })
    }

    /// Takes a step: solves the mean-value equations of `embedding`. Hard-pinned vertices keep their positions. If
    /// the equations of unpinned vertices depend on each other, the step finds them and lays out the system anew for
    /// further steps.
    ///
    /// # Errors
    ///
    /// [`SolveError::Singular`], [`SolveError::ResidualTooLarge`] if refinement cannot reduce the residual, or
    /// [`SolveError::Cancelled`].
    pub fn step(
        &mut self,
        mesh: &DiskMesh,
        embedding: &Embedding,
        control: Control<'_>,
    ) -> Result<Solution, SolveError> {
        control.enter(Phase::Assemble)?;
        let start = Instant::now();
        let pins = held_in(embedding, &self.pins);
        let is_pulled = |(v, pin): (&VertexId, &Pin)| embedding[v] != pin.target;
        let residuals = residuals_in_plane(mesh, embedding, control)?;
        if residuals.iter().all(|residual| *residual == Complex::ZERO) && !pins.iter().any(is_pulled) {
            // The embedding meets its equations and no pin pulls: it is the solution.
            let seconds = PhaseSeconds { assemble: start.elapsed().as_secs_f64(), ..PhaseSeconds::default() };
            let (embedding, linear) = (embedding.clone(), Some(LinearSolve::default()));
            return Ok(Solution { embedding, pins, gauge_completed: false, linear, seconds, convergence: None });
        }
        let mut seconds = PhaseSeconds { assemble: start.elapsed().as_secs_f64(), ..PhaseSeconds::default() };
        let solve = self.factored(mesh, embedding, &mut seconds, control)?;
        control.enter(Phase::Solve)?;
        let start = Instant::now();
        let site = Site { mesh, system: &self.laid_out.system };
        let (embedding, residual) =
            solve.solve_from(site, SolveStart { embedding, residuals: &residuals }, &targets_of(&pins), control)?;
        let linear = Some(solve.numbers(mesh, &embedding, residual, control)?);
        seconds.solve = start.elapsed().as_secs_f64();
        Ok(Solution { embedding, pins, gauge_completed: false, linear, seconds, convergence: None })
    }

    /// Factors the equations of an embedding, without two more of them if least squares requires that.
    fn factored(
        &mut self,
        mesh: &DiskMesh,
        embedding: &Embedding,
        seconds: &mut PhaseSeconds,
        control: Control<'_>,
    ) -> Result<FreeSolve, SolveError> {
        let numbers = |seconds: &mut PhaseSeconds| {
            let start = Instant::now();
            let equations = natural_in_plane(mesh, embedding, control)?;
            let unit = mean_edge_length_in_plane(mesh, embedding);
            seconds.assemble += start.elapsed().as_secs_f64();
            Ok::<_, SolveError>(Numbers { equations, matrix: None, unit })
        };
        let gauge = match FreeSolve::new(mesh, &self.laid_out, numbers(seconds)?, seconds, control) {
            Ok(solve) => return Ok(solve),
            Err(Unsolved::WithoutGauge(gauge)) => gauge,
            Err(Unsolved::Error(error)) => return Err(error),
        };
        let gauge = match gauge {
            Some(gauge) => gauge,
            None => gauge_of(mesh, &numbers(seconds)?.equations, control)?,
        };
        let way = Way { gauge: Some(gauge), ..self.laid_out.way };
        self.laid_out = Unanalysed::new(mesh, &self.pins, way, Kind::General, control)?.analysed_now(mesh, control)?;
        FreeSolve::new(mesh, &self.laid_out, numbers(seconds)?, seconds, control).map_err(SolveError::from)
    }

    /// Seconds of the analysis, which all steps share.
    pub(crate) fn analyze_seconds(&self) -> f64 {
        self.laid_out.seconds
    }

    /// True if the iteration can be reused for these pins: equal vertices and kinds of pins, and soft pins with
    /// equal targets.
    pub fn serves(&self, pins: &Pins) -> bool {
        let pulls_alike = |(a, b): (&Pin, &Pin)| a.kind.is_hard() || a.target == b.target;
        are_held_alike(&self.pins, pins) && self.pins.values().zip(pins.values()).all(pulls_alike)
    }
}

/// Pins with the targets of hard pins moved to the positions of their vertices in an embedding.
fn held_in(embedding: &Embedding, pins: &Pins) -> Pins {
    let place = |v: VertexId| embedding.get(v.index()).copied().unwrap_or(DVec2::NAN);
    let held = |pin: &Pin, v| if pin.kind.is_hard() { Pin { target: place(v), ..*pin } } else { *pin };
    pins.iter().map(|(&v, pin)| (v, held(pin, v))).collect()
}
