//! The place of a pane in the window, and its camera.

use eframe::egui::{Pos2, Rect, Vec2};
use glam::{DVec2, DVec3};

use crate::view::{OrbitCamera, PlaneCamera};

/// A point of the screen as the camera takes it, relative to the pane.
pub(in crate::ui) fn in_pane(rect: Rect, position: Pos2) -> DVec2 {
    DVec2::new((position.x - rect.min.x).into(), (position.y - rect.min.y).into())
}

/// A point of the pane on the screen.
#[expect(clippy::cast_possible_truncation, reason = "points of the screen are f32")]
fn on_screen(rect: Rect, point: DVec2) -> Pos2 {
    rect.min + Vec2::new(point.x as f32, point.y as f32)
}

/// The pane's size as the camera takes it.
pub(in crate::ui) fn size_of(rect: Rect) -> DVec2 {
    DVec2::new(rect.width().into(), rect.height().into())
}

/// A part of the screen, and the camera that shows something in it.
#[derive(Clone, Copy)]
pub(in crate::ui) struct Viewport<C> {
    pub(in crate::ui) rect: Rect,
    pub(in crate::ui) camera: C,
}

impl Viewport<PlaneCamera> {
    /// Place of a point of the plane on the screen.
    pub(in crate::ui) fn spot(&self, point: DVec2) -> Pos2 {
        on_screen(self.rect, self.camera.pane_from_embedding(point, size_of(self.rect)))
    }

    /// The point of the plane at a place of the screen.
    pub(in crate::ui) fn point_at(&self, at: Pos2) -> DVec2 {
        self.camera.embedding_from_pane(in_pane(self.rect, at), size_of(self.rect))
    }
}

impl Viewport<OrbitCamera> {
    /// Place of a point of the world on the screen; none behind the eye.
    pub(in crate::ui) fn spot(&self, position: DVec3) -> Option<Pos2> {
        Some(on_screen(self.rect, self.camera.pane_from_world(position, size_of(self.rect))?))
    }
}

/// Place of a pane in the window, and its camera, once there is something to see.
#[derive(Clone, Copy, Debug)]
pub struct PaneView<C> {
    /// Points; none where the pane does not show.
    rect: Option<Rect>,
    size: DVec2,
    camera: Option<C>,
}

impl<C> Default for PaneView<C> {
    fn default() -> Self {
        Self { rect: None, size: DVec2::splat(400.0), camera: None }
    }
}

impl<C: Copy> PaneView<C> {
    /// The size of the pane when it showed last, points.
    pub fn size(&self) -> DVec2 {
        self.size
    }

    /// Takes in that the pane does not show, or not yet in this frame.
    pub(in crate::ui) fn hide(&mut self) {
        self.rect = None;
    }

    /// Takes in where the pane lies. Returns whether its size has changed.
    pub(in crate::ui) fn set_rect(&mut self, rect: Rect) -> bool {
        self.rect = Some(rect);
        std::mem::replace(&mut self.size, size_of(rect)) != self.size
    }

    pub fn camera(&self) -> Option<C> {
        self.camera
    }

    pub fn camera_mut(&mut self) -> Option<&mut C> {
        self.camera.as_mut()
    }

    pub fn set_camera(&mut self, camera: C) {
        self.camera = Some(camera);
    }

    pub(in crate::ui) fn forget_camera(&mut self) {
        self.camera = None;
    }

    /// Viewport of the pane, if it shows and has a camera.
    pub(in crate::ui) fn viewport(&self) -> Option<Viewport<C>> {
        Some(Viewport { rect: self.rect?, camera: self.camera? })
    }

    pub(in crate::ui) fn rect(&self) -> Option<Rect> {
        self.rect
    }
}
