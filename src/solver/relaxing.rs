//! Relaxing: a planar embedding's distortion is lowered, one-to-one throughout, exact pins where they are.
//!
//! Each round triangulates the outside anew and takes a few Newton steps down the symmetric Dirichlet energy of mesh and
//! outside (J. Smith, S. Schaefer, "Bijective parameterization with free boundaries", 2015). While some face is nearly
//! without area, the foldover energy goes first, which is less steep there.

use std::sync::Arc;

use super::foldover_energy::Energy;
use super::membrane::{Limits, Membrane};
use super::outside::{FRAME_POINTS, outside_of};
use super::rest::{Rest, Surrounded};
use super::{Candidate, Control, Embedding, Method, Outside, Pins, Progress, Sheet, SolveError};
use crate::mesh::DiskMesh;

/// Weight of the whole outside, that of the mesh being 1.
const OUTSIDE_WEIGHT: f64 = 0.002;

/// Newton steps of a round, and of one that begins with a face nearly without area: there a step hardly more than
/// doubles an area.
const ROUND_STEPS: usize = 5;
const STEEP_ROUND_STEPS: usize = 25;

/// A round that gains a smaller share of the energy is the last.
const TOLERANCE: f64 = 1e-3;

/// Below this determinant the symmetric Dirichlet energy is too steep to begin with.
const STEEP: f64 = 1e-3;

#[derive(Debug)]
pub(super) struct Relaxing {
    rest: Rest,
    pins: Pins,
    embedding: Embedding,
    /// How distorted the embedding is.
    progress: Progress,
    /// That of the round before, whose order of elimination is kept.
    membrane: Option<Membrane>,
    /// Whether the last round gained next to nothing.
    pub(super) has_converged: bool,
    /// How embeddings are written: what is proved.
    sheet: Arc<Sheet>,
}

impl Relaxing {
    /// Begins at a planar embedding of `mesh`; `pins` are held, exact ones where they lie.
    pub(super) fn new(mesh: &DiskMesh, embedding: Embedding, pins: &Pins) -> Self {
        let rest = Rest::new(mesh);
        let progress = rest.progress(mesh, &embedding, 0.0);
        Self {
            rest,
            pins: pins.clone(),
            embedding,
            progress,
            membrane: None,
            has_converged: false,
            sheet: Arc::default(),
        }
    }

    /// The same with embeddings proved as they are written on a sheet.
    pub(super) fn written_on(self, sheet: Arc<Sheet>) -> Self {
        Self { sheet, ..self }
    }

    /// One round. The embedding stays as it is where rounding keeps a better one from being planar.
    pub(super) fn round(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Candidate, SolveError> {
        let outside =
            outside_of(mesh, &self.embedding, std::iter::empty(), FRAME_POINTS).ok_or(SolveError::NotPlanar)?;
        match self.descend(mesh, &outside, control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            Ok(()) => {}
            // No direction of descent but for rounding: the energy is as low as it gets.
            Err(_) => self.has_converged = true,
        }
        let candidate = Candidate::one_to_one(Method::Relax, self.embedding.clone(), &self.pins);
        Ok(Candidate { progress: Some(self.progress), outside: Some(Arc::new(outside)), ..candidate })
    }

    /// Goes down the energy of mesh and outside, to what is planar there.
    fn descend(&mut self, mesh: &DiskMesh, outside: &Outside, control: Control<'_>) -> Result<(), SolveError> {
        let surrounded = Surrounded { embedding: &self.embedding, outside, weight: OUTSIDE_WEIGHT };
        let (membrane, mut z) = self.rest.membrane(mesh, surrounded, &self.pins, self.membrane.as_ref())?;
        let is_steep = self.progress.least_determinant < STEEP;
        let unfolded = if is_steep { Energy::Foldover(0.0) } else { Energy::SymmetricDirichlet };
        let steps = if is_steep { STEEP_ROUND_STEPS } else { ROUND_STEPS };
        let limits = Limits { unfolded, steps, until_unfolded: false, tolerance: 0.1 * TOLERANCE };
        let gain = membrane.descend(&mut z, limits, control)?.gain;
        self.membrane = Some(membrane);
        let z = Embedding::of_mesh(mesh, &z);
        // The outside has a small part in the energy that goes down; the faces' own must not go up for it.
        let is_drawn = is_steep || self.pins.values().any(|pin| !pin.hold.is_exact());
        let progress = self.rest.progress(mesh, &z, 0.0);
        let is_better = is_drawn || progress.energy <= self.progress.energy;
        // What the descent gains by size alone is lost again: an embedding is measured at its own size.
        let gain = if is_drawn { gain } else { 1.0 - progress.energy / self.progress.energy };
        let is_taken = is_better && self.sheet.is_planar(mesh, &z);
        if is_taken {
            (self.embedding, self.progress) = (z, progress);
        }
        let is_still_steep = self.progress.least_determinant < STEEP;
        self.has_converged = !is_taken || (gain < TOLERANCE && is_still_steep == is_steep);
        Ok(())
    }
}
