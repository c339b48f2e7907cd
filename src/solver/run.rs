//! A run: the steps of a method, one after another; for `auto` the rungs of the ladder.
//!
//! ```text
//! auto              natural → iterate → natural again → iterate → virtual boundary      until planar
//!  with constraints natural → iterate → continuation → new vertices                     until planar and met
//! continuation      planar without the constraints → continuation                       until met, or stuck
//! matchmaker        planar without the constraints → new vertices                       until met
//! iterate           natural → iterate                                                   until planar, stalled or at the limit
//! virtual-boundary  natural → virtual boundary                                          until planar
//! others            one linear solve
//! ```
//!
//! *Natural again* is our addition to the ladder. The virtual boundary keeps a boundary that is simple and bends one that
//! is not to a circle. Before it has to bend, `auto` starts once more with conformal weights and the default pins, if
//! other ones were asked for: their boundary is simple far more often, and stays free.
//!
//! A run is asked for one step at a time, so that it can be watched, paused and taken on by hand. A step that is
//! cancelled leaves the run as it was.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;

use super::constrained_run::{ConstrainedRun, Reached, check_distances};
use super::iterate::Iteration;
use super::relaxing::{Relaxed, Relaxing};
use super::scale::{complete_gauge, fit_gauge};
use super::stall::Stall;
use super::step::{Step, largest_move};
use super::virtual_boundary_run::{Bent, VirtualBoundaryRun};
use super::{
    Control, Embedding, Family, Method, Outside, Phase, PhaseSeconds, Pins, Prepared, Progress, Settings, Solution,
    SolveError, fixed_pins, flatten, gauge_pins, verdict,
};
use crate::geom::Similarity;
use crate::mesh::{DiskMesh, Refinement};

/// Why a run has come to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The embedding is proved planar.
    Planar,
    /// The method has no further step.
    Done,
    /// The iteration gets no better and hardly moves.
    Stalled,
    /// The iteration has taken as many steps as it may.
    Limit,
    /// The embedding is planar, but constraints could not be met without new vertices: [`Step::unmet`] names them.
    Unmet,
}

/// Rounds of relaxing that follow by themselves: after the boundary was bent to a convex polygon, and after rungs 4 and
/// 5, whose first answer is not their best. More where springs have yet to pull, or paths were made straight.
const ROUNDS_AFTER_BENDING: usize = 30;
const ROUNDS_AFTER_CONTINUATION: usize = 3;
const ROUNDS_AFTER_MATCHMAKER: usize = 30;

/// The most mean-value iterations of a ladder that has other ways to the constraints.
const ITERATIONS_WITH_CONSTRAINTS: usize = 8;

/// A method under way on one mesh with one set of pins.
#[derive(Debug)]
pub struct Ladder {
    settings: Settings,
    pins: Pins,
    prepared: Option<Arc<Prepared>>,
    iteration: Option<Iteration>,
    virtual_boundary: Option<VirtualBoundaryRun>,
    constrained: Option<ConstrainedRun>,
    relaxing: Option<Relaxing>,
    /// Rounds of relaxing that may still follow a planar end.
    relax_left: usize,
    stall: Stall,
    /// Iterations since the last linear solve.
    iterations: usize,
    /// Whether the ladder may still start again with the default weights and pins.
    may_start_again: bool,
    step_count: usize,
    latest: Option<Latest>,
    ending: Option<Ending>,
    /// What there is to say about the next step: why others gave nothing.
    notes: Vec<String>,
}

/// What the next step goes on from.
#[derive(Clone, Debug)]
struct Latest {
    embedding: Embedding,
    /// The pins in force.
    pins: Pins,
    has_simple_boundary: bool,
    /// Whether it is proved planar.
    planar: bool,
    /// The mesh with new vertices that it is of.
    refinement: Option<Arc<Refinement>>,
}

/// What a rung gave, before it is proved.
struct Raw {
    rung: Method,
    family: Family,
    solution: Solution,
    bent_vertices: usize,
    virtual_boundary: Option<Arc<super::VirtualBoundary>>,
    prepared: Option<Arc<Prepared>>,
    refinement: Option<Arc<Refinement>>,
    progress: Option<Progress>,
    outside: Option<Arc<Outside>>,
}

impl Raw {
    /// A solution of a rung, and nothing else.
    fn of(rung: Method, family: Family, solution: Solution) -> Self {
        Self {
            rung,
            family,
            solution,
            bent_vertices: 0,
            virtual_boundary: None,
            prepared: None,
            refinement: None,
            progress: None,
            outside: None,
        }
    }
}

impl Ladder {
    /// A run that has not begun. `pins` are the user's.
    pub fn new(settings: Settings, pins: Pins) -> Self {
        let pins = if settings.method.uses_pins() { pins } else { Pins::new() };
        let is_default = settings.family == Family::default() && pins.is_empty();
        Self {
            may_start_again: settings.method == Method::Auto && !is_default,
            settings,
            pins,
            prepared: None,
            iteration: None,
            virtual_boundary: None,
            constrained: None,
            relaxing: None,
            relax_left: settings.relax_rounds.unwrap_or(0),
            stall: Stall::default(),
            iterations: 0,
            step_count: 0,
            latest: None,
            ending: None,
            notes: Vec::new(),
        }
    }

    /// The same with equations and factors that are at hand, used where they serve.
    #[must_use]
    pub fn with_prepared(self, prepared: Option<Arc<Prepared>>) -> Self {
        Self { prepared, ..self }
    }

    /// The same, going on from a step of another run's on the same mesh, which counts as this run's first.
    #[must_use]
    pub fn after(mut self, step: &Step) -> Self {
        self.take_in(step);
        self
    }

    /// What was asked for.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The user's pins.
    pub fn pins(&self) -> &Pins {
        &self.pins
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
        let raw = self.next_raw(mesh, control)?;
        // What is solved is handed over, even where the caller has meanwhile asked to stop: the run has moved on.
        control.enter(Phase::Verify).ok();
        let start = Instant::now();
        let proved_mesh = raw.refinement.as_ref().map_or(mesh, |refinement| refinement.disk());
        let verdict = verdict(proved_mesh, &raw.solution.embedding);
        let verify_seconds = start.elapsed().as_secs_f64();
        // New vertices have no place before, or another one's.
        let old = mesh.vertex_count();
        let moved = |latest: &Latest| largest_move(&latest.embedding[..old], &raw.solution.embedding[..old]);
        let max_move = self.latest.as_ref().map(moved);
        let step = Step {
            rung: raw.rung,
            family: raw.family,
            index: self.step_count,
            solution: raw.solution,
            verdict,
            max_move,
            verify_seconds,
            bent_vertices: raw.bent_vertices,
            virtual_boundary: raw.virtual_boundary,
            note: (!self.notes.is_empty()).then(|| std::mem::take(&mut self.notes).join("; ")),
            prepared: raw.prepared,
            refinement: raw.refinement,
            progress: raw.progress,
            outside: raw.outside,
        };
        self.take_in(&step);
        Ok(step)
    }

    /// Remembers a step and decides whether the method has ended.
    fn take_in(&mut self, step: &Step) {
        self.step_count += 1;
        self.latest = Some(Latest {
            embedding: step.solution.embedding.clone(),
            pins: step.solution.pins.clone(),
            has_simple_boundary: step.has_simple_boundary(),
            planar: step.verdict.planar,
            refinement: step.refinement.clone(),
        });
        if step.rung == Method::Iterate {
            self.iterations += 1;
        }
        self.stall.look_at(step);
        if step.rung == Method::Relax {
            self.relax_left = self.relax_left.saturating_sub(1);
        } else {
            self.relaxing = None;
            self.relax_left = self.settings.relax_rounds.unwrap_or_else(|| self.own_rounds_after(step));
        }
        // A mirror image is one-to-one, but not what the ladder is for.
        let is_upright = !step.verdict.mirrored || self.settings.method != Method::Auto;
        let is_solved = step.verdict.planar && is_upright && step.unmet().is_empty();
        let relaxes_on = self.relax_left > 0 && !self.relaxing.as_ref().is_some_and(Relaxing::has_converged);
        let has_more = self.constrained.as_ref().is_some_and(|run| !run.is_exhausted());
        self.ending = match (is_solved, relaxes_on || has_more) {
            (true, true) => None,
            (true, false) => Some(Ending::Planar),
            (false, _) => self.ending_of_method(),
        };
    }

    /// Rounds of relaxing that follow a step though nobody asked for them.
    fn own_rounds_after(&self, step: &Step) -> usize {
        let is_pulled = || self.settings.held(&self.pins).values().any(|pin| !pin.hold.is_exact());
        match step.rung {
            // A boundary that had to be bent is not to stay a circle.
            Method::VirtualBoundary if self.settings.method == Method::Auto && step.bent_vertices > 0 => {
                ROUNDS_AFTER_BENDING
            }
            Method::Continuation if is_pulled() => ROUNDS_AFTER_BENDING,
            Method::Continuation => ROUNDS_AFTER_CONTINUATION,
            Method::Matchmaker => ROUNDS_AFTER_MATCHMAKER,
            _ => 0,
        }
    }

    /// Lets rounds of relaxing follow: each lowers the distortion of a planar embedding, which keeps its exact pins and
    /// stays one-to-one.
    ///
    /// # Errors
    ///
    /// [`SolveError::NotPlanar`] where there is no planar embedding to begin with.
    pub fn relax(&mut self, rounds: usize) -> Result<(), SolveError> {
        if !self.latest.as_ref().is_some_and(|latest| latest.planar) {
            return Err(SolveError::NotPlanar);
        }
        (self.relax_left, self.relaxing) = (rounds, None);
        self.ending = (rounds == 0).then_some(Ending::Planar);
        Ok(())
    }

    fn ending_of_method(&self) -> Option<Ending> {
        match self.settings.method {
            Method::Auto | Method::VirtualBoundary if self.may_bend_boundary() => None,
            Method::Iterate => self.ending_of_iteration(),
            Method::Auto | Method::Continuation | Method::Matchmaker => {
                self.constrained.as_ref().filter(|run| run.is_exhausted()).map(|_| Ending::Unmet)
            }
            _ => Some(Ending::Done),
        }
        .or_else(|| self.virtual_boundary.as_ref().filter(|run| run.is_exhausted()).map(|_| Ending::Done))
    }

    fn ending_of_iteration(&self) -> Option<Ending> {
        // With constraints the iteration seldom arrives, and continuation always begins anew.
        let gives_way = self.settings.method == Method::Auto && !self.may_bend_boundary();
        let is_enough = gives_way && (self.stall.is_slow() || self.iterations >= ITERATIONS_WITH_CONSTRAINTS);
        if is_enough || self.stall.is_reached() {
            Some(Ending::Stalled)
        } else {
            (self.iterations >= self.settings.max_steps).then_some(Ending::Limit)
        }
    }

    /// Whether the virtual boundary applies: up to two exact pins only fix the similarity, others are constraints.
    fn may_bend_boundary(&self) -> bool {
        let is_exact = || self.pins.values().all(|pin| self.settings.is_exact(pin.hold));
        self.pins.len() < 2 || (self.pins.len() == 2 && is_exact())
    }

    fn next_raw(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Raw, SolveError> {
        let is_planar = self.latest.as_ref().is_some_and(|latest| latest.planar);
        let is_relaxed_by_hand = self.constrained.is_some() && self.ending == Some(Ending::Planar);
        let has_more = self.constrained.as_ref().is_some_and(|run| !run.is_exhausted());
        if is_planar && !has_more && (is_relaxed_by_hand || (self.relax_left > 0 && self.is_met())) {
            return self.relax_step(mesh, control);
        }
        let is_stuck = || self.latest.is_some() && self.ending_of_iteration().is_some();
        let climbs_on = self.settings.method == Method::Auto && !self.may_bend_boundary();
        if climbs_on && self.latest.is_none() {
            check_distances(mesh, &self.settings.held(&self.pins))?;
        }
        if self.settings.method.is_one_to_one() || self.constrained.is_some() || (climbs_on && is_stuck()) {
            return self.constrained_step(mesh, control);
        }
        if self.latest.is_none() && self.virtual_boundary.is_none() {
            return match self.linear(mesh, control) {
                Err(error) if self.has_rung_left_after(&error) => {
                    self.say(format!("the natural boundary gave nothing: {error}"));
                    if climbs_on { self.constrained_step(mesh, control) } else { self.last_rungs(mesh, control) }
                }
                other => other,
            };
        }
        let climbs = self.settings.method.bends_boundary() && self.may_bend_boundary() && self.ending.is_none();
        let iterated_out = self.settings.method == Method::VirtualBoundary || self.ending_of_iteration().is_some();
        if climbs && (iterated_out || self.virtual_boundary.is_some()) {
            return self.last_rungs(mesh, control);
        }
        match self.iterate(mesh, control) {
            Err(error) if (climbs || climbs_on) && self.ending.is_none() && error != SolveError::Cancelled => {
                self.say(format!("the iteration gave nothing: {error}"));
                if climbs_on { self.constrained_step(mesh, control) } else { self.last_rungs(mesh, control) }
            }
            other => other,
        }
    }

    /// Whether the latest embedding meets the user's exact pins.
    fn is_met(&self) -> bool {
        let Some(latest) = &self.latest else { return false };
        let exact = self.pins.iter().filter(|(_, pin)| self.settings.is_exact(pin.hold));
        exact.into_iter().all(|(v, pin)| latest.embedding[v] == pin.target)
    }

    /// One round of relaxing.
    fn relax_step(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Raw, SolveError> {
        let start = Instant::now();
        let Some(latest) = &self.latest else { return Err(SolveError::NotPlanar) };
        let refinement = latest.refinement.clone();
        let mesh = refinement.as_ref().map_or(mesh, |refinement| refinement.disk());
        let held = if self.pins.len() < 2 { Pins::new() } else { self.settings.held(&self.pins) };
        let relaxing = self.relaxing.get_or_insert_with(|| Relaxing::new(mesh, latest.embedding.clone(), &held));
        let Relaxed { mut embedding, progress, mut outside } = relaxing.round(mesh, control)?;
        if held.is_empty() {
            let before = embedding.clone();
            complete_gauge(mesh, &mut embedding, (&self.pins, self.settings.size));
            let pairs: Vec<[DVec2; 2]> = before.iter().zip(&embedding).map(|(a, b)| [*a, *b]).collect();
            if let Some(similarity) = Similarity::fitting(&pairs) {
                let frame = outside.frame.iter().map(|&z| similarity.apply(z)).collect();
                outside = Arc::new(Outside { frame, triangles: outside.triangles.clone() });
            }
        }
        let pins = if held.is_empty() { gauge_in(mesh, &embedding) } else { held };
        let solution = self.one_to_one(embedding, pins, start);
        let (progress, outside) = (Some(progress), Some(outside));
        Ok(Raw { refinement, progress, outside, ..Raw::of(Method::Relax, Family::default(), solution) })
    }

    /// A solution that no linear system stands behind.
    fn one_to_one(&self, embedding: Embedding, pins: Pins, start: Instant) -> Solution {
        Solution {
            embedding,
            pins,
            gauge_completed: self.pins.len() < 2,
            linear: None,
            seconds: PhaseSeconds { solve: start.elapsed().as_secs_f64(), ..PhaseSeconds::default() },
        }
    }

    /// Rungs 4 and 5: planar embeddings on their way to the constraints.
    fn constrained_step(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Raw, SolveError> {
        let start = Instant::now();
        let run = self.constrained.get_or_insert_with(|| ConstrainedRun::new(&self.settings, &self.pins));
        let reached = run.step(mesh, control);
        if matches!(reached, Err(SolveError::Unmet)) {
            self.ending = Some(Ending::Unmet);
        }
        let reached = reached?;
        let Reached { rung, embedding, progress, outside, refinement } = reached;
        let solution = self.one_to_one(embedding, self.settings.held(&self.pins), start);
        Ok(Raw { refinement, progress, outside, ..Raw::of(rung, Family::default(), solution) })
    }

    /// Keeps something to say about the next step, once.
    fn say(&mut self, note: String) {
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }

    /// What is left where neither the natural boundary nor the iteration helps.
    fn last_rungs(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Raw, SolveError> {
        let would_bend = self.latest.as_ref().is_none_or(|latest| !latest.has_simple_boundary);
        if would_bend && self.virtual_boundary.is_none() && self.may_start_again {
            match self.start_again(mesh, control) {
                Err(error) if error != SolveError::Cancelled => {
                    self.may_start_again = false;
                    self.say(format!("starting again gave nothing: {error}"));
                }
                other => return other,
            }
        }
        self.virtual_step(mesh, control)
    }

    /// Whether a failed linear solve leaves another rung: the system may be at fault, but not what the user asked for.
    fn has_rung_left_after(&self, error: &SolveError) -> bool {
        let of_the_system = matches!(
            error,
            SolveError::Singular { .. } | SolveError::ResidualTooLarge { .. } | SolveError::Linear { .. }
        );
        let has_rung = self.settings.method.bends_boundary() && self.may_bend_boundary();
        of_the_system && (has_rung || self.settings.method == Method::Auto)
    }

    fn linear(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Raw, SolveError> {
        if self.settings.method == Method::VirtualBoundary && !self.may_bend_boundary() {
            return Err(SolveError::TooManyPins { count: self.pins.len(), most: 2 });
        }
        let at_hand = self.prepared.take().filter(|prepared| prepared.serves(&self.settings, &self.pins));
        let prepared = match at_hand {
            Some(prepared) => prepared,
            None => Arc::new(Prepared::new(mesh, &self.settings, &self.pins, control)?),
        };
        self.prepared = Some(Arc::clone(&prepared));
        let solution = prepared.solve(mesh, &self.pins, control)?;
        let rung = match self.settings.method {
            Method::Auto | Method::Iterate | Method::VirtualBoundary => Method::Natural,
            other => other,
        };
        let family = self.settings.family;
        Ok(Raw { prepared: Some(prepared), ..Raw::of(rung, family, solution) })
    }

    /// The natural boundary with conformal weights and the default pins, moved to where the user's pins want it.
    fn start_again(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Raw, SolveError> {
        let settings = Settings { size: self.settings.size, ..Settings::new(Method::Natural, Family::default()) };
        let mut solution = flatten(mesh, &settings, &Pins::new(), control)?;
        self.may_start_again = false;
        (self.stall, self.iterations) = (Stall::default(), 0);
        self.say("started again with conformal weights and the farthest boundary vertices as pins".to_owned());
        self.fit(mesh, &mut solution);
        Ok(Raw::of(Method::Natural, settings.family, solution))
    }

    /// Moves an embedding to where up to two pins of the user's want it.
    fn fit(&mut self, mesh: &DiskMesh, solution: &mut Solution) {
        let is_fitted = fit_gauge(mesh, &mut solution.embedding, (&self.pins, self.settings.size));
        if !is_fitted {
            self.say("the pinned vertices fell together, and no similarity takes them to their targets".to_owned());
        }
        solution.gauge_completed = self.pins.len() < 2;
        let has_both = self.pins.len() == 2 && is_fitted;
        solution.pins = if has_both { self.pins.clone() } else { gauge_in(mesh, &solution.embedding) };
    }

    fn iterate(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Raw, SolveError> {
        let Some(latest) = &self.latest else { return Err(SolveError::Cancelled) };
        let pins = if latest.pins.len() >= 2 { latest.pins.clone() } else { gauge_in(mesh, &latest.embedding) };
        if self.iteration.as_ref().is_none_or(|iteration| !iteration.serves(&pins)) {
            let treatment = self.settings.treatment_on(Method::Iterate, self.pins.len());
            self.iteration = Some(Iteration::new(mesh, &latest.embedding, &pins, treatment, control)?);
        }
        let iteration = self.iteration.as_ref().expect("made above");
        let mut solution = iteration.step(mesh, &latest.embedding, control)?;
        if self.iterations == 0 {
            solution.seconds.analyze = iteration.analyze_seconds();
        }
        if self.pins.len() < 2 {
            complete_gauge(mesh, &mut solution.embedding, (&self.pins, self.settings.size));
            solution.gauge_completed = true;
            for (vertex, pin) in &mut solution.pins {
                pin.target = solution.embedding[vertex];
            }
        }
        Ok(Raw::of(Method::Iterate, Family::MeanValue, solution))
    }

    fn virtual_step(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Raw, SolveError> {
        let run = self.virtual_boundary.get_or_insert_with(|| VirtualBoundaryRun::new(mesh, &self.settings));
        let simple = self.latest.as_ref().filter(|latest| latest.has_simple_boundary);
        let bent = run.step(mesh, simple.map(|latest| &latest.embedding), control);
        for note in run.take_notes() {
            self.say(note);
        }
        let Bent { mut solution, pinned, family, stages } = bent?;
        self.fit(mesh, &mut solution);
        let bent_vertices = if pinned > 2 { pinned } else { 0 };
        Ok(Raw { bent_vertices, virtual_boundary: stages, ..Raw::of(Method::VirtualBoundary, family, solution) })
    }
}

/// The default gauge pins where they lie in an embedding.
fn gauge_in(mesh: &DiskMesh, embedding: &Embedding) -> Pins {
    fixed_pins(gauge_pins(mesh).into_keys().map(|v| (v, embedding[v])))
}
