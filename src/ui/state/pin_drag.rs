//! Drag of a pin, and of the pins that move with it.

use eframe::egui::Vec2;
use glam::DVec2;

use crate::session::Action;
use freebound_core::geom::PictureFrame;
use freebound_core::mesh::VertexId;

#[derive(Clone, Debug)]
pub(in crate::ui) struct PinDrag {
    pub(in crate::ui) vertex: VertexId,
    /// Vector from the grabbed point to the middle of the pin, points.
    pub(in crate::ui) offset: Vec2,
    /// Other pins that move with the dragged pin, and their offsets from it in the plane.
    pub(in crate::ui) others: Vec<(VertexId, DVec2)>,
    /// Time of the last move of the pointer, seconds of the window's clock.
    pub(in crate::ui) moved_at: f64,
    /// True if the pointer has been reported as resting since the last move.
    pub(in crate::ui) has_rested: bool,
}

impl PinDrag {
    pub(in crate::ui) fn vertex(&self) -> VertexId {
        self.vertex
    }

    /// Action that moves the pin to a point of the plane, together with the other pins.
    pub(in crate::ui) fn moves_to(&self, place: DVec2, frame: PictureFrame) -> Action {
        let (vertex, target) = (self.vertex, frame.uv_from_plane(place));
        if self.others.is_empty() {
            return Action::MovePin { vertex, target };
        }
        let others = self.others.iter().map(|&(other, offset)| (other, frame.uv_from_plane(place + offset)));
        Action::MovePins(std::iter::once((vertex, target)).chain(others).collect())
    }
}
