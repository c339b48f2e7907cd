//! Springs in place of hard pins if the response is narrow, so that pins can pass around each other.

use std::sync::Arc;

use glam::DVec2;

use super::super::Advance;
use super::{Continuation, Settled, downhill};
use crate::mesh::DiskMesh;
use crate::nonlinear::energy_problem::Planning;
use crate::problem::{Control, Embedding, Pin, PinKind, SolveError};

/// Share of the response without a folded face below which springs replace the pins, drawing them to their targets.
const NARROW: f64 = 0.25;
/// Weights of the springs at successive uses, increasing.
const LOOSE_WEIGHTS: [f64; 5] = [30.0, 100.0, 300.0, 1000.0, 3000.0];
/// Newton steps at each use of springs.
const LOOSE_STEPS: usize = 10;

/// Weights of the springs, in this order, at the restart from the initial embedding.
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
                    // A cancelled restart can be tried again: earlier distances are discarded only when it succeeds.
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

    /// Advances along the response, or replaces the pins by springs if the response is narrow.
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

    /// Minimises the energy with springs in place of hard pins. Returns true if the result is one-to-one and was
    /// accepted.
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
        problem.descend(&mut points, downhill(LOOSE_STEPS), None, control)?;
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
