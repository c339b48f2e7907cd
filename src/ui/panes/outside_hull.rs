//! Marks of vertices outside the hull of their neighbours, in both panes, if enabled.

use eframe::egui::{self, Pos2, Stroke, Vec2};

use crate::ui::{Editor, Theme};
use freebound_core::mesh::VertexId;

/// Greatest number of marks of one kind. The list in the panel is complete.
pub(super) const MARKS_SHOWN: usize = 500;

/// Distance from the middle of a mark to its corners, points.
const REACH: f32 = 6.0;

/// Marked vertices; none during a transition or a drag preview.
pub(super) fn marked(editor: &Editor) -> impl Iterator<Item = VertexId> + '_ {
    let is_wanted = editor.selection.marks_outside_hull && editor.plane.verdict().is_some() && !editor.shows_preview();
    editor.outside_hull().iter().copied().filter(move |_| is_wanted).take(MARKS_SHOWN)
}

/// Mark of a vertex outside the hull: a diamond.
pub(super) fn mark(painter: &egui::Painter, at: Pos2, theme: &Theme) {
    let corners = [(REACH, 0.0), (0.0, REACH), (-REACH, 0.0), (0.0, -REACH)].map(|(x, y)| at + Vec2::new(x, y));
    painter.add(egui::Shape::closed_line(corners.to_vec(), Stroke::new(2.0, theme.outside_hull)));
}
