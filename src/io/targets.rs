//! Targets: what the user pins, in texture coordinates.
//!
//! Texture coordinates are not the plane: see [`PictureFrame`]. [`pins_in_plane`] is the one way from targets to the
//! [`Pins`] that the solver is given.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::geom::PictureFrame;
use crate::mesh::VertexId;
use crate::solver::{Hold, Pin, Pins};

/// The user's pinned vertices with their targets.
pub type Targets = BTreeMap<VertexId, Target>;

/// A vertex's prescribed texture coordinates, and how it is held there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Where the vertex is to be, u and v.
    pub uv: DVec2,
    /// How it is held.
    pub hold: Hold,
}

impl Target {
    /// A constraint that is met exactly.
    pub const fn hard(uv: DVec2) -> Self {
        Self { uv, hold: Hold::Hard }
    }

    /// A vertex that stays where it is.
    pub const fn fixed(uv: DVec2) -> Self {
        Self { uv, hold: Hold::Fixed }
    }

    /// A constraint that pulls with a weight.
    pub const fn weighted(uv: DVec2, weight: f64) -> Self {
        Self { uv, hold: Hold::Weighted(weight) }
    }
}

/// Hard constraints.
pub fn hard_targets(list: impl IntoIterator<Item = (VertexId, DVec2)>) -> Targets {
    list.into_iter().map(|(vertex, uv)| (vertex, Target::hard(uv))).collect()
}

/// The pins of targets, in the plane of the embedding.
pub fn pins_in_plane(targets: &Targets, frame: PictureFrame) -> Pins {
    let pin = |&Target { uv, hold }: &Target| Pin { target: frame.plane_from_uv(uv), hold };
    targets.iter().map(|(&vertex, target)| (vertex, pin(target))).collect()
}
