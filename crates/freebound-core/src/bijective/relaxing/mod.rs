//! Relaxing: lowers the distortion of a planar embedding, one-to-one throughout, with hard pins fixed.
//!
//! Each round triangulates the outside again and takes a few Newton steps on the symmetric Dirichlet energy of mesh
//! and outside (J. Smith, S. Schaefer, "Bijective parameterization with free boundaries", 2015). While some face is
//! nearly degenerate, the foldover energy comes first, which is less steep there.
//!
//! The last rounds minimise the energy at equal total areas, which is the measure of distortion: the rest shapes grow
//! and shrink with the embedding (see `nonlinear/energy_problem/own_size.rs`).
//!
//! If the mesh has polygons, the triangles at their corners have energies too. Convex polygons stay convex. A concave
//! polygon is unfolded like a folded triangle, by the foldover energy with ε > 0.
//!
//! | file | contents |
//! |---|---|
//! | `mod.rs` | [`Relaxing`]: rounds of Newton steps on the energy |
//! | `coarse.rs` | relaxing on a disk with fewer vertices, for huge energies |

mod coarse;

use std::sync::Arc;

use glam::DVec2;

pub(crate) use coarse::Relaxed;

use super::Advance;
use crate::linalg::EliminationOrder;
use crate::mesh::DiskMesh;
use crate::nonlinear::Scaffold;
use crate::nonlinear::energy_problem::{Damping, Limits, PassableOutside, Planning, Unfolding};
use crate::nonlinear::foldover_energy::Energy;
use crate::nonlinear::rest_shape::{RestShape, Surrounded};
use crate::nonlinear::scaffold::{FRAME_POINTS, outside_of};
use crate::problem::{Control, Embedding, Pins, Progress, SolveError};
use crate::verify::UvFrame;

/// Weight of the whole outside, relative to that of the mesh.
const OUTSIDE_WEIGHT: f64 = 0.002;

/// Newton steps of a round.
const ROUND_STEPS: usize = 5;
/// Newton steps of a round that starts with a nearly degenerate face, where a step hardly more than doubles an area.
const STEEP_ROUND_STEPS: usize = 25;

/// Relative gain below which a round is the last, for [`Measure::AsItBegins`].
const TOLERANCE: f64 = 1e-3;
/// Relative gain below which a round is the last, for [`Measure::AtOwnSize`].
const TOLERANCE_AT_OWN_SIZE: f64 = 1e-4;

/// Least determinant for the symmetric Dirichlet energy; below it that energy is too steep to start with.
const STEEP: f64 = 1e-3;

/// Rounds in a row without a new lowest energy after which relaxing stops: it cycles.
const PATIENCE: usize = 5;
/// Relative decrease that counts as a new lowest energy.
const LOWER: f64 = 1e-9;

/// Size of the rest shapes, relative to that of the embedding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Measure {
    /// Size of the embedding at the start of each round. Converges fast, but not to the least energy at equal areas.
    AsItBegins,
    /// Size of the embedding at every moment. Follows [`Measure::AsItBegins`] once that gains no more. Excluded if
    /// springs pull, because their stiffness refers to a size. Excluded if polygons have triangles at their corners,
    /// because the areas of these triangles are not the faces'.
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
    /// Rest shapes including the triangles at the corners of polygons, if the mesh has polygons.
    with_ears: Option<RestShape>,
    pins: Pins,
    embedding: Embedding,
    /// Distortion of `embedding`.
    standing: DistortionState,
    /// Elimination order of the previous round, for reuse.
    order: Option<EliminationOrder>,
    /// Damping of single faces after the previous round.
    damping: Damping,
    stall: Stall,
    measure: Measure,
    /// True if the last round gained next to nothing.
    pub(crate) has_converged: bool,
    /// Output frame in which embeddings are proved.
    sheet: Arc<UvFrame>,
    /// Energy at or above which the next round starts on a disk with fewer vertices.
    coarse_from: f64,
}

impl Relaxing {
    /// Starts from a one-to-one embedding of `mesh`. Hard pins stay at their present positions; soft pins act as
    /// springs.
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
            damping: Damping::default(),
            stall: Stall::default(),
            measure: Measure::AsItBegins,
            has_converged: false,
            sheet: Arc::default(),
            coarse_from: coarse::MOST_DIRECTLY,
        }
    }

    /// Proves embeddings as they are written in an output frame.
    pub(crate) fn with_output_frame(self, sheet: Arc<UvFrame>) -> Self {
        Self { sheet, ..self }
    }

    /// Runs one round. The embedding stays unchanged if the improved one is not planar after rounding.
    pub(crate) fn round(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Advance, SolveError> {
        self.go_by_way_of_coarse(mesh, control)?;
        self.coarse_from = f64::INFINITY;
        let mut outside = scaffold_of(mesh, &self.embedding).ok_or(SolveError::NotPlanar)?;
        match self.descend(mesh, &mut outside, control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            Ok(()) => {}
            // No descent direction except for rounding: the energy is as low as possible.
            Err(_) => self.has_converged = true,
        }
        let (embedding, progress) = (self.embedding.clone(), self.standing.faces);
        Ok(Advance { embedding, progress, scaffold: Arc::new(outside), note: None })
    }

    /// Minimises the energy of mesh and outside. Accepts the result only if it is one-to-one, and planar if the start
    /// was.
    fn descend(&mut self, mesh: &DiskMesh, outside: &mut Scaffold, control: Control<'_>) -> Result<(), SolveError> {
        let all = self.with_ears.as_ref().unwrap_or(&self.rest);
        let is_drawn = self.is_drawn();
        let DistortionState { inner: before, movable: movable_before, .. } = self.standing;
        let folded = if before.least_determinant > 0.0 { 0 } else { all.folded_count(mesh, &self.embedding) };
        let is_steep = movable_before.least_determinant < STEEP;
        let unfolded = if is_steep { Energy::Foldover(0.0) } else { Energy::SymmetricDirichlet };
        let steps = if is_steep { STEEP_ROUND_STEPS } else { ROUND_STEPS };
        let unfolding = Unfolding::BesideBarriers;
        let limits = Limits { unfolded, steps, unfolding, tolerance: 0.1 * self.measure.tolerance() };
        let lowered = self.lowered(mesh, outside.clone(), limits, control)?;
        let Lowered { embedding: z, gain, pull, order, damping, .. } = lowered;
        // The energy being minimised includes a small share of the outside; the energy of the faces must not rise for
        // it.
        let is_drawn = is_steep || is_drawn;
        let standing = self.standing_of(mesh, &z);
        let inner = standing.inner;
        let is_better = is_drawn || inner.energy <= before.energy;
        // A gain by size alone is not a gain: an embedding is measured at its own size.
        let gain = if is_drawn { gain } else { (before.energy - inner.energy) / movable_before.energy };
        let must_be_planar = folded == 0 && self.with_ears.is_some() && self.sheet.is_planar(mesh, &self.embedding);
        let is_taken = is_better
            && if must_be_planar { self.sheet.is_planar(mesh, &z) } else { self.sheet.is_one_to_one(mesh, &z) };
        let is_unfolding = is_taken && folded > 0 && all.folded_count(mesh, &z) < folded;
        if is_taken {
            (self.embedding, self.standing, *outside) = (z, standing, lowered.outside);
        }
        (self.order, self.damping) = (order, damping);
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

    /// Runs the Newton steps of a round. Triangulates the outside again whenever a step has folded it.
    fn lowered(
        &self,
        mesh: &DiskMesh,
        outside: Scaffold,
        limits: Limits,
        control: Control<'_>,
    ) -> Result<Lowered, SolveError> {
        let embedding = self.embedding.clone();
        let damping = self.damping.clone();
        let mut lowered =
            Lowered { embedding, outside, steps_left: limits.steps, gain: 0.0, pull: 0.0, order: None, damping };
        loop {
            match self.lower(mesh, &mut lowered, limits, control) {
                Ok(true) => {}
                Err(error) if error == SolveError::Cancelled || lowered.order.is_none() => return Err(error),
                // The steps before an error are good.
                Ok(false) | Err(_) => break,
            }
            lowered.outside = scaffold_of(mesh, &lowered.embedding).ok_or(SolveError::NotPlanar)?;
            if lowered.steps_left == 0 {
                break;
            }
        }
        Ok(lowered)
    }

    /// Runs Newton steps within a triangulated outside. The last step may fold the outside; returns true if it did.
    fn lower(
        &self,
        mesh: &DiskMesh,
        lowered: &mut Lowered,
        limits: Limits,
        control: Control<'_>,
    ) -> Result<bool, SolveError> {
        let all = self.with_ears.as_ref().unwrap_or(&self.rest);
        let surrounded =
            Surrounded { embedding: &lowered.embedding, outside: &lowered.outside, weight: OUTSIDE_WEIGHT };
        let planning = Planning { order: lowered.order.as_ref().or(self.order.as_ref()), control };
        let (problem, mut z) = all.problem(mesh, surrounded, &self.pins, planning)?;
        let problem = match self.measure {
            Measure::AsItBegins => problem,
            Measure::AtOwnSize => problem.measured_at_own_size(mesh.real_faces().len()),
        };
        let is_simple = |z: &[DVec2]| self.sheet.is_one_to_one(mesh, &Embedding::of_mesh(mesh, z));
        let mut damping = std::mem::take(&mut lowered.damping);
        damping.forget_outside();
        let passable = PassableOutside { first: all.element_count(), is_simple: &is_simple, damping: &mut damping };
        let limits = Limits { steps: lowered.steps_left, ..limits };
        let descent = problem.descend(&mut z, limits, Some(passable), control)?;
        lowered.embedding = Embedding::of_mesh(mesh, &z);
        lowered.steps_left -= descent.steps;
        lowered.gain = 1.0 - (1.0 - lowered.gain) * (1.0 - descent.gain);
        (lowered.pull, lowered.order, lowered.damping) = (problem.pull(&z), problem.order(), damping);
        Ok(descent.has_passed)
    }

    fn standing_of(&self, mesh: &DiskMesh, embedding: &Embedding) -> DistortionState {
        DistortionState::of(&self.rest, self.with_ears.as_ref(), Placed { mesh, embedding, pins: &self.pins })
    }

    /// True if springs pull.
    fn is_drawn(&self) -> bool {
        self.pins.values().any(|pin| !pin.kind.is_hard())
    }

    /// True if the energy can be measured at the embedding's own size and that size can change.
    fn has_own_size(&self, mesh: &DiskMesh) -> bool {
        let is_boundary_free = mesh.boundary_loop().iter().any(|vertex| !self.pins.contains_key(vertex));
        is_boundary_free && !self.is_drawn() && self.with_ears.is_none()
    }
}

/// Scaffold of an embedding within a frame.
fn scaffold_of(mesh: &DiskMesh, embedding: &Embedding) -> Option<Scaffold> {
    outside_of(mesh, embedding, std::iter::empty(), FRAME_POINTS)
}

/// Result of the Newton steps of a round.
struct Lowered {
    embedding: Embedding,
    /// Outside of the embedding.
    outside: Scaffold,
    /// Steps that may follow.
    steps_left: usize,
    /// Relative decrease of the energy.
    gain: f64,
    /// Energy of the springs.
    pull: f64,
    order: Option<EliminationOrder>,
    /// Damping of single elements.
    damping: Damping,
}

/// Distortion of an embedding.
#[derive(Clone, Copy, Debug)]
struct DistortionState {
    /// Distortion of the faces.
    faces: Progress,
    /// Distortion of all elements: faces, and triangles at polygon corners.
    inner: Progress,
    /// Distortion of the elements that are not held at all their corners. Other elements cannot change.
    movable: Progress,
}

impl DistortionState {
    /// Measures the faces, and with `with_ears` also the triangles at the corners of polygons.
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

/// Detects rounds without progress, such as rounds that keep switching between the steep and the ordinary energy.
#[derive(Debug, Default)]
struct Stall {
    /// Lowest energy after ordinary rounds, and after steep rounds.
    lowest: [Option<f64>; 2],
    rounds_since: usize,
}

impl Stall {
    /// Records a round: the energy that it minimises, and the value reached.
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
