//! Newton's method on the angles: steps, step lengths and stop criteria.
//!
//! # Equation
//!
//! With the multipliers λ of the wheels (multipliers of sums have no curvature) the Lagrangian's Hessian is diagonal:
//!
//! ```text
//! W_i = 2/φ_i² + κ/α_i² + (λ_next − λ_previous) / sin² α_i
//! ```
//!
//! `next` is the vertex at the face's next corner; it sees `α_i` as the angle of its previous corner. `previous` sees
//! it as the angle of its next corner. If the last term is negative, W is kept above a share of the other terms. So W
//! is positive, and every step reduces the merit
//!
//! ```text
//! E(α) + Σ μ |c|        μ slightly above |λ|
//! ```
//!
//! A step is shortened until no angle loses more than a share of its distance to 0 or π. Then it is halved until the
//! merit falls.
//!
//! # Angles that would become 0
//!
//! The energy does not forbid an angle of 0, and on some surfaces its minimum has such angles. The source raises the
//! weights of such angles and restarts. This implementation adds a *barrier* once a step is cut short by them:
//!
//! ```text
//! E(α) = Σ (α/φ − 1)² + κ (α/φ − 1 − ln α/φ)
//! ```
//!
//! The barrier, like the energy, has its minimum at φ. κ falls step by step to a smallest value, and then to 0. If the
//! energy has its minimum at positive angles, that minimum is the result. Otherwise the result is the minimum with the
//! smallest barrier.

use std::f64::consts::PI;

use super::AngleSystem;
use super::full::Full;
use super::net::{Net, face_gaps};
use super::reduced::Reduced;
use crate::problem::{Control, Convergence, Phase, SolveError, Stop};

/// Largest number of steps.
const MOST_STEPS: usize = 100;

/// Largest change of an angle, radians, in a whole step after which the iteration stops.
const STILL: f64 = 1e-10;

/// Smallest W, relative to W without the wheels.
const LEAST_CURVATURE: f64 = 0.1;

/// Largest share of its distance to 0 or π that an angle may lose in one step.
const MOST_LOST: f64 = 0.9;

/// A step shortened below this fraction by an angle leads to angles of 0.
const SHORT: f64 = 0.25;

/// Initial barrier κ.
const GREATEST_BARRIER: f64 = 1.0;
/// Factor of κ in each reduction.
const FALL: f64 = 0.1;
/// Barriers up to this bound count as the smallest one. The bound is slightly above `GREATEST_BARRIER · FALL²`.
const LEAST_BARRIER: f64 = 0.011;

/// Largest relative change of an angle in a whole step after which the barrier is reduced.
const NEARLY_STILL: f64 = 0.1;

/// Ratio of penalties to multipliers.
const PENALTY: f64 = 1.5;

/// Smallest decrease of the merit, relative to the decrease that the step predicts.
const DECREASE: f64 = 1e-4;
/// Rounding error of the merit, relative to the merit.
const ROUNDING: f64 = 1e-12;

/// Number of halvings of a step before it counts as failed.
const HALVINGS: usize = 30;

/// Problem linearised at the current angles, the input of a step's linear system.
pub(super) struct Linearised<'a> {
    pub(super) net: &'a Net<'a>,
    pub(super) angles: &'a [[f64; 3]],
    /// Gradient ∇E.
    pub(super) gradient: Vec<[f64; 3]>,
    /// Diagonal W.
    pub(super) curvatures: Vec<[f64; 3]>,
    /// Residuals of sum and wheel around each inner vertex.
    pub(super) gaps: Vec<[f64; 2]>,
    /// Residual of the angle sum of each face.
    pub(super) face_gaps: Vec<f64>,
}

/// Newton step: moves of the angles, and the new multipliers of inner vertices.
#[derive(Debug)]
pub(super) struct Direction {
    pub(super) angles: Vec<[f64; 3]>,
    pub(super) multipliers: Vec<[f64; 2]>,
}

/// Result of the iteration.
pub(super) struct Found {
    pub(super) angles: Vec<[f64; 3]>,
    pub(super) convergence: Convergence,
    /// Energy Σ (α/φ − 1)².
    pub(super) energy: f64,
    /// Final κ.
    pub(super) barrier: f64,
    /// Number of angles that the barrier keeps from 0.
    pub(super) held: usize,
}

/// Result with the smallest barrier.
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

/// State after a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NewtonState {
    GoesOn,
    /// Converged: another step would hardly change anything.
    Arrived,
    /// Failed: the step leads to angles of 0, or to no smaller merit.
    Blocked,
}

#[derive(Debug)]
pub(super) struct Newton<'a> {
    net: &'a Net<'a>,
    system: System,
    angles: Vec<[f64; 3]>,
    multipliers: Vec<[f64; 2]>,
    penalties: Vec<[f64; 2]>,
    /// Weight κ of the barrier.
    barrier: f64,
    /// Result with the smallest barrier, while the iteration runs without a barrier.
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
                // Angles near 0 make singular systems.
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

    /// Restarts with the initial barrier.
    fn start_behind_barrier(&mut self) {
        let none = vec![[0.0; 2]; self.net.inner.len()];
        self.angles = self.net.first_angles();
        (self.multipliers, self.penalties) = (none.clone(), none);
        self.barrier = GREATEST_BARRIER;
    }

    /// Builds the result. If the iteration converged with the smallest barrier but not without it, the result is the
    /// minimum with that barrier.
    fn found(self, stop: Stop, control: Control<'_>) -> Result<Found, SolveError> {
        let Self { net, angles, barrier, kept, steps, .. } = self;
        let (angles, barrier, stop) = match kept {
            Some(kept) => (kept.angles, kept.barrier, Stop::Converged),
            None => (angles, barrier, stop),
        };
        let pairs = || angles.as_flattened().iter().zip(net.targets.as_flattened());
        // Below this ratio to φ the barrier's curvature κ/α² exceeds the energy's 2/φ². Before convergence this means
        // nothing.
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

    /// Applies as much of a step as reduces the merit. Returns the applied fraction, or `None` if no fraction does.
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
        // At convergence angles move by rounding only, which the merit cannot tell from a step.
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

    /// Longest fraction of a step, at most 1, after which every angle keeps part of its distance to 0 and π.
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

/// Residuals before a step, and the merit decrease that it predicts.
struct Before {
    gaps: Vec<[f64; 2]>,
    descent: f64,
}

/// Smallest first-order decrease of the merit, δᵀ W δ.
fn descent(at: &Linearised<'_>, direction: &Direction) -> f64 {
    let work = |(w, d): (&f64, &f64)| w * d * d;
    at.curvatures.as_flattened().iter().zip(direction.angles.as_flattened()).map(work).sum()
}

fn moved(angles: &[[f64; 3]], by: &[[f64; 3]], step: f64) -> Vec<[f64; 3]> {
    angles.iter().zip(by).map(|(angles, by)| [0, 1, 2].map(|k| angles[k] + step * by[k])).collect()
}

/// Largest absolute value; NaN if any number is NaN.
fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |largest: f64, number| if number.abs() <= largest { largest } else { number.abs() })
}
