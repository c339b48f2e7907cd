//! Relaxing: a planar embedding's distortion is lowered, one-to-one throughout, exact pins where they are.
//!
//! Each round triangulates the outside anew and takes a few Newton steps down the symmetric Dirichlet energy of mesh and
//! outside (J. Smith, S. Schaefer, "Bijective parameterization with free boundaries", 2015). While some face is nearly
//! without area, the foldover energy goes first, which is less steep there.
//!
//! Where the mesh has polygons, the triangles at their corners have energies too: a polygon that is convex stays so, and
//! one that is not is unfolded like any folded triangle, by the same energy with ε > 0.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | [`Relaxing`]: round by round down the energy |
//! | `coarse.rs` | by way of a disk with fewer vertices, where the energy is huge |

mod coarse;

use std::sync::Arc;

pub(super) use coarse::Relaxed;

use super::foldover_energy::Energy;
use super::membrane::{Limits, Planning, Unfolding};
use super::outside::{FRAME_POINTS, outside_of};
use super::rest::{Rest, Surrounded};
use super::{Candidate, Control, Embedding, Method, Outside, Pins, Progress, Sheet, SolveError};
use crate::linalg::EliminationOrder;
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

/// Rounds in a row without a lower energy than ever before, by more than this share, after which it goes round in circles.
const PATIENCE: usize = 5;
const LOWER: f64 = 1e-9;

#[derive(Debug)]
pub(super) struct Relaxing {
    rest: Rest,
    /// The same with the triangles at the corners of polygons, where there are any.
    with_ears: Option<Rest>,
    pins: Pins,
    embedding: Embedding,
    /// How distorted the embedding is: over the faces, and over all that has an energy.
    progress: Progress,
    inner: Progress,
    /// The order of elimination of the round before.
    order: Option<EliminationOrder>,
    stall: Stall,
    /// Whether the last round gained next to nothing.
    pub(super) has_converged: bool,
    /// How embeddings are written: what is proved.
    sheet: Arc<Sheet>,
    /// Whether the next round may begin by way of a disk with fewer vertices.
    may_go_by_coarse: bool,
}

impl Relaxing {
    /// Begins at a one-to-one embedding of `mesh`; `pins` are held, exact ones where they lie.
    pub(super) fn new(mesh: &DiskMesh, embedding: Embedding, pins: &Pins) -> Self {
        let rest = Rest::new(mesh);
        let with_ears = Rest::with_ears(mesh);
        let progress = rest.progress(mesh, &embedding, 0.0);
        let inner = with_ears.as_ref().map_or(progress, |all| all.progress(mesh, &embedding, 0.0));
        Self {
            rest,
            with_ears,
            pins: pins.clone(),
            embedding,
            progress,
            inner,
            order: None,
            stall: Stall::default(),
            has_converged: false,
            sheet: Arc::default(),
            may_go_by_coarse: true,
        }
    }

    /// The same with embeddings proved as they are written on a sheet.
    pub(super) fn written_on(self, sheet: Arc<Sheet>) -> Self {
        Self { sheet, ..self }
    }

    /// One round. The embedding stays as it is where rounding keeps a better one from being planar.
    pub(super) fn round(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Candidate, SolveError> {
        if self.may_go_by_coarse {
            self.go_by_way_of_coarse(mesh, control)?;
            self.may_go_by_coarse = false;
        }
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

    /// Goes down the energy of mesh and outside, to what is one-to-one there, and planar if it was.
    fn descend(&mut self, mesh: &DiskMesh, outside: &Outside, control: Control<'_>) -> Result<(), SolveError> {
        let surrounded = Surrounded { embedding: &self.embedding, outside, weight: OUTSIDE_WEIGHT };
        let all = self.with_ears.as_ref().unwrap_or(&self.rest);
        let planning = Planning { order: self.order.as_ref(), control };
        let (membrane, mut z) = all.membrane(mesh, surrounded, &self.pins, planning)?;
        let before = self.inner;
        let folded = if before.least_determinant > 0.0 { 0 } else { all.folded_count(mesh, &self.embedding) };
        let is_steep = before.least_determinant < STEEP;
        let unfolded = if is_steep { Energy::Foldover(0.0) } else { Energy::SymmetricDirichlet };
        let steps = if is_steep { STEEP_ROUND_STEPS } else { ROUND_STEPS };
        let unfolding = Unfolding::BesideBarriers;
        let limits = Limits { unfolded, steps, unfolding, tolerance: 0.1 * TOLERANCE };
        let gain = membrane.descend(&mut z, limits, control)?.gain;
        let pull = membrane.pull(&z);
        let z = Embedding::of_mesh(mesh, &z);
        // The outside has a small part in the energy that goes down; the faces' own must not go up for it.
        let is_drawn = is_steep || self.pins.values().any(|pin| !pin.hold.is_exact());
        let inner = all.progress(mesh, &z, 0.0);
        let is_better = is_drawn || inner.energy <= before.energy;
        // What the descent gains by size alone is lost again: an embedding is measured at its own size.
        let gain = if is_drawn { gain } else { 1.0 - inner.energy / before.energy };
        let must_be_planar = folded == 0 && self.with_ears.is_some() && self.sheet.is_planar(mesh, &self.embedding);
        let is_taken = is_better
            && if must_be_planar { self.sheet.is_planar(mesh, &z) } else { self.sheet.is_one_to_one(mesh, &z) };
        let is_unfolding = is_taken && folded > 0 && all.folded_count(mesh, &z) < folded;
        if is_taken {
            let progress = if self.with_ears.is_some() { self.rest.progress(mesh, &z, 0.0) } else { inner };
            (self.embedding, self.progress, self.inner) = (z, progress, inner);
        }
        self.order = membrane.order();
        let is_still_steep = self.inner.least_determinant < STEEP;
        self.has_converged = !is_taken || (gain < TOLERANCE && is_still_steep == is_steep && !is_unfolding);
        if is_taken && !is_unfolding {
            let own = if is_steep { all.energy(mesh, &self.embedding, unfolded) } else { 0.5 * inner.energy };
            self.stall.look_at(is_steep, own + pull);
            self.has_converged |= self.stall.is_reached();
        }
        Ok(())
    }
}

/// Watches for rounds that lead nowhere, such as those that come to the steep and leave it again and again.
#[derive(Debug, Default)]
struct Stall {
    /// The lowest energy after a steep round, and after another.
    lowest: [Option<f64>; 2],
    rounds_since: usize,
}

impl Stall {
    /// Takes in a round: which energy it lowers, and what that has come to.
    fn look_at(&mut self, is_steep: bool, energy: f64) {
        let lowest = &mut self.lowest[usize::from(is_steep)];
        let is_lower = lowest.is_none_or(|lowest| energy < (1.0 - LOWER) * lowest);
        self.rounds_since = if is_lower { 0 } else { self.rounds_since + 1 };
        *lowest = Some(lowest.unwrap_or(energy).min(energy));
    }

    fn is_reached(&self) -> bool {
        self.rounds_since >= PATIENCE
    }
}
