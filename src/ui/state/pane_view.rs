//! Place and camera of a pane.

use eframe::egui::{Pos2, Rect, Vec2};
use glam::{DVec2, DVec3};

use crate::view::{OrbitCamera, PlaneCamera};

/// Converts a point of the screen to coordinates of the pane, which the camera uses.
pub(in crate::ui) fn in_pane(rect: Rect, position: Pos2) -> DVec2 {
    DVec2::new((position.x - rect.min.x).into(), (position.y - rect.min.y).into())
}

/// Converts a point of the pane to the screen.
#[expect(clippy::cast_possible_truncation, reason = "points of the screen are f32")]
fn on_screen(rect: Rect, point: DVec2) -> Pos2 {
    rect.min + Vec2::new(point.x as f32, point.y as f32)
}

/// Size of the pane, as the camera uses it.
pub(in crate::ui) fn size_of(rect: Rect) -> DVec2 {
    DVec2::new(rect.width().into(), rect.height().into())
}

/// Part of the screen, and the camera that draws into it.
#[derive(Clone, Copy)]
pub(in crate::ui) struct Viewport<C> {
    pub(in crate::ui) rect: Rect,
    pub(in crate::ui) camera: C,
}

impl Viewport<PlaneCamera> {
    /// Position of a point of the plane on the screen.
    pub(in crate::ui) fn spot(&self, point: DVec2) -> Pos2 {
        on_screen(self.rect, self.camera.pane_from_embedding(point, size_of(self.rect)))
    }

    /// Point of the plane at a position on the screen.
    pub(in crate::ui) fn point_at(&self, at: Pos2) -> DVec2 {
        self.camera.embedding_from_pane(in_pane(self.rect, at), size_of(self.rect))
    }
}

impl Viewport<OrbitCamera> {
    /// Position of a point of the world on the screen; `None` behind the eye.
    pub(in crate::ui) fn spot(&self, position: DVec3) -> Option<Pos2> {
        Some(on_screen(self.rect, self.camera.pane_from_world(position, size_of(self.rect))?))
    }
}

/// Place of a pane in the window, and its camera. The camera is set once there is something to show.
#[derive(Clone, Copy, Debug)]
pub struct PaneView<C> {
    /// Place of the pane, points; `None` if the pane is hidden.
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
    /// Size of the pane when it last showed, points.
    pub fn size(&self) -> DVec2 {
        self.size
    }

    /// Marks the pane as hidden, until it is shown in this frame.
    pub(in crate::ui) fn hide(&mut self) {
        self.rect = None;
    }

    /// Sets the place of the pane. Returns true if the size has changed.
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
