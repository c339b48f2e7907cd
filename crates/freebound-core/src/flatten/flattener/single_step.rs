//! Stages of a single step each: the given layout, linear solves, the grid drawing, and the cut of concave polygons.

use std::sync::Arc;
use std::time::Instant;

use super::stage::{Attained, RunStage, StageFailure, StageInput, StepState};
use super::task::Task;
use super::{Candidate, Step};
use crate::bijective::{Padded, schnyder};
use crate::flatten::{Prepared, solve_once};
use crate::linear::{Spectral, spectral};
use crate::mesh::Refinement;
use crate::nonlinear::{AngleMap, AngleSystem, angle_based};
use crate::problem::{Control, Family, Method, Pins, Settings, SolveError, Stage};

/// Given layout: the first step, unchanged.
#[derive(Debug, Default)]
pub(super) struct Given;

impl RunStage for Given {
    fn step(&mut self, from: StageInput<'_>, _: Control<'_>) -> Result<Candidate, StageFailure> {
        let began = Instant::now();
        let start = from.task.start.as_ref().ok_or(SolveError::NotPlanar)?;
        let pins = if from.task.is_constrained() { from.task.held() } else { Pins::new() };
        let stage = if from.task.start_is_free { Stage::Seams } else { Stage::Given };
        Ok(Candidate::one_to_one(stage, start.as_ref().clone(), &pins).since(began))
    }

    fn has_more(&self, task: &Task, latest: Option<&StepState>) -> bool {
        task.start.is_some() && latest.is_none()
    }
}

/// Single linear solve of the requested method. For `auto`, the natural boundary (paper §3.3).
#[derive(Debug)]
pub(super) struct Natural {
    /// Equations and factors, from an earlier solve or from a step that did not finish.
    pub(super) prepared: Option<Arc<Prepared>>,
}

impl RunStage for Natural {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        let Task { settings, pins, .. } = from.task;
        let prepared = match self.prepared.take().filter(|prepared| prepared.serves(settings, pins)) {
            Some(prepared) => prepared,
            None => Arc::new(Prepared::new(from.mesh, settings, pins, control).map_err(natural_failure)?),
        };
        let solved = prepared.solve_unplaced(from.mesh, pins, control);
        if solved.is_err() {
            self.prepared = Some(Arc::clone(&prepared));
        }
        let solution = solved.map_err(natural_failure)?;
        let stage = Stage::of_linear_solve(&settings.method);
        Ok(Candidate { prepared: Some(prepared), ..Candidate::new(stage, settings.family(), solution) })
    }

    fn has_more(&self, _: &Task, latest: Option<&StepState>) -> bool {
        latest.is_none()
    }
}

/// Failures of the system are left to other stages; errors of the request are final.
fn natural_failure(error: SolveError) -> StageFailure {
    if error.is_failure_of_method() { StageFailure::of("the natural boundary", error) } else { error.into() }
}

/// Second natural boundary, with conformal weights and default pins, moved to the user's pins.
///
/// This stage is our addition. The virtual boundary keeps a simple boundary and bends any other to a circle. If other
/// weights or pins were requested, this solve comes first. The default ones give a simple boundary far more often, and
/// it stays free.
#[derive(Debug, Default)]
pub(super) struct Again {
    is_done: bool,
}

impl RunStage for Again {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        let settings = Settings { size: from.task.settings.size, ..Settings::new(Method::Natural, Family::default()) };
        let mut solution = solve_once(from.mesh, &settings, &Pins::new(), control)
            .map_err(|error| StageFailure::of("the restart", error))?;
        self.is_done = true;
        solution.pins = Pins::new();
        let note = "restarted with conformal weights and the farthest boundary vertices as pins".to_owned();
        Ok(Candidate { note: Some(note), ..Candidate::new(Stage::Natural, settings.family(), solution) })
    }

    fn has_more(&self, task: &Task, latest: Option<&StepState>) -> bool {
        let is_other = task.settings.family() != Family::default() || !task.pins.is_empty();
        is_other && !self.is_done && latest.is_none_or(|latest| !latest.has_simple_boundary)
    }
}

/// Lee's virtual boundary: layers around the mesh on a convex shape, one solve, peeled.
#[derive(Debug, Default)]
pub(super) struct Pad {
    is_done: bool,
}

impl RunStage for Pad {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        let settings = &from.task.settings;
        let padded = Padded::new(from.mesh, settings.layers);
        let (solution, outside) = padded.solve(settings, control)?;
        self.is_done = true;
        let candidate = Candidate::new(
            Stage::Lee(settings.method.boundary_shape().cloned().unwrap_or_default()),
            settings.family(),
            solution,
        );
        Ok(Candidate { outside: Some(Arc::new(outside)), ..candidate })
    }

    fn has_more(&self, _: &Task, latest: Option<&StepState>) -> bool {
        !self.is_done && latest.is_none()
    }
}

/// Spectral conformal map. Pins are ignored.
#[derive(Debug, Default)]
pub(super) struct Eigenvector {
    is_done: bool,
}

impl RunStage for Eigenvector {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        let Spectral { solution, eigenvalue } = spectral(from.mesh, control)?;
        self.is_done = true;
        let note = solution
            .convergence
            .map(|found| format!("eigenvalue {eigenvalue:.3e} after {} solves: {}", found.steps, found.stop.words()));
        Ok(Candidate { note, ..Candidate::new(Stage::Spectral, Family::default(), solution) })
    }

    fn has_more(&self, _: &Task, _: Option<&StepState>) -> bool {
        !self.is_done
    }
}

/// Angle based flattening. Pins are ignored.
#[derive(Debug, Default)]
pub(super) struct Angles {
    is_done: bool,
}

impl RunStage for Angles {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        let (stage, system) = match from.task.settings.method {
            Method::Abf => (Stage::Abf, AngleSystem::Full),
            _ => (Stage::AbfPlusPlus, AngleSystem::Reduced),
        };
        let found = angle_based(from.mesh, system, control)?;
        self.is_done = true;
        let note = angle_note(&found);
        Ok(Candidate { note, ..Candidate::new(stage, Family::default(), found.solution) })
    }

    fn has_more(&self, _: &Task, _: Option<&StepState>) -> bool {
        !self.is_done
    }
}

fn angle_note(found: &AngleMap) -> Option<String> {
    let convergence = found.solution.convergence?;
    let steps = format!("{} Newton steps: {}", convergence.steps, convergence.stop.words());
    let left = format!("conditions on the angles met to {:.1e}, energy {:.4e}", convergence.residual, found.energy);
    let held = if found.barrier > 0.0 {
        format!(", with a barrier of weight {:.2} that keeps {} angles from 0", found.barrier, found.held)
    } else {
        String::new()
    };
    Some(format!("{steps}, {left}{held}"))
}

/// Rounds of relaxing after the grid drawing, whose faces are far from their shapes.
const ROUNDS_AFTER_DRAWING: usize = 100;

/// Schnyder's grid drawing: planar by theorem when every linear solve runs out of digits.
#[derive(Debug, Default)]
pub(super) struct Draw {
    is_done: bool,
}

impl RunStage for Draw {
    fn step(&mut self, from: StageInput<'_>, _: Control<'_>) -> Result<Candidate, StageFailure> {
        let began = Instant::now();
        self.is_done = true;
        Ok(Candidate::one_to_one(Stage::Schnyder, schnyder(from.mesh), &Pins::new()).since(began))
    }

    fn has_more(&self, _: &Task, _: Option<&StepState>) -> bool {
        !self.is_done
    }

    fn relax_rounds_after(&self, _: &Task, _: &Step) -> usize {
        ROUNDS_AFTER_DRAWING
    }
}

/// Cut of concave polygons into triangles, after a step without any other fault.
///
/// A polygon cannot be convex if only two polygons meet at an inner vertex, or if hard pins fix its corners so. The
/// triangles of the polygon are positive. Once it is cut into them, other programs cannot cut it otherwise.
#[derive(Debug, Default)]
pub(super) struct Cut;

impl RunStage for Cut {
    fn step(
        &mut self,
        StageInput { mesh, latest, .. }: StageInput<'_>,
        _: Control<'_>,
    ) -> Result<Candidate, StageFailure> {
        let began = Instant::now();
        let latest = latest.ok_or(SolveError::NotPlanar)?;
        let concave = &latest.concave_polygons;
        let refinement = match &latest.refinement {
            Some(refinement) => (**refinement).clone().without_polygons(concave),
            None => Refinement::of_cut_polygons(mesh, concave).map_err(|_| SolveError::NotPlanar)?,
        };
        let note = match concave.len() {
            1 => "1 polygon cannot be convex: cut into triangles".to_owned(),
            count => format!("{count} polygons cannot be convex: cut into triangles"),
        };
        let candidate = Candidate::one_to_one(Stage::Cut, latest.embedding.clone(), &latest.pins).since(began);
        Ok(Candidate { refinement: Some(Arc::new(refinement)), note: Some(note), ..candidate })
    }

    fn has_more(&self, task: &Task, latest: Option<&StepState>) -> bool {
        task.cuts_polygons()
            && latest.is_some_and(|latest| {
                latest.attained == Attained::AllButPolygons && !latest.concave_polygons.is_empty()
            })
    }
}
