//! What follows a planar embedding: rounds of relaxing, each of lower distortion.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;

use super::rung::{Failure, Footing, Handover, Latest, Rung};
use super::task::Task;
use super::{Candidate, Step, gauge_in};
use crate::geom::Similarity;
use crate::mesh::DiskMesh;
use crate::solver::relaxing::Relaxing;
use crate::solver::scale::complete_gauge;
use crate::solver::{Control, Outside, Pins, SolveError};

#[derive(Debug, Default)]
pub(super) struct Relax {
    relaxing: Option<Relaxing>,
    /// Rounds that may still follow.
    rounds_left: usize,
}

impl Relax {
    /// Lets so many rounds follow, from the latest embedding on.
    pub(super) fn begin(&mut self, rounds: usize) {
        (self.relaxing, self.rounds_left) = (None, rounds);
    }

    fn round(&mut self, from: Footing<'_>, control: Control<'_>) -> Result<Candidate, SolveError> {
        let Footing { task, mesh, latest } = from;
        let start = Instant::now();
        let latest = latest.ok_or(SolveError::NotPlanar)?;
        let refinement = latest.refinement.clone();
        let mesh = refinement.as_ref().map_or(mesh, |refinement| refinement.disk());
        let held = if task.has_open_gauge() { Pins::new() } else { task.held() };
        let relaxing = self.relaxing.get_or_insert_with(|| Relaxing::new(mesh, latest.embedding.clone(), &held));
        let mut candidate = relaxing.round(mesh, control)?;
        if held.is_empty() {
            place(task, mesh, &mut candidate);
        }
        Ok(Candidate { refinement, ..candidate.since(start) })
    }
}

impl Rung for Relax {
    fn step(&mut self, from: Footing<'_>, control: Control<'_>) -> Result<Candidate, Failure> {
        self.round(from, control).map_err(|error| {
            // What was planar before is still there to go on from.
            let is_start = !from.task.is_constrained();
            let handover = (is_start && error != SolveError::Cancelled).then(Handover::default);
            Failure { error, handover }
        })
    }

    fn has_more(&self, _: &Task, _: Option<&Latest>) -> bool {
        self.rounds_left > 0 && !self.relaxing.as_ref().is_some_and(|relaxing| relaxing.has_converged)
    }

    fn look_at(&mut self, _: &Step) {
        self.rounds_left = self.rounds_left.saturating_sub(1);
    }
}

/// Moves an embedding that no pins hold to where it is asked for, its outside with it.
fn place(task: &Task, mesh: &DiskMesh, candidate: &mut Candidate) {
    let solution = &mut candidate.solution;
    let before = solution.embedding.clone();
    complete_gauge(mesh, &mut solution.embedding, &task.pins, task.settings.size);
    solution.pins = gauge_in(mesh, &solution.embedding);
    let pairs: Vec<[DVec2; 2]> = before.iter().zip(&solution.embedding).map(|(a, b)| [*a, *b]).collect();
    if let (Some(similarity), Some(outside)) = (Similarity::fitting(&pairs), &candidate.outside) {
        let frame = outside.frame.iter().map(|&z| similarity.apply(z)).collect();
        candidate.outside = Some(Arc::new(Outside { frame, triangles: outside.triangles.clone() }));
    }
}
