//! The ladder: the steps of a method, one after another; for `auto` one rung after another until the embedding is planar.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | [`Ladder`]: walks the plan, proves each candidate, remembers the latest step |
//! | `plan.rs` | the plan of every method: which rung follows which |
//! | `kept.rs` | what ladders on a mesh have computed, for further ones |
//! | `flights.rs` | the rungs by name, and the flights of them that plans are made of |
//! | `proof.rs` | a candidate proved in the numbers that are written of it: a step |
//! | `rung.rs` | what a rung is: from the latest step to a candidate, or to a reason why there is none |
//! | `task.rs` | what is asked for: settings and pins |
//! | `ending.rs` | why a ladder has come to its end |
//! | `step.rs` | [`Candidate`]: what a rung gives, before it is proved; [`Step`]: a candidate with its verdict |
//! | `given.rs` | before all rungs: the layout that it is to start from |
//! | `going_on.rs` | before all rungs: a one-to-one embedding to go on from, or a step of another ladder's |
//! | `natural.rs` | rung 1: one linear solve |
//! | `iterate.rs` | rung 2: mean-value iterations, and when they get no better |
//! | `again.rs` | rung 1 once more, with the default weights and pins |
//! | `lee.rs` | Lee's virtual boundary: layers around the mesh, peeled |
//! | `slim.rs` | Tutte's map, or a planar one of the ladder, iteration after iteration with less energy |
//! | `stretch.rs` | a convex boundary, solve after solve with less stretch |
//! | `coarse.rs` | before rung 3 on large meshes: a disk with few vertices goes first |
//! | `virtual_boundary.rs` | rung 3: the boundary made simple, and the outside embedded with the mesh |
//! | `angles.rs` | angles, then the plane |
//! | `spectral.rs` | one eigenvector, without pins |
//! | `schnyder.rs` | the end of rung 3: a grid drawing, planar by theorem |
//! | `continuation.rs` | rung 4: a planar start fitted to the constraints, then one-to-one on the way to them |
//! | `held.rs` | rung 4 where the whole boundary is held: from a boundary that follows its targets |
//! | `matchmaker.rs` | rung 5: new vertices |
//! | `relax.rs` | what follows: lower distortion, convex polygons; `auto` goes on until the embedding serves |
//! | `cut.rs` | what follows: polygons that cannot be convex, cut into triangles |
//!
//! A ladder is asked for one step at a time, so that it can be watched, paused and taken on by hand. A step that is
//! cancelled leaves the ladder as it was.

mod again;
mod angles;
mod coarse;
mod continuation;
mod cut;
mod ending;
mod flights;
mod given;
mod going_on;
mod held;
mod iterate;
mod kept;
mod lee;
mod matchmaker;
mod natural;
mod plan;
mod proof;
mod relax;
mod rung;
mod schnyder;
mod slim;
mod spectral;
mod step;
mod stretch;
mod task;
mod virtual_boundary;

use std::sync::Arc;

pub use self::ending::Ending;
pub use self::kept::{Kept, PlanarStart};
pub use self::step::{Candidate, Progress, Step, largest_move};

use self::plan::{Aim, Plan};
use self::relax::Rounds;
use self::rung::{Failure, Footing, Latest, Notes};
use self::task::Task;
use super::units::Units;
use super::{Control, Embedding, Method, Pins, Settings, Sheet, SolveError};
use crate::mesh::DiskMesh;

/// A method under way on one mesh with one set of pins.
#[derive(Debug)]
pub struct Ladder {
    asked: Task,
    units: Units,
    /// What is asked for, in units of the solve, as all but steps are.
    task: Arc<Task>,
    plan: Plan,
    step_count: usize,
    latest: Option<Latest>,
    /// A candidate whose proof was stopped: its rung has moved on.
    unproved: Option<Candidate>,
    ending: Option<Ending>,
    /// Notes on the next step: why rungs before it gave no candidate.
    notes: Notes,
    /// What earlier ladders on the mesh have computed.
    kept: Kept,
    /// Whether its steps hand on factors, which are large.
    hands_on_factors: bool,
}

impl Ladder {
    /// A ladder that has not begun. `pins` are the user's.
    pub fn new(settings: Settings, pins: Pins) -> Self {
        Self::of(Task::new(settings, pins, Arc::default()))
    }

    fn of(asked: Task) -> Self {
        let (units, kept) = (asked.units(), Kept::default());
        let task = Arc::new(asked.in_units(&units));
        let plan = Plan::new(&task, &kept, asked.start.as_ref());
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
            hands_on_factors: false,
        }
    }

    /// The same with every step proved in the numbers that are written of it, not in those of the plane.
    #[must_use]
    pub fn written_on(self, sheet: Sheet) -> Self {
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
        if !self.asked.settings.method.goes_on_from_layout() {
            return self;
        }
        Self::of(Task { start: Some(embedding), ..self.asked })
    }

    /// The same, going on from a step of another ladder's on the same mesh, which counts as this one's first.
    #[must_use]
    pub fn after(mut self, step: &Step) -> Self {
        self.take_in(step);
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

    /// Why the method has come to its end, if it has. [`Ladder::step`] goes on all the same.
    pub fn ending(&self) -> Option<Ending> {
        self.ending
    }

    /// Takes all steps of the method, and hands each over as it is there.
    ///
    /// # Errors
    ///
    /// As [`Ladder::step`]; steps handed over before are good.
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

    /// Takes the method's next step; where the method has ended, one more mean-value iteration, or, after rungs 4 and 5, a
    /// round of relaxing.
    ///
    /// # Errors
    ///
    /// Pins that cannot be, a family that does not go with the method, a system that cannot be solved, or the caller's
    /// wish to stop. In a ladder only the last rung's errors are errors.
    pub fn step(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Step, SolveError> {
        if self.step_count == 0 {
            self.task.check(mesh)?;
            self.check_beginning(mesh);
        }
        let candidate = match self.ending {
            _ if self.unproved.is_some() => self.unproved.take().ok_or(SolveError::Cancelled),
            None => self.climb(mesh, control),
            // Where no way led to the constraints, none does now.
            Some(Ending::Unmet) => Err(SolveError::Unmet),
            Some(_) => {
                let task = Arc::clone(&self.plan.part().task);
                let from = Footing { task: &task, mesh, latest: self.latest.as_ref() };
                self.plan.part_mut().by_hand().step(from, control).map_err(|failure| failure.error)
            }
        };
        if matches!(candidate, Err(SolveError::Unmet)) {
            self.ending = Some(Ending::Unmet);
        }
        let mut step = self.proved(candidate?, mesh, control)?;
        self.take_in(&step);
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

    /// The next candidate by the plan. A rung that gives nothing leads on to the next flight.
    fn climb(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Candidate, SolveError> {
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
            let from = Footing { task: &task, mesh, latest };
            let Failure { error, handover } = match self.plan.part_mut().enter(place).step(from, control) {
                Ok(candidate) => match candidate.solution.embedding.check_finite() {
                    Ok(()) => return Ok(candidate),
                    Err(error) => Failure::of(candidate.rung.as_rung(), error),
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
        if !self.plan.has_next_part() || (self.plan.part().aim == Aim::PlanarStart && !has_start()) {
            let reasons = "the planar start without the constraints is not planar".to_owned();
            return Err(self.given_up(SolveError::LadderExhausted { reasons }));
        }
        // A part may have given no step at all.
        if let Some(latest) = &mut self.latest {
            (latest.is_solved, latest.is_solved_but_for_polygons) = (false, false);
        }
        self.plan.enter_next_part();
        Ok(())
    }

    /// The error of a ladder that gives up: which rungs failed, and why.
    fn given_up(&mut self, error: SolveError) -> SolveError {
        match self.notes.take() {
            Some(reasons) if self.task.settings.method == Method::Auto && error != SolveError::Unmet => {
                SolveError::LadderExhausted { reasons }
            }
            _ => error,
        }
    }

    /// Remembers a step and decides whether the method has ended.
    fn take_in(&mut self, step: &Step) {
        self.step_count += 1;
        let units = self.units_in_force();
        let part = self.plan.part_mut();
        // A mirror image is one-to-one, but not what the ladder is for.
        let is_upright = !step.verdict.mirrored || part.task.settings.method != Method::Auto;
        let is_met = part.aim == Aim::PlanarStart || step.unmet().is_empty();
        let is_given = step.rung == Method::Given;
        // What fills the holes of a layout that was given may fold without harm.
        let is_proved = (step.verdict.is_one_to_one() || (is_given && step.verdict.planar)) && is_upright;
        let is_solved_for_faces = is_proved && is_met;
        // The way from a planar start to the constraints keeps no polygon convex: that follows.
        let is_solved = is_solved_for_faces && (step.verdict.planar || part.aim == Aim::PlanarStart);
        self.latest = Some(Latest {
            embedding: units.embedding(&step.solution.embedding),
            onward: None,
            pins: units.pins(&step.solution.pins),
            has_simple_boundary: step.has_simple_boundary(),
            is_one_to_one: step.verdict.is_one_to_one(),
            is_solved,
            is_unplaced: is_proved && !is_met && !part.task.is_constrained(),
            is_solved_but_for_polygons: is_solved_for_faces && !is_solved,
            concave_polygons: step.verdict.concave_polygons.clone(),
            refinement: step.refinement.clone(),
        });
        part.look_at(step);
        if is_given && !is_proved && self.task.settings.method.needs_one_to_one_start() {
            self.begin_afresh(step);
        }
        self.ending = self.ending_now();
    }

    /// Takes the way from the surface alone: the layout that was given is no map to go on from.
    fn begin_afresh(&mut self, given: &Step) {
        let fault = if given.verdict.is_one_to_one() { "a mirror image" } else { "not one-to-one" };
        self.notes.say(format!("solved afresh, for the layout of the file is {fault}"));
        self.plan = Plan::afresh(&self.task, &self.kept);
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
