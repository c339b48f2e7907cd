//! Newton's method on the angles: a step, how much of it is taken, and when it ends.
//!
//! # Equation
//!
//! With the multipliers λ of the wheels (those of sums have no curvature) the Lagrangian's Hessian is diagonal:
//!
//! ```text
//! W_i = 2/φ_i² + κ/α_i² + (λ_next − λ_previous) / sin² α_i
//! ```
//!
//! `next` is the vertex at the face's next corner: it sees `α_i` as the angle of its previous corner, and the other way
//! round. Where the last term is below zero, W is kept above a share of the others: so W is positive, and every step goes
//! down the merit
//!
//! ```text
//! E(α) + Σ μ |c|        μ a little above |λ|
//! ```
//!
//! A step is taken as far as no angle loses more than a share of what it has to 0 or π, and is then halved until the
//! merit goes down.
//!
//! # Angles that would become 0
//!
//! Nothing in the energy forbids an angle of 0, and on some surfaces the least energy has one. The source raises such
//! angles' weights and starts again. Here a *barrier* stands in where a step is cut short by them,
//!
//! ```text
//! E(α) = Σ (α/φ − 1)² + κ (α/φ − 1 − ln α/φ)
//! ```
//!
//! with its own least at φ, as the energy. κ falls step by step to a least one, and then to 0: where the energy has its
//! least at positive angles, that is the answer; where it has not, the answer is that of the least barrier.

use std::f64::consts::PI;

use super::AngleSystem;
use super::full::Full;
use super::net::{Net, face_gaps};
use super::reduced::Reduced;
use crate::problem::{Control, Convergence, Phase, SolveError, Stop};

/// The most steps.
const MOST_STEPS: usize = 100;

/// A whole step that moves no angle by more than this, radians, is the last.
const STILL: f64 = 1e-10;

/// The least W, as a share of what it is without the wheels.
const LEAST_CURVATURE: f64 = 0.1;

/// The most that an angle may lose at once of what it has to 0 and to π.
const MOST_LOST: f64 = 0.9;

/// A step that an angle cuts down to a smaller part than this leads to angles of 0.
const SHORT: f64 = 0.25;

/// The barrier κ: what it begins with, to which part it falls each time, and what is hardly more than the least.
const GREATEST_BARRIER: f64 = 1.0;
const FALL: f64 = 0.1;
const LEAST_BARRIER: f64 = 0.011;

/// A whole step that changes no angle by more than this part of it lets the barrier fall.
const NEARLY_STILL: f64 = 0.1;

/// Penalties are so many times the multipliers.
const PENALTY: f64 = 1.5;

/// The least decrease of the merit, by what the step promises; and what of the merit is rounding.
const DECREASE: f64 = 1e-4;
const ROUNDING: f64 = 1e-12;

/// Halvings of a step before it counts as none.
const HALVINGS: usize = 30;

/// Where the problem stands, as a linear system of a step takes it.
pub(super) struct Linearised<'a> {
    pub(super) net: &'a Net<'a>,
    pub(super) angles: &'a [[f64; 3]],
    /// ∇E.
    pub(super) gradient: Vec<[f64; 3]>,
    /// W.
    pub(super) curvatures: Vec<[f64; 3]>,
    /// What is left of sum and wheel around each inner vertex.
    pub(super) gaps: Vec<[f64; 2]>,
    /// What is left of the sum of each face.
    pub(super) face_gaps: Vec<f64>,
}

/// A step: moves of the angles, and the multipliers of inner vertices after it.
#[derive(Debug)]
pub(super) struct Direction {
    pub(super) angles: Vec<[f64; 3]>,
    pub(super) multipliers: Vec<[f64; 2]>,
}

/// Where it ended.
pub(super) struct Found {
    pub(super) angles: Vec<[f64; 3]>,
    pub(super) convergence: Convergence,
    /// Σ (α/φ − 1)².
    pub(super) energy: f64,
    /// κ at the end.
    pub(super) barrier: f64,
    /// Angles that the barrier keeps from 0.
    pub(super) held: usize,
}

/// Where a barrier came to.
#[derive(Debug)]
struct Kept {
    angles: Vec<[f64; 3]>,
    barrier: f64,
}

#[derive(Debug)]
enum System {
    Full(Box<Full>),
    Reduced(Reduced),
}

/// How a step ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NewtonState {
    GoesOn,
    /// Another step would hardly change anything.
    Arrived,
    /// It leads to angles of 0, or to nothing better.
    Blocked,
}

#[derive(Debug)]
pub(super) struct Newton<'a> {
    net: &'a Net<'a>,
    system: System,
    angles: Vec<[f64; 3]>,
    multipliers: Vec<[f64; 2]>,
    penalties: Vec<[f64; 2]>,
    /// κ.
    barrier: f64,
    /// Where the least barrier came to, while it is tried without one.
    kept: Option<Kept>,
    steps: usize,
}

impl<'a> Newton<'a> {
    pub(super) fn new(net: &'a Net<'a>, system: AngleSystem, control: Control<'_>) -> Result<Self, SolveError> {
        let system = match system {
            AngleSystem::Full => System::Full(Box::new(Full::new(net, control)?)),
            AngleSystem::Reduced => System::Reduced(Reduced::new(net, control)?),
        };
        let none = vec![[0.0; 2]; net.inner.len()];
        let (angles, multipliers, penalties) = (net.first_angles(), none.clone(), none);
        Ok(Self { net, system, angles, multipliers, penalties, barrier: 0.0, kept: None, steps: 0 })
    }

    pub(super) fn run(mut self, control: Control<'_>) -> Result<Found, SolveError> {
        while self.steps < MOST_STEPS {
            control.enter(Phase::Solve)?;
            let stage = match self.step(control) {
                // Angles that are next to 0 make systems that cannot be solved.
                Err(error) if error != SolveError::Cancelled && self.barrier == 0.0 => NewtonState::Blocked,
                other => other?,
            };
            match stage {
                NewtonState::GoesOn => {}
                NewtonState::Arrived if self.barrier > LEAST_BARRIER => self.barrier *= FALL,
                NewtonState::Arrived if self.barrier > 0.0 => {
                    self.kept = Some(Kept { angles: self.angles.clone(), barrier: self.barrier });
                    self.barrier = 0.0;
                }
                NewtonState::Arrived => {
                    self.kept = None;
                    return self.found(Stop::Converged, control);
                }
                NewtonState::Blocked if self.kept.is_none() && self.barrier == 0.0 => self.start_behind_barrier(),
                NewtonState::Blocked => return self.found(Stop::Stalled, control),
            }
        }
        self.found(Stop::Limit, control)
    }

    /// Starts again, with a barrier.
    fn start_behind_barrier(&mut self) {
        let none = vec![[0.0; 2]; self.net.inner.len()];
        self.angles = self.net.first_angles();
        (self.multipliers, self.penalties) = (none.clone(), none);
        self.barrier = GREATEST_BARRIER;
    }

    /// The end. What converged with the least barrier, and has not without it, is as it was with it: the least of the energy
    /// with that barrier.
    fn found(self, stop: Stop, control: Control<'_>) -> Result<Found, SolveError> {
        let Self { net, angles, barrier, kept, steps, .. } = self;
        let (angles, barrier, stop) = match kept {
            Some(kept) => (kept.angles, kept.barrier, Stop::Converged),
            None => (angles, barrier, stop),
        };
        let pairs = || angles.as_flattened().iter().zip(net.targets.as_flattened());
        // Below this the barrier, κ/α², is curved more than the energy, 2/φ². On the way to the end that tells nothing.
        let most = if stop == Stop::Converged { (barrier / 2.0).sqrt() } else { 0.0 };
        let held = pairs().filter(|(angle, target)| **angle < most * **target).count();
        let energy = pairs().map(|(angle, target)| (angle / target - 1.0).powi(2)).sum();
        let gaps = net.gaps(&angles, control)?;
        let residual = largest(gaps.as_flattened()).max(largest(&face_gaps(&angles)));
        Ok(Found { angles, convergence: Convergence { steps, residual, stop }, energy, barrier, held })
    }

    fn step(&mut self, control: Control<'_>) -> Result<NewtonState, SolveError> {
        self.steps += 1;
        let at = self.linearised(control)?;
        let direction = match &self.system {
            System::Full(full) => full.direction(&at, control)?,
            System::Reduced(reduced) => reduced.direction(&at, control)?,
        };
        control.go_on()?;
        let before = Before { descent: descent(&at, &direction), gaps: at.gaps };
        let longest = self.longest(&direction);
        if self.barrier == 0.0 && longest < SHORT {
            return Ok(NewtonState::Blocked);
        }
        let is_still = if self.barrier > LEAST_BARRIER {
            let moves = direction.angles.as_flattened().iter().zip(self.angles.as_flattened());
            moves.map(|(by, angle)| by.abs() / angle).fold(0.0, f64::max) <= NEARLY_STILL
        } else {
            largest(direction.angles.as_flattened()) <= STILL
        };
        control.go_on()?;
        Ok(match self.take(&direction, &before, longest, control)? {
            None => NewtonState::Blocked,
            Some(taken) if taken >= 1.0 && is_still => NewtonState::Arrived,
            Some(_) => NewtonState::GoesOn,
        })
    }

    fn linearised(&self, control: Control<'_>) -> Result<Linearised<'_>, SolveError> {
        let (net, barrier) = (self.net, self.barrier);
        let gradient = |face: usize| {
            let (angles, targets) = (self.angles[face], net.targets[face]);
            [0, 1, 2].map(|k| {
                let (angle, target) = (angles[k], targets[k]);
                2.0 * (angle / target - 1.0) / target + barrier * (1.0 / target - 1.0 / angle)
            })
        };
        let curvature = |face: usize| {
            let (angles, targets) = (self.angles[face], net.targets[face]);
            let wheels =
                net.corners[face].map(|place| self.multipliers.get(place as usize).map_or(0.0, |pair| pair[1]));
            [0, 1, 2].map(|k| {
                let own = 2.0 / (targets[k] * targets[k]) + barrier / (angles[k] * angles[k]);
                let bend = (wheels[(k + 1) % 3] - wheels[(k + 2) % 3]) / angles[k].sin().powi(2);
                (own + bend).max(LEAST_CURVATURE * own)
            })
        };
        let count = self.angles.len();
        let (gradient, curvatures) = (control.each(count, gradient)?, control.each(count, curvature)?);
        let gaps = net.gaps(&self.angles, control)?;
        Ok(Linearised { net, angles: &self.angles, gradient, curvatures, gaps, face_gaps: face_gaps(&self.angles) })
    }

    /// Takes as much of a step as serves. Returns how much, none where nothing does.
    fn take(
        &mut self,
        direction: &Direction,
        before: &Before,
        longest: f64,
        control: Control<'_>,
    ) -> Result<Option<f64>, SolveError> {
        let multipliers = direction.multipliers.as_flattened();
        for (penalty, multiplier) in self.penalties.as_flattened_mut().iter_mut().zip(multipliers) {
            let wanted = PENALTY * multiplier.abs();
            *penalty = wanted.max(0.5 * (*penalty + wanted));
        }
        let merit = self.merit(&self.angles, &before.gaps);
        // What is still moves by rounding, which the merit does not tell from a step.
        let is_still = largest(direction.angles.as_flattened()) <= STILL;
        let mut step = longest;
        for _ in 0..HALVINGS {
            let trial = moved(&self.angles, &direction.angles, step);
            let most = merit - DECREASE * step * before.descent + ROUNDING * merit;
            if is_still || self.merit(&trial, &self.net.gaps(&trial, control)?) <= most {
                self.angles = trial;
                for (old, new) in self.multipliers.as_flattened_mut().iter_mut().zip(multipliers) {
                    *old += step * (new - *old);
                }
                return Ok(Some(step));
            }
            step *= 0.5;
        }
        Ok(None)
    }

    /// The longest part of a step, up to all of it, that leaves every angle some of what it has to 0 and π.
    fn longest(&self, direction: &Direction) -> f64 {
        let of_angle = |(&angle, &by): (&f64, &f64)| {
            let room = if by < 0.0 { angle } else { PI - angle };
            if by == 0.0 { f64::INFINITY } else { MOST_LOST * room / by.abs() }
        };
        let all = self.angles.as_flattened().iter().zip(direction.angles.as_flattened());
        all.map(of_angle).fold(1.0, f64::min)
    }

    fn merit(&self, angles: &[[f64; 3]], gaps: &[[f64; 2]]) -> f64 {
        let of_angle = |(angle, target): (&f64, &f64)| {
            let off = angle / target - 1.0;
            let barrier = if self.barrier > 0.0 { self.barrier * (off - (angle / target).ln()) } else { 0.0 };
            off * off + barrier
        };
        let energy: f64 = angles.as_flattened().iter().zip(self.net.targets.as_flattened()).map(of_angle).sum();
        let penalties = self.penalties.as_flattened().iter().zip(gaps.as_flattened());
        energy + penalties.map(|(penalty, gap)| penalty * gap.abs()).sum::<f64>()
    }
}

/// What a step begins from, and what it promises.
struct Before {
    gaps: Vec<[f64; 2]>,
    descent: f64,
}

/// δᵀ W δ, by which the merit goes down at least, to first order.
fn descent(at: &Linearised<'_>, direction: &Direction) -> f64 {
    let work = |(w, d): (&f64, &f64)| w * d * d;
    at.curvatures.as_flattened().iter().zip(direction.angles.as_flattened()).map(work).sum()
}

fn moved(angles: &[[f64; 3]], by: &[[f64; 3]], step: f64) -> Vec<[f64; 3]> {
    angles.iter().zip(by).map(|(angles, by)| [0, 1, 2].map(|k| angles[k] + step * by[k])).collect()
}

/// The largest amount; a NaN where there is one.
fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |largest: f64, number| if number.abs() <= largest { largest } else { number.abs() })
}
