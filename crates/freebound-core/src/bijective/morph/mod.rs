//! Planar morphs: from one planar embedding of a mesh to another in frames, every frame proved one-to-one. The motion
//! between two frames is not proved. The middle is always tested, because anything that turns by half a turn collapses
//! there.
//!
//! # Method
//!
//! C. Gotsman, V. Surazhsky, "Guaranteed intersection-free polygon morphing", 2001, after M. Floater, C. Gotsman, "How
//! to morph tilings injectively", 1999. Within a fixed convex frame, a planar embedding solves a system with positive
//! weights: its own mean-value weights, scaled such that each row of λ₀ and λ₁ adds up to 1. Rows between them are
//! positive, too:
//!
//! ```text
//! λ(t) = (1 − t) λ₀ + t λ₁        A(λ(t)) z(t) = 0,  with the frame fixed
//! ```
//!
//! By the theorem of Tutte and Floater, z(t) is planar for each t between 0 and 1, in exact arithmetic. In 64-bit
//! numbers each frame is proved by itself. A route with an unproved frame is rejected.
//!
//! # Routes
//!
//! Routes are tried in this order. The first route whose frames are all proved is returned. Straight lines come first,
//! so that nothing moves without need (V. Surazhsky, C. Gotsman, "Controllable morphing of compatible planar
//! triangulations", 2001).
//!
//! | route | motion | works if |
//! |---|---|---|
//! | [`Route::Straight`] | vertices along straight lines | no frame folds |
//! | [`Route::Turned`] | vertices along straight lines, in a plane that turns and scales | no frame folds |
//! | [`Route::Boundary`] | weights, within a boundary that moves straight | the boundary is convex throughout |
//! | [`Route::Outside`] | weights of mesh and outside, in a fixed frame | a common outside triangulation exists |
//! | [`Route::Circle`] | weights, while pockets open to a circle by layers, and back | always, except for rounding |
//!
//! | file | contents |
//! |---|---|
//! | `mod.rs` | the morph: routes in order, each frame proved |
//! | `turn.rs` | similarity between the two ends, applied along the route |
//! | `blend.rs` | weights between those of two embeddings, and their linear systems |
//! | `outside.rs` | an outside of both ends with a common triangulation |
//! | `circle.rs`, `half.rs`, `pockets.rs` | route through a circle; one half of it; layers of pockets |

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

/// Route of a morph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Route {
    /// Every vertex moves straight.
    Straight,
    /// Every vertex moves straight in a plane that turns and scales.
    Turned,
    /// Weights are interpolated within a convex boundary.
    Boundary,
    /// Weights of mesh and outside are interpolated within a frame.
    Outside,
    /// The boundary opens to a circle and closes again.
    Circle,
}

impl Route {
    /// All routes, in the order in which they are tried.
    pub const ALL: [Self; 5] = [Self::Straight, Self::Turned, Self::Boundary, Self::Outside, Self::Circle];

    /// Fixed name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Straight => "straight",
            Self::Turned => "turned",
            Self::Boundary => "boundary",
            Self::Outside => "outside",
            Self::Circle => "circle",
        }
    }

    /// Short lower-case description.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Straight => "straight",
            Self::Turned => "straight, with rotation",
            Self::Boundary => "interpolated weights, convex boundary",
            Self::Outside => "interpolated weights, within a frame",
            Self::Circle => "interpolated weights, through a circle",
        }
    }
}

/// Options of a morph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MorphOptions {
    /// Number of frames, both ends included. Values below 2 count as 2. Default: 33.
    pub frame_count: usize,
    /// Routes to try, in order. Default: [`Route::ALL`].
    pub routes: Vec<Route>,
}

impl Default for MorphOptions {
    fn default() -> Self {
        Self { frame_count: 33, routes: Route::ALL.to_vec() }
    }
}

/// Morph from one embedding to another. Both are among its frames, each proved one-to-one.
#[derive(Clone, Debug, PartialEq)]
pub struct Morph {
    /// Route that was taken.
    pub route: Route,
    /// Embeddings at equal time steps, from the first end to the second.
    pub frames: Vec<Embedding>,
}

/// Reason for the lack of a morph.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoMorph {
    /// An end is not one-to-one.
    #[error("an embedding is not proved one-to-one: a planar morph needs two that are")]
    EndFolds,
    /// Exactly one end is a mirror image.
    #[error("one of the two embeddings is mirrored: every morph between them folds")]
    Mirrored,
    /// Every route has a frame that is not proved.
    #[error("every route tried has a frame that is not proved one-to-one")]
    NoWay,
    /// The caller cancelled.
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
    // Frames are mirrored in place, so that memory holds them once.
    found.frames.iter_mut().for_each(|frame| *frame = mirrored(frame));
    Ok(found)
}

/// True if the faces of a one-to-one embedding are positive, tested on one face.
fn is_upright(mesh: &DiskMesh, embedding: &Embedding) -> bool {
    mesh.faces().take(1).all(|face| {
        let [a, b, c] = embedding.corners(mesh, face);
        orientation(a, b, c) == Some(Orientation::CounterClockwise)
    })
}

/// Mirror image, exact.
fn mirrored(embedding: &Embedding) -> Embedding {
    embedding.iter().map(|z| DVec2::new(-z.x, z.y)).collect()
}

/// Reason for the failure of one route.
#[derive(Debug)]
enum Miss {
    Cancelled,
    /// The route does not apply to these ends, a system has no solution, or a frame is not proved.
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

/// Search for a morph. The faces of both ends are positive.
struct Search<'a> {
    mesh: &'a DiskMesh,
    ends: [&'a Embedding; 2],
    frame_count: usize,
    control: Control<'a>,
}

impl Search<'_> {
    /// All frames of one route.
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

    /// Similarity applied along a route: the best fit of all vertices for [`Route::Turned`], of the boundaries for
    /// routes by weights. A boundary that is equal at both ends therefore stays fixed.
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

    /// Frames with interpolated weights.
    fn blended(&self, blend: &Blend, turn: &Turn) -> Result<Vec<Embedding>, Miss> {
        let mut latest = blend.points_at_start();
        self.frames(|t| {
            latest = blend.at(t, &latest, self.control)?;
            Ok(turn.along(t, &Embedding::of_mesh(self.mesh, &latest)))
        })
    }

    /// All frames of a route, each proved. Also proves the middle if no frame is there. `at` is called at ascending
    /// times.
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
            // Embeddings are requested in the order of their times.
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

/// Point at a share of the way between two points. Exact if both are equal.
fn toward([from, to]: [DVec2; 2], share: f64) -> DVec2 {
    from + share * (to - from)
}
