//! What insets over the panes share: the wheel and drags over them are theirs, and a cross closes them.

use eframe::egui::{self, Rect, Response, Role, Sense, Vec2};
use glam::DVec2;

use super::pane;
use crate::mesh::VertexId;
use crate::ui::{Control, Request, close_button};

/// How much nearer and farther the wheel brings an inset.
const REACH: std::ops::RangeInclusive<f64> = 0.1..=1e4;

/// How much nearer a point of a trackpad's two fingers brings it.
const PER_POINT: f64 = 1.004;

/// How a person has moved what the insets show: nearer by the wheel, sideways by a drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::ui) struct Sight {
    /// The defect that it was brought nearer for, by its place in the list; none for pairs.
    of: Option<usize>,
    factor: f64,
    /// The last drag of each kind of inset.
    panned: [Option<(About, DVec2)>; 3],
}

impl Default for Sight {
    fn default() -> Self {
        Self { of: None, factor: 1.0, panned: [None; 3] }
    }
}

impl Sight {
    /// Whether a person has moved what an inset shows.
    pub(super) fn is_set(&self, kind: Kind, about: About) -> bool {
        (self.factor(about.defect()) - 1.0).abs() > f64::EPSILON || self.panned(kind, about) != DVec2::ZERO
    }

    /// How much nearer the inset of a defect shows, or that of a pair. Another defect begins anew.
    pub(super) fn factor(&self, of: Option<usize>) -> f64 {
        if self.of == of { self.factor } else { 1.0 }
    }

    /// How far what an inset shows was dragged, points. Another thing begins anew.
    pub(super) fn panned(&self, kind: Kind, about: About) -> DVec2 {
        self.panned[kind as usize].filter(|(of, _)| *of == about).map_or(DVec2::ZERO, |(_, by)| by)
    }

    pub(in crate::ui) fn bring_nearer(&mut self, of: Option<usize>, by: f64) {
        let before = self.factor(of);
        let factor = (before * by).clamp(*REACH.start(), *REACH.end());
        (self.of, self.factor) = (of, factor);
        // What lies in the middle stays there.
        for (_, panned) in self.panned.iter_mut().flatten().filter(|(about, _)| about.defect() == of) {
            *panned *= factor / before;
        }
    }

    pub(in crate::ui) fn pan(&mut self, InsetPan { kind, about, by }: InsetPan) {
        self.panned[kind as usize] = Some((about, self.panned(kind, about) + by));
    }
}

/// What an inset is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) enum About {
    /// A defect, by its place in the list.
    Defect(usize),
    /// A pair, by its vertex where it has one yet.
    Pair(Option<VertexId>),
}

impl About {
    const fn defect(self) -> Option<usize> {
        match self {
            Self::Defect(place) => Some(place),
            Self::Pair(_) => None,
        }
    }
}

/// A drag over an inset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InsetPan {
    kind: Kind,
    about: About,
    /// Points of the screen.
    by: DVec2,
}

/// The insets that there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::ui) enum Kind {
    /// A defect in the plane.
    Defect,
    /// The vertex of a pair, on the mesh.
    PairOnMesh,
    /// The target of a pair, in the plane.
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
    pub(super) about: About,
}

impl Inset<'_> {
    /// Takes clicks, drags and the wheel, which what lies under it must not get, and shows the cross. The wheel brings what
    /// it shows nearer, a drag pans it.
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
