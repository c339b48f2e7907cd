//! Relaxing of a planar embedding: rounds of lower distortion.
//!
//! `auto` continues with them until the embedding is *usable*: planar in 32 bits, as most programs read it, and of
//! moderate energy, and without a face that shrank to a hundredth, so that a picture on it keeps some texels
//! everywhere. A given planar layout stays unchanged.
//!
//! A planar start, from which constraints are met, need not be usable. Its rounds end as soon as it serves as a start:
//! relaxing follows once, after the constraints are met.

use std::sync::Arc;
use std::time::Instant;

use super::matchmaker::is_tangle;
use super::stage::{Attained, PhaseGoal, RunStage, StageFailure, StageInput, StepState};
use super::task::Task;
use super::{Candidate, Step};
use crate::bijective::relaxing::Relaxing;
use crate::problem::{Control, PinKind, Pins, Progress, SolveError, Stage};
use crate::verify::DistortionSummary;

/// Largest mean symmetric Dirichlet energy that is moderate. The minimum is 4.
pub(super) const MODERATE_ENERGY: f64 = 20.0;

/// Largest energy of a planar start. Natural maps of heads reach 1,000. From maps of 50,000 constraints are met
/// with the final energy of a relaxed start; far above, faces lose their digits.
const MOST_ENERGY_OF_START: f64 = 1e4;

/// Distance from the origin, in sizes of the embedding, beyond which it is far. Far numbers have fewer digits.
const FAR: f64 = 8.0;

/// Numbers of rounds that may follow.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rounds {
    /// Rounds that follow in any case.
    pub(super) always: usize,
    /// Rounds that follow while the embedding is not usable.
    pub(super) until_it_serves: usize,
}

#[derive(Debug, Default)]
pub(super) struct Relax {
    relaxing: Option<Relaxing>,
    /// Rounds that may still follow.
    left: Rounds,
    /// Reason why the latest embedding is not usable.
    lack: Option<Shortfall>,
    /// True if constraints can be met from the latest embedding without further rounds.
    serves_as_start: bool,
    /// True if a round has failed, so that no further one follows.
    has_failed: bool,
    /// True if constraints are met afterwards.
    is_before_constraints: bool,
}

/// Reason why an embedding is not usable.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shortfall {
    /// Folds in 32 bits. `is_far` is true if it lies far from the origin.
    Digits { is_far: bool },
    /// High energy.
    Energy(f64),
    /// Face whose area on the surface is so many times its area in the plane.
    Shrunk(f64),
}

impl Shortfall {
    /// Reason why a step is not usable. Steps of a planar start may have any energy.
    fn of(step: &Step) -> Option<Self> {
        if step.verdict.planar && !step.verdict.planar_in_f32 {
            let bounds = step.candidate.solution.embedding.bounds();
            let vertices = step.candidate.solution.embedding.len() as f64;
            // A face of the drawing is at least 1/n of a grid cell high, and a cell is 1/n of the drawing.
            let far = FAR.max(0.5 / (f64::from(f32::EPSILON) * vertices * vertices));
            let is_far = bounds.middle().abs().max_element() > far * bounds.size().max_element();
            return Some(Self::Digits { is_far });
        }
        let Progress { energy, least_determinant, .. } =
            step.candidate.progress.filter(|_| !step.is_of_planar_start())?;
        // Relaxing would pull the map away from soft pins, for the sake of a few faces.
        let has_soft_pins = step.candidate.solution.pins.values().any(|pin| matches!(pin.kind, PinKind::Soft(_)));
        let shrunk = if has_soft_pins { 0.0 } else { least_determinant.recip() };
        if energy > MODERATE_ENERGY {
            Some(Self::Energy(energy))
        } else {
            (shrunk >= DistortionSummary::BAD_RATIO_OF_AREAS).then_some(Self::Shrunk(shrunk))
        }
    }

    fn words(self) -> String {
        match self {
            Self::Digits { .. } => "it does not hold in 32 bits".to_owned(),
            Self::Energy(energy) => format!("its energy is {energy:.0}, over {MODERATE_ENERGY}"),
            Self::Shrunk(ratio) => format!("a face shrank to 1/{ratio:.0} of its area"),
        }
    }
}

impl Relax {
    /// Relaxing in a phase with this goal.
    pub(super) fn of(aim: PhaseGoal) -> Self {
        Self { is_before_constraints: aim == PhaseGoal::PlanarStart, ..Self::default() }
    }

    /// Schedules rounds that start from the latest embedding.
    pub(super) fn begin(&mut self, rounds: Rounds) {
        (self.relaxing, self.left, self.has_failed) = (None, rounds, false);
    }

    /// Examines the step that rounds may follow.
    pub(super) fn look_at_start(&mut self, step: &Step) {
        self.examine(step);
        if step.candidate.refinement.as_deref().is_some_and(is_tangle) {
            // No number of rounds makes a tangle usable.
            self.left.until_it_serves = 0;
        }
    }

    fn examine(&mut self, step: &Step) {
        let is_low = step.candidate.progress.is_some_and(|progress| progress.energy <= MOST_ENERGY_OF_START);
        self.lack = Shortfall::of(step);
        self.serves_as_start = is_low && !self.folds_in_32_bits();
    }

    fn folds_in_32_bits(&self) -> bool {
        matches!(self.lack, Some(Shortfall::Digits { .. }))
    }

    /// True if a planar start would be relaxed further.
    pub(super) fn goes_on_for_start(&self) -> bool {
        self.folds_in_32_bits() || (self.left.always > 0 && !self.serves_as_start)
    }

    /// True if the latest embedding folds in 32 bits although it is not far from the origin.
    pub(super) fn is_too_fine(&self) -> bool {
        self.lack == Some(Shortfall::Digits { is_far: false })
    }

    fn round(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, SolveError> {
        let StageInput { task, mesh, latest } = from;
        let start = Instant::now();
        let latest = latest.ok_or(SolveError::NotPlanar)?;
        let refinement = latest.refinement.clone();
        let mesh = refinement.as_ref().map_or(mesh, |refinement| refinement.disk());
        // Up to two pins only place the embedding, which happens after the round.
        let is_constrained = task.is_constrained();
        let held = if is_constrained { task.held() } else { Pins::new() };
        let frame = if is_constrained { Arc::clone(&task.frame) } else { Arc::default() };
        let begin = || {
            let relaxing = Relaxing::new(mesh, latest.embedding.clone(), &held).with_output_frame(frame);
            if self.is_before_constraints { relaxing.before_constraints(mesh) } else { relaxing }
        };
        let relaxed = self.relaxing.get_or_insert_with(begin).round(mesh, control)?;
        let candidate = Candidate::of_advance(Stage::Relax, relaxed, &held);
        let lack = self.lack.filter(|_| self.left.always == 0);
        let note = lack.map(|lack| format!("relaxed because {}", lack.words()));
        Ok(Candidate { refinement, note, ..candidate.since(start) })
    }
}

impl RunStage for Relax {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        let error = match self.round(from, control) {
            Ok(candidate) => return Ok(candidate),
            Err(error) => error,
        };
        // A one-to-one embedding stays the result: a failure only ends the relaxing.
        let latest = from.latest.filter(|latest| latest.is_one_to_one && error != SolveError::Cancelled);
        let Some(StepState { embedding, pins, refinement, .. }) = latest else { return Err(error.into()) };
        self.has_failed = true;
        let note = Some(format!("relaxing failed: {error}; the previous embedding is kept"));
        let candidate = Candidate::one_to_one(Stage::Relax, embedding.clone(), pins);
        Ok(Candidate { refinement: refinement.clone(), note, ..candidate })
    }

    fn has_more(&self, _: &Task, latest: Option<&StepState>) -> bool {
        // Polygons that cannot be convex are cut.
        let may_serve = self.lack.is_some() && latest.is_none_or(|latest| latest.attained != Attained::AllButPolygons);
        // The filling of holes of a given layout may fold; relaxing cannot start from that.
        let may_begin = latest.is_none_or(|latest| latest.is_one_to_one || !latest.is_solved());
        let is_enough = self.is_before_constraints && self.serves_as_start;
        let is_wanted = (self.left.always > 0 && !is_enough) || (self.left.until_it_serves > 0 && may_serve);
        is_wanted
            && may_begin
            && !self.has_failed
            && !self.relaxing.as_ref().is_some_and(|relaxing| relaxing.has_converged)
    }

    fn observe(&mut self, step: &Step) {
        let left = if self.left.always > 0 { &mut self.left.always } else { &mut self.left.until_it_serves };
        *left = left.saturating_sub(1);
        self.examine(step);
    }
}
