//! The steps of the virtual boundary method (paper §5).
//!
//! ```text
//! while the boundary is not simple: pin more of its vertices to a circle, solve the natural boundary equations
//! extend the embedding up to a convex outline, solve the mean-value equations with the outline fixed, peel
//! ```
//!
//! With all boundary vertices pinned the boundary is simple, so the method ends planar where numbers are exact. What can
//! still go wrong is rounding: a solve that collapses faces. Then it is repeated with weights from its own result, which squeeze less, and at the
//! very end with weights from the surface and with equal weights.

use std::f64::consts::TAU;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;

use super::equations::{barycentric, uniform};
use super::plane_weights::{mean_value_in_plane, residuals_in_plane};
use super::virtual_boundary::{Extended, Start, VirtualBoundary};
use super::{
    Control, Embedding, Family, Growth, LinearSolve, Method, PhaseSeconds, PinPositions, Pins, Prepared, Settings,
    Solution, SolveError, Treatment, fixed_pins,
};
use crate::mesh::DiskMesh;

/// Least share of the circle between neighbouring pins, relative to an even share: in 64 bits they must stay apart,
/// and the polygon strictly convex.
const LEAST_SHARE: f64 = 0.2;

/// Weights that an extended embedding is solved with, in the order in which they are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Weights {
    /// Mean value, from the embedding before.
    Before,
    /// Mean value, from the last result.
    Again,
    /// Mean value, from the surface in space.
    Surface,
    /// All equal.
    Uniform,
}

/// While the boundary is free, or partly so.
const TRIED_WHILE_FREE: &[Weights] = &[Weights::Before, Weights::Again, Weights::Again];

/// When all of it is pinned, and nothing comes after.
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

/// The method under way.
#[derive(Debug)]
pub(super) struct VirtualBoundaryRun {
    settings: Settings,
    /// Boundary vertices that the embedding at hand was pinned by.
    pinned: usize,
    /// Length of the boundary.
    boundary: usize,
    extended: Option<Extended>,
    /// The last result, with the outside.
    solved: Embedding,
    /// How many weights have been tried on `extended`.
    tried: usize,
    /// Whether nothing is left to do.
    is_exhausted: bool,
    /// What gave nothing, and why.
    notes: Vec<String>,
}

/// What a step gave.
pub(super) struct Bent {
    pub(super) solution: Solution,
    pub(super) pinned: usize,
    pub(super) family: Family,
    pub(super) stages: Option<Arc<VirtualBoundary>>,
}

impl VirtualBoundaryRun {
    pub(super) fn new(mesh: &DiskMesh, settings: &Settings) -> Self {
        let boundary = mesh.boundary_loop().len();
        Self {
            settings: *settings,
            pinned: 2,
            boundary,
            extended: None,
            solved: Embedding::default(),
            tried: 0,
            is_exhausted: false,
            notes: Vec::new(),
        }
    }

    /// Whether nothing is left to do.
    pub(super) fn is_exhausted(&self) -> bool {
        let has_tried_all = self.extended.is_some() && self.tried >= self.weights().len();
        self.is_exhausted || (self.pinned >= self.boundary && has_tried_all)
    }

    /// What gave nothing since the last call, and why.
    pub(super) fn take_notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }

    fn weights(&self) -> &'static [Weights] {
        if self.pinned < self.boundary { TRIED_WHILE_FREE } else { TRIED_AT_LAST }
    }

    /// Takes a step. `simple` is the embedding at hand, where its boundary is simple; it is looked at once.
    pub(super) fn step(
        &mut self,
        mesh: &DiskMesh,
        simple: Option<&Embedding>,
        control: Control<'_>,
    ) -> Result<Bent, SolveError> {
        if self.extended.is_none() && self.tried == 0 {
            self.extended = simple.and_then(|embedding| Extended::new(mesh, embedding));
        }
        while let (Some(extended), Some(&weights)) = (&self.extended, self.weights().get(self.tried)) {
            self.tried += 1;
            match bend(mesh, extended, (weights, &self.solved, self.pinned), control) {
                Ok(bent) => {
                    self.solved.clone_from(&bent.stages.as_ref().expect("bending has stages").solved);
                    return Ok(bent);
                }
                Err(SolveError::Cancelled) => {
                    self.tried -= 1;
                    return Err(SolveError::Cancelled);
                }
                Err(error) => self.notes.push(format!("the virtual boundary gave nothing: {error}")),
            }
        }
        self.pin_more(mesh, control)
    }

    /// Solves the natural boundary equations with more vertices on a circle.
    fn pin_more(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Bent, SolveError> {
        loop {
            if self.pinned >= self.boundary {
                self.is_exhausted = true;
                return Err(SolveError::LadderExhausted);
            }
            let wanted = match self.settings.growth {
                Growth::Double => 2 * self.pinned,
                Growth::One => self.pinned + 1,
            };
            let pinned = wanted.min(self.boundary);
            let is_last = pinned == self.boundary;
            // At last only weights that cannot fail will do.
            let family = if is_last { Family::MeanValue } else { self.settings.family };
            let settings = Settings { treatment: Some(Treatment::Eliminate), ..Settings::new(Method::Natural, family) };
            let pins = fixed_pins(on_circle(mesh, pinned));
            let solved = Prepared::new(mesh, &settings, &pins, control).and_then(|p| p.solve(mesh, &pins, control));
            match solved {
                Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
                Err(error) => self.notes.push(format!("{pinned} boundary pins gave nothing: {error}")),
                Ok(solution) => {
                    (self.pinned, self.extended, self.tried) = (pinned, None, 0);
                    self.solved = Embedding::default();
                    return Ok(Bent { solution, pinned, family, stages: None });
                }
            }
            self.pinned = pinned;
        }
    }
}

/// Extends, solves and peels.
fn bend(
    mesh: &DiskMesh,
    extended: &Extended,
    (weights, solved, pinned): (Weights, &Embedding, usize),
    control: Control<'_>,
) -> Result<Bent, SolveError> {
    let start = Instant::now();
    let from = if weights == Weights::Again && !solved.is_empty() { solved } else { &extended.embedding };
    let has_pockets = !extended.pockets.is_empty();
    let (equations, residuals) = match weights {
        Weights::Surface if !has_pockets => (barycentric(mesh, 0.0)?, None),
        Weights::Uniform => (uniform(&extended.disk), None),
        _ => (mean_value_in_plane(&extended.disk, from), Some(residuals_in_plane(&extended.disk, from))),
    };
    let bounded_corners = equations.bounded_corners;
    let start_at = Start { embedding: from, residuals: residuals.as_deref() };
    let (solved, residual, stats) = extended.solve(&equations, start_at, control)?;
    let embedding = Embedding::of_mesh(mesh, &solved);
    let stages = VirtualBoundary {
        pinned,
        outline: extended.outline,
        before: from.clone(),
        weights_of_before: residuals.is_some(),
        hull: extended.disk.boundary_loop().to_vec(),
        pockets: extended.pockets.clone(),
        solved,
    };
    let seconds = PhaseSeconds { solve: start.elapsed().as_secs_f64(), ..PhaseSeconds::default() };
    let solution = Solution {
        embedding,
        pins: Pins::new(),
        gauge_completed: true,
        linear: Some(LinearSolve {
            residual,
            // All equations of the extended mesh are solved; those of the outline are prescribed.
            equation_residual: extended.equation_residual(&equations, &stages.solved),
            replaced_pivots: stats.replaced_pivots,
            bounded_corners,
            factor_bytes: stats.factor_bytes,
        }),
        seconds,
    };
    Ok(Bent { solution, pinned, family: Family::MeanValue, stages: Some(Arc::new(stages)) })
}

/// Boundary vertices on a circle as long as the boundary, evenly chosen along the loop, at distances that follow the
/// lengths between them.
fn on_circle(mesh: &DiskMesh, count: usize) -> PinPositions {
    let boundary = mesh.boundary_loop();
    let chosen: Vec<usize> = (0..count).map(|j| j * boundary.len() / count).collect();
    let edge = |place: usize| {
        let [a, b] = [place, place + 1].map(|p| mesh.position(boundary[p % boundary.len()]));
        a.distance(b)
    };
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
