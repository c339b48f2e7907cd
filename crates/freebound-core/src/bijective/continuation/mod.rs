//! Bijective continuation: from a planar embedding without the constraints to one that meets them, one-to-one at every
//! step (stage 4 of the flattener).
//!
//! ```text
//! response: how all points follow, to first order of the energy, where the pins go to their targets
//! jump:     the whole response at once; what folds is unfolded with the pins held        tried once
//! advance:  as far along the response as no face folds and the boundary stays simple    then again and again
//! loosen:   where that is a small share, springs instead of pins: they pass around each other
//! settle:   outside triangulated anew, a few Newton steps down the energy
//! ```
//!
//! The mesh lies in an outside that is triangulated up to a frame (see the module `outside`), so that the boundary
//! keeps its distance from itself. Every step is accepted by the exact verdict alone.
//!
//! Jumps that are halved until they unfold, with Newton's method, stall on three of the nine constrained sets of real
//! meshes and take over 40 s on three more: where triangles are thin, a soft barrier unfolds one by folding others. The
//! response behind the exact barrier arrives on all nine.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | [`Continuation`]: step by step along the response |
//! | `loose.rs` | springs instead of pins, where the response is narrow |
//! | `coarse.rs` | the way of a disk with fewer vertices, which the others follow |

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

/// Weight of the whole outside, that of the mesh being 1.
const OUTSIDE_WEIGHT: f64 = 0.02;

/// The share of the longest step that folds no face that is taken at once.
const ADVANCE_SHARE: f64 = 0.8;

/// The smallest advance, as a share of the response.
const SMALLEST_ADVANCE: f64 = 1e-4;

/// Newton steps to unfold a jump, and to settle.
const UNFOLD_STEPS: usize = 6;
const SETTLE_STEPS: usize = 4;

/// The least share of the energy that a Newton step must gain to be followed by another.
const TOLERANCE: f64 = 1e-3;

/// It is stuck where so many steps shorten the largest distance by less than this factor, after so many steps in all, and
/// where it is so small a share of the first one and yet not zero.
const PATIENCE: usize = 10;
const SHORTER: f64 = 0.9;
const MOST_STEPS: usize = 200;
const HARDLY_ANY: f64 = 1e-6;

/// An embedding whose energy is more than so many times the lowest is crushed: no step continues from it.
const CRUSHED: f64 = 10.0;

#[derive(Debug)]
pub(crate) struct Continuation {
    rest: RestShape,
    pins: Pins,
    /// Where exact pins are to go.
    targets: PinPositions,
    pub(crate) embedding: Embedding,
    /// The largest distance of an exact pin from its target after each step.
    distances: Vec<f64>,
    /// Mesh and outside after the latest step, all points, and the outside.
    settled: Option<Settled>,
    /// Whether to try the whole response at once.
    jumps: bool,
    /// How often pins were let loose, and whether by the latest step.
    loosened: usize,
    is_loose: bool,
    /// Where a second try begins, until it does.
    start: Option<Embedding>,
    /// The latest embedding that was not crushed, and the lowest energy so far.
    sound: (Embedding, f64),
    /// How embeddings are written: what is proved.
    sheet: Arc<UvFrame>,
}

#[derive(Debug)]
struct Settled {
    problem: EnergyProblem,
    points: Vec<DVec2>,
    outside: Arc<Scaffold>,
}

impl Continuation {
    /// Begins at a planar embedding, wherever it lies.
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

    /// The same with embeddings proved as they are written on a sheet.
    pub(crate) fn with_output_frame(self, sheet: Arc<UvFrame>) -> Self {
        Self { sheet, ..self }
    }

    /// Goes back to the latest embedding that is not crushed, where the present one is. Returns whether it is.
    pub(crate) fn go_back_to_sound(&mut self) -> bool {
        let is_crushed = self.embedding != self.sound.0;
        (self.embedding, self.settled) = (self.sound.0.clone(), None);
        is_crushed
    }

    fn outside_of(&self, mesh: &DiskMesh, embedding: &Embedding) -> Option<Scaffold> {
        outside_of(mesh, embedding, self.targets.values().copied(), FRAME_POINTS)
    }

    /// The points moved by a share of the moves; those with targets exactly onto them by all of it.
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

    /// Advances as far as possible; where it is stuck, once more from the start with springs, tightened step by step.
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

    /// The present embedding, accepted by the verdict.
    fn accepted(&self, progress: Progress, scaffold: Arc<Scaffold>) -> Advance {
        Advance { embedding: self.embedding.clone(), progress, scaffold, note: None }
    }

    /// Whether a step has brought all exact pins onto their targets: there is no further way.
    pub(crate) fn is_at_its_end(&self) -> bool {
        !self.distances.is_empty() && !self.targets.is_empty() && self.has_arrived()
    }

    fn has_arrived(&self) -> bool {
        self.targets.iter().all(|(v, target)| self.embedding[v] == *target)
    }

    /// Whether further steps are of no use.
    fn is_stuck(&self) -> bool {
        let (all, count) = (&self.distances, self.distances.len());
        let has_arrived = self.has_arrived();
        let is_almost_there = || matches!(all[..], [first, .., now] if now <= HARDLY_ANY * first);
        let is_slow = || count > PATIENCE && all[count - 1] > SHORTER * all[count - 1 - PATIENCE];
        !has_arrived && (count >= MOST_STEPS || is_almost_there() || is_slow())
    }

    /// An embedding with its outside, and the energy of both with these pins; `None` where its boundary is not simple.
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

    /// Moves the pins to their targets at once, and unfolds what folds. Returns whether that is planar.
    fn jump(
        &mut self,
        mesh: &DiskMesh,
        Settled { problem, points, .. }: &Settled,
        moves: &[DVec2],
        control: Control<'_>,
    ) -> Result<bool, SolveError> {
        let mut z = self.moved(points, moves, 1.0);
        let limits = Limits { unfolding: Unfolding::Alone, ..downhill(UNFOLD_STEPS) };
        let is_unfolded = problem.descend(&mut z, limits, control)?.least_determinant > 0.0;
        let z = Embedding::of_mesh(mesh, &z);
        control.go_on()?;
        Ok(is_unfolded && self.sheet.is_one_to_one(mesh, &z) && self.settle(mesh, z, problem, control)?)
    }

    /// Moves the pins as far as no face folds and the boundary stays simple. Returns whether they moved.
    fn advance(
        &mut self,
        mesh: &DiskMesh,
        Settled { problem, points, .. }: &Settled,
        moves: &[DVec2],
        control: Control<'_>,
    ) -> Result<bool, SolveError> {
        let longest = problem.longest_step(points, moves, mesh.face_count());
        let first = (ADVANCE_SHARE * longest).min(1.0);
        // Where the whole way is free it is taken at once.
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

    /// Takes in a planar embedding, at a lower energy where that is planar too.
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
        settled.problem.descend(&mut z, downhill(SETTLE_STEPS), control)?;
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

/// Newton steps that fold nothing.
fn downhill(steps: usize) -> Limits {
    Limits { unfolded: Energy::Foldover(0.0), steps, unfolding: Unfolding::Freely, tolerance: TOLERANCE }
}
