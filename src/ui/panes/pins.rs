//! Pins in both panes: their kinds and marks.

use std::collections::BTreeMap;

use eframe::egui::{self, Color32, Painter, Pos2, Rect, Shape, Stroke, Vec2};
use glam::DVec2;

use crate::ui::{Editor, Theme};
use freebound_core::mesh::VertexId;
use freebound_core::problem::PinKind;

/// Side of the square of a fixed pin or gauge pin, points.
const SQUARE: f32 = 9.0;

/// Half the height of the diamond of a hard pin, points.
const DIAMOND: f32 = 6.5;

/// Half the heights of the smallest and the largest diamond of a soft pin, points.
const DIAMONDS: [f32; 2] = [4.0, 9.0];

/// Weights of the smallest and the largest diamond.
const WEIGHTS: [f64; 2] = [1e-2, 1e2];

/// Increase in size of a strong mark, points.
const STRONG: f32 = 2.0;

/// Least length of an arrow or line, points. A shorter one would only hide its ends.
const LEAST_LINE: f32 = 3.0;

/// Size of the name of a pin under the pointer, points.
const NAME_SIZE: f32 = 12.0;

/// Position of the name of a pin relative to its mark, points.
const NAME_OFFSET: Vec2 = Vec2::new(12.0, -24.0);

/// Kind of a pin, for its mark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PinMark {
    /// Gauge pin, chosen by the solver.
    Gauge,
    /// Pin of the user, with its kind.
    User(PinKind),
}

impl PinMark {
    /// Name of the pin of the vertex with this number in files, for screen readers.
    pub fn name(self, number: VertexId) -> String {
        match self {
            Self::Gauge => format!("Gauge pin {number}"),
            Self::User(PinKind::Fixed) => format!("Pin {number}"),
            Self::User(PinKind::Hard | PinKind::Soft(_)) => format!("Constraint {number}"),
        }
    }

    /// Draws the mark. Fixed pins are squares, hollow for gauge pins. Constraints are diamonds, hollow for soft pins,
    /// whose size grows with the weight.
    pub(in crate::ui) fn mark(self, painter: &Painter, at: Pos2, theme: &Theme, emphasis: Emphasis) {
        let more = if emphasis == Emphasis::Strong { STRONG } else { 0.0 };
        match self {
            Self::Gauge => {
                let square = Rect::from_center_size(at, Vec2::splat(SQUARE + more));
                painter.rect_filled(square, 1.0, theme.background.gamma_multiply(0.7));
                let edge = Stroke::new(if more > 0.0 { 2.5 } else { 1.5 }, theme.pin);
                painter.rect_stroke(square, 1.0, edge, egui::StrokeKind::Inside);
            }
            Self::User(PinKind::Fixed) => {
                let square = Rect::from_center_size(at, Vec2::splat(SQUARE + more));
                painter.rect_filled(square, 1.0, theme.pin);
                painter.rect_stroke(square, 1.0, Stroke::new(1.0, Color32::WHITE), egui::StrokeKind::Outside);
            }
            Self::User(PinKind::Hard) => {
                let edge = Stroke::new(1.0, Color32::WHITE);
                painter.add(Shape::convex_polygon(diamond(at, DIAMOND + more), theme.constraint, edge));
            }
            Self::User(PinKind::Soft(weight)) => {
                let corners = diamond(at, half_height(weight) + more);
                let under = Stroke::new(4.0, theme.background.gamma_multiply(0.8));
                painter.add(Shape::closed_line(corners.clone(), under));
                let fill = theme.background.gamma_multiply(0.35);
                painter.add(Shape::convex_polygon(corners, fill, Stroke::new(2.0, theme.constraint)));
            }
        }
    }
}

/// Pin with its target in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinShown {
    pub vertex: VertexId,
    /// Target, in the plane.
    pub target: DVec2,
    pub kind: PinMark,
}

impl Editor {
    /// Drawn pins: first those of the user, then the gauge pins that the solver chose.
    pub fn pins_shown(&self) -> Vec<PinShown> {
        let document = self.session.document();
        let uses_pins = document.settings.method.uses_pins();
        // Marks show the kinds that the solver uses: a treatment may make hard pins soft.
        let users = if uses_pins { document.settings.held(&document.pins()) } else { BTreeMap::new() };
        let outcome = self.plane.scene().map(|scene| &scene.outcome).filter(|outcome| {
            outcome.step.candidate.solution.gauge_completed
                && outcome.problem.settings.method.uses_pins()
                && users.len() < 2
        });
        let gauge = outcome.into_iter().flat_map(|outcome| &outcome.step.candidate.solution.pins);
        // Gauge pins follow a transition.
        let way = self.plane.result().filter(|_| self.plane.is_easing());
        let place = |vertex, at| way.and_then(|way| way.position_of(vertex)).unwrap_or(at);
        let gauge = gauge.filter(|(vertex, _)| !users.contains_key(vertex)).map(|(&vertex, pin)| PinShown {
            vertex,
            target: place(vertex, pin.target),
            kind: PinMark::Gauge,
        });
        let own =
            users.iter().map(|(&vertex, pin)| PinShown { vertex, target: pin.target, kind: PinMark::User(pin.kind) });
        own.chain(gauge).collect()
    }

    /// Hard pins that miss their targets in the planar embedding on the screen, ascending.
    pub fn unmet_shown(&self) -> Vec<VertexId> {
        let outcome = self.plane.scene().map(|scene| &scene.outcome);
        let planar = outcome
            .filter(|outcome| outcome.step.verdict.planar && !self.plane.shows_preview() && !self.plane.is_easing());
        planar.map(|outcome| outcome.step.unmet()).unwrap_or_default()
    }

    /// Selected vertices of the chart on the screen that the user has pinned; none on the page.
    pub fn pins_selected(&self) -> impl Iterator<Item = VertexId> + '_ {
        let targets = Some(&self.session.document().targets).filter(|_| !self.shows_page());
        let is_pin = move |vertex: &VertexId| targets.is_some_and(|targets| targets.contains_key(vertex));
        self.selection.vertices().iter().copied().filter(is_pin)
    }
}

/// Emphasis of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) enum Emphasis {
    Plain,
    /// Selected, or under the pointer.
    Strong,
}

impl Emphasis {
    pub(in crate::ui) fn strong_if(is_strong: bool) -> Self {
        if is_strong { Self::Strong } else { Self::Plain }
    }
}

/// Ring around the vertex of a pin that misses its target.
pub(super) fn unmet_mark(painter: &Painter, at: Pos2, theme: &Theme) {
    painter.circle_stroke(at, DIAMOND + 4.0, Stroke::new(2.0, theme.unmet));
}

/// Name of the pin under the pointer, beside its mark.
pub(super) fn name_beside(painter: &Painter, at: Pos2, theme: &Theme, editor: &Editor) {
    let Some(name) = editor.pointer.vertex().and_then(|vertex| editor.session.pin_name(vertex)) else { return };
    let text = painter.layout_no_wrap(name.to_string(), egui::FontId::proportional(NAME_SIZE), theme.text);
    let mut place = Rect::from_min_size(at + NAME_OFFSET, text.size()).expand2(Vec2::new(4.0, 2.0));
    let pane = painter.clip_rect();
    if place.right() > pane.right() {
        place = place.translate(Vec2::new(at.x - NAME_OFFSET.x - place.right(), 0.0));
    }
    if place.top() < pane.top() {
        place = place.translate(Vec2::new(0.0, at.y - NAME_OFFSET.y - place.bottom()));
    }
    painter.rect_filled(place, 3.0, theme.panel.gamma_multiply(0.92));
    painter.galley(place.min + Vec2::new(4.0, 2.0), text, theme.text);
}

/// Thin ring around a pin that conflicts with others on the given mesh.
pub(super) fn conflict_mark(painter: &Painter, at: Pos2, theme: &Theme) {
    painter.circle_stroke(at, DIAMOND + 3.0, Stroke::new(1.25, theme.stale));
}

/// Preview of a constraint that a click would place: a translucent diamond.
pub(in crate::ui) fn ghost(painter: &Painter, at: Pos2, theme: &Theme) {
    let colour = theme.constraint.gamma_multiply(0.7);
    let edge = Stroke::new(1.5, colour);
    painter.add(Shape::convex_polygon(diamond(at, DIAMOND + STRONG), colour.gamma_multiply(0.3), edge));
}

/// Half the height of the diamond of a weight.
fn half_height(weight: f64) -> f32 {
    let [least, most] = WEIGHTS.map(f64::log10);
    let share = ((weight.log10() - least) / (most - least)).clamp(0.0, 1.0);
    #[expect(clippy::cast_possible_truncation, reason = "a share of a few points")]
    let share = share as f32;
    egui::lerp(DIAMONDS[0]..=DIAMONDS[1], share)
}

fn diamond(at: Pos2, half: f32) -> Vec<Pos2> {
    [(0.0, -half), (half, 0.0), (0.0, half), (-half, 0.0)].map(|(x, y)| at + Vec2::new(x, y)).to_vec()
}

/// Line from a vertex to its target if they differ; an arrow for a soft pin.
pub(in crate::ui) fn residual(painter: &Painter, [vertex, target]: [Pos2; 2], theme: &Theme, kind: PinMark) {
    let way = target - vertex;
    if !(LEAST_LINE..1e5).contains(&way.length()) {
        return;
    }
    let colour =
        if matches!(kind, PinMark::User(PinKind::Fixed) | PinMark::Gauge) { theme.pin } else { theme.constraint };
    let stroke = Stroke::new(1.5, colour.gamma_multiply(0.75));
    painter.circle_filled(vertex, 2.5, colour);
    painter.line_segment([vertex, target], stroke);
    if matches!(kind, PinMark::User(PinKind::Soft(_))) {
        let along = way.normalized();
        let wing = |turn: f32| target + (egui::emath::Rot2::from_angle(turn) * along) * -8.0;
        painter.line_segment([target, wing(0.45)], stroke);
        painter.line_segment([target, wing(-0.45)], stroke);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_larger_weight_has_a_larger_diamond() {
        let sizes = [1e-9, 1e-2, 0.1, 1.0, 10.0, 1e2, 1e9].map(half_height);
        assert!(sizes.is_sorted(), "{sizes:?}");
        assert!(sizes[1] < sizes[3] && sizes[3] < sizes[5], "{sizes:?}");
        assert!((DIAMONDS[0]..=DIAMONDS[1]).contains(&sizes[0]) && (DIAMONDS[0]..=DIAMONDS[1]).contains(&sizes[6]));
    }
}
