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

/// Ends of the two boundary edges of each crossing that is marked.
pub(super) fn crossings(editor: &Editor, scene: &MeshScene) -> Vec<[[VertexId; 2]; 2]> {
    let (Some(plane), Some(disk)) = (editor.plane_scene(), scene.model.disk()) else { return Vec::new() };
    let pairs = plane.outcome.step.verdict.boundary_crossings.iter().take(MARKS_SHOWN);
    pairs.map(|edges| edges.map(|edge| disk.ends(edge))).collect()
}

/// Where two segments of the screen cross; the middle of the first where they are parallel.
pub(super) fn crossing_point([a, b]: [Pos2; 2], [c, d]: [Pos2; 2]) -> Pos2 {
    let (along, across, between) = (b - a, d - c, c - a);
    let cross = |u: egui::Vec2, w: egui::Vec2| u.x * w.y - u.y * w.x;
    let share = cross(between, across) / cross(along, across);
    a + along * if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 }
}

/// The overwound vertices that are marked.
pub(super) fn overwound(editor: &Editor) -> Vec<VertexId> {
    let all = editor.plane_scene().map(|plane| &plane.outcome.step.verdict.overwound_vertices);
    all.map(|all| all.iter().copied().take(MARKS_SHOWN).collect()).unwrap_or_default()
}

/// A ring with a dot.
pub(super) fn overwound_mark(painter: &egui::Painter, at: Pos2, theme: &Theme) {
    painter.circle_stroke(at, 7.0, Stroke::new(2.0, theme.overwound));
    painter.circle_filled(at, 2.5, theme.overwound);
}
