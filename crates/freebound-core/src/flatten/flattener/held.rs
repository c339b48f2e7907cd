//! Stage 4 if the whole boundary is pinned: starts from an embedding whose boundary follows the targets, not from a
//! free one.
//!
//! If the polygon of the targets is convex, the mean-value equations with a fixed boundary give a planar embedding by
//! theorem (Floater 1997), and often also if it is not convex. Otherwise the boundary starts on a circle, its vertices
//! spaced in proportion to their targets. If faces between boundary vertices would turn over, the edges of these faces
//! get new vertices.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;

use super::stage::{RunStage, StageFailure, StageInput, StepState, tried};
use super::task::Task;
use super::{Candidate, Step};
use crate::bijective::clearance::with_boundary_clearance;
use crate::bijective::continuation::Continuation;
use crate::bijective::matchmaker::{Matched, simplified};
use crate::flatten::solve_once;
use crate::geom::{Similarity, is_simple, turning_number};
use crate::linear::convex::on_shape;
use crate::mesh::{DiskMesh, Refinement};
use crate::problem::{
    BoundaryShape, Control, Embedding, Family, Method, Pins, Settings, SolveError, Spacing, Stage, Treatment,
    fixed_pins,
};

/// Rounds of relaxing after the targets are met: the first result is not the best.
const ROUNDS: usize = 3;

/// Most steps of continuation with new vertices.
const MOST_STEPS: usize = 60;

#[derive(Debug, Default)]
pub(super) struct HeldBoundary {
    is_done: bool,
}

impl RunStage for HeldBoundary {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        let began = Instant::now();
        let found = tried(begun(from, control))?;
        self.is_done = true;
        found.map(|candidate| candidate.since(began)).ok_or_else(|| StageFailure::in_silence(SolveError::Unmet))
    }

    fn has_more(&self, _: &Task, _: Option<&StepState>) -> bool {
        !self.is_done
    }

    fn relax_rounds_after(&self, _: &Task, _: &Step) -> usize {
        ROUNDS
    }
}

/// Initial one-to-one embedding. `None` if part of the boundary is not pinned, its targets do not form a simple
/// polygon, or rounding prevents it.
fn begun(StageInput { task, mesh, .. }: StageInput<'_>, control: Control<'_>) -> Result<Option<Candidate>, SolveError> {
    let held = task.held();
    let Some(targets) = targets_of_boundary(mesh, &held) else { return Ok(None) };
    if !is_simple(&targets) || turning_number(&targets) != Some(1) {
        return Ok(None);
    }
    // For other output frames, stage 5 adds the vertices.
    if task.adds_vertices()
        && task.frame.is_plain()
        && let Some(refinement) = with_boundary_clearance(mesh, &targets)
    {
        return with_new_vertices(task, mesh, refinement, control);
    }
    let Some((embedding, note)) = begun_on(task, mesh, &targets, control)? else { return Ok(None) };
    let progress = Continuation::new(mesh, embedding.clone(), &held).progress(mesh);
    let candidate = Candidate::one_to_one(Stage::Continuation, embedding, &held);
    Ok(Some(Candidate { progress: Some(progress), note: Some(note.to_owned()), ..candidate }))
}

/// Embedding that meets the targets on a mesh with boundary clearance, without the new vertices that are not needed.
/// `None` if it gets stuck.
fn with_new_vertices(
    task: &Task,
    mesh: &DiskMesh,
    refinement: Refinement,
    control: Control<'_>,
) -> Result<Option<Candidate>, SolveError> {
    let (disk, held) = (refinement.disk(), task.held());
    let Some(targets) = targets_of_boundary(disk, &held) else { return Ok(None) };
    let Some((start, _)) = begun_on(task, disk, &targets, control)? else { return Ok(None) };
    let mut continuation = Continuation::new(disk, start, &held).with_output_frame(Arc::clone(&task.frame));
    for _ in 0..MOST_STEPS {
        continuation.step(disk, control)?;
        if continuation.is_at_its_end() {
            let embedding = continuation.embedding;
            let refined = Matched { refinement: Arc::new(refinement), embedding };
            let Matched { refinement, embedding } = simplified(mesh, refined, control)?;
            let candidate = Candidate::one_to_one(Stage::Matchmaker, embedding, &held);
            let note = Some("new vertices on edges between boundary vertices".to_owned());
            return Ok(Some(Candidate { refinement: Some(refinement), note, ..candidate }));
        }
    }
    Ok(None)
}

/// Initial one-to-one embedding with the whole boundary on its targets or else on a circle, and a note of which.
fn begun_on(
    task: &Task,
    mesh: &DiskMesh,
    targets: &[DVec2],
    control: Control<'_>,
) -> Result<Option<(Embedding, &'static str)>, SolveError> {
    let is_one_to_one = |embedding: &Embedding| task.frame.is_one_to_one(mesh, embedding);
    let at_once = with_boundary_at(mesh, targets, control)?.filter(is_one_to_one);
    Ok(if let Some(embedding) = at_once {
        Some((embedding, "mean-value equations with the whole boundary on its targets"))
    } else {
        let Some(circle) = on_circle(mesh, targets)? else { return Ok(None) };
        let round = with_boundary_at(mesh, &circle, control)?.filter(is_one_to_one);
        round.map(|round| (round, "the whole boundary starts on a circle"))
    })
}

/// Points on the circle that fits the targets best, spaced in proportion to the targets.
fn on_circle(mesh: &DiskMesh, targets: &[DVec2]) -> Result<Option<Vec<DVec2>>, SolveError> {
    let next = targets.iter().cycle().skip(1);
    let lengths: Vec<f64> = targets.iter().zip(next).map(|(a, b)| a.distance(*b)).collect();
    let circle = on_shape(mesh, &lengths, &BoundaryShape::Circle, Spacing::Chord)?;
    let pairs: Vec<[DVec2; 2]> = circle.iter().zip(targets).map(|(&from, &to)| [from, to]).collect();
    Ok(Similarity::fitting(&pairs).map(|way| circle.into_iter().map(|z| way.apply(z)).collect()))
}

/// Targets of the boundary. `None` if part of it is not held by hard pins.
fn targets_of_boundary(mesh: &DiskMesh, held: &Pins) -> Option<Vec<DVec2>> {
    let target = |vertex| held.get(vertex).filter(|pin| pin.kind.is_hard()).map(|pin| pin.target);
    mesh.boundary_loop().iter().map(target).collect()
}

/// Mean-value embedding with the boundary at the given points.
fn with_boundary_at(mesh: &DiskMesh, places: &[DVec2], control: Control<'_>) -> Result<Option<Embedding>, SolveError> {
    let settings =
        Settings { treatment: Some(Treatment::Eliminate), ..Settings::new(Method::Natural, Family::MeanValue) };
    let pins = fixed_pins(mesh.boundary_loop().iter().copied().zip(places.iter().copied()));
    match solve_once(mesh, &settings, &pins, control) {
        Err(SolveError::Cancelled) => Err(SolveError::Cancelled),
        solved => Ok(solved.ok().map(|solution| solution.embedding)),
    }
}
