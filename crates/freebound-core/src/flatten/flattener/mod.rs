//! The flattener: the steps of a method, one after another; for `auto` one stage after another until the embedding is planar.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | [`Flattener`]: walks the strategy, proves each candidate, remembers the latest step |
//! | `strategy.rs` | the strategy of every method: which stage follows which |
//! | `cache.rs` | what flatteners on a mesh have computed, for further ones |
//! | `sequence.rs` | the stages by name, and the sequences of them that plans are made of |
//! | `proof.rs` | a candidate proved in the numbers that are written of it: a step |
//! | `stage.rs` | what a stage is: from the latest step to a candidate, or to a reason why there is none |
//! | `options.rs` | [`Options`]: all that a flattener is built from |
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
mod options;
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
pub use self::options::Options;
pub use self::step::{Candidate, Step, largest_move};

use self::relax::Rounds;
use self::stage::{Attained, Notes, PhaseGoal, StageFailure, StageInput, StepState};
use self::strategy::Strategy;
use self::task::Task;
use crate::mesh::DiskMesh;
use crate::problem::units::Units;
use crate::problem::{Control, Method, Pins, Settings, SolveError, Stage};

/// A method under way on one mesh with one set of pins.
#[derive(Debug)]
pub struct Flattener {
    asked: Task,
    units: Units,
    /// What is asked for, in units of the solve, as all but steps are.
    task: Arc<Task>,
    strategy: Strategy,
    step_count: usize,
    latest: Option<StepState>,
    /// A candidate whose proof was stopped: its stage has moved on.
    unproved: Option<Candidate>,
    ending: Option<Ending>,
    /// Notes on the next step: why stages before it gave no candidate.
    notes: Notes,
    /// What earlier flatteners on the mesh have computed.
    cache: SolverCache,
    /// Whether its steps hand on factors, which are large.
    keeps_factors: bool,
}

impl Flattener {
    /// Makes a flattener of these settings and the user's pins. All other options have their defaults.
    pub fn new(settings: Settings, pins: Pins) -> Self {
        Self::with_options(Options { settings, pins, ..Options::default() })
    }

    /// Makes a flattener. Methods that do not continue from a layout ignore [`Options::layout`].
    pub fn with_options(options: Options) -> Self {
        let Options { settings, pins, output_frame, layout, cache } = options;
        let start = layout.filter(|_| settings.method.continues_from_layout());
        let asked = Task { start, ..Task::new(settings, pins, Arc::new(output_frame)) };
        let units = asked.units();
        let task = Arc::new(asked.in_units(&units));
        let (keeps_factors, cache) = (cache.is_some(), cache.unwrap_or_default());
        let strategy = Strategy::new(&task, &cache, asked.start.as_ref());
        Self {
            asked,
            units,
            task,
            strategy,
            step_count: 0,
            latest: None,
            unproved: None,
            ending: None,
            notes: Notes::default(),
            cache,
            keeps_factors,
        }
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
                let task = Arc::clone(&self.strategy.phase().task);
                let from = StageInput { task: &task, mesh, latest: self.latest.as_ref() };
                self.strategy.phase_mut().by_hand().step(from, control).map_err(|failure| failure.error)
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
        self.strategy.phase_mut().relax.begin(Rounds { always: rounds, until_it_serves: 0 });
        self.ending = (rounds == 0).then_some(Ending::Planar);
        Ok(())
    }

    /// The next candidate by the strategy. A stage that gives nothing leads on to the next sequence.
    fn next_candidate(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Candidate, SolveError> {
        loop {
            let latest = self.latest.as_ref().filter(|_| !self.strategy.phase().begins_anew());
            if self.strategy.phase().begins_anew() {
                self.notes.say("without the constraints, for a planar start".to_owned());
            }
            let Some(place) = self.strategy.phase().next(latest) else {
                self.enter_next_phase()?;
                continue;
            };
            let task = Arc::clone(&self.strategy.phase().task);
            let from = StageInput { task: &task, mesh, latest };
            let StageFailure { error, handover } = match self.strategy.phase_mut().enter(place).step(from, control) {
                Ok(candidate) => match candidate.solution.embedding.check_finite() {
                    Ok(()) => return Ok(candidate),
                    Err(error) => StageFailure::of(candidate.stage.words(), error),
                },
                Err(failure) => failure,
            };
            let Some(handover) = handover else { return Err(error) };
            self.notes.say(handover.note);
            if !self.strategy.phase_mut().leave_sequence(place) {
                if !self.strategy.has_next_phase() {
                    return Err(self.given_up(error));
                }
                self.enter_next_phase()?;
            }
            if let Some(latest) = &mut self.latest {
                latest.onward = handover.embedding;
            }
        }
    }

    /// Goes on to the next phase of the strategy: from the planar start to the constraints only where it is planar.
    fn enter_next_phase(&mut self) -> Result<(), SolveError> {
        let has_start = || self.latest.as_ref().is_some_and(|latest| latest.is_one_to_one);
        if !self.strategy.has_next_phase() || (self.strategy.phase().aim == PhaseGoal::PlanarStart && !has_start()) {
            let reasons = "the planar start without the constraints is not planar".to_owned();
            return Err(self.given_up(SolveError::StagesExhausted { reasons }));
        }
        // A phase may have given no step at all.
        if let Some(latest) = &mut self.latest {
            latest.attained = Attained::Nothing;
        }
        self.strategy.enter_next_phase();
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
        let phase = self.strategy.phase_mut();
        // A mirror image is one-to-one, but not what the flattener is for.
        let is_upright = !step.verdict.mirrored || phase.task.settings.method != Method::Auto;
        let is_met = phase.aim == PhaseGoal::PlanarStart || step.unmet().is_empty();
        let is_given = step.candidate.stage == Stage::Given;
        // What fills the holes of a layout that was given may fold without harm.
        let is_proved = (step.verdict.is_one_to_one() || (is_given && step.verdict.planar)) && is_upright;
        // The way from a planar start to the constraints keeps no polygon convex: that follows.
        let has_polygons = step.verdict.planar || phase.aim == PhaseGoal::PlanarStart;
        let attained = match (is_proved, is_met) {
            (true, true) if has_polygons => Attained::Goal,
            (true, true) => Attained::AllButPolygons,
            (true, false) if !phase.task.is_constrained() => Attained::AllButPlace,
            _ => Attained::Nothing,
        };
        self.latest = Some(StepState {
            embedding: units.embedding(&step.candidate.solution.embedding),
            onward: None,
            pins: units.pins(&step.candidate.solution.pins),
            has_simple_boundary: step.has_simple_boundary(),
            is_one_to_one: step.verdict.is_one_to_one(),
            attained,
            concave_polygons: step.verdict.concave_polygons.clone(),
            refinement: step.candidate.refinement.clone(),
        });
        phase.observe(step);
        if is_given && !is_proved && self.task.settings.method.needs_planar_start() {
            self.start_from_scratch(step);
        }
        self.ending = self.ending_now();
    }

    /// Takes the way from the surface alone: the layout that was given is no map to go on from.
    fn start_from_scratch(&mut self, given: &Step) {
        let fault = if given.verdict.is_one_to_one() { "a mirror image" } else { "not one-to-one" };
        self.notes.say(format!("solved afresh, for the layout of the file is {fault}"));
        self.strategy = Strategy::from_scratch(&self.task, &self.cache);
        self.latest = None;
    }

    fn ending_now(&self) -> Option<Ending> {
        let (phase, latest) = (self.strategy.phase(), self.latest.as_ref());
        if phase.next(latest).is_some() || self.strategy.leads_on(latest) {
            return None;
        }
        Some(if latest.is_some_and(StepState::is_solved) { Ending::Planar } else { phase.ending() })
    }
}
