//! Marks of defects over both panes: crossings orange, overwound vertices magenta. Flipped faces are drawn with the
//! faces.

use eframe::egui::{self, Pos2, Stroke};
use glam::DVec2;

use super::pane::Viewport;
use crate::mesh::VertexId;
use crate::ui::editor::scene::{MeshScene, PlaneScene};
use crate::ui::{Editor, Theme, theme_of};
use crate::view::PlaneCamera;

/// Crossings and overwound vertices marked at most; the list in the panel has them all.
const MARKS_SHOWN: usize = 500;

/// Ends of the two boundary edges of each crossing that is marked.
pub(super) fn crossings(editor: &Editor, scene: &MeshScene) -> Vec<[[VertexId; 2]; 2]> {
    let (Some(verdict), Some(disk)) = (editor.plane.verdict(), scene.disk()) else { return Vec::new() };
    let pairs = verdict.boundary_crossings.iter().take(MARKS_SHOWN);
    pairs.map(|edges| edges.map(|edge| disk.ends(edge))).collect()
}

/// Where two segments cross; the middle of the first where they are parallel.
pub(super) fn crossing_point([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> DVec2 {
    let (along, across) = (b - a, d - c);
    let share = (c - a).perp_dot(across) / along.perp_dot(across);
    a + along * if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 }
}

/// Crossings and overwound vertices of the embedding.
pub(super) fn plane_marks(ui: &egui::Ui, view: Viewport<PlaneCamera>, editor: &Editor, plane: &PlaneScene) {
    let (painter, theme) = (&ui.painter_at(view.rect), theme_of(ui));
    let at = |vertex: VertexId| plane.position_of(vertex).unwrap_or(DVec2::NAN);
    for pair in crossings(editor, &plane.mesh) {
        let [first, second] = pair.map(|edge| edge.map(at));
        for edge in [first, second] {
            painter.line_segment(edge.map(|z| view.spot(z)), Stroke::new(3.0, theme.crossing));
        }
        painter.circle_stroke(view.spot(crossing_point(first, second)), 7.0, Stroke::new(1.5, theme.crossing));
    }
    for vertex in overwound(editor) {
        overwound_mark(painter, view.spot(at(vertex)), theme);
    }
}

/// The overwound vertices that are marked.
pub(super) fn overwound(editor: &Editor) -> Vec<VertexId> {
    let all = editor.plane.verdict().into_iter().flat_map(|verdict| &verdict.overwound_vertices);
    all.copied().take(MARKS_SHOWN).collect()
}

/// A ring with a dot.
pub(super) fn overwound_mark(painter: &egui::Painter, at: Pos2, theme: &Theme) {
    painter.circle_stroke(at, 7.0, Stroke::new(2.0, theme.overwound));
    painter.circle_filled(at, 2.5, theme.overwound);
}
