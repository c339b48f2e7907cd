//! Place and size of an old surface beside a new one, before nearest points are sought.

use std::borrow::Cow;

use glam::DVec3;

use freebound_core::geom::SpaceBounds;
use freebound_core::mesh::TriMesh;

/// Place and size of an old surface beside a new one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Registration {
    /// Both as their files have them.
    #[default]
    AsTheyAre,
    /// The old surface is moved and scaled: the box around it gets the centre and the diagonal of the box around the new
    /// one.
    ByBox,
}

impl Registration {
    /// Registration for a choice to fit the old surface or not.
    pub fn of(is_fitted: bool) -> Self {
        if is_fitted { Self::ByBox } else { Self::AsTheyAre }
    }

    /// The old surface at its place beside the points of the new one. A surface without extent stays where it is.
    pub(crate) fn applied(self, old: &TriMesh, new: impl IntoIterator<Item = DVec3>) -> Cow<'_, TriMesh> {
        let from = SpaceBounds::of(old.triangles.iter().flatten().map(|vertex| old.positions[vertex.index()]));
        let to = SpaceBounds::of(new);
        let scale = to.diagonal() / from.diagonal();
        if self == Self::AsTheyAre || !scale.is_finite() || scale <= 0.0 {
            return Cow::Borrowed(old);
        }
        let place = |&p: &DVec3| to.middle() + scale * (p - from.middle());
        Cow::Owned(TriMesh { positions: old.positions.iter().map(place).collect(), ..old.clone() })
    }
}
