//! The flattener: the steps of a method, one after another; for `auto` one stage after another until the embedding is planar.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | [`Flattener`]: walks the plan, proves each candidate, remembers the latest step |
//! | `strategy.rs` | the plan of every method: which stage follows which |
//! | `cache.rs` | what flatteners on a mesh have computed, for further ones |
//! | `sequence.rs` | the stages by name, and the sequences of them that plans are made of |
//! | `proof.rs` | a candidate proved in the numbers that are written of it: a step |
//! | `stage.rs` | what a stage is: from the latest step to a candidate, or to a reason why there is none |
//! | `task.rs` | what is asked for: settings and pins |
//! | `ending.rs` | why a flattener has come to its end |
//! | `step.rs` | [`Candidate`]: what a stage gives, before it is proved; [`Step`]: a candidate with its verdict |
//! | `continue_from.rs` | before all stages: a one-to-one embedding to go on from, or a step of another flattener's |
//! | `single_step.rs` | stages of one step: given layout, linear solves, grid drawing, cut of concave polygons |
//! | `iterate.rs` | stage 2: mean-value iterations, and when they get no better |
//! | `slim.rs` | Tutte's map, or a planar one of the flattener, iteration after iteration with less energy |
//! | `stretch.rs` | a convex boundary, solve after solve with less stretch |
//! | `coarse.rs` | before stage 3 on large meshes: a disk with few vertices goes first |
//! | `virtual_boundary.rs` | stage 3: the boundary made simple, and the outside embedded with the mesh |
//! | `continuation.rs` | stage 4: a planar start fitted to the constraints, then one-to-one on the way to them |
//! | `held.rs` | stage 4 where the whole boundary is held: from a boundary that follows its targets |
//! | `matchmaker.rs` | stage 5: new vertices |
//! | `relax.rs` | what follows: lower distortion, convex polygons; `auto` goes on until the embedding serves |
//!
//! A flattener is asked for one step at a time, so that it can be watched, paused and taken on by hand. A step that is
//! cancelled leaves the flattener as it was.

mod cache;
mod coarse;
mod continuation;
mod continue_from;
mod ending;
mod held;
mod iterate;
mod matchmaker;
mod proof;
mod relax;
mod sequence;
mod single_step;
mod slim;
mod stage;
mod step;
mod strategy;
mod stretch;
mod task;
mod virtual_boundary;

use std::sync::Arc;

pub use self::cache::{PlanarStart, SolverCache};
pub use self::ending::Ending;
pub use self::step::{Candidate, Step, largest_move};

use self::relax::Rounds;
use self::stage::{Notes, PhaseGoal, StageFailure, StageInput, StepState};
use self::strategy::Strategy;
use self::task::Task;
use crate::mesh::DiskMesh;
use crate::problem::units::Units;
use crate::problem::{Control, Embedding, Method, Pins, Settings, SolveError, Stage};
use crate::verify::UvFrame;

/// A method under way on one mesh with one set of pins.
#[derive(Debug)]
pub struct Flattener {
    asked: Task,
    units: Units,
    /// What is asked for, in units of the solve, as all but steps are.
    task: Arc<Task>,
    plan: Strategy,
    step_count: usize,
    latest: Option<StepState>,
    /// A candidate whose proof was stopped: its stage has moved on.
    unproved: Option<Candidate>,
    ending: Option<Ending>,
    /// Notes on the next step: why stages before it gave no candidate.
    notes: Notes,
    /// What earlier flatteners on the mesh have computed.
    kept: SolverCache,
    /// Whether its steps hand on factors, which are large.
    keeps_factors: bool,
}

impl Flattener {
    /// A flattener that has not begun. `pins` are the user's.
    pub fn new(settings: Settings, pins: Pins) -> Self {
        Self::of(Task::new(settings, pins, Arc::default()))
    }

    fn of(asked: Task) -> Self {
        let (units, kept) = (asked.units(), SolverCache::default());
        let task = Arc::new(asked.in_units(&units));
        let plan = Strategy::new(&task, &kept, asked.start.as_ref());
        Self {
            asked,
            units,
            task,
            plan,
            step_count: 0,
            latest: None,
            unproved: None,
            ending: None,
            notes: Notes::default(),
            kept,
            keeps_factors: false,
        }
    }

    /// The same with every step proved in the numbers that are written of it, not in those of the plane.
    #[must_use]
    pub fn with_output_frame(self, sheet: UvFrame) -> Self {
        Self::of(Task { sheet: Arc::new(sheet), ..self.asked })
    }

    /// The same from an embedding on: it is the first step, as it is, and where pins leave that open, all steps lie as it
    /// does. One-to-one, it is what constraints are met from and relaxing begins with, or else what an iteration and a
    /// virtual boundary begin with; where it meets all constraints, nothing is done to it, and where two of them, it is not
    /// moved to where it fits the others; other methods then take the way that they take without it. Where it serves poorly,
    /// it is relaxed only if rounds are asked for. One position per vertex, in the plane; those of vertices of no face do not
    /// count. Methods of one linear solve pass over it.
    #[must_use]
    pub fn starting_from(self, embedding: Arc<Embedding>) -> Self {
        if !self.asked.settings.method.continues_from_layout() {
            return self;
        }
        Self::of(Task { start: Some(embedding), ..self.asked })
    }

    /// The same, going on from a step of another flattener's on the same mesh, which counts as this one's first.
    #[must_use]
    pub fn after(mut self, step: &Step) -> Self {
        self.adopt(step);
        self
    }

    /// What was asked for.
    pub fn settings(&self) -> &Settings {
        &self.asked.settings
    }

    /// The user's pins.
    pub fn pins(&self) -> &Pins {
        &self.asked.pins
    }

    /// How many steps it has taken.
    pub fn step_count(&self) -> usize {
        self.step_count
    }

    /// Why the method has come to its end, if it has. [`Flattener::step`] goes on all the same.
    pub fn ending(&self) -> Option<Ending> {
        self.ending
    }

    /// Takes all steps of the method, and hands each over as it is there.
    ///
    /// # Errors
    ///
    /// As [`Flattener::step`]; steps handed over before are good.
    pub fn finish(
        &mut self,
        mesh: &DiskMesh,
        control: Control<'_>,
        mut take: impl FnMut(Step),
    ) -> Result<Ending, SolveError> {
        loop {
            if let Some(ending) = self.ending {
                return Ok(ending);
            }
            take(self.step(mesh, control)?);
        }
    }

    /// Takes the method's next step; where the method has ended, one more mean-value iteration, or, after stages 4 and 5, a
    /// round of relaxing.
    ///
    /// # Errors
    ///
    /// Pins that cannot be, a family that does not go with the method, a system that cannot be solved, or the caller's
    /// wish to stop. In a flattener only the last stage's errors are errors.
    pub fn step(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Step, SolveError> {
        if self.step_count == 0 {
            self.task.check(mesh)?;
            self.check_beginning(mesh);
        }
        let candidate = match self.ending {
            _ if self.unproved.is_some() => self.unproved.take().ok_or(SolveError::Cancelled),
            None => self.next_candidate(mesh, control),
            // Where no way led to the constraints, none does now.
            Some(Ending::Unmet) => Err(SolveError::Unmet),
            Some(_) => {
                let task = Arc::clone(&self.plan.part().task);
                let from = StageInput { task: &task, mesh, latest: self.latest.as_ref() };
                self.plan.part_mut().by_hand().step(from, control).map_err(|failure| failure.error)
            }
        };
        if matches!(candidate, Err(SolveError::Unmet)) {
            self.ending = Some(Ending::Unmet);
        }
        let mut step = self.proved(candidate?, mesh, control)?;
        self.adopt(&step);
        self.keep_start(&mut step, mesh);
        Ok(step)
    }

    /// Whether rounds of relaxing may follow the latest step: it is one-to-one, even where polygons are concave.
    pub fn can_relax(&self) -> bool {
        self.latest.as_ref().is_some_and(|latest| latest.is_one_to_one)
    }

    /// Lets rounds of relaxing follow: each lowers the distortion of a planar embedding, which keeps its exact pins and
    /// stays one-to-one.
    ///
    /// # Errors
    ///
    /// [`SolveError::NotPlanar`] where there is no planar embedding to begin with.
    pub fn relax(&mut self, rounds: usize) -> Result<(), SolveError> {
        if !self.can_relax() {
            return Err(SolveError::NotPlanar);
        }
        self.plan.part_mut().relax.begin(Rounds { always: rounds, until_it_serves: 0 });
        self.ending = (rounds == 0).then_some(Ending::Planar);
        Ok(())
    }

    /// The next candidate by the plan. A stage that gives nothing leads on to the next sequence.
    fn next_candidate(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Candidate, SolveError> {
        loop {
            let latest = self.latest.as_ref().filter(|_| !self.plan.part().begins_anew());
            if self.plan.part().begins_anew() {
                self.notes.say("without the constraints, for a planar start".to_owned());
            }
            let Some(place) = self.plan.part().next(latest) else {
                self.enter_next_part()?;
                continue;
            };
            let task = Arc::clone(&self.plan.part().task);
            let from = StageInput { task: &task, mesh, latest };
            let StageFailure { error, handover } = match self.plan.part_mut().enter(place).step(from, control) {
                Ok(candidate) => match candidate.solution.embedding.check_finite() {
                    Ok(()) => return Ok(candidate),
                    Err(error) => StageFailure::of(candidate.stage.words(), error),
                },
                Err(failure) => failure,
            };
            let Some(handover) = handover else { return Err(error) };
            self.notes.say(handover.note);
            if !self.plan.part_mut().leave_flight(place) {
                if !self.plan.has_next_part() {
                    return Err(self.given_up(error));
                }
                self.enter_next_part()?;
            }
            if let Some(latest) = &mut self.latest {
                latest.onward = handover.embedding;
            }
        }
    }

    /// Goes on to the next part of the plan: from the planar start to the constraints only where it is planar.
    fn enter_next_part(&mut self) -> Result<(), SolveError> {
        let has_start = || self.latest.as_ref().is_some_and(|latest| latest.is_one_to_one);
        if !self.plan.has_next_part() || (self.plan.part().aim == PhaseGoal::PlanarStart && !has_start()) {
            let reasons = "the planar start without the constraints is not planar".to_owned();
            return Err(self.given_up(SolveError::StagesExhausted { reasons }));
        }
        // A part may have given no step at all.
        if let Some(latest) = &mut self.latest {
            (latest.is_solved, latest.is_solved_but_for_polygons) = (false, false);
        }
        self.plan.enter_next_part();
        Ok(())
    }

    /// The error of a flattener that gives up: which stages failed, and why.
    fn given_up(&mut self, error: SolveError) -> SolveError {
        match self.notes.take() {
            Some(reasons) if self.task.settings.method == Method::Auto && error != SolveError::Unmet => {
                SolveError::StagesExhausted { reasons }
            }
            _ => error,
        }
    }

    /// Remembers a step and decides whether the method has ended.
    fn adopt(&mut self, step: &Step) {
        self.step_count += 1;
        let units = self.units_in_force();
        let part = self.plan.part_mut();
        // A mirror image is one-to-one, but not what the flattener is for.
        let is_upright = !step.verdict.mirrored || part.task.settings.method != Method::Auto;
        let is_met = part.aim == PhaseGoal::PlanarStart || step.unmet().is_empty();
        let is_given = step.candidate.stage == Stage::Given;
        // What fills the holes of a layout that was given may fold without harm.
        let is_proved = (step.verdict.is_one_to_one() || (is_given && step.verdict.planar)) && is_upright;
        let is_solved_for_faces = is_proved && is_met;
        // The way from a planar start to the constraints keeps no polygon convex: that follows.
        let is_solved = is_solved_for_faces && (step.verdict.planar || part.aim == PhaseGoal::PlanarStart);
        self.latest = Some(StepState {
            embedding: units.embedding(&step.candidate.solution.embedding),
            onward: None,
            pins: units.pins(&step.candidate.solution.pins),
            has_simple_boundary: step.has_simple_boundary(),
            is_one_to_one: step.verdict.is_one_to_one(),
            is_solved,
            is_unplaced: is_proved && !is_met && !part.task.is_constrained(),
            is_solved_but_for_polygons: is_solved_for_faces && !is_solved,
            concave_polygons: step.verdict.concave_polygons.clone(),
            refinement: step.candidate.refinement.clone(),
        });
        part.observe(step);
        if is_given && !is_proved && self.task.settings.method.needs_planar_start() {
            self.begin_afresh(step);
        }
        self.ending = self.ending_now();
    }

    /// Takes the way from the surface alone: the layout that was given is no map to go on from.
    fn begin_afresh(&mut self, given: &Step) {
        let fault = if given.verdict.is_one_to_one() { "a mirror image" } else { "not one-to-one" };
        self.notes.say(format!("solved afresh, for the layout of the file is {fault}"));
        self.plan = Strategy::from_scratch(&self.task, &self.kept);
        self.latest = None;
    }

    fn ending_now(&self) -> Option<Ending> {
        let (part, latest) = (self.plan.part(), self.latest.as_ref());
        if part.next(latest).is_some() || self.plan.leads_on(latest) {
            return None;
        }
        Some(if latest.is_some_and(|latest| latest.is_solved) { Ending::Planar } else { part.ending() })
    }
}
