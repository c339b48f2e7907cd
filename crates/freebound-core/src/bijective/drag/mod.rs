//! Planar embedding under dragged pins: vertices follow the pins as far as the embedding stays planar, proved at every
//! frame.
//!
//! ```text
//! response: moves of the neighbourhood to first order of the energy, which include a Newton step
//! advance:  0.8 of the way to the first crushed triangle; the whole way if all of it is free
//! settle:   after a partial advance, a Newton step with the pins held; then a second advance
//! prove:    exact proof of the region that moved; a step without proof is halved, then rejected
//! ```
//!
//! The *rest shape* is the embedding at the start of the drag: the energy of a triangle measures its deformation since
//! then. Nothing moves except because of the pins, however distorted the embedding is. A pin dragged back restores the
//! initial embedding (only approximately if the outside was triangulated again meanwhile). Lowering the distortion
//! against the surface is left to the flattener, which continues when the pins are released.
//!
//! Only a *neighbourhood* of the pins moves; all other vertices are held. The neighbourhood grows with the distance of
//! the pins from their start, and with the strain at its rim. During a drag the neighbourhood never shrinks. Its size
//! is at most [`MOST_VERTICES`], so that a frame takes equally long on any mesh.
//!
//! Soft pins pull with springs, which are slack at the start of the drag. The spring of a dragged soft pin is
//! displaced by the move of its target.
//!
//! | file | contents |
//! |---|---|
//! | `mod.rs` | [`DragSolver`]: the drag, frame by frame |
//! | `brush.rs` | [`BrushSolver`]: strokes of brushes on an embedding |
//! | `reach.rs` | nearest vertices |
//! | `grow.rs` | size of the neighbourhood |
//! | `patch.rs` | the region that moves: its energy, and the longest step |
//! | `scaffold.rs` | the outside, if the region reaches the boundary |
//! | `blocker.rs` | blocker of a pin |
//! | `proof.rs` | proof of a frame, from that of the previous frame |

mod blocker;
mod brush;
mod grow;
mod patch;
mod proof;
mod reach;
mod scaffold;

use std::sync::Arc;

use glam::DVec2;

pub use self::blocker::Blocker;
pub use self::brush::{Brush, BrushFrame, BrushKind, BrushSolver};

use self::grow::Scale;
use self::patch::Patch;
use self::proof::{Boundary, InF32, verdict_of_planar, whole_proof};
use self::reach::Reach;
use self::scaffold::LocalScaffold;
use crate::mesh::{DiskMesh, VertexId};
use crate::nonlinear::energy_problem::{Limits, Unfolding};
use crate::nonlinear::foldover_energy::Energy;
use crate::problem::{Control, Embedding, Pins, SolveError};
use crate::verify::{UvFrame, Verdict};

/// Number of vertices that move at the start. A frame takes about 3 ms on two cores.
const FIRST_VERTICES: usize = 1500;
/// Largest number of vertices that move. A frame takes about 20 ms on two cores.
const MOST_VERTICES: usize = 10_000;

/// Growth factor of the neighbourhood.
const GROWTH: usize = 2;

/// Largest mean deformation at the rim; above it the neighbourhood grows.
const STRAIN: f64 = 0.02;

/// Most advances per frame, if only a part of the way is free.
const ADVANCES: usize = 2;

/// Halvings of a step without proof before it is rejected.
const HALVINGS: usize = 4;

/// Largest move of a point in a frame that counts as no move, relative to the mean edge.
const REST: f64 = 1e-3;

/// Share of its remaining way below which a pin counts as blocked in a frame.
const LITTLE: f64 = 0.1;

/// Targets of all pins, with the output frame in which embeddings are proved.
#[derive(Clone, Debug)]
pub struct DragTarget {
    /// All pins, with targets in the plane.
    pub pins: Pins,
    /// Output frame in which embeddings are proved.
    pub sheet: Arc<UvFrame>,
}

/// Planar embedding under dragged pins.
#[derive(Debug)]
pub struct DragSolver {
    /// Pins with their targets at the start of the drag.
    pins: Pins,
    /// Dragged pins, ascending.
    dragged: Vec<VertexId>,
    begin: Embedding,
    embedding: Embedding,
    /// Output frame of the embedding.
    sheet: Arc<UvFrame>,
    in_f32: InF32,
    scale: Scale,
    reach: Reach,
    /// Number of vertices that the neighbourhood is to have.
    wanted: usize,
    around: Option<LocalScaffold>,
    patch: Option<Patch>,
}

/// Result of one frame.
#[derive(Clone, Debug)]
pub struct DragFrame {
    /// Share of their remaining way that the dragged hard pins have covered, 0 to 1.
    pub reached: f64,
    /// Blocker of a pin that covered next to nothing of its way.
    pub obstacle: Option<Blocker>,
    /// True if nothing moves any more while the pins' targets stay.
    pub is_at_rest: bool,
    /// Verdict on the embedding as written, equal to [`verdict`](crate::verify::verdict) but proved from the moved
    /// region.
    pub verdict: Verdict,
}

/// Advance along the response.
#[derive(Clone, Copy, Debug, Default)]
struct Advance {
    /// Share of the response that was taken.
    share: f64,
    /// Largest move of a point.
    largest: f64,
    /// Triangle that limited the advance.
    end: Option<usize>,
    /// Object next to that triangle.
    obstacle: Option<Blocker>,
}

impl DragSolver {
    /// Starts a drag of some pins from an embedding made for `aim`.
    ///
    /// The embedding as written must be planar, with positive orientation, including the filling of holes. `None`
    /// otherwise. `None` also if `embedding` does not have one position per vertex, a dragged vertex has no pin, or a
    /// size of the embedding overflows or vanishes.
    pub fn new(mesh: &DiskMesh, embedding: Embedding, dragged: &[VertexId], aim: DragTarget) -> Option<Self> {
        if embedding.len() != mesh.vertex_count() || dragged.iter().any(|v| !aim.pins.contains_key(v)) {
            return None;
        }
        let DragTarget { pins, sheet } = aim;
        let in_f32 = whole_proof(mesh, &embedding, &sheet)?;
        let scale = Scale::of(mesh, &embedding, &pins)?;
        let mut dragged = dragged.to_vec();
        dragged.sort_unstable();
        dragged.dedup();
        let reach = Reach::new(mesh, &dragged, scale.mean_edge);
        let begin = embedding.clone();
        let (wanted, around, patch) = (FIRST_VERTICES, None, None);
        Some(Self { pins, dragged, begin, embedding, sheet, in_f32, scale, reach, wanted, around, patch })
    }

    /// Embedding of the latest frame.
    pub fn embedding(&self) -> &Embedding {
        &self.embedding
    }

    /// Dragged pins, ascending.
    pub fn dragged(&self) -> &[VertexId] {
        &self.dragged
    }

    /// Output frame since the latest accepted step.
    pub fn sheet(&self) -> &Arc<UvFrame> {
        &self.sheet
    }

    /// Vertices that may have moved since the drag began. All other vertices are where they were.
    pub fn moving(&self) -> &[VertexId] {
        self.patch.as_ref().map_or(&[], |patch| patch.moving())
    }

    /// Computes one frame: moves the dragged pins towards their targets in `aim`. The targets of all other pins in
    /// `aim` must be those of the start of the drag. If cancelled, the embedding is that of the last proved step.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub fn drag(&mut self, mesh: &DiskMesh, aim: &DragTarget, control: Control<'_>) -> Result<DragFrame, SolveError> {
        let before = self.distance_left(&aim.pins);
        if !self.prepare(mesh, aim) {
            return Ok(self.moved(aim, before, Advance::default()));
        }
        let (mut last, mut largest) = (Advance::default(), 0.0_f64);
        let mut may_triangulate = true;
        for _ in 0..ADVANCES {
            last = self.advance(mesh, aim, control)?;
            // The blocker is found first: triangulating the outside again renumbers its triangles.
            last.obstacle = last.end.and_then(|end| self.obstacle(mesh, end));
            let is_before_outside = |end| self.patch.as_ref().is_some_and(|patch| patch.is_outside(end));
            if last.share < 1.0 && may_triangulate && last.end.is_some_and(is_before_outside) {
                may_triangulate = false;
                self.triangulate_around(mesh, aim);
            }
            if last.share > 0.0 && last.share < 1.0 {
                self.settle(mesh, aim, control)?;
            }
            largest = largest.max(last.largest);
            if last.share >= 1.0 {
                break;
            }
        }
        Ok(self.moved(aim, before, Advance { largest, ..last }))
    }

    /// Result of a frame; `before` is the distance left before the frame. Enlarges the neighbourhood of the next frame
    /// if the rim is strained.
    fn moved(&mut self, aim: &DragTarget, before: f64, last: Advance) -> DragFrame {
        let left = self.distance_left(&aim.pins);
        let reached = if before > 0.0 { (1.0 - left / before).max(0.0) } else { 1.0 };
        let is_stopped = left > 0.0 && reached < LITTLE;
        let obstacle = last.obstacle.filter(|_| is_stopped);
        let is_rim = |v: VertexId| v.index() < self.begin.len() && !self.is_hard(v);
        let strain = self.patch.as_ref().map_or(0.0, |patch| patch.strain_at_rim(is_rim));
        let grows = strain > STRAIN && self.wanted < MOST_VERTICES;
        if grows {
            self.wanted = (GROWTH * self.wanted).min(MOST_VERTICES);
        }
        let is_at_rest = !grows && last.largest <= REST * self.scale.mean_edge;
        DragFrame { reached, obstacle, is_at_rest, verdict: verdict_of_planar(self.in_f32 != InF32::Folded) }
    }

    /// Largest distance of a dragged hard pin from its target.
    fn distance_left(&self, pins: &Pins) -> f64 {
        let exact = self.dragged.iter().filter(|v| self.is_hard(**v));
        let distance = |v: &VertexId| pins.get(v).map_or(0.0, |pin| self.embedding[v].distance(pin.target));
        exact.map(distance).fold(0.0, f64::max)
    }

    fn is_hard(&self, vertex: VertexId) -> bool {
        self.pins.get(&vertex).is_some_and(|pin| pin.kind.is_hard())
    }

    /// Advances along the response while nothing is crushed and the proof holds.
    fn advance(&mut self, mesh: &DiskMesh, aim: &DragTarget, control: Control<'_>) -> Result<Advance, SolveError> {
        let Some(patch) = &mut self.patch else { return Ok(Advance::default()) };
        let moved_by = |v: VertexId| Some(aim.pins.get(&v)?.target - self.pins.get(&v)?.target);
        patch.aim_springs(|v| self.begin[v] + moved_by(v).unwrap_or_default());
        let target = |v: VertexId| aim.pins.get(&v).map(|pin| pin.target);
        let shift = patch.shift(|v, z| target(v).map_or(DVec2::ZERO, |target| target - z));
        let moves = match patch.problem().response(patch.z(), &shift, control) {
            Ok(moves) => moves,
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            // Rounding leaves no direction: this frame repeats the previous one.
            Err(_) => return Ok(Advance::default()),
        };
        let room = patch.room(&moves);
        let largest = moves.iter().map(|by| by.length()).fold(0.0, f64::max);
        let mut share = room.share;
        for _ in 0..=HALVINGS {
            let Some(patch) = &self.patch else { break };
            let mut z: Vec<DVec2> = patch.z().iter().zip(&moves).map(|(z, by)| *z + share * *by).collect();
            if share >= 1.0 {
                patch.put_on(&mut z, target);
            }
            if self.take(mesh, z, &aim.sheet) {
                return Ok(Advance { share, largest: share * largest, end: Some(room.end), obstacle: None });
            }
            share *= 0.5;
        }
        Ok(Advance { end: Some(room.end), ..Advance::default() })
    }

    /// Takes a Newton step on the energy with the dragged pins held.
    fn settle(&mut self, mesh: &DiskMesh, aim: &DragTarget, control: Control<'_>) -> Result<(), SolveError> {
        let Some(patch) = &self.patch else { return Ok(()) };
        let mut z = patch.z().to_vec();
        let unfolding = Unfolding::Freely;
        let limits = Limits { unfolded: Energy::Foldover(0.0), steps: 1, unfolding, tolerance: 0.0 };
        match patch.problem().descend(&mut z, limits, None, control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            Err(_) => {}
            Ok(_) => {
                self.take(mesh, z, &aim.sheet);
            }
        }
        Ok(())
    }

    /// Accepts positions of the patch if the embedding is proved planar with them. Returns true if accepted.
    fn take(&mut self, mesh: &DiskMesh, z: Vec<DVec2>, sheet: &Arc<UvFrame>) -> bool {
        let Some(patch) = &mut self.patch else { return false };
        let put = |embedding: &mut Embedding, z: &[DVec2]| {
            patch.moving().iter().zip(z).for_each(|(v, z)| embedding[*v] = *z);
        };
        put(&mut self.embedding, &z);
        let is_positive = |flag: fn(&LocalScaffold) -> bool| self.around.as_ref().is_some_and(flag);
        let moved = patch.moved(mesh, &z, sheet).beside(is_positive(|around| around.is_positive));
        let written_boundary = |embedding: &Embedding| -> Vec<DVec2> {
            mesh.boundary_loop().iter().map(|&v| sheet.written_place(Some(v), embedding[v])).collect()
        };
        let Some(boundary) = moved.proof(|| written_boundary(&self.embedding)) else {
            put(&mut self.embedding, patch.z());
            return false;
        };
        let in_f32 = moved.in_f32(is_positive(|around| around.is_positive_in_f32));
        let boundary_in_f32 = || written_boundary(&self.embedding).iter().map(|z| z.as_vec2().as_dvec2()).collect();
        let by_parts = if self.in_f32 == InF32::Positive { in_f32.proof(boundary_in_f32) } else { None };
        if by_parts.is_none() {
            let is_upright = in_f32.has_upright_faces();
            self.in_f32 = if is_upright { InF32::of(mesh, &sheet.written(&self.embedding)) } else { InF32::Folded };
        }
        if let Some(around) = &mut self.around {
            around.is_positive &= boundary != Boundary::Whole;
            around.is_positive_in_f32 &= by_parts.is_some_and(|boundary| boundary != Boundary::Whole);
        }
        self.sheet = Arc::clone(sheet);
        patch.take(z);
        true
    }
}
