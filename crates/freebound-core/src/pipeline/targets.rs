//! Targets: the user's pins in texture coordinates.
//!
//! Texture coordinates are not the plane: see [`PictureFrame`]. [`pins_in_plane`] is the one way from targets to the
//! [`Pins`] of the solver.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::geom::PictureFrame;
use crate::mesh::VertexId;
use crate::problem::{Pin, PinKind, Pins};

/// The user's pinned vertices with their targets.
pub type Targets = BTreeMap<VertexId, Target>;

/// Prescribed texture coordinates of a vertex, and the kind of its pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Prescribed u and v.
    pub uv: DVec2,
    /// Kind of the pin.
    pub kind: PinKind,
}

impl Target {
    /// A constraint that is met exactly.
    pub const fn hard(uv: DVec2) -> Self {
        Self { uv, kind: PinKind::Hard }
    }

    /// A vertex that stays where it is.
    pub const fn fixed(uv: DVec2) -> Self {
        Self { uv, kind: PinKind::Fixed }
    }

    /// A constraint that pulls with a weight.
    pub const fn weighted(uv: DVec2, weight: f64) -> Self {
        Self { uv, kind: PinKind::Soft(weight) }
    }
}

/// Hard constraints.
pub fn hard_targets(list: impl IntoIterator<Item = (VertexId, DVec2)>) -> Targets {
    list.into_iter().map(|(vertex, uv)| (vertex, Target::hard(uv))).collect()
}

/// The pins of targets, in the plane of the embedding.
pub fn pins_in_plane(targets: &Targets, frame: PictureFrame) -> Pins {
    let pin = |&Target { uv, kind }: &Target| Pin { target: frame.plane_from_uv(uv), kind };
    targets.iter().map(|(&vertex, target)| (vertex, pin(target))).collect()
}
