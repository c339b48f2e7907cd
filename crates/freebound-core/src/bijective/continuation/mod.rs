//! Bijective continuation: moves a planar embedding to the constraints, one-to-one at every step (stage 4 of the
//! flattener).
//!
//! ```text
//! response: moves of all points, to first order of the energy, when the pins move to their targets
//! jump:     the whole response at once; folded faces are unfolded with the pins held     tried once
//! advance:  along the response while no face folds and the boundary stays simple         repeated
//! loosen:   if that is a small share, springs instead of pins, which pass around each other
//! settle:   outside triangulated again, a few Newton steps on the energy
//! ```
//!
//! The mesh lies in an outside that is triangulated up to a frame (see `nonlinear::scaffold`), so that the boundary
//! keeps its distance from itself. The exact verdict alone accepts a step.
//!
//! Rejected alternative: jumps that are halved until Newton's method unfolds them. These stall on three of the nine
//! constrained sets of real meshes and take over 40 s on three more. At thin triangles, a soft barrier unfolds some by
//! folding others. The response behind the exact barrier reaches the targets on all nine.
//!
//! | file | contents |
//! |---|---|
//! | `mod.rs` | [`Continuation`]: step by step along the response |
//! | `loose.rs` | springs instead of pins, if the response is narrow |
//! | `coarse.rs` | continuation of a disk with fewer vertices, followed by prolongation |

mod coarse;
mod loose;

use std::iter::successors;
use std::sync::Arc;

use glam::DVec2;

use super::Advance;
use crate::mesh::DiskMesh;
use crate::nonlinear::Scaffold;
use crate::nonlinear::energy_problem::{EnergyProblem, Limits, Planning, Unfolding};
use crate::nonlinear::foldover_energy::Energy;
use crate::nonlinear::rest_shape::{RestShape, Surrounded};
use crate::nonlinear::scaffold::{FRAME_POINTS, outside_of};
use crate::problem::{Control, Embedding, PinPositions, Pins, Progress, SolveError};
use crate::verify::UvFrame;

/// Weight of the whole outside, relative to that of the mesh.
const OUTSIDE_WEIGHT: f64 = 0.02;

/// Share of the longest step without a fold that is taken at once.
const ADVANCE_SHARE: f64 = 0.8;

/// Smallest advance, as a share of the response.
const SMALLEST_ADVANCE: f64 = 1e-4;

/// Newton steps to unfold a jump.
const UNFOLD_STEPS: usize = 6;
/// Newton steps to settle.
const SETTLE_STEPS: usize = 4;

/// Least relative gain of a Newton step that is followed by another.
const TOLERANCE: f64 = 1e-3;

/// Number of steps over which [`SHORTER`] is tested.
const PATIENCE: usize = 10;
/// Stop if the largest pin distance is still more than this share of its value [`PATIENCE`] steps ago.
const SHORTER: f64 = 0.9;
/// Most steps in all.
const MOST_STEPS: usize = 200;
/// Stop if the largest pin distance is at most this share of the first one, but not zero.
const HARDLY_ANY: f64 = 1e-6;

/// Ratio of energy to lowest energy above which an embedding counts as crushed: no step continues from it.
const CRUSHED: f64 = 10.0;

#[derive(Debug)]
pub(crate) struct Continuation {
    rest: RestShape,
    pins: Pins,
    /// Targets of the hard pins.
    targets: PinPositions,
    pub(crate) embedding: Embedding,
    /// Largest distance of a hard pin from its target after each step.
    distances: Vec<f64>,
    /// Energy of mesh and outside after the latest step, with all points and the outside.
    settled: Option<Settled>,
    /// True if the next step tries the whole response at once.
    jumps: bool,
    /// Number of times that springs replaced the pins.
    loosened: usize,
    /// True if springs replaced the pins in the latest step.
    is_loose: bool,
    /// Initial embedding, until the restart uses it.
    start: Option<Embedding>,
    /// Latest embedding that was not crushed, and the lowest energy so far.
    sound: (Embedding, f64),
    /// Output frame in which embeddings are proved.
    sheet: Arc<UvFrame>,
}

#[derive(Debug)]
struct Settled {
    problem: EnergyProblem,
    points: Vec<DVec2>,
    outside: Arc<Scaffold>,
}

impl Continuation {
    /// Starts from a planar embedding, at any position.
    pub(crate) fn new(mesh: &DiskMesh, embedding: Embedding, pins: &Pins) -> Self {
        let (rest, pins) = (RestShape::new(mesh), pins.clone());
        let exact = pins.iter().filter(|(_, pin)| pin.kind.is_hard());
        let targets = exact.map(|(&vertex, pin)| (vertex, pin.target)).collect();
        let sound = (embedding.clone(), rest.progress(mesh, &embedding, 0.0).energy);
        let start = Some(embedding.clone());
        Self {
            rest,
            pins,
            targets,
            embedding,
            distances: Vec::new(),
            settled: None,
            jumps: true,
            loosened: 0,
            is_loose: false,
            start,
            sound,
            sheet: Arc::default(),
        }
    }

    /// Proves embeddings as they are written in an output frame.
    pub(crate) fn with_output_frame(self, sheet: Arc<UvFrame>) -> Self {
        Self { sheet, ..self }
    }

    /// Restores the latest embedding that is not crushed. Returns true if the present one was crushed.
    pub(crate) fn go_back_to_sound(&mut self) -> bool {
        let is_crushed = self.embedding != self.sound.0;
        (self.embedding, self.settled) = (self.sound.0.clone(), None);
        is_crushed
    }

    fn outside_of(&self, mesh: &DiskMesh, embedding: &Embedding) -> Option<Scaffold> {
        outside_of(mesh, embedding, self.targets.values().copied(), FRAME_POINTS)
    }

    /// Points moved by `share` times `moves`. A share of 1 puts the points with targets exactly onto them.
    fn moved(&self, points: &[DVec2], moves: &[DVec2], share: f64) -> Vec<DVec2> {
        let mut z: Vec<DVec2> = points.iter().zip(moves).map(|(z, by)| *z + share * *by).collect();
        if share >= 1.0 {
            for (v, target) in &self.targets {
                z[v.index()] = *target;
            }
        }
        z
    }

    pub(crate) fn progress(&self, mesh: &DiskMesh) -> Progress {
        let distances = self.targets.iter().map(|(v, target)| self.embedding[v].distance(*target));
        self.rest.progress(mesh, &self.embedding, distances.fold(0.0, f64::max))
    }

    /// Advances as far as possible. If stuck for the first time, restarts from the initial embedding with springs of
    /// growing weight.
    pub(crate) fn step(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Advance, SolveError> {
        match (self.go_on(mesh, control), &self.start) {
            (Ok(advance), _) => Ok(advance),
            (Err(error), Some(_)) if error != SolveError::Cancelled => self.begin_again(mesh, control),
            (Err(error), _) => Err(error),
        }
    }

    fn go_on(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Advance, SolveError> {
        let settled = match self.settled.take() {
            Some(settled) => settled,
            None => self
                .surround(mesh, &self.embedding, &self.pins, Planning { order: None, control })?
                .ok_or(SolveError::Unmet)?,
        };
        let mut shift = vec![DVec2::ZERO; settled.points.len()];
        for (v, target) in &self.targets {
            shift[v.index()] = *target - settled.points[v.index()];
        }
        let moves = settled.problem.response(&settled.points, &shift, control)?;
        let has_jumped = self.jumps && self.jump(mesh, &settled, &moves, control)?;
        self.jumps = false;
        if !has_jumped && !self.loosen_or_advance(mesh, &settled, &moves, control)? {
            return Err(SolveError::Unmet);
        }
        let progress = self.progress(mesh);
        if progress.energy <= CRUSHED * self.sound.1 {
            self.sound = (self.embedding.clone(), self.sound.1.min(progress.energy));
        }
        self.distances.push(progress.distance_left);
        let outside = self.settled.as_ref().map_or(settled.outside, |settled| Arc::clone(&settled.outside));
        if self.is_stuck() { Err(SolveError::Unmet) } else { Ok(self.accepted(progress, outside)) }
    }

    /// Result with the present embedding, accepted by the verdict.
    fn accepted(&self, progress: Progress, scaffold: Arc<Scaffold>) -> Advance {
        Advance { embedding: self.embedding.clone(), progress, scaffold, note: None }
    }

    /// True if a step has brought all hard pins onto their targets.
    pub(crate) fn is_at_its_end(&self) -> bool {
        !self.distances.is_empty() && !self.targets.is_empty() && self.has_arrived()
    }

    fn has_arrived(&self) -> bool {
        self.targets.iter().all(|(v, target)| self.embedding[v] == *target)
    }

    /// True if further steps are useless.
    fn is_stuck(&self) -> bool {
        let (all, count) = (&self.distances, self.distances.len());
        let has_arrived = self.has_arrived();
        let is_almost_there = || matches!(all[..], [first, .., now] if now <= HARDLY_ANY * first);
        let is_slow = || count > PATIENCE && all[count - 1] > SHORTER * all[count - 1 - PATIENCE];
        !has_arrived && (count >= MOST_STEPS || is_almost_there() || is_slow())
    }

    /// Embedding with its outside, and the energy of both with these pins. `None` if its boundary is not simple.
    fn surround(
        &self,
        mesh: &DiskMesh,
        embedding: &Embedding,
        pins: &Pins,
        planning: Planning<'_>,
    ) -> Result<Option<Settled>, SolveError> {
        let Some(outside) = self.outside_of(mesh, embedding) else { return Ok(None) };
        planning.control.go_on()?;
        let surrounded = Surrounded { embedding, outside: &outside, weight: OUTSIDE_WEIGHT };
        let (problem, points) = self.rest.problem(mesh, surrounded, pins, planning)?;
        Ok(Some(Settled { problem, points, outside: Arc::new(outside) }))
    }

    /// Moves the pins to their targets at once and unfolds the faces. Returns true if the result is one-to-one and was
    /// accepted.
    fn jump(
        &mut self,
        mesh: &DiskMesh,
        Settled { problem, points, .. }: &Settled,
        moves: &[DVec2],
        control: Control<'_>,
    ) -> Result<bool, SolveError> {
        let mut z = self.moved(points, moves, 1.0);
        let limits = Limits { unfolding: Unfolding::Alone, ..downhill(UNFOLD_STEPS) };
        let is_unfolded = problem.descend(&mut z, limits, None, control)?.least_determinant > 0.0;
        let z = Embedding::of_mesh(mesh, &z);
        control.go_on()?;
        Ok(is_unfolded && self.sheet.is_one_to_one(mesh, &z) && self.settle(mesh, z, problem, control)?)
    }

    /// Moves the pins while no face folds and the boundary stays simple. Returns true if they moved.
    fn advance(
        &mut self,
        mesh: &DiskMesh,
        Settled { problem, points, .. }: &Settled,
        moves: &[DVec2],
        control: Control<'_>,
    ) -> Result<bool, SolveError> {
        let longest = problem.longest_step(points, moves, mesh.face_count());
        let first = (ADVANCE_SHARE * longest).min(1.0);
        // The whole response is tried first if no face folds on it.
        let whole = (longest > 1.0 && first < 1.0).then_some(1.0);
        let halved = successors(Some(first), |share| Some(0.5 * share)).take_while(|share| *share > SMALLEST_ADVANCE);
        for share in whole.into_iter().chain(halved) {
            control.go_on()?;
            let z = Embedding::of_mesh(mesh, &self.moved(points, moves, share));
            if self.sheet.is_one_to_one(mesh, &z) {
                return self.settle(mesh, z, problem, control);
            }
        }
        Ok(false)
    }

    /// Accepts a one-to-one embedding, and lowers its energy if that stays one-to-one. Returns false if the outside
    /// cannot be triangulated.
    fn settle(
        &mut self,
        mesh: &DiskMesh,
        embedding: Embedding,
        similar: &EnergyProblem,
        control: Control<'_>,
    ) -> Result<bool, SolveError> {
        control.go_on()?;
        let Some(mut settled) =
            self.surround(mesh, &embedding, &self.pins, Planning { order: similar.order().as_ref(), control })?
        else {
            return Ok(false);
        };
        let mut z = settled.points.clone();
        settled.problem.descend(&mut z, downhill(SETTLE_STEPS), None, control)?;
        control.go_on()?;
        let lower = Embedding::of_mesh(mesh, &z);
        let is_lower_sound = self.sheet.is_one_to_one(mesh, &lower);
        control.go_on()?;
        if is_lower_sound {
            self.embedding = lower;
            settled.points = z;
        } else {
            self.embedding = embedding;
        }
        self.settled = Some(settled);
        Ok(true)
    }
}

/// Limits of Newton steps that fold nothing.
fn downhill(steps: usize) -> Limits {
    Limits { unfolded: Energy::Foldover(0.0), steps, unfolding: Unfolding::Freely, tolerance: TOLERANCE }
}
