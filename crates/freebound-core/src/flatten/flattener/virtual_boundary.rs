//! Stage 3: the virtual boundary (paper §5).
//!
//! ```text
//! while the boundary is not simple: pin more of its vertices to a circle, solve the natural boundary equations
//! extend the embedding up to a convex outline, solve the mean-value equations with the outline fixed, peel
//! ```
//!
//! With all boundary vertices pinned the boundary is simple, so the method ends planar in exact arithmetic. In
//! floating point a solve may still collapse faces. Then it is repeated with weights from its own result, which
//! squeeze less. The last attempts use weights from the surface, and equal weights.

use std::f64::consts::TAU;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;

use super::stage::{Handover, Notes, RunStage, StageFailure, StageInput, StepState};
use super::task::Task;
use super::{Candidate, Step};
use crate::bijective::{Extended, VirtualBoundary};
use crate::flatten::solve_once;
use crate::mesh::DiskMesh;
use crate::problem::{
    Control, Embedding, Family, Growth, Method, PhaseSeconds, PinPositions, Pins, Settings, Solution, SolveError,
    Stage, Treatment, fixed_pins,
};
use crate::weights::equations::{barycentric, uniform};
use crate::weights::plane_weights::{mean_value_in_plane, residuals_in_plane};

/// Least share of the circle between neighbouring pins, relative to an even share. In 64 bits the pins must stay
/// apart, and the polygon strictly convex.
const LEAST_SHARE: f64 = 0.2;

/// Rounds of relaxing after the boundary was bent, so that it does not stay a circle.
const ROUNDS_AFTER_BENDING: usize = 30;

/// Weights for solving an extended embedding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Weights {
    /// Mean value, from the previous embedding.
    Before,
    /// Mean value, from the last result.
    Again,
    /// Mean value, from the surface in space. With pockets, equal to [`Weights::Before`].
    Surface,
    /// Equal weights.
    Uniform,
}

/// Weights to try while the boundary is free, or partly free.
const TRIED_WHILE_FREE: &[Weights] = &[Weights::Before, Weights::Again, Weights::Again];

/// Weights to try when the whole boundary is pinned, as the last resort.
const TRIED_AT_LAST: &[Weights] = &[
    Weights::Before,
    Weights::Again,
    Weights::Again,
    Weights::Surface,
    Weights::Again,
    Weights::Again,
    Weights::Uniform,
    Weights::Again,
    Weights::Again,
];

#[derive(Debug)]
pub(super) struct Bend {
    /// Number of boundary vertices by which the present embedding was pinned.
    pinned: usize,
    /// True if the whole boundary was pinned.
    is_all_pinned: bool,
    trial: Trial,
    /// Reasons for failed solves.
    notes: Notes,
}

/// Embedding that is being extended.
#[derive(Debug, Default)]
struct Trial {
    extended: Option<Extended>,
    /// Last result.
    last: Option<Arc<VirtualBoundary>>,
    /// Number of weights tried on `extended`.
    tried: usize,
}

impl Default for Bend {
    fn default() -> Self {
        Self { pinned: 2, is_all_pinned: false, trial: Trial::default(), notes: Notes::default() }
    }
}

impl RunStage for Bend {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        let mut candidate = self.bent(from, control).map_err(|error| self.failure(error))?;
        candidate.solution.pins = Pins::new();
        candidate.bent_vertices = if self.pinned > 2 { self.pinned } else { 0 };
        Ok(Candidate { note: self.notes.take(), ..candidate })
    }

    fn has_more(&self, _: &Task, _: Option<&StepState>) -> bool {
        let has_tried_all = self.trial.extended.is_some() && self.trial.tried >= self.weights().len();
        !(self.is_all_pinned && has_tried_all)
    }

    fn relax_rounds_after(&self, task: &Task, step: &Step) -> usize {
        let is_bent = task.settings.method == Method::Auto && step.candidate.bent_vertices > 0;
        if is_bent { ROUNDS_AFTER_BENDING } else { 0 }
    }
}

impl Bend {
    /// Failure after all weights. The grid drawing, which needs no weights, may follow.
    fn failure(&mut self, error: SolveError) -> StageFailure {
        match error {
            SolveError::Cancelled => error.into(),
            _ => StageFailure { error, handover: Some(Handover { note: self.notes.take(), embedding: None }) },
        }
    }

    fn weights(&self) -> &'static [Weights] {
        if self.is_all_pinned { TRIED_AT_LAST } else { TRIED_WHILE_FREE }
    }

    /// Tries the next weights on the extended embedding. If all were tried, or the boundary is not simple, pins more
    /// vertices.
    fn bent(
        &mut self,
        StageInput { task, mesh, latest }: StageInput<'_>,
        control: Control<'_>,
    ) -> Result<Candidate, SolveError> {
        if self.trial.extended.is_none() && self.trial.tried == 0 {
            let simple = latest.filter(|latest| latest.has_simple_boundary);
            self.trial.extended = simple.and_then(|latest| Extended::new(mesh, &latest.embedding));
        }
        while let (Some(extended), Some(&weights)) = (&self.trial.extended, self.weights().get(self.trial.tried)) {
            match self.peeled(mesh, extended, weights, control) {
                Ok(candidate) => {
                    self.trial.tried += 1;
                    self.trial.last.clone_from(&candidate.virtual_boundary);
                    return Ok(candidate);
                }
                Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
                Err(error) => {
                    self.trial.tried += 1;
                    self.notes.say(format!("the virtual boundary failed: {error}"));
                }
            }
        }
        self.pin_more(task, mesh, control)
    }

    /// Solves the natural boundary equations with more vertices on a circle.
    fn pin_more(&mut self, task: &Task, mesh: &DiskMesh, control: Control<'_>) -> Result<Candidate, SolveError> {
        let boundary = mesh.boundary_loop().len();
        while !self.is_all_pinned {
            let wanted = match task.settings.growth {
                Growth::Double => 2 * self.pinned,
                Growth::One => self.pinned + 1,
            };
            let pinned = wanted.min(boundary);
            let is_last = pinned == boundary;
            // With the whole boundary pinned, only weights that cannot fail are used.
            let family = if is_last { Family::MeanValue } else { task.settings.family() };
            let settings = Settings { treatment: Some(Treatment::Eliminate), ..Settings::new(Method::Natural, family) };
            let solved = solve_once(mesh, &settings, &fixed_pins(on_circle(mesh, pinned)), control);
            if solved == Err(SolveError::Cancelled) {
                return Err(SolveError::Cancelled);
            }
            (self.pinned, self.is_all_pinned) = (pinned, is_last);
            match solved {
                Err(error) => self.notes.say(format!("{pinned} boundary pins failed: {error}")),
                Ok(solution) => {
                    self.trial = Trial::default();
                    return Ok(Candidate::new(Stage::VirtualBoundary, family, solution));
                }
            }
        }
        Err(SolveError::AllBent)
    }

    /// Solves for mesh and outside together, and removes the outside.
    fn peeled(
        &self,
        mesh: &DiskMesh,
        extended: &Extended,
        weights: Weights,
        control: Control<'_>,
    ) -> Result<Candidate, SolveError> {
        let start = Instant::now();
        let last = self.trial.last.as_ref().filter(|_| weights == Weights::Again);
        let from = last.map_or(&extended.embedding, |last| &last.solved);
        let has_pockets = !extended.pockets.is_empty();
        let (equations, residuals) = match weights {
            // The theorem holds for triangles.
            Weights::Surface if !has_pockets => (barycentric(&mesh.without_polygons(), 0.0, control)?, None),
            Weights::Uniform => (uniform(&extended.disk), None),
            _ => (
                mean_value_in_plane(&extended.disk, from, control)?,
                Some(residuals_in_plane(&extended.disk, from, control)?),
            ),
        };
        let (solved, linear) = extended.solve(equations, from, residuals.as_deref(), control)?;
        let embedding = Embedding::of_mesh(mesh, &solved);
        let stages = VirtualBoundary {
            pinned: self.pinned,
            outline: extended.outline,
            before: from.clone(),
            weights_of_before: residuals.is_some(),
            hull: extended.disk.boundary_loop().to_vec(),
            pockets: extended.pockets.clone(),
            solved,
        };
        let solution = Solution {
            embedding,
            pins: Pins::new(),
            gauge_completed: true,
            linear: Some(linear),
            convergence: None,
            seconds: PhaseSeconds { solve: start.elapsed().as_secs_f64(), ..PhaseSeconds::default() },
        };
        let candidate = Candidate::new(Stage::VirtualBoundary, Family::MeanValue, solution);
        Ok(Candidate { virtual_boundary: Some(Arc::new(stages)), ..candidate })
    }
}

/// Boundary vertices, evenly chosen along the loop, on a circle as long as the boundary. Their gaps are proportional
/// to lengths along the boundary, with a lower bound.
fn on_circle(mesh: &DiskMesh, count: usize) -> PinPositions {
    let boundary = mesh.boundary_loop();
    let chosen: Vec<usize> = (0..count).map(|j| j * boundary.len() / count).collect();
    let edge = |place: usize| mesh.length([place, place + 1].map(|p| boundary[p % boundary.len()]));
    let end = |j: usize| chosen.get(j + 1).copied().unwrap_or(boundary.len());
    let lengths: Vec<f64> = (0..count).map(|j| (chosen[j]..end(j)).map(edge).sum()).collect();
    let total: f64 = lengths.iter().sum();
    let floor = LEAST_SHARE * total / count as f64;
    let lengths: Vec<f64> = lengths.into_iter().map(|length| length.max(floor)).collect();
    let widened: f64 = lengths.iter().sum();
    let mut walked = 0.0;
    let mut places = PinPositions::new();
    for (place, length) in chosen.into_iter().zip(lengths) {
        places.insert(boundary[place], DVec2::from_angle(walked / widened * TAU) * (total / TAU));
        walked += length;
    }
    places
}
