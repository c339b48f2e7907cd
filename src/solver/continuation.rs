//! Bijective continuation: from a planar embedding without the constraints to one that meets them, one-to-one at every
//! step (rung 4 of the ladder).
//!
//! The mesh lies in an outside that is triangulated up to a frame. The pins jump toward their targets, mesh and outside
//! follow, and what folds on the way is unfolded with the pins held where they are. A jump that cannot be unfolded is
//! halved; after every jump that can, the outside is triangulated again. While all triangles are unfolded the boundary
//! is simple, and the embedding is one-to-one; every step is accepted by the exact verdict alone.
//!
//! Sources: the outside is the paper's virtual boundary (§5), kept up as in Z. Jiang, S. Schaefer, D. Panozzo,
//! "Simplicial complex augmentation framework for bijective maps", 2017; the energy is that of the module
//! `foldover_energy`.

use std::sync::Arc;

use glam::DVec2;

use super::foldover_energy::Energy;
use super::membrane::{Descent, Limits, Membrane};
use super::outside::outside_of;
use super::rest::Rest;
use super::{Control, Outside, Pins, Places, Progress, SolveError, verdict};
use crate::mesh::DiskMesh;

/// Weight of the whole outside, that of the mesh being 1.
const OUTSIDE_WEIGHT: f64 = 0.02;

/// The smallest jump, as a share of the way that is left.
const SMALLEST_JUMP: f64 = 1.0 / 1024.0;

/// Newton steps to unfold a jump, and to settle after it.
const UNFOLD_STEPS: usize = 60;
const SETTLE_STEPS: usize = 6;

/// The least share of the energy that a Newton step must gain to be followed by another.
const TOLERANCE: f64 = 1e-4;

/// A one-to-one embedding on its way.
#[derive(Debug)]
pub(super) struct Continuation {
    rest: Rest,
    pins: Pins,
    embedding: Vec<DVec2>,
    /// Share of the way left that is tried next.
    jump: f64,
}

/// A state on the way, accepted by the verdict.
#[derive(Debug)]
pub(super) struct Accepted {
    pub(super) embedding: Vec<DVec2>,
    pub(super) progress: Progress,
    pub(super) outside: Arc<Outside>,
}

impl Continuation {
    /// Begins at a planar embedding, wherever it lies.
    pub(super) fn new(mesh: &DiskMesh, embedding: Vec<DVec2>, pins: &Pins) -> Self {
        Self { rest: Rest::new(mesh), pins: pins.clone(), embedding, jump: 1.0 }
    }

    /// Where exact pins are to go.
    fn targets(&self) -> Places {
        let exact = self.pins.iter().filter(|(_, pin)| pin.hold.is_exact());
        exact.map(|(&vertex, pin)| (vertex, pin.target)).collect()
    }

    fn distance_left(&self) -> f64 {
        self.targets().iter().map(|(v, target)| self.embedding[v.index()].distance(*target)).fold(0.0, f64::max)
    }

    /// Whether every exact pin is on its target.
    pub(super) fn has_arrived(&self) -> bool {
        self.targets().iter().all(|(v, target)| self.embedding[v.index()] == *target)
    }

    /// Goes on by one jump, as long as can be. `None` where not even the smallest one goes.
    pub(super) fn step(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Option<Accepted>, SolveError> {
        let targets = self.targets();
        let Some(outside) = outside_of(mesh, &self.embedding, targets.values().copied()) else { return Ok(None) };
        let outside = Arc::new(outside);
        let (membrane, points) = self.rest.membrane(mesh, (&self.embedding, &outside), &self.pins, OUTSIDE_WEIGHT)?;
        while self.jump >= SMALLEST_JUMP {
            if let Some(least_determinant) = self.try_jump(mesh, (&membrane, &points), &targets, control)? {
                self.jump = (2.0 * self.jump).min(1.0);
                let energy = membrane.energy(&points, Energy::Foldover(0.0));
                let progress = Progress { energy, least_determinant, distance_left: self.distance_left() };
                return Ok(Some(Accepted { embedding: self.embedding.clone(), progress, outside }));
            }
            self.jump *= 0.5;
        }
        Ok(None)
    }

    /// Moves the pins by the present jump. Returns the smallest determinant where the embedding is then planar.
    fn try_jump(
        &mut self,
        mesh: &DiskMesh,
        (membrane, points): (&Membrane, &[DVec2]),
        targets: &Places,
        control: Control<'_>,
    ) -> Result<Option<f64>, SolveError> {
        let mut z = points.to_vec();
        let mut shift = vec![DVec2::ZERO; z.len()];
        for (v, target) in targets {
            shift[v.index()] = self.jump * (*target - z[v.index()]);
        }
        membrane.follow(&mut z, &shift, control)?;
        if self.jump >= 1.0 {
            for (v, target) in targets {
                z[v.index()] = *target;
            }
        }
        let limits =
            Limits { unfolded: Energy::Foldover(0.0), steps: UNFOLD_STEPS, until_unfolded: true, tolerance: TOLERANCE };
        let Descent { least_determinant, steps, .. } = membrane.descend(&mut z, limits, control)?;
        if std::env::var_os("FB_TRACE").is_some() {
            eprintln!("jump {} -> least {least_determinant:.3e} after {steps}", self.jump);
        }
        if least_determinant <= 0.0 {
            return Ok(None);
        }
        let limits = Limits {
            unfolded: Energy::Foldover(0.0),
            steps: SETTLE_STEPS,
            until_unfolded: false,
            tolerance: TOLERANCE,
        };
        let Descent { least_determinant, .. } = membrane.descend(&mut z, limits, control)?;
        z.truncate(mesh.vertex_count());
        if !verdict(mesh, &z).planar {
            return Ok(None);
        }
        self.embedding = z;
        Ok(Some(least_determinant))
    }
}
