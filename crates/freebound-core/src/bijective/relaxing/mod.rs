//! Relaxing: a planar embedding's distortion is lowered, one-to-one throughout, exact pins where they are.
//!
//! Each round triangulates the outside anew and takes a few Newton steps down the symmetric Dirichlet energy of mesh and
//! outside (J. Smith, S. Schaefer, "Bijective parameterization with free boundaries", 2015). While some face is nearly
//! without area, the foldover energy goes first, which is less steep there.
//!
//! In the end it is the energy at equal total areas, which is what distortion is measured by: as the embedding grows or
//! shrinks, so do the shapes at rest (see `membrane/own_size.rs`).
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

pub(crate) use coarse::Relaxed;

use super::Advance;
use crate::linalg::EliminationOrder;
use crate::mesh::DiskMesh;
use crate::nonlinear::Scaffold;
use crate::nonlinear::energy_problem::{Limits, Planning, Unfolding};
use crate::nonlinear::foldover_energy::Energy;
use crate::nonlinear::rest_shape::{RestShape, Surrounded};
use crate::nonlinear::scaffold::{FRAME_POINTS, outside_of};
use crate::problem::{Control, Embedding, Pins, Progress, SolveError};
use crate::verify::UvFrame;

/// Weight of the whole outside, that of the mesh being 1.
const OUTSIDE_WEIGHT: f64 = 0.002;

/// Newton steps of a round, and of one that begins with a face nearly without area: there a step hardly more than
/// doubles an area.
const ROUND_STEPS: usize = 5;
const STEEP_ROUND_STEPS: usize = 25;

/// A round that gains a smaller share of the energy is the last; the first while the size is that of each round's beginning,
/// the second at the embedding's own size.
const TOLERANCE: f64 = 1e-3;
const TOLERANCE_AT_OWN_SIZE: f64 = 1e-4;

/// Below this determinant the symmetric Dirichlet energy is too steep to begin with.
const STEEP: f64 = 1e-3;

/// Rounds in a row without a lower energy than ever before, by more than this share, after which it goes round in circles.
const PATIENCE: usize = 5;
const LOWER: f64 = 1e-9;

/// The size of the shapes at rest, beside that of the embedding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Measure {
    /// As large as the embedding is when a round begins. That way is short, but ends where the energy at equal areas is not
    /// least.
    AsItBegins,
    /// Always as large as the embedding. It follows where the other gains no more, but not where springs pull, whose
    /// stiffness is told by a size, or polygons have triangles at their corners, whose areas are not the faces'.
    AtOwnSize,
}

impl Measure {
    fn tolerance(self) -> f64 {
        match self {
            Self::AsItBegins => TOLERANCE,
            Self::AtOwnSize => TOLERANCE_AT_OWN_SIZE,
        }
    }
}

#[derive(Debug)]
pub(crate) struct Relaxing {
    rest: RestShape,
    /// The same with the triangles at the corners of polygons, where there are any.
    with_ears: Option<RestShape>,
    pins: Pins,
    embedding: Embedding,
    /// How distorted the embedding is.
    standing: DistortionState,
    /// The order of elimination of the round before.
    order: Option<EliminationOrder>,
    stall: Stall,
    measure: Measure,
    /// Whether the last round gained next to nothing.
    pub(crate) has_converged: bool,
    /// How embeddings are written: what is proved.
    sheet: Arc<UvFrame>,
    /// The energy from which on the next round begins by way of a disk with fewer vertices.
    coarse_from: f64,
}

impl Relaxing {
    /// Begins at a one-to-one embedding of `mesh`; `pins` are held, exact ones where they lie.
    pub(crate) fn new(mesh: &DiskMesh, embedding: Embedding, pins: &Pins) -> Self {
        let rest = RestShape::new(mesh);
        let with_ears = RestShape::with_ears(mesh);
        let standing = DistortionState::of(&rest, with_ears.as_ref(), Placed { mesh, embedding: &embedding, pins });
        Self {
            standing,
            rest,
            with_ears,
            pins: pins.clone(),
            embedding,
            order: None,
            stall: Stall::default(),
            measure: Measure::AsItBegins,
            has_converged: false,
            sheet: Arc::default(),
            coarse_from: coarse::MOST_DIRECTLY,
        }
    }

    /// The same with embeddings proved as they are written on a sheet.
    pub(crate) fn with_output_frame(self, sheet: Arc<UvFrame>) -> Self {
        Self { sheet, ..self }
    }

    /// One round. The embedding stays as it is where rounding keeps a better one from being planar.
    pub(crate) fn round(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Advance, SolveError> {
        self.go_by_way_of_coarse(mesh, control)?;
        self.coarse_from = f64::INFINITY;
        let outside =
            outside_of(mesh, &self.embedding, std::iter::empty(), FRAME_POINTS).ok_or(SolveError::NotPlanar)?;
        match self.descend(mesh, &outside, control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            Ok(()) => {}
            // No direction of descent but for rounding: the energy is as low as it gets.
            Err(_) => self.has_converged = true,
        }
        let (embedding, progress) = (self.embedding.clone(), self.standing.faces);
        Ok(Advance { embedding, progress, scaffold: Arc::new(outside), note: None })
    }

    /// Goes down the energy of mesh and outside, to what is one-to-one there, and planar if it was.
    fn descend(&mut self, mesh: &DiskMesh, outside: &Scaffold, control: Control<'_>) -> Result<(), SolveError> {
        let surrounded = Surrounded { embedding: &self.embedding, outside, weight: OUTSIDE_WEIGHT };
        let all = self.with_ears.as_ref().unwrap_or(&self.rest);
        let planning = Planning { order: self.order.as_ref(), control };
        let (problem, mut z) = all.problem(mesh, surrounded, &self.pins, planning)?;
        let is_drawn = self.is_drawn();
        let problem = match self.measure {
            Measure::AsItBegins => problem,
            Measure::AtOwnSize => problem.measured_at_own_size(mesh.real_faces().len()),
        };
        let DistortionState { inner: before, movable: movable_before, .. } = self.standing;
        let folded = if before.least_determinant > 0.0 { 0 } else { all.folded_count(mesh, &self.embedding) };
        let is_steep = movable_before.least_determinant < STEEP;
        let unfolded = if is_steep { Energy::Foldover(0.0) } else { Energy::SymmetricDirichlet };
        let steps = if is_steep { STEEP_ROUND_STEPS } else { ROUND_STEPS };
        let unfolding = Unfolding::BesideBarriers;
        let limits = Limits { unfolded, steps, unfolding, tolerance: 0.1 * self.measure.tolerance() };
        let gain = problem.descend(&mut z, limits, control)?.gain;
        let pull = problem.pull(&z);
        let z = Embedding::of_mesh(mesh, &z);
        // The outside has a small part in the energy that goes down; the faces' own must not go up for it.
        let is_drawn = is_steep || is_drawn;
        let standing = self.standing_of(mesh, &z);
        let inner = standing.inner;
        let is_better = is_drawn || inner.energy <= before.energy;
        // What the descent gains by size alone is lost again: an embedding is measured at its own size.
        let gain = if is_drawn { gain } else { (before.energy - inner.energy) / movable_before.energy };
        let must_be_planar = folded == 0 && self.with_ears.is_some() && self.sheet.is_planar(mesh, &self.embedding);
        let is_taken = is_better
            && if must_be_planar { self.sheet.is_planar(mesh, &z) } else { self.sheet.is_one_to_one(mesh, &z) };
        let is_unfolding = is_taken && folded > 0 && all.folded_count(mesh, &z) < folded;
        if is_taken {
            (self.embedding, self.standing) = (z, standing);
        }
        self.order = problem.order();
        let is_still_steep = self.standing.movable.least_determinant < STEEP;
        self.has_converged =
            !is_taken || (gain < self.measure.tolerance() && is_still_steep == is_steep && !is_unfolding);
        if is_taken && !is_unfolding {
            let own = if is_steep { all.energy(mesh, &self.embedding, unfolded) } else { 0.5 * inner.energy };
            self.stall.observe(is_steep, own + pull);
            self.has_converged |= self.stall.is_reached();
        }
        if self.has_converged && self.measure == Measure::AsItBegins && self.has_own_size(mesh) {
            (self.measure, self.stall, self.has_converged) = (Measure::AtOwnSize, Stall::default(), false);
        }
        Ok(())
    }

    fn standing_of(&self, mesh: &DiskMesh, embedding: &Embedding) -> DistortionState {
        DistortionState::of(&self.rest, self.with_ears.as_ref(), Placed { mesh, embedding, pins: &self.pins })
    }

    /// Whether springs pull.
    fn is_drawn(&self) -> bool {
        self.pins.values().any(|pin| !pin.kind.is_hard())
    }

    /// Whether the energy can be measured at the embedding's own size, and that can change.
    fn has_own_size(&self, mesh: &DiskMesh) -> bool {
        let is_boundary_free = mesh.boundary_loop().iter().any(|vertex| !self.pins.contains_key(vertex));
        is_boundary_free && !self.is_drawn() && self.with_ears.is_none()
    }
}

/// How distorted an embedding is.
#[derive(Clone, Copy, Debug)]
struct DistortionState {
    /// Over the faces.
    faces: Progress,
    /// Over all that has an energy.
    inner: Progress,
    /// Over what of that is not held at all its corners: the rest stays as it is.
    movable: Progress,
}

impl DistortionState {
    /// By the faces, and by these with the triangles at the corners of polygons where there are any.
    fn of(faces: &RestShape, with_ears: Option<&RestShape>, Placed { mesh, embedding, pins }: Placed<'_>) -> Self {
        let of_faces = faces.progress(mesh, embedding, 0.0);
        let inner = with_ears.map_or(of_faces, |all| all.progress(mesh, embedding, 0.0));
        let has_held_faces = pins.len() >= 3;
        let of_movable = || with_ears.unwrap_or(faces).progress_of_movable(mesh, embedding, pins);
        Self { faces: of_faces, inner, movable: if has_held_faces { of_movable() } else { inner } }
    }
}

/// An embedding with its pins.
#[derive(Clone, Copy)]
struct Placed<'a> {
    mesh: &'a DiskMesh,
    embedding: &'a Embedding,
    pins: &'a Pins,
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
    fn observe(&mut self, is_steep: bool, energy: f64) {
        let lowest = &mut self.lowest[usize::from(is_steep)];
        let is_lower = lowest.is_none_or(|lowest| energy < (1.0 - LOWER) * lowest);
        self.rounds_since = if is_lower { 0 } else { self.rounds_since + 1 };
        *lowest = Some(lowest.unwrap_or(energy).min(energy));
    }

    fn is_reached(&self) -> bool {
        self.rounds_since >= PATIENCE
    }
}
