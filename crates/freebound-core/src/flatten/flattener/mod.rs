//! The flattener: the steps of a method, one after another; for `auto`, stage after stage until the embedding is
//! planar.
//!
//! | file | contents |
//! |---|---|
//! | `mod.rs` | [`Flattener`]: follows the strategy, proves each candidate, keeps the latest step |
//! | `strategy.rs` | strategy of every method: the order of stages |
//! | `cache.rs` | results of flatteners on a mesh, for further ones |
//! | `sequence.rs` | stages by name, and the sequences of which strategies consist |
//! | `proof.rs` | proof of a candidate in the written numbers, which makes it a step |
//! | `stage.rs` | interface of a stage: from the latest step to a candidate, or to the reason why there is none |
//! | `options.rs` | [`Options`] from which a flattener is built |
//! | `task.rs` | the request: settings and pins |
//! | `ending.rs` | reason for the end of a flattener |
//! | `step.rs` | [`Candidate`]: result of a stage before its proof; [`Step`]: a candidate with its verdict |
//! | `continue_from.rs` | continuation from a one-to-one embedding, or from a step of another flattener |
//! | `single_step.rs` | stages of one step: given layout, linear solves, grid drawing, cut of concave polygons |
//! | `iterate.rs` | stage 2: mean-value iterations, and when they no longer improve |
//! | `slim.rs` | SLIM iterations from Tutte's map, or from a planar map of the flattener |
//! | `stretch.rs` | solves with a convex boundary, each of less stretch |
//! | `coarse.rs` | before stage 3 on large meshes: a disk with few vertices first |
//! | `virtual_boundary.rs` | stage 3: the boundary made simple, and the outside embedded with the mesh |
//! | `continuation.rs` | stage 4: a planar start fitted to the constraints, then moved to them one-to-one |
//! | `held.rs` | stage 4 if the whole boundary is pinned: from a boundary that follows its targets |
//! | `matchmaker.rs` | stage 5: new vertices |
//! | `relax.rs` | relaxing: lower distortion, convex polygons; for `auto`, until the embedding is usable |
//!
//! A flattener takes one step per call, so that a caller can observe it, pause it, or continue it manually. A
//! cancelled step leaves the flattener unchanged.

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

/// Run of a method on one mesh with one set of pins.
#[derive(Debug)]
pub struct Flattener {
    asked: Task,
    units: Units,
    /// The request in units of the solve. Everything except steps is in these units.
    task: Arc<Task>,
    strategy: Strategy,
    step_count: usize,
    latest: Option<StepState>,
    /// Candidate whose proof was cancelled, although its stage has already advanced.
    unproved: Option<Candidate>,
    ending: Option<Ending>,
    /// Notes on the next step: reasons why earlier stages had no candidate.
    notes: Notes,
    /// Results of earlier flatteners on the mesh.
    cache: SolverCache,
    /// True if steps keep factors, which are large, for further flatteners.
    keeps_factors: bool,
}

impl Flattener {
    /// Makes a flattener of these settings and pins. All other options have their defaults.
    pub fn new(settings: Settings, pins: Pins) -> Self {
        Self::with_options(Options { settings, pins, ..Options::default() })
    }

    /// Makes a flattener. Methods that do not continue from a layout ignore [`Options::layout`].
    pub fn with_options(options: Options) -> Self {
        let Options { settings, pins, output_frame, layout, layout_is_free, cache } = options;
        let start = layout.filter(|_| settings.method.continues_from_layout());
        let asked = Task { start, start_is_free: layout_is_free, ..Task::new(settings, pins, Arc::new(output_frame)) };
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

    /// Adopts a step of another flattener on the same mesh as the first step.
    #[must_use]
    pub fn after(mut self, step: &Step) -> Self {
        self.adopt(step);
        self
    }

    /// Settings of the request.
    pub fn settings(&self) -> &Settings {
        &self.asked.settings
    }

    /// Pins of the request.
    pub fn pins(&self) -> &Pins {
        &self.asked.pins
    }

    /// Number of steps taken.
    pub fn step_count(&self) -> usize {
        self.step_count
    }

    /// Reason for the end of the method, if it has ended. [`Flattener::step`] can still continue unless it is
    /// [`Ending::Unmet`].
    pub fn ending(&self) -> Option<Ending> {
        self.ending
    }

    /// Takes all steps of the method, and passes each to `take` as soon as it is proved.
    ///
    /// # Errors
    ///
    /// Errors of [`Flattener::step`]. Steps passed on before remain valid.
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

    /// Takes the method's next step. After the end of the method: one more mean-value iteration or, after stages 4 and
    /// 5, a round of relaxing.
    ///
    /// # Errors
    ///
    /// If pins are invalid, the family does not fit the method, a system cannot be solved, or the caller cancels. A
    /// failure of a stage that a later stage can replace is no error. [`SolveError::Unmet`] if the constraints cannot
    /// be met.
    pub fn step(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Step, SolveError> {
        if self.step_count == 0 {
            self.task.check(mesh)?;
            self.check_beginning(mesh);
        }
        let candidate = match self.ending {
            _ if self.unproved.is_some() => self.unproved.take().ok_or(SolveError::Cancelled),
            None => self.next_candidate(mesh, control),
            // No stage met the constraints, so no further step can.
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

    /// True if rounds of relaxing may follow the latest step: it is one-to-one, even if polygons are concave.
    pub fn can_relax(&self) -> bool {
        self.latest.as_ref().is_some_and(|latest| latest.is_one_to_one)
    }

    /// Requests rounds of relaxing as the next steps. Each lowers the distortion of a planar embedding, which stays
    /// one-to-one with its hard pins fixed.
    ///
    /// # Errors
    ///
    /// [`SolveError::NotPlanar`] if the latest step is not one-to-one.
    pub fn relax(&mut self, rounds: usize) -> Result<(), SolveError> {
        if !self.can_relax() {
            return Err(SolveError::NotPlanar);
        }
        self.strategy.phase_mut().relax.begin(Rounds { always: rounds, until_it_serves: 0 });
        self.ending = (rounds == 0).then_some(Ending::Planar);
        Ok(())
    }

    /// Next candidate of the strategy. If a stage has no candidate, the next sequence follows.
    fn next_candidate(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Candidate, SolveError> {
        loop {
            let latest = self.latest.as_ref().filter(|_| !self.strategy.phase().begins_anew());
            if self.strategy.phase().begins_anew() {
                self.notes.say("constraints ignored to find a planar start".to_owned());
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
                    Err(_) if candidate.stage == Stage::Given && self.task.settings.method.needs_planar_start() => {
                        self.start_from_scratch("not finite");
                        continue;
                    }
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

    /// Enters the next phase of the strategy. Fails if a planar start is required and the latest step is not
    /// one-to-one.
    fn enter_next_phase(&mut self) -> Result<(), SolveError> {
        let has_start = || self.latest.as_ref().is_some_and(|latest| latest.is_one_to_one);
        if !self.strategy.has_next_phase() || (self.strategy.phase().aim == PhaseGoal::PlanarStart && !has_start()) {
            let reasons = "the start without constraints is not planar".to_owned();
            return Err(self.given_up(SolveError::StagesExhausted { reasons }));
        }
        // A phase may have had no step at all.
        if let Some(latest) = &mut self.latest {
            latest.attained = Attained::Nothing;
        }
        self.strategy.enter_next_phase();
        Ok(())
    }

    /// Error of a flattener that gives up: which stages failed, and why.
    fn given_up(&mut self, error: SolveError) -> SolveError {
        match self.notes.take() {
            Some(reasons) if self.task.settings.method == Method::Auto && error != SolveError::Unmet => {
                SolveError::StagesExhausted { reasons }
            }
            _ => error,
        }
    }

    /// Keeps a step as the latest one, and decides if the method has ended.
    fn adopt(&mut self, step: &Step) {
        self.step_count += 1;
        let units = self.units_in_force();
        let phase = self.strategy.phase_mut();
        // A mirror image is one-to-one, but not a goal of the flattener.
        let is_upright = !step.verdict.mirrored || phase.task.settings.method != Method::Auto;
        let is_met = phase.aim == PhaseGoal::PlanarStart || step.unmet().is_empty();
        let is_given = matches!(step.candidate.stage, Stage::Given | Stage::Seams | Stage::Saved);
        // The filling of holes of a given layout may fold without harm.
        let is_proved = (step.verdict.is_one_to_one() || (is_given && step.verdict.planar)) && is_upright;
        // Polygons may be concave on the way from a planar start to the constraints: relaxing makes them convex
        // afterwards.
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
            let fault = step.verdict.summary();
            self.start_from_scratch(if step.verdict.planar { "a mirror image" } else { &fault });
        }
        self.ending = self.ending_now();
    }

    /// Restarts with the surface alone: the given layout is no map to continue from.
    fn start_from_scratch(&mut self, fault: &str) {
        self.notes.say(format!("restarted from scratch: the layout of the file: {fault}"));
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
