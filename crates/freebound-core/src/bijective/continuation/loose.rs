//! Springs instead of pins, where the response is narrow: pins pass around each other.

use std::sync::Arc;

use glam::DVec2;

use super::super::Advance;
use super::{Continuation, Settled, downhill};
use crate::mesh::DiskMesh;
use crate::nonlinear::energy_problem::Planning;
use crate::problem::{Control, Embedding, Pin, PinKind, SolveError};

/// Where less of the response than this folds no face, pins are let loose: springs draw them to their
/// targets, by a greater weight each time, and they pass around each other.
const NARROW: f64 = 0.25;
const LOOSE_WEIGHTS: [f64; 5] = [30.0, 100.0, 300.0, 1000.0, 3000.0];
const LOOSE_STEPS: usize = 10;

/// Weights of the springs, one after another, by which a second try begins.
const TIGHTENING: [f64; 6] = [3.0, 10.0, 30.0, 100.0, 300.0, 1000.0];

impl Continuation {
    pub(super) fn begin_again(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Advance, SolveError> {
        let start = self.start.take().ok_or(SolveError::Unmet)?;
        let stopped_at = std::mem::replace(&mut self.embedding, start);
        let outside = self.outside_of(mesh, &self.embedding).ok_or(SolveError::Unmet)?;
        for weight in TIGHTENING {
            if let Err(error) = self.loosen(mesh, weight, control) {
                let start = std::mem::replace(&mut self.embedding, stopped_at);
                if error == SolveError::Cancelled {
                    // As if nothing had been tried: the steps before are forgotten only when it has begun.
                    self.start = Some(start);
                }
                return Err(error);
            }
        }
        (self.settled, self.is_loose) = (None, true);
        self.distances.clear();
        let progress = self.progress(mesh);
        Ok(self.accepted(progress, Arc::new(outside)))
    }

    /// Goes on along the response, or lets the pins loose where it is narrow.
    pub(super) fn loosen_or_advance(
        &mut self,
        mesh: &DiskMesh,
        settled: &Settled,
        moves: &[DVec2],
        control: Control<'_>,
    ) -> Result<bool, SolveError> {
        let longest = settled.problem.longest_step(&settled.points, moves, mesh.face_count());
        let weight = LOOSE_WEIGHTS.get(self.loosened).filter(|_| longest < NARROW && !self.is_loose);
        self.is_loose = match weight {
            Some(&weight) => self.loosen(mesh, weight, control)?,
            None => false,
        };
        self.loosened += usize::from(weight.is_some());
        Ok(self.is_loose || self.advance(mesh, settled, moves, control)?)
    }

    /// Lowers the energy with springs in the place of exact pins. Returns whether that is planar.
    fn loosen(&mut self, mesh: &DiskMesh, weight: f64, control: Control<'_>) -> Result<bool, SolveError> {
        let loose = self.pins.iter().map(|(&v, pin)| match pin.kind {
            PinKind::Soft(_) => (v, *pin),
            _ => (v, Pin::weighted(pin.target, weight)),
        });
        let Some(Settled { problem, mut points, .. }) =
            self.surround(mesh, &self.embedding, &loose.collect(), Planning { order: None, control })?
        else {
            return Ok(false);
        };
        problem.descend(&mut points, downhill(LOOSE_STEPS), control)?;
        control.go_on()?;
        let z = Embedding::of_mesh(mesh, &points);
        let is_taken = self.sheet.is_one_to_one(mesh, &z);
        control.go_on()?;
        if is_taken {
            (self.embedding, self.settled) = (z, None);
        }
        Ok(is_taken)
    }
}
