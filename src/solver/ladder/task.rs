//! What is asked for: settings and pins.

use super::gauge_in;
use super::rung::Notes;
use crate::mesh::DiskMesh;
use crate::solver::pins::GAUGE_PINS;
use crate::solver::scale::fit_gauge;
use crate::solver::{Conflict, Method, Pins, Settings, Solution, SolveError, check_pins, conflicts};

#[derive(Debug)]
pub(super) struct Task {
    pub(super) settings: Settings,
    pub(super) pins: Pins,
}

impl Task {
    /// Pins count only where the method uses them.
    pub(super) fn new(settings: Settings, pins: Pins) -> Self {
        Self { settings, pins: if settings.method.uses_pins() { pins } else { Pins::new() } }
    }

    /// Whether the pins are constraints: up to two exact ones only fix the similarity.
    pub(super) fn is_constrained(&self) -> bool {
        let is_exact = || self.pins.values().all(|pin| self.settings.is_exact(pin.hold));
        self.pins.len() > GAUGE_PINS || (self.pins.len() == GAUGE_PINS && !is_exact())
    }

    pub(super) fn has_open_gauge(&self) -> bool {
        self.pins.len() < GAUGE_PINS
    }

    pub(super) fn held(&self) -> Pins {
        self.settings.held(&self.pins)
    }

    /// Whether new vertices are made where the constraints cannot be met otherwise.
    pub(super) fn adds_vertices(&self) -> bool {
        self.settings.method == Method::Auto && self.settings.new_vertices
    }

    /// Checks what the first rung does not.
    pub(super) fn check(&self, mesh: &DiskMesh) -> Result<(), SolveError> {
        match self.settings.method {
            Method::VirtualBoundary | Method::Schnyder if self.is_constrained() => {
                Err(SolveError::TooManyPins { count: self.pins.len(), most: GAUGE_PINS })
            }
            Method::Auto if self.is_constrained() => check_distances(mesh, &self.held()),
            method if method.is_one_to_one() => {
                check_pins(mesh, &self.held())?;
                check_distances(mesh, &self.held())
            }
            _ => Ok(()),
        }
    }

    /// Moves an embedding to where up to two pins want it.
    pub(super) fn fit(&self, mesh: &DiskMesh, solution: &mut Solution, notes: &mut Notes) {
        let is_fitted = fit_gauge(mesh, &mut solution.embedding, &self.pins, self.settings.size);
        if !is_fitted {
            notes.say("the pinned vertices fell together, and no similarity takes them to their targets".to_owned());
        }
        solution.gauge_completed = self.has_open_gauge();
        let has_both = self.pins.len() == GAUGE_PINS && is_fitted;
        solution.pins = if has_both { self.pins.clone() } else { gauge_in(mesh, &solution.embedding) };
    }
}

/// Checks that no two exact targets are so near that numbers between them run out.
fn check_distances(mesh: &DiskMesh, pins: &Pins) -> Result<(), SolveError> {
    for conflict in conflicts(mesh, pins) {
        if let Conflict::TooNear { vertices: [first, second] } = conflict {
            return Err(SolveError::TargetsTooNear { first, second });
        }
    }
    Ok(())
}
