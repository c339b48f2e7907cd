//! Planar morphs: from one planar embedding of a mesh to another in frames, every frame proved one-to-one. What lies between two
//! frames is not proved. Half way, where what is turned half around falls together, is always looked at.
//!
//! # Method
//!
//! C. Gotsman, V. Surazhsky, "Guaranteed intersection-free polygon morphing", 2001, after M. Floater, C. Gotsman, "How to
//! morph tilings injectively", 1999. Within a fixed convex frame a planar embedding is the solution of a system with positive
//! weights, its own mean-value weights: each row of λ₀ and λ₁ adds up to 1. Rows between them are positive, too:
//!
//! ```text
//! λ(t) = (1 − t) λ₀ + t λ₁        A(λ(t)) z(t) = 0,  the frame where it is
//! ```
//!
//! and so, by Tutte's and Floater's theorem, z(t) is planar for each t between 0 and 1: in exact arithmetic. In numbers of 64 bits
//! each frame is proved by itself, and a way with a frame that is not is none.
//!
//! # Ways
//!
//! They are tried in this order. The first that is proved at every frame is taken: where straight lines serve, nothing moves
//! that need not (V. Surazhsky, C. Gotsman, "Controllable morphing of compatible planar triangulations", 2001).
//!
//! | way | what moves | where it serves |
//! |---|---|---|
//! | [`Route::Straight`] | vertices along straight lines | where no frame folds |
//! | [`Route::Turned`] | the same, turned and scaled along | where no frame folds |
//! | [`Route::Boundary`] | weights, within a boundary that moves straight | boundaries that are convex throughout |
//! | [`Route::Outside`] | weights of mesh and outside, within a fixed frame | outsides that are triangulated alike |
//! | [`Route::Circle`] | weights, while pockets are opened one layer after the other until the boundary is a circle, and back | always, but for rounding |
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | the morph: ways in their order, each frame proved |
//! | `turn.rs` | what a similarity between the two ends has to do with the way |
//! | `blend.rs` | weights between those of two embeddings, and the systems that they make |
//! | `outside.rs` | an outside of both ends, triangulated alike |
//! | `circle.rs`, `half.rs`, `pockets.rs` | the way through a circle; one half of it; the layers of pockets around a boundary |

mod blend;
mod circle;
mod half;
mod outside;
mod pockets;
mod turn;

use glam::DVec2;

use crate::geom::{Orientation, orientation};
use crate::mesh::DiskMesh;
use crate::problem::{Control, Embedding, Phase, SolveError};
use crate::verify::is_one_to_one;
use blend::Blend;
use circle::Circle;
use turn::Turn;

/// By what way a morph goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Route {
    /// Every vertex goes straight.
    Straight,
    /// Every vertex goes straight in a plane that is turned and scaled along.
    Turned,
    /// Weights are interpolated within a convex boundary.
    Boundary,
    /// Weights of mesh and outside are interpolated within a frame.
    Outside,
    /// The boundary opens to a circle and closes again.
    Circle,
}

impl Route {
    /// All ways, in the order in which they are tried.
    pub const ALL: [Self; 5] = [Self::Straight, Self::Turned, Self::Boundary, Self::Outside, Self::Circle];

    /// A fixed name of it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Straight => "straight",
            Self::Turned => "turned",
            Self::Boundary => "boundary",
            Self::Outside => "outside",
            Self::Circle => "circle",
        }
    }

    /// How it goes, in a few lower-case words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Straight => "straight",
            Self::Turned => "straight, turned along",
            Self::Boundary => "by weights, within a convex boundary",
            Self::Outside => "by weights, within a frame",
            Self::Circle => "by weights, through a circle",
        }
    }
}

/// What is sought.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MorphOptions {
    /// How many frames there are, both ends included: two at least.
    pub frame_count: usize,
    /// The ways that are tried, in their order.
    pub routes: Vec<Route>,
}

impl Default for MorphOptions {
    fn default() -> Self {
        Self { frame_count: 33, routes: Route::ALL.to_vec() }
    }
}

/// A way from one embedding to another, both among its frames, each proved one-to-one.
#[derive(Clone, Debug, PartialEq)]
pub struct Morph {
    /// How it goes.
    pub route: Route,
    /// Embeddings at equal times, from the one to the other.
    pub frames: Vec<Embedding>,
}

/// Why there is no morph.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoMorph {
    /// One of the two embeddings is not one-to-one.
    #[error("only embeddings that are proved one-to-one have a planar morph between them")]
    EndFolds,
    /// One of them is a mirror image.
    #[error("one of the two embeddings is a mirror image: every way to the other one folds")]
    Mirrored,
    /// Every way has a frame that is not proved.
    #[error("every way that was tried has a frame that is not proved one-to-one")]
    NoWay,
    /// The caller asked to stop.
    #[error("the morph was cancelled")]
    Cancelled,
}

/// Finds a morph between two embeddings of a mesh.
///
/// # Errors
///
/// [`NoMorph`] with the reason.
///
/// # Panics
///
/// If an embedding does not have one position per vertex.
pub fn morph(
    mesh: &DiskMesh,
    ends: [&Embedding; 2],
    options: &MorphOptions,
    control: Control<'_>,
) -> Result<Morph, NoMorph> {
    if !ends.iter().all(|end| is_one_to_one(mesh, end)) {
        return Err(NoMorph::EndFolds);
    }
    match ends.map(|end| is_upright(mesh, end)) {
        [true, true] => return upright_morph(mesh, ends, options, control),
        [false, false] => {}
        _ => return Err(NoMorph::Mirrored),
    }
    let [from, to] = ends.map(mirrored);
    let mut found = upright_morph(mesh, [&from, &to], options, control)?;
    // One after the other: not all of them twice in memory.
    found.frames.iter_mut().for_each(|frame| *frame = mirrored(frame));
    Ok(found)
}

/// Whether the faces of a one-to-one embedding are positive: one of them is.
fn is_upright(mesh: &DiskMesh, embedding: &Embedding) -> bool {
    mesh.faces().take(1).all(|face| {
        let [a, b, c] = embedding.corners(mesh, face);
        orientation(a, b, c) == Some(Orientation::CounterClockwise)
    })
}

/// The mirror image: exact.
fn mirrored(embedding: &Embedding) -> Embedding {
    embedding.iter().map(|z| DVec2::new(-z.x, z.y)).collect()
}

/// Why one way gives no morph.
#[derive(Debug)]
enum Miss {
    Cancelled,
    /// It is not for these ends, a system has no solution, or a frame is not proved.
    NotThisWay,
}

impl From<SolveError> for Miss {
    fn from(error: SolveError) -> Self {
        if error == SolveError::Cancelled { Self::Cancelled } else { Self::NotThisWay }
    }
}

fn upright_morph(
    mesh: &DiskMesh,
    ends: [&Embedding; 2],
    options: &MorphOptions,
    control: Control<'_>,
) -> Result<Morph, NoMorph> {
    let search = Search { mesh, ends, frame_count: options.frame_count.max(2), control };
    for &route in &options.routes {
        match search.along(route) {
            Ok(frames) => return Ok(Morph { route, frames }),
            Err(Miss::Cancelled) => return Err(NoMorph::Cancelled),
            Err(Miss::NotThisWay) => {}
        }
    }
    Err(NoMorph::NoWay)
}

/// What a way is sought for. Faces of both ends are positive.
struct Search<'a> {
    mesh: &'a DiskMesh,
    ends: [&'a Embedding; 2],
    frame_count: usize,
    control: Control<'a>,
}

impl Search<'_> {
    /// All frames of one way.
    fn along(&self, route: Route) -> Result<Vec<Embedding>, Miss> {
        let [from, to] = self.ends;
        let turn = &self.turn_along(route);
        let beside = turn.taken_back(to);
        match route {
            Route::Straight | Route::Turned => self.frames(|t| Ok(turn.along(t, &straight([from, &beside], t)))),
            Route::Boundary => {
                let blend =
                    Blend::within_boundary(self.mesh, [from, &beside], self.control).ok_or(Miss::NotThisWay)??;
                self.blended(&blend, turn)
            }
            Route::Outside => {
                let blend =
                    outside::common_outside(self.mesh, [from, &beside], self.control).ok_or(Miss::NotThisWay)??;
                self.blended(&blend, turn)
            }
            Route::Circle => {
                let mut circle = Circle::new(self.mesh, [from, &beside], self.control).ok_or(Miss::NotThisWay)??;
                self.frames(|t| Ok(turn.along(t, &circle.at(t, self.control)?)))
            }
        }
    }

    /// What is turned along a way: all vertices by what fits them best, or boundaries by what fits these, so that one that
    /// is the same at both ends stays where it is.
    fn turn_along(&self, route: Route) -> Turn {
        let [from, to] = self.ends;
        match route {
            Route::Straight => Turn::NONE,
            Route::Turned => Turn::between([from, to]),
            Route::Boundary | Route::Outside | Route::Circle => {
                Turn::between([&from.boundary(self.mesh), &to.boundary(self.mesh)])
            }
        }
    }

    /// The frames of interpolated weights.
    fn blended(&self, blend: &Blend, turn: &Turn) -> Result<Vec<Embedding>, Miss> {
        let mut latest = blend.points_at_start();
        self.frames(|t| {
            latest = blend.at(t, &latest, self.control)?;
            Ok(turn.along(t, &Embedding::of_mesh(self.mesh, &latest)))
        })
    }

    /// The frames of a way that is asked for them in turn, each proved; and half way, where no frame is, what is there.
    fn frames(&self, mut at: impl FnMut(f64) -> Result<Embedding, Miss>) -> Result<Vec<Embedding>, Miss> {
        let last = self.frame_count - 1;
        let mut proved = |t: f64| {
            let mut frame = at(t)?;
            frame.gather_unused(self.mesh);
            self.control.enter(Phase::Verify)?;
            let is_proved = is_one_to_one(self.mesh, &frame) && is_upright(self.mesh, &frame);
            is_proved.then_some(frame).ok_or(Miss::NotThisWay)
        };
        let mut frames = vec![self.ends[0].clone()];
        for k in 1..=last {
            // A way is asked for its embeddings in the order of their times.
            if 2 * k == last + 1 {
                proved(0.5)?;
            }
            if k < last {
                frames.push(proved(k as f64 / last as f64)?);
            }
        }
        frames.push(self.ends[1].clone());
        Ok(frames)
    }
}

fn straight([from, to]: [&Embedding; 2], t: f64) -> Embedding {
    from.iter().zip(to).map(|(&a, &b)| toward([a, b], t)).collect()
}

/// A point at a share of the way from one to another; exactly there where both are the same.
fn toward([from, to]: [DVec2; 2], share: f64) -> DVec2 {
    from + share * (to - from)
}
