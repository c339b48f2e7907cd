//! A planar embedding under dragged pins: it follows them as far as it stays planar, proved at every frame.
//!
//! ```text
//! response: how the part of the sheet around the pins follows them, to first order of the energy; at once a Newton step
//! advance:  0.8 of the way to where a first triangle would be crushed; where all of it is free, all of it
//! settle:   where only a part was free, a Newton step with the pins held; then once more
//! prove:    what moved, exactly; a step without proof is halved, or not taken
//! ```
//!
//! The sheet is *at rest where it lay when the drag began*: a triangle's energy measures how it is deformed since then. So
//! nothing moves but for the pins' sake, however much the sheet is distorted against the surface, and a pin that comes
//! back brings back what it began with (nearly, where the outside was triangulated anew on the way). What the surface
//! wants is for the flattener, which goes on when the pins are let go.
//!
//! Only a *neighbourhood* of the pins moves; the rest is held. It grows with the pins' way, and wherever the sheet is
//! deformed at its rim, and never shrinks during a drag. It is at most [`MOST_VERTICES`] large, so that a frame takes as long on
//! any mesh. Weighted pins pull with springs that hang slack where the drag begins; dragged, they pull by how far their target
//! has moved.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | [`DragSolver`]: the drag, frame by frame |
//! | `reach.rs` | which vertices are near |
//! | `grow.rs` | the neighbourhood as large as the pins' way wants it |
//! | `patch.rs` | what moves: its energy, and how far it can go |
//! | `around.rs` | the outside, where what moves reaches the boundary |
//! | `obstacle.rs` | what is in a pin's way |
//! | `proof.rs` | the proof of a frame, from that of the one before |

mod blocker;
mod grow;
mod patch;
mod proof;
mod reach;
mod scaffold;

use std::sync::Arc;

use glam::DVec2;

pub use self::blocker::Blocker;

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

/// Vertices that move at first, and at most: a frame of these takes some 3 and some 20 milliseconds on two cores.
const FIRST_VERTICES: usize = 1500;
const MOST_VERTICES: usize = 10_000;

/// The neighbourhood grows by so much at once.
const GROWTH: usize = 2;

/// The neighbourhood grows where the mean deformation at its rim is larger.
const STRAIN: f64 = 0.02;

/// How often a frame goes on where only a part of the way was free.
const ADVANCES: usize = 2;

/// Halvings of a step that is not proved, before it is none.
const HALVINGS: usize = 4;

/// A sheet is at rest where nothing moves by more than such a share of its mean edge.
const REST: f64 = 1e-3;

/// A pin that goes a smaller share of its way in a frame has something in its way.
const LITTLE: f64 = 0.1;

/// Where pins are to be, as they are held, and how embeddings are written with them there.
#[derive(Clone, Debug)]
pub struct DragTarget {
    /// All pins, in the plane.
    pub pins: Pins,
    /// How embeddings are written: what is proved.
    pub sheet: Arc<UvFrame>,
}

/// A planar embedding under pins that are dragged.
#[derive(Debug)]
pub struct DragSolver {
    /// Where pins were to be when the drag began.
    pins: Pins,
    /// The pins that are dragged, ascending.
    dragged: Vec<VertexId>,
    begin: Embedding,
    embedding: Embedding,
    /// How the embedding is written.
    sheet: Arc<UvFrame>,
    in_f32: InF32,
    scale: Scale,
    reach: Reach,
    /// How many vertices the neighbourhood is to have.
    wanted: usize,
    around: Option<LocalScaffold>,
    patch: Option<Patch>,
}

/// What a frame has come to.
#[derive(Clone, Debug)]
pub struct DragFrame {
    /// The share of their remaining way that the dragged exact pins have gone, 0 to 1.
    pub reached: f64,
    /// What is in the way of a pin that has gone next to nothing of it.
    pub obstacle: Option<Blocker>,
    /// Whether nothing moves any more as long as the pins' targets stay.
    pub is_at_rest: bool,
    /// The verdict on the embedding as it is written: that of [`verdict`](crate::verify::verdict), proved of what moved.
    pub verdict: Verdict,
}

/// An advance along the response.
#[derive(Clone, Copy, Debug, Default)]
struct Advance {
    /// The share of it that was taken.
    share: f64,
    /// The largest move of a point.
    largest: f64,
    /// The triangle that ended it, and what lies next to that.
    end: Option<usize>,
    obstacle: Option<Blocker>,
}

impl DragSolver {
    /// Begins a drag of some pins at an embedding, which was made for `aim`. `None` where that is not planar as it lies,
    /// holes included, in the numbers that are written.
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

    /// The embedding of the latest frame.
    pub fn embedding(&self) -> &Embedding {
        &self.embedding
    }

    /// The pins that are dragged, ascending.
    pub fn dragged(&self) -> &[VertexId] {
        &self.dragged
    }

    /// How embeddings are written since the latest frame.
    pub fn sheet(&self) -> &Arc<UvFrame> {
        &self.sheet
    }

    /// The vertices that may have moved since the drag began; all others lie where they did.
    pub fn moving(&self) -> &[VertexId] {
        self.patch.as_ref().map_or(&[], |patch| patch.moving())
    }

    /// One frame: the dragged pins go on towards their targets in `aim`, in which no other pin differs from where the drag
    /// began. Stopped, the embedding is that of the last step which was proved.
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
            // Triangles are numbered anew where the outside is triangulated anew.
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

    /// What a frame has come to, before which pins had so far to go. The neighbourhood of the next one is larger where
    /// the sheet is deformed at the rim of this one.
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

    /// The largest distance of a dragged exact pin from its target.
    fn distance_left(&self, pins: &Pins) -> f64 {
        let exact = self.dragged.iter().filter(|v| self.is_hard(**v));
        let distance = |v: &VertexId| pins.get(v).map_or(0.0, |pin| self.embedding[v].distance(pin.target));
        exact.map(distance).fold(0.0, f64::max)
    }

    fn is_hard(&self, vertex: VertexId) -> bool {
        self.pins.get(&vertex).is_some_and(|pin| pin.kind.is_hard())
    }

    /// Goes along the response as far as nothing is crushed and the proof holds.
    fn advance(&mut self, mesh: &DiskMesh, aim: &DragTarget, control: Control<'_>) -> Result<Advance, SolveError> {
        let Some(patch) = &mut self.patch else { return Ok(Advance::default()) };
        let moved_by = |v: VertexId| Some(aim.pins.get(&v)?.target - self.pins.get(&v)?.target);
        patch.aim_springs(|v| self.begin[v] + moved_by(v).unwrap_or_default());
        let target = |v: VertexId| aim.pins.get(&v).map(|pin| pin.target);
        let shift = patch.shift(|v, z| target(v).map_or(DVec2::ZERO, |target| target - z));
        let moves = match patch.problem().response(patch.z(), &shift, control) {
            Ok(moves) => moves,
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            // Rounding has left no direction: this frame shows what the last one did.
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

    /// Lowers the energy by a Newton step, the dragged pins held where they are.
    fn settle(&mut self, mesh: &DiskMesh, aim: &DragTarget, control: Control<'_>) -> Result<(), SolveError> {
        let Some(patch) = &self.patch else { return Ok(()) };
        let mut z = patch.z().to_vec();
        let unfolding = Unfolding::Freely;
        let limits = Limits { unfolded: Energy::Foldover(0.0), steps: 1, unfolding, tolerance: 0.0 };
        match patch.problem().descend(&mut z, limits, control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            Err(_) => {}
            Ok(_) => {
                self.take(mesh, z, &aim.sheet);
            }
        }
        Ok(())
    }

    /// Takes over places of the patch where that is proved planar. Returns whether it is.
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
