//! Region that is drawn in a pane to select what lies in it: a box with Ctrl, a lasso with Ctrl and Alt, a stroke with
//! Ctrl and Shift.

use eframe::egui::{self, Pos2, Rect, Response, Shape, Stroke};
use glam::DVec2;

use crate::ui::editor::RegionShape;
use crate::ui::{Editor, Pane, theme_of};
use crate::view::distance_to_segment;
use freebound_core::geom::{Bounds, winding_number};

/// Least distance between two points of a lasso or a stroke, points.
const STEP: f32 = 3.0;

/// Half the width of a stroke, points.
const STROKE_RADIUS: f32 = 14.0;

/// Region of a pane, in window points.
pub(super) enum Region {
    /// Box.
    Box(Rect),
    /// Inside of a closed curve, with the box around the curve.
    Lasso(Vec<DVec2>, Bounds),
    /// Surroundings of a line, with the box around them.
    Stroke(Vec<Pos2>, Rect),
}

impl Region {
    fn of(shape: RegionShape, points: Vec<Pos2>) -> Self {
        match shape {
            RegionShape::Box => Self::Box(Rect::from_points(&points)),
            RegionShape::Lasso => {
                let curve: Vec<DVec2> = points.into_iter().map(in_plane).collect();
                let bounds = Bounds::of(curve.iter().copied());
                Self::Lasso(curve, bounds)
            }
            RegionShape::Stroke => {
                let around = Rect::from_points(&points).expand(STROKE_RADIUS);
                Self::Stroke(points, around)
            }
        }
    }

    /// True if a point of the window lies in the region.
    pub(super) fn contains(&self, at: Pos2) -> bool {
        match self {
            Self::Box(rect) => rect.contains(at),
            Self::Lasso(curve, bounds) => {
                let at = in_plane(at);
                // Most points lie outside the box, and the curve is long.
                bounds.contains(at) && winding_number(curve, at).is_some_and(|turns| turns != 0)
            }
            Self::Stroke(points, around) => {
                around.contains(at) && distance_to_line(points, at) <= f64::from(STROKE_RADIUS)
            }
        }
    }

    /// Points along the line of a stroke, close to each other: it also selects what it crosses. Empty for other regions.
    pub(super) fn line(&self) -> Vec<Pos2> {
        let Self::Stroke(points, _) = self else { return Vec::new() };
        let along = |ends: &[Pos2]| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a number of points on a screen"
            )]
            let count = (ends[0].distance(ends[1]) / STEP).ceil().clamp(1.0, 1000.0) as u16;
            let [start, end] = [ends[0], ends[1]];
            (1..=count).map(move |step| start + (end - start) * (f32::from(step) / f32::from(count)))
        };
        points.first().copied().into_iter().chain(points.windows(2).flat_map(along)).collect()
    }
}

/// Point of the window as a point of the plane.
pub(super) fn in_plane(at: Pos2) -> DVec2 {
    DVec2::new(f64::from(at.x), f64::from(at.y))
}

/// Distance from a line through points, which may be a single one.
fn distance_to_line(points: &[Pos2], at: Pos2) -> f64 {
    let away = |ends: [Pos2; 2]| distance_to_segment(in_plane(at), ends.map(in_plane));
    let to_first = points.first().map_or(f64::INFINITY, |&first| away([first; 2]));
    points.windows(2).map(|ends| away([ends[0], ends[1]])).fold(to_first, f64::min)
}

/// Follows a region while it is drawn. Returns it at the end of the drag.
pub(super) fn draw_region(ui: &egui::Ui, response: &Response, editor: &mut Editor, pane: Pane) -> Option<Region> {
    let modifiers = ui.input(|input| input.modifiers);
    if response.drag_started_by(egui::PointerButton::Primary) && modifiers.command {
        // Start at the position of the press, not at the later position of egui's drag detection.
        let origin = ui.input(|input| input.pointer.press_origin()).or(response.interact_pointer_pos());
        let shape = match (modifiers.alt, modifiers.shift) {
            (true, _) => RegionShape::Lasso,
            (false, true) => RegionShape::Stroke,
            (false, false) => RegionShape::Box,
        };
        editor.pointer.begin_region(pane, origin, shape);
    }
    let at = ui.input(|input| input.pointer.latest_pos())?;
    let drawn = editor.pointer.region_in(pane, at, STEP)?;
    let (shape, points) = (drawn.shape, drawn.points.clone());
    if response.drag_stopped() {
        editor.pointer.end_region();
        return Some(Region::of(shape, points));
    }
    let theme = theme_of(ui);
    let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("selection region"));
    let painter = ui.ctx().layer_painter(layer).with_clip_rect(response.rect);
    let (stroke, tint) = (Stroke::new(1.0, theme.selection), theme.selection.gamma_multiply(0.12));
    match shape {
        RegionShape::Box => {
            let chosen = Rect::from_points(&points);
            painter.rect_filled(chosen, 0.0, tint);
            painter.rect_stroke(chosen, 0.0, stroke, egui::StrokeKind::Inside);
        }
        RegionShape::Lasso => drop(painter.add(Shape::closed_line(points, stroke))),
        RegionShape::Stroke => {
            painter.add(Shape::line(points, Stroke::new(2.0 * STROKE_RADIUS, theme.selection.gamma_multiply(0.25))));
            painter.circle_stroke(at, STROKE_RADIUS, stroke);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;

    #[test]
    fn a_stroke_holds_what_lies_within_half_its_width() {
        let corner = vec![pos2(0.0, 0.0), pos2(100.0, 0.0), pos2(100.0, 50.0)];
        let region = Region::of(RegionShape::Stroke, corner);
        for (at, is_in) in [
            (pos2(50.0, 13.0), true),
            (pos2(50.0, 15.0), false),
            (pos2(-13.0, 0.0), true),
            (pos2(-13.0, -13.0), false),
            (pos2(113.0, 40.0), true),
            (pos2(50.0, 40.0), false),
        ] {
            assert_eq!(region.contains(at), is_in, "{at:?}");
        }
        let dot = Region::of(RegionShape::Stroke, vec![pos2(5.0, 5.0)]);
        assert!(dot.contains(pos2(5.0, 18.0)) && !dot.contains(pos2(5.0, 20.0)));
    }
}
