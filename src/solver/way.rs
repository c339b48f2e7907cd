//! The way of the pins in continuation, and of all points with them.

use glam::DVec2;

use super::PinPositions;

/// Where pins are to go, and how all points follow to first order.
pub(super) struct Way {
    pub(super) targets: PinPositions,
    pub(super) moves: Vec<DVec2>,
}

impl Way {
    /// The points moved by a share of the moves; those with targets exactly onto them by all of it.
    pub(super) fn from(&self, points: &[DVec2], share: f64) -> Vec<DVec2> {
        let mut z: Vec<DVec2> = points.iter().zip(&self.moves).map(|(z, by)| *z + share * *by).collect();
        if share >= 1.0 {
            for (v, target) in &self.targets {
                z[v.index()] = *target;
            }
        }
        z
    }
}
