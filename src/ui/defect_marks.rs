//! Marks of defects over both panes: crossings orange, overwound vertices magenta. Flipped faces are drawn with the
//! faces.

use eframe::egui;
use egui::{Pos2, Stroke};

use super::Editor;
use super::scene::MeshScene;
use super::theme::Theme;
use crate::mesh::VertexId;

/// Crossings and overwound vertices marked at most; the list in the panel has them all.
const MARKS_SHOWN: usize = 500;

/// Calls `draw` with the ends of each boundary edge that crosses another.
pub(super) fn crossings(editor: &Editor, scene: &MeshScene, mut draw: impl FnMut([VertexId; 2])) {
    let (Some(plane), Some(disk)) = (editor.plane_scene(), scene.model.disk()) else { return };
    for edge in plane.outcome.verdict.boundary_crossings.iter().take(MARKS_SHOWN).flatten() {
        draw(disk.ends(*edge));
    }
}

/// The overwound vertices that are marked.
pub(super) fn overwound(editor: &Editor) -> Vec<VertexId> {
    let all = editor.plane_scene().map(|plane| &plane.outcome.verdict.overwound_vertices);
    all.map(|all| all.iter().copied().take(MARKS_SHOWN).collect()).unwrap_or_default()
}

/// A ring with a dot.
pub(super) fn overwound_mark(painter: &egui::Painter, at: Pos2, theme: &Theme) {
    painter.circle_stroke(at, 7.0, Stroke::new(2.0, theme.overwound));
    painter.circle_filled(at, 2.5, theme.overwound);
}
