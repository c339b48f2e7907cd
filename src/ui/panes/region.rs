//! Region that is drawn in a pane to select what lies in it: a box with Ctrl, a lasso with Ctrl and Alt.

use eframe::egui::{self, Pos2, Rect, Response, Shape, Stroke};
use glam::DVec2;

use crate::ui::{Editor, Pane, theme_of};
use freebound_core::geom::{Bounds, winding_number};

/// Least distance between two points of a lasso, points.
const LASSO_STEP: f32 = 3.0;

/// Region of a pane, in window points.
pub(super) enum Region {
    /// Box.
    Box(Rect),
    /// Inside of a closed curve, with the box around the curve.
    Lasso(Vec<DVec2>, Bounds),
}

impl Region {
    /// True if a point of the window lies in the region.
    pub(super) fn contains(&self, at: Pos2) -> bool {
        match self {
            Self::Box(rect) => rect.contains(at),
            Self::Lasso(curve, bounds) => {
                let at = in_plane(at);
                // Most points lie outside the box, and the curve is long.
                bounds.contains(at) && winding_number(curve, at).is_some_and(|turns| turns != 0)
            }
        }
    }
}

fn in_plane(at: Pos2) -> DVec2 {
    DVec2::new(f64::from(at.x), f64::from(at.y))
}

/// Follows a region while it is drawn. Returns it at the end of the drag.
pub(super) fn draw_region(ui: &egui::Ui, response: &Response, editor: &mut Editor, pane: Pane) -> Option<Region> {
    let modifiers = ui.input(|input| input.modifiers);
    if response.drag_started_by(egui::PointerButton::Primary) && modifiers.command {
        // Start at the position of the press, not at the later position of egui's drag detection.
        let origin = ui.input(|input| input.pointer.press_origin()).or(response.interact_pointer_pos());
        editor.pointer.begin_region(pane, origin, modifiers.alt);
    }
    let at = ui.input(|input| input.pointer.latest_pos())?;
    let drawn = editor.pointer.region_in(pane, at, LASSO_STEP)?;
    let (is_lasso, points) = (drawn.is_lasso, drawn.points.clone());
    let (first, last) = (*points.first()?, *points.last()?);
    if response.drag_stopped() {
        editor.pointer.end_region();
        return Some(if is_lasso {
            let curve: Vec<DVec2> = points.into_iter().map(in_plane).collect();
            let bounds = Bounds::of(curve.iter().copied());
            Region::Lasso(curve, bounds)
        } else {
            Region::Box(Rect::from_two_pos(first, last))
        });
    }
    let theme = theme_of(ui);
    let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("selection region"));
    let painter = ui.ctx().layer_painter(layer).with_clip_rect(response.rect);
    let stroke = Stroke::new(1.0, theme.selection);
    if is_lasso {
        painter.add(Shape::closed_line(points, stroke));
    } else {
        let chosen = Rect::from_two_pos(first, last);
        painter.rect_filled(chosen, 0.0, theme.selection.gamma_multiply(0.12));
        painter.rect_stroke(chosen, 0.0, stroke, egui::StrokeKind::Inside);
    }
    None
}
