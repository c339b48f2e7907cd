//! Common parts of insets over the panes: an inset handles the wheel and drags over it, and has a close button.

use eframe::egui::{self, Rect, Response, Role, Sense, Vec2};
use glam::DVec2;

use super::pane;
use crate::ui::state::{InsetKind, InsetPan, InsetSubject};
use crate::ui::{Control, Request, close_button};

/// Zoom factor per point of a two-finger scroll on a trackpad.
const PER_POINT: f64 = 1.004;

impl InsetKind {
    fn id(self, ui: &egui::Ui) -> egui::Id {
        ui.scope_id().with(("inset", self))
    }
}

/// True if the wheel belongs to an inset over the plane, because the pointer was over it in the frame before.
pub(super) fn has_wheel(ui: &egui::Ui) -> bool {
    let has_pointer =
        |kind: InsetKind| ui.ctx().read_response(kind.id(ui)).is_some_and(|inset| inset.contains_pointer());
    [InsetKind::Defect, InsetKind::PairInPlane].into_iter().any(has_pointer)
}

/// Inset of a frame, for the pointer and for screen readers.
pub(super) struct Inset<'a> {
    pub(super) kind: InsetKind,
    pub(super) rect: Rect,
    pub(super) role: Role,
    pub(super) name: &'a str,
    pub(super) about: InsetSubject,
}

impl Inset<'_> {
    /// Handles clicks, drags and the wheel, which the pane below must not receive, and shows the close button. The
    /// wheel zooms, a drag pans.
    pub(super) fn interact(&self, ui: &egui::Ui, requests: &mut Vec<Request>) -> Response {
        let response = ui.interact(self.rect, self.kind.id(ui), Sense::click_and_drag()).named(self.role, self.name);
        if response.contains_pointer() {
            let wheel = pane::wheel(ui);
            let by = wheel.zoom * PER_POINT.powf(wheel.pan.y);
            if (by - 1.0).abs() > f64::EPSILON {
                requests.push(Request::ZoomInset(self.about.defect(), by));
            }
        }
        let drag = response.drag_delta();
        if drag != Vec2::ZERO {
            let by = DVec2::new(drag.x.into(), drag.y.into());
            requests.push(Request::PanInset(InsetPan { kind: self.kind, about: self.about, by }));
        }
        let cross = Rect::from_center_size(self.rect.right_top() + Vec2::new(-11.0, 10.0), Vec2::splat(16.0));
        let tip = "Close the magnifiers; the View menu opens them again";
        let name = format!("Close: {}", self.name);
        let close = close_button(ui, self.kind.id(ui).with("close"), cross, [&name, tip]);
        close.asks(Request::ToggleMagnifier, requests);
        response
    }
}
