//! Bijective continuation: from a planar embedding without the constraints to one that meets them, one-to-one at every
//! step (rung 4 of the ladder).
//!
//! ```text
//! response: how all points follow, to first order of the energy, where the pins go to their targets
//! jump:     all of the way at once; what folds is unfolded with the pins held           tried once
//! advance:  as far along the response as no face folds and the boundary stays simple    then again and again
//! settle:   outside triangulated anew, a few Newton steps down the energy
//! ```
//!
//! The mesh lies in an outside that is triangulated up to a frame (see the module `outside`), so that the boundary
//! keeps its distance from itself. Every step is accepted by the exact verdict alone.
//!
//! A prototype unfolded jumps that were halved until they could be. Measured on the nine constrained sets of real meshes,
//! that stalls on five of them where triangles are thin: a soft barrier unfolds one triangle by folding others. To go on
//! along the response behind the exact barrier arrives on all nine, in 2 to 32 steps.

use std::sync::Arc;

use glam::DVec2;

use super::foldover_energy::Energy;
use super::membrane::{Limits, Membrane};
use super::outside::outside_of;
use super::rest::Rest;
use super::{Control, Outside, Pins, Places, Progress, SolveError, verdict};
use crate::mesh::DiskMesh;

/// Weight of the whole outside, that of the mesh being 1.
const OUTSIDE_WEIGHT: f64 = 0.02;

/// The share of the way until the first face would fold that is gone at once.
const ADVANCE_SHARE: f64 = 0.8;

/// The smallest advance, as a share of the way that is left.
const SMALLEST_ADVANCE: f64 = 1e-4;

/// Newton steps to unfold a jump, and to settle.
const UNFOLD_STEPS: usize = 6;
const SETTLE_STEPS: usize = 6;

/// The least share of the energy that a Newton step must gain to be followed by another.
const TOLERANCE: f64 = 1e-4;

/// It is stuck where so many steps shorten the way by less than this factor.
const PATIENCE: usize = 10;
const SHORTER: f64 = 0.9;

/// A one-to-one embedding on its way.
pub(super) struct Continuation {
    rest: Rest,
    pins: Pins,
    embedding: Vec<DVec2>,
    /// The way that was left after each step.
    way_left: Vec<f64>,
    /// Mesh and outside after the latest step, all points, and the outside.
    settled: Option<Settled>,
    /// Whether to try all of the way at once.
    jumps: bool,
}

struct Settled {
    membrane: Membrane,
    points: Vec<DVec2>,
    outside: Arc<Outside>,
}

/// A state on the way, accepted by the verdict.
pub(super) struct Accepted {
    pub(super) embedding: Vec<DVec2>,
    pub(super) progress: Progress,
    pub(super) outside: Arc<Outside>,
}

impl std::fmt::Debug for Continuation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Continuation").field("way_left", &self.way_left).finish_non_exhaustive()
    }
}

impl Continuation {
    /// Begins at a planar embedding, wherever it lies.
    pub(super) fn new(mesh: &DiskMesh, embedding: Vec<DVec2>, pins: &Pins) -> Self {
        let (rest, pins) = (Rest::new(mesh), pins.clone());
        Self { rest, pins, embedding, way_left: Vec::new(), settled: None, jumps: true }
    }

    /// The present embedding, one-to-one.
    pub(super) fn embedding(&self) -> &[DVec2] {
        &self.embedding
    }

    /// Where exact pins are to go.
    fn targets(&self) -> Places {
        let exact = self.pins.iter().filter(|(_, pin)| pin.hold.is_exact());
        exact.map(|(&vertex, pin)| (vertex, pin.target)).collect()
    }

    /// How far it has come.
    pub(super) fn progress(&self, mesh: &DiskMesh) -> Progress {
        let targets = self.targets();
        let left = targets.iter().map(|(v, target)| self.embedding[v.index()].distance(*target));
        Progress {
            energy: self.rest.symmetric_dirichlet(mesh, &self.embedding),
            least_determinant: self.rest.least_determinant(mesh, &self.embedding),
            distance_left: left.fold(0.0, f64::max),
        }
    }

    /// Whether every exact pin is on its target.
    pub(super) fn has_arrived(&self) -> bool {
        self.targets().iter().all(|(v, target)| self.embedding[v.index()] == *target)
    }

    /// Goes on as far as can be at once. `None` where nothing goes any more.
    pub(super) fn step(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Option<Accepted>, SolveError> {
        let targets = self.targets();
        let settled = match self.settled.take() {
            Some(settled) => settled,
            None => match self.surround(mesh, &self.embedding, (&targets, None))? {
                Some(settled) => settled,
                None => return Ok(None),
            },
        };
        let mut shift = vec![DVec2::ZERO; settled.points.len()];
        for (v, target) in &targets {
            shift[v.index()] = *target - settled.points[v.index()];
        }
        let moves = settled.membrane.response(&settled.points, &shift, control)?;
        let gone = match std::mem::take(&mut self.jumps) {
            true if self.jump(mesh, &settled, (&targets, &moves), control)? => true,
            _ => self.advance(mesh, &settled, (&targets, &moves), control)?,
        };
        // A cancelled step leaves the embedding as it was, and finds its surroundings again.
        if !gone {
            return Ok(None);
        }
        let progress = self.progress(mesh);
        self.way_left.push(progress.distance_left);
        let outside = self.settled.as_ref().map_or(settled.outside, |settled| Arc::clone(&settled.outside));
        Ok((!self.is_stuck()).then(|| Accepted { embedding: self.embedding.clone(), progress, outside }))
    }

    /// Whether many steps have hardly shortened the way.
    fn is_stuck(&self) -> bool {
        match self.way_left.as_slice() {
            [.., now] if *now == 0.0 => false,
            way @ [.., now] if way.len() > PATIENCE => *now > SHORTER * way[way.len() - 1 - PATIENCE],
            _ => false,
        }
    }

    /// Triangulates the outside of an embedding, and plans the energy of both. `None` where its boundary is not simple.
    fn surround(
        &self,
        mesh: &DiskMesh,
        embedding: &[DVec2],
        (targets, similar): (&Places, Option<&Membrane>),
    ) -> Result<Option<Settled>, SolveError> {
        let Some(outside) = outside_of(mesh, embedding, targets.values().copied()) else { return Ok(None) };
        let how = (OUTSIDE_WEIGHT, similar);
        let (membrane, points) = self.rest.membrane(mesh, (embedding, &outside), &self.pins, how)?;
        Ok(Some(Settled { membrane, points, outside: Arc::new(outside) }))
    }

    /// Moves the pins to their targets at once, and unfolds what folds. Returns whether that goes.
    fn jump(
        &mut self,
        mesh: &DiskMesh,
        Settled { membrane, points, .. }: &Settled,
        (targets, moves): (&Places, &[DVec2]),
        control: Control<'_>,
    ) -> Result<bool, SolveError> {
        let mut z = moved(points, moves, 1.0, targets);
        let unfolded = Energy::Foldover(0.0);
        let limits = Limits { unfolded, steps: UNFOLD_STEPS, until_unfolded: true, tolerance: TOLERANCE };
        let is_unfolded = membrane.descend(&mut z, limits, control)?.least_determinant > 0.0;
        z.truncate(mesh.vertex_count());
        Ok(is_unfolded && verdict(mesh, &z).planar && self.settle(mesh, z, (targets, membrane), control)?)
    }

    /// Moves the pins as far as no face folds and the boundary stays simple. Returns whether that is any way.
    fn advance(
        &mut self,
        mesh: &DiskMesh,
        Settled { membrane, points, .. }: &Settled,
        (targets, moves): (&Places, &[DVec2]),
        control: Control<'_>,
    ) -> Result<bool, SolveError> {
        let longest = membrane.longest_step(points, moves, mesh.face_count());
        let mut share = (ADVANCE_SHARE * longest).min(1.0);
        while share > SMALLEST_ADVANCE {
            let mut z = moved(points, moves, share, targets);
            z.truncate(mesh.vertex_count());
            if verdict(mesh, &z).planar {
                return self.settle(mesh, z, (targets, membrane), control);
            }
            share *= 0.5;
        }
        Ok(false)
    }

    /// Takes in a planar embedding, at a lower energy where that is planar too.
    fn settle(
        &mut self,
        mesh: &DiskMesh,
        embedding: Vec<DVec2>,
        (targets, similar): (&Places, &Membrane),
        control: Control<'_>,
    ) -> Result<bool, SolveError> {
        let Some(mut settled) = self.surround(mesh, &embedding, (targets, Some(similar)))? else { return Ok(false) };
        let unfolded = Energy::Foldover(0.0);
        let limits = Limits { unfolded, steps: SETTLE_STEPS, until_unfolded: false, tolerance: TOLERANCE };
        let mut z = settled.points.clone();
        settled.membrane.descend(&mut z, limits, control)?;
        let lower = &z[..mesh.vertex_count()];
        if verdict(mesh, lower).planar {
            self.embedding = lower.to_vec();
            settled.points = z;
        } else {
            self.embedding = embedding;
        }
        self.settled = Some(settled);
        Ok(true)
    }
}

/// The points moved by a share of the moves; those with targets exactly onto them by all of it.
fn moved(points: &[DVec2], moves: &[DVec2], share: f64, targets: &Places) -> Vec<DVec2> {
    let mut z: Vec<DVec2> = points.iter().zip(moves).map(|(z, by)| *z + share * *by).collect();
    if share >= 1.0 {
        for (v, target) in targets {
            z[v.index()] = *target;
        }
    }
    z
}
