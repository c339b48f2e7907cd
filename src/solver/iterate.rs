//! The mean-value iteration: solve again with weights from the embedding at hand (paper §4).
//!
//! `x_{k+1} = A(x_k)⁻¹ b`, where A(x) holds the mean-value equations of the planar geometry x, angles unsigned. The
//! pins stay what they are. A planar embedding is a fixed point; a fixed point with turning number 1 that meets *all*
//! equations is planar (Theorem 2). Nothing is solved for such an embedding. It is solved for the move `x_{k+1} − x_k`, so that rounding dies away with it. The pattern never changes, so it is ordered and analysed once a run.

use std::time::Instant;

use glam::DVec2;
use num_complex::Complex;

use super::free_solve::{FreeSolve, Site};
use super::gauge_rows::gauge_of;
use super::plane_weights::{left_over_in_plane, natural_in_plane};
use super::system::FreeSystem;
use super::{Control, Phase, PhaseSeconds, Pins, Solution, SolveError, Treatment, check_pins, farthest_pair};
use crate::linalg::{Analysis, Kind};
use crate::mesh::{DiskMesh, VertexId};

/// An iteration made ready: the layout of the system and its analysis, for a mesh and its pinned vertices.
#[derive(Debug)]
pub struct Iteration {
    system: FreeSystem,
    analysis: Analysis,
    pinned: Vec<VertexId>,
    /// With least squares the two vertices that are left out of the factors; with elimination the pins are.
    gauge: Option<[VertexId; 2]>,
    analyze_seconds: f64,
}

impl Iteration {
    /// Lays out and analyses the system, to go on from `embedding` with some of its vertices pinned where they lie.
    ///
    /// # Errors
    ///
    /// Pins that cannot be, or the caller's wish to stop.
    pub fn new(
        mesh: &DiskMesh,
        embedding: &[DVec2],
        pinned: &[VertexId],
        treatment: Treatment,
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        check_pins(mesh, &pins_at(pinned, embedding))?;
        control.enter(Phase::Analyze)?;
        let start = Instant::now();
        let gauge = match treatment {
            Treatment::LeastSquares if mesh.vertex_count() > 2 => Some(gauge_or_pins(mesh, embedding, control)?),
            _ => None,
        };
        let left_out: &[VertexId] = gauge.as_ref().map_or(pinned, |gauge| gauge.as_slice());
        let system = FreeSystem::new(mesh, |v| left_out.contains(&v));
        let analysis = Analysis::new(Kind::General, system.pattern())
            .map_err(|error| SolveError::Linear { reason: error.to_string() })?;
        let analyze_seconds = start.elapsed().as_secs_f64();
        Ok(Self { system, analysis, pinned: pinned.to_vec(), gauge, analyze_seconds })
    }

    /// One step: the embedding that solves the mean-value equations of `embedding`. Its pinned vertices stay where they
    /// are.
    ///
    /// # Errors
    ///
    /// A singular matrix, a residual that refinement cannot bring down, or the caller's wish to stop.
    pub fn step(&self, mesh: &DiskMesh, embedding: &[DVec2], control: Control<'_>) -> Result<Solution, SolveError> {
        control.enter(Phase::Assemble)?;
        let start = Instant::now();
        let left = left_over_in_plane(mesh, embedding);
        if left.iter().all(|left| *left == Complex::ZERO) {
            return Ok(self.unmoved(embedding, start.elapsed().as_secs_f64()));
        }
        let equations = natural_in_plane(mesh, embedding);
        let mut seconds = PhaseSeconds { assemble: start.elapsed().as_secs_f64(), ..PhaseSeconds::default() };
        let pins = pins_at(&self.pinned, embedding);
        let left_out: &[VertexId] = self.gauge.as_ref().map_or(&self.pinned, |gauge| gauge.as_slice());
        let site = Site { mesh, system: &self.system, pinned: left_out };
        let solve = FreeSolve::new(site, equations, (&self.analysis, Treatment::Eliminate), &mut seconds, control)?;
        control.enter(Phase::Solve)?;
        let start = Instant::now();
        let (embedding, residual) = match self.gauge {
            None => solve.solve_from(site, (embedding, &left), &pins)?,
            Some(gauge) => solve.least_squares_from(site, (gauge, &self.pinned), (embedding, &left), control)?,
        };
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
            pins: pins_at(&self.pinned, embedding),
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

fn pins_at(pinned: &[VertexId], embedding: &[DVec2]) -> Pins {
    pinned.iter().map(|&v| (v, embedding[v.index()])).collect()
}

/// The two vertices to leave out of the factors: where the left kernel is largest; where it cannot be found, the
/// farthest two of the boundary.
fn gauge_or_pins(mesh: &DiskMesh, embedding: &[DVec2], control: Control<'_>) -> Result<[VertexId; 2], SolveError> {
    match gauge_of(mesh, &natural_in_plane(mesh, embedding), control) {
        Err(error) if error != SolveError::Cancelled => Ok(farthest_pair(mesh)),
        other => other,
    }
}
