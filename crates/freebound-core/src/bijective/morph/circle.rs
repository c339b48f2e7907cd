//! Route through a circle: pockets open until the boundary is a circle, weights change there, and pockets close again.
//!
//! # Method
//!
//! At each end, mesh and pockets form a disk with a convex outline, the hull. The end is the solution of its
//! mean-value weights. On one half of the route the weights are constant; the set of held points and their positions
//! change:
//!
//! ```text
//! round     the hull's corners move straight to places on a circle, each in the cone of its outer normals
//! turn      they move along the circle to places common to both ends
//! bulge     boundary vertices within the hull's sides move straight out to the circle
//! release   weights k of the apexes in the next layer shift to the ends of their sides: k → (1 − τ) k + τ (1 − f, f)
//! push      these apexes move straight on to the circle; their triangles are no longer there
//!    … until the whole boundary lies on the circle
//! blend     weights of the mesh change from those of one end to those of the other
//! ```
//!
//! The second half is the reverse, with the weights and pockets of the other end.
//!
//! # Planarity
//!
//! The outline is convex at every time. Let u be the point of the unit circle in a direction of the cone of normals at
//! p. The points `(1 − s) p + s u` lie in order on the rim of the Minkowski sum of hull and disk. A vertex that leaves
//! a chord for its arc keeps the angles at its ends between those of chord and arc.
//!
//! All weights are positive, except those of an apex that has reached its side and depends on its ends alone. Such an
//! apex belongs to the outline, and its degenerate triangle does not belong to the mesh. Tutte's theorem therefore
//! holds throughout.

use std::f64::consts::TAU;

use super::blend::{Blend, Held};
use super::half::{Half, Round};
use crate::mesh::DiskMesh;
use crate::nonlinear::scaffold::disk_in_plane;
use crate::problem::{Control, Embedding, SolveError};

/// Least share of the circle between neighbours, relative to an even share.
const LEAST_SHARE: f64 = 0.3;

/// Duration of the change of weights, in the units of the halves' stages.
const BLEND: f64 = 1.5;

/// The whole route.
pub(super) struct Circle {
    halves: [Half; 2],
    blend: Blend,
    latest: Embedding,
    /// Number of the half, number of held layers, and system of the latest solve, for reuse.
    held: Option<(usize, usize, Held)>,
}

impl Circle {
    /// `None` if the outside of an end cannot be triangulated.
    pub(super) fn new(
        mesh: &DiskMesh,
        ends: [&Embedding; 2],
        control: Control<'_>,
    ) -> Option<Result<Self, SolveError>> {
        let angles = spaced(mesh);
        let halves = [Half::new(mesh, ends[0], &angles)?, Half::new(mesh, ends[1], &angles)?];
        let disk = disk_in_plane(ends[0], mesh.mesh().triangles.clone())?;
        let blend = Blend::new(disk, ends.map(Embedding::clone), control);
        Some(blend.map(|blend| Self { halves, blend, latest: ends[0].clone(), held: None }))
    }

    /// Embedding at time t, computed from the previous one.
    pub(super) fn at(&mut self, t: f64, control: Control<'_>) -> Result<Embedding, SolveError> {
        let [first, second] = [0, 1].map(|k| self.halves[k].lasts());
        let time = t * (first + BLEND + second);
        let left = first + BLEND + second - time;
        self.latest = if time < first {
            self.on_half(0, time, control)?
        } else if left < second {
            self.on_half(1, left, control)?
        } else {
            self.on_circle((time - first) / BLEND, control)?
        };
        Ok(self.latest.clone())
    }

    /// Embedding on one half, `time` after its end of the route.
    fn on_half(&mut self, which: usize, time: f64, control: Control<'_>) -> Result<Embedding, SolveError> {
        let half = &self.halves[which];
        let moment = half.moment(time);
        let outline = half.outline(moment);
        let mut start = self.latest.clone();
        for (&vertex, &at) in &outline {
            start[vertex] = at;
        }
        let layer = moment.layers_held();
        let held = match self.held.take().filter(|held| (held.0, held.1) == (which, layer)) {
            Some((_, _, held)) => held,
            None => Held::new(&half.disk, |v| outline.contains_key(&v), control)?,
        };
        let found = held.solve(&half.disk, half.equations_at(moment), &start, control)?;
        self.held = Some((which, layer, held));
        Ok(found)
    }

    /// Embedding with the boundary on the circle, at a share of the change of weights.
    fn on_circle(&self, share: f64, control: Control<'_>) -> Result<Embedding, SolveError> {
        let [from, to] = [0, 1].map(|k| &self.halves[k]);
        let round = Round::between([&from.round, &to.round], share);
        let mut start = self.latest.clone();
        for (&vertex, &angle) in from.boundary().iter().zip(&from.angles) {
            start[vertex] = round.point(angle);
        }
        self.blend.solve(share, &start, control)
    }
}

/// Directions of the boundary's vertices on the circle, ascending within one turn. Gaps are proportional to the
/// surface's edges, with a lower bound.
fn spaced(mesh: &DiskMesh) -> Vec<f64> {
    let boundary = mesh.boundary_loop();
    let length = |k: usize| mesh.length([boundary[k], boundary[(k + 1) % boundary.len()]]);
    let lengths: Vec<f64> = (0..boundary.len()).map(length).collect();
    let floor = LEAST_SHARE * lengths.iter().sum::<f64>() / boundary.len() as f64;
    let widened: Vec<f64> = lengths.into_iter().map(|length| length.max(floor)).collect();
    let total: f64 = widened.iter().sum();
    let mut walked = 0.0;
    let mut before = |length: &f64| {
        let here = walked;
        walked += length;
        here / total * TAU
    };
    widened.iter().map(&mut before).collect()
}
