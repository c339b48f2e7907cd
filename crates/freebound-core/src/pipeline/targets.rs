//! Targets: the user's pins in texture coordinates.
//!
//! Texture coordinates differ from coordinates of the plane: see [`PictureFrame`]. Only [`pins_in_plane`] converts
//! targets to the [`Pins`] of the solver.

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
    /// Hard constraint: met exactly.
    pub const fn hard(uv: DVec2) -> Self {
        Self { uv, kind: PinKind::Hard }
    }

    /// Fixed vertex: stays where it is.
    pub const fn fixed(uv: DVec2) -> Self {
        Self { uv, kind: PinKind::Fixed }
    }

    /// Soft constraint: pulls with a weight.
    pub const fn weighted(uv: DVec2, weight: f64) -> Self {
        Self { uv, kind: PinKind::Soft(weight) }
    }
}

/// Targets of hard constraints.
pub fn hard_targets(list: impl IntoIterator<Item = (VertexId, DVec2)>) -> Targets {
    list.into_iter().map(|(vertex, uv)| (vertex, Target::hard(uv))).collect()
}

/// Converts targets to pins in the plane of the embedding.
pub fn pins_in_plane(targets: &Targets, frame: PictureFrame) -> Pins {
    let pin = |&Target { uv, kind }: &Target| Pin { target: frame.plane_from_uv(uv), kind };
    targets.iter().map(|(&vertex, target)| (vertex, pin(target))).collect()
}
