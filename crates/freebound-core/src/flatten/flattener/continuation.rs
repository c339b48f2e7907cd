//! Stage 4: moves a planar start to the best fit to the constraints, then towards them, one-to-one at every step.

use std::sync::Arc;
use std::time::Instant;

use super::relax::MODERATE_ENERGY;
use super::stage::{Handover, RunStage, StageFailure, StageInput, StepState};
use super::task::Task;
use super::{Candidate, Ending, PlanarStart, Step};
use crate::bijective::continuation::Continuation;
use crate::bijective::relaxing::Relaxing;
use crate::flatten::placing::Placing;
use crate::mesh::DiskMesh;
use crate::problem::{Control, Embedding, Pins, SolveError, Stage};

/// Rounds of relaxing afterwards: the first result is not the best.
const ROUNDS: usize = 3;
/// Rounds of relaxing afterwards if the planar start had a high energy: its boundary was far from the best.
const ROUNDS_FROM_HIGH_ENERGY: usize = 5;
/// Rounds of relaxing afterwards if a coarse disk met the constraints first: all levels were relaxed on the way, and
/// further rounds of the whole mesh lower the energy by less than 1 %.
const ROUNDS_FROM_COARSE: usize = 1;
/// Rounds of relaxing afterwards if springs have yet to pull.
const ROUNDS_WITH_SPRINGS: usize = 30;

/// Most rounds of relaxing until a planar start can be moved to its best fit.
const ROUNDS_BEFORE_FITTING: usize = 30;

fn rounds_after(task: &Task) -> usize {
    if task.held().values().any(|pin| !pin.kind.is_hard()) { ROUNDS_WITH_SPRINGS } else { ROUNDS }
}

/// Stage that moves the planar start to its best fit.
#[derive(Debug)]
pub(super) struct Fit {
    /// Start from an earlier flattener. `None`: the latest step.
    pub(super) start: Option<Arc<PlanarStart>>,
    pub(super) is_done: bool,
}

impl RunStage for Fit {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        let StageInput { task, mesh, latest } = from;
        let began = Instant::now();
        let of_latest = || {
            let embedding = latest?.embedding.clone();
            Some(Arc::new(PlanarStart::new(task, embedding)))
        };
        let start = self.start.clone().or_else(of_latest).ok_or(SolveError::NotPlanar)?;
        let held = task.held();
        let embedding = fitted(task, mesh, &start.embedding, control)?;
        control.go_on()?;
        self.is_done = true;
        let progress = Continuation::new(mesh, embedding.clone(), &held).progress(mesh);
        let candidate = Candidate::one_to_one(Stage::Continuation, embedding, &held);
        Ok(Candidate { progress: Some(progress), planar_start: Some(start), ..candidate.since(began) })
    }

    fn has_more(&self, _: &Task, _: Option<&StepState>) -> bool {
        !self.is_done
    }

    fn relax_rounds_after(&self, task: &Task, _: &Step) -> usize {
        rounds_after(task)
    }
}

/// Embedding at its best fit to the pins. If it would fold there, it is relaxed until it does not; if relaxing
/// converges first, it stays in place.
fn fitted(task: &Task, mesh: &DiskMesh, start: &Embedding, control: Control<'_>) -> Result<Embedding, SolveError> {
    let held = task.held();
    let holds = |placed: &Embedding| control.go_on().map(|()| task.frame.is_one_to_one(mesh, placed));
    let fit = |embedding: &Embedding| Placing::fitting(embedding, &held).best(embedding, holds);
    let mut placed = fit(start)?;
    let mut relaxing = Relaxing::new(mesh, start.clone(), &Pins::new());
    for _ in 0..ROUNDS_BEFORE_FITTING {
        if placed.is_as_wished || relaxing.has_converged {
            break;
        }
        match relaxing.round(mesh, control) {
            Ok(relaxed) => placed = fit(&relaxed.embedding)?,
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            Err(_) => break,
        }
    }
    Ok(placed.embedding)
}

#[derive(Debug, Default)]
pub(super) struct Continue {
    stage: ContinuationPhase,
    /// True if the latest step left the embedding unchanged.
    has_stayed: bool,
    /// True if the planar start had a high energy.
    is_from_high_energy: bool,
    /// True if a coarse disk met the constraints first.
    is_from_coarse: bool,
}

impl Continue {
    /// Stage that returns its initial embedding unchanged if that meets all constraints.
    pub(super) fn staying() -> Self {
        Self { stage: ContinuationPhase::Stay, ..Self::default() }
    }

    /// Initial embedding, if it meets all constraints.
    fn stay(from: StageInput<'_>) -> Option<Candidate> {
        let StageInput { task, mesh, latest } = from;
        let (began, held) = (Instant::now(), task.held());
        let is_met =
            |latest: &&StepState| held.values().all(|pin| pin.kind.is_hard()) && task.are_met(&latest.embedding);
        let embedding = latest.filter(is_met)?.embedding.clone();
        let progress = Some(Continuation::new(mesh, embedding.clone(), &held).progress(mesh));
        Some(Candidate { progress, ..Candidate::one_to_one(Stage::Continuation, embedding, &held).since(began) })
    }
}

#[derive(Debug, Default)]
enum ContinuationPhase {
    /// Return the initial embedding if it meets the constraints.
    Stay,
    #[default]
    Begin,
    UnderWay(Box<Continuation>),
    /// No step gets closer to the targets.
    Stuck,
}

impl RunStage for Continue {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        let StageInput { task, mesh, latest } = from;
        let (began, held) = (Instant::now(), task.held());
        self.has_stayed = false;
        if let ContinuationPhase::Stay = self.stage {
            self.stage = ContinuationPhase::Begin;
            if let Some(candidate) = Self::stay(from) {
                self.has_stayed = true;
                return Ok(candidate);
            }
        }
        if let ContinuationPhase::Begin = self.stage {
            let start = latest.ok_or(SolveError::NotPlanar)?.embedding.clone();
            control.go_on()?;
            let frame = Arc::clone(&task.frame);
            let mut continuation = Box::new(Continuation::new(mesh, start, &held).with_output_frame(frame));
            self.is_from_high_energy = continuation.progress(mesh).energy > MODERATE_ENERGY;
            let met = continuation.by_way_of_coarse(mesh, control)?;
            self.stage = ContinuationPhase::UnderWay(continuation);
            if let Some(advance) = met {
                self.is_from_coarse = true;
                return Ok(Candidate::of_advance(Stage::Continuation, advance, &held).since(began));
            }
        }
        let ContinuationPhase::UnderWay(continuation) = &mut self.stage else {
            // The next stage may still meet the constraints.
            return Err(StageFailure { error: SolveError::Unmet, handover: Some(Handover::default()) });
        };
        // If it has arrived but another step is requested, the embedding folds in the written numbers.
        let next = if continuation.is_at_its_end() { Err(SolveError::Unmet) } else { continuation.step(mesh, control) };
        match next {
            Ok(advance) => return Ok(Candidate::of_advance(Stage::Continuation, advance, &held).since(began)),
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled.into()),
            // Every other error also means stuck.
            Err(_) => {}
        }
        let is_crushed = continuation.go_back_to_sound();
        let (embedding, progress) = (continuation.embedding.clone(), continuation.progress(mesh));
        self.stage = ContinuationPhase::Stuck;
        if is_crushed && !task.adds_vertices() {
            let candidate = Candidate::one_to_one(Stage::Continuation, embedding, &held).since(began);
            return Ok(Candidate { progress: Some(progress), ..candidate });
        }
        let handover = Handover { embedding: Some(embedding), ..Handover::default() };
        Err(StageFailure { error: SolveError::Unmet, handover: Some(handover) })
    }

    fn has_more(&self, _: &Task, _: Option<&StepState>) -> bool {
        true
    }

    fn relax_rounds_after(&self, task: &Task, _: &Step) -> usize {
        match rounds_after(task) {
            _ if self.has_stayed => 0,
            ROUNDS if self.is_from_high_energy => ROUNDS_FROM_HIGH_ENERGY,
            ROUNDS if self.is_from_coarse => ROUNDS_FROM_COARSE,
            rounds => rounds,
        }
    }

    fn ending(&self, _: &Task) -> Ending {
        Ending::Unmet
    }
}
