//! What insets over the panes share: the wheel over them is theirs, and a cross closes them.

use eframe::egui::{self, Rect, Response, Role, Sense, Vec2};

use super::pane;
use crate::ui::{Control, Request, close_button};

/// How much nearer and farther the wheel brings an inset.
const REACH: std::ops::RangeInclusive<f64> = 0.1..=1e4;

/// How much nearer a point of a trackpad's two fingers brings it.
const PER_POINT: f64 = 1.004;

/// How much nearer a person has brought what the insets show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::ui) struct Zoom {
    /// The defect that it was for, by its place in the list; none for pairs.
    of: Option<usize>,
    factor: f64,
}

impl Default for Zoom {
    fn default() -> Self {
        Self { of: None, factor: 1.0 }
    }
}

impl Zoom {
    /// Whether a person has brought that inset nearer or farther.
    pub(super) fn is_set(&self, of: Option<usize>) -> bool {
        (self.factor(of) - 1.0).abs() > f64::EPSILON
    }

    /// How much nearer the inset of a defect shows, or that of a pair. Another defect begins anew.
    pub(super) fn factor(&self, of: Option<usize>) -> f64 {
        if self.of == of { self.factor } else { 1.0 }
    }

    pub(in crate::ui) fn bring_nearer(&mut self, of: Option<usize>, by: f64) {
        let factor = (self.factor(of) * by).clamp(*REACH.start(), *REACH.end());
        *self = Self { of, factor };
    }
}

/// The insets that there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Kind {
    /// A defect in the plane.
    Defect,
    PairOnMesh,
    PairInPlane,
}

impl Kind {
    fn id(self, ui: &egui::Ui) -> egui::Id {
        ui.scope_id().with(("inset", self))
    }
}

/// Whether the wheel belongs to an inset over the plane: the pointer was over it in the frame before.
pub(super) fn has_wheel(ui: &egui::Ui) -> bool {
    let has_pointer = |kind: Kind| ui.ctx().read_response(kind.id(ui)).is_some_and(|inset| inset.contains_pointer());
    [Kind::Defect, Kind::PairInPlane].into_iter().any(has_pointer)
}

/// An inset of one frame, for the pointer and for those who do not see it.
pub(super) struct Inset<'a> {
    pub(super) kind: Kind,
    pub(super) rect: Rect,
    pub(super) role: Role,
    pub(super) name: &'a str,
    /// The defect that it shows, by its place in the list; none for pairs.
    pub(super) of: Option<usize>,
}

impl Inset<'_> {
    /// Takes clicks, drags and the wheel, which what lies under it must not get, and shows the cross.
    pub(super) fn interact(&self, ui: &egui::Ui, requests: &mut Vec<Request>) -> Response {
        let response = ui.interact(self.rect, self.kind.id(ui), Sense::click_and_drag()).named(self.role, self.name);
        if response.contains_pointer() {
            let wheel = pane::wheel(ui);
            let by = wheel.zoom * PER_POINT.powf(wheel.pan.y);
            if (by - 1.0).abs() > f64::EPSILON {
                requests.push(Request::ZoomInset(self.of, by));
            }
        }
        let cross = Rect::from_center_size(self.rect.right_top() + Vec2::new(-11.0, 10.0), Vec2::splat(16.0));
        let tip = "Close the magnifiers; the View menu opens them again";
        let name = format!("Close: {}", self.name);
        let close = close_button(ui, self.kind.id(ui).with("close"), cross, [&name, tip]);
        close.asks(Request::ToggleMagnifier, requests);
        response
    }
}
