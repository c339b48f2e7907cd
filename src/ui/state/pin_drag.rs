//! A drag of a pin, with the pins that go with it.

use eframe::egui::Vec2;
use glam::DVec2;

use crate::session::Action;
use freebound_core::geom::PictureFrame;
use freebound_core::mesh::VertexId;

#[derive(Clone, Debug)]
pub(in crate::ui) struct PinDrag {
    pub(in crate::ui) vertex: VertexId,
    /// From where the pointer grabbed it to its middle, points.
    pub(in crate::ui) offset: Vec2,
    /// The other pins that go with it, and how far from it they lie in the plane.
    pub(in crate::ui) others: Vec<(VertexId, DVec2)>,
    /// When the pointer moved last, seconds of the window's clock.
    pub(in crate::ui) moved_at: f64,
    /// True if it was said since then that the pointer rests.
    pub(in crate::ui) has_rested: bool,
}

impl PinDrag {
    pub(in crate::ui) fn vertex(&self) -> VertexId {
        self.vertex
    }

    /// Action that moves the pin to a place in the plane, and all pins that go with it.
    pub(in crate::ui) fn moves_to(&self, place: DVec2, frame: PictureFrame) -> Action {
        let (vertex, target) = (self.vertex, frame.uv_from_plane(place));
        if self.others.is_empty() {
            return Action::MovePin { vertex, target };
        }
        let others = self.others.iter().map(|&(other, offset)| (other, frame.uv_from_plane(place + offset)));
        Action::MovePins(std::iter::once((vertex, target)).chain(others).collect())
    }
}
