//! Common parts of both panes: positions on the screen, clicks and boxes, the wheel, and marks of defects. Crossings
//! are orange, overwound vertices magenta, concave polygons olive. Flipped faces are drawn with the faces.

use eframe::egui::{self, Color32, CursorIcon, FontId, Pos2, Rect, Response, Role, Sense, Stroke, Vec2};
use glam::DVec2;

use super::elements;
use super::outside_hull::{self, MARKS_SHOWN};
use super::seam;
use crate::session::Action;
use crate::ui::editor::scene::{MeshScene, PlaneScene};
use crate::ui::round_joins::closed_line;
use crate::ui::state::Viewport;
use crate::ui::{Control, Editor, Request, Theme, Tool, theme_of};
use crate::view::{ElementKind, PlaneCamera};
use freebound_core::geom::{Bounds, clip_segment};
use freebound_core::mesh::VertexId;

/// Text in the middle of an empty pane.
pub(super) fn empty_state(ui: &egui::Ui, rect: Rect, lines: &[&str]) {
    let theme = theme_of(ui);
    let width = (rect.width() - 32.0).max(40.0);
    let styles = std::iter::once((15.0, theme.text)).chain(std::iter::repeat((13.0, theme.weak_text)));
    let galley = |(line, (size, colour)): (&&str, (f32, Color32))| {
        let mut job = egui::text::LayoutJob::simple((*line).to_owned(), FontId::proportional(size), colour, width);
        job.halign = egui::Align::Center;
        ui.painter().layout_job(job)
    };
    let galleys: Vec<_> = lines.iter().zip(styles).map(galley).collect();
    let height: f32 = galleys.iter().map(|galley| galley.size().y + 6.0).sum();
    let mut at = rect.center() - Vec2::new(0.0, height / 2.0);
    for galley in galleys {
        let step = galley.size().y + 6.0;
        ui.painter_at(rect).galley(at, galley, theme.text);
        at.y += step;
    }
}

/// Short text in the middle of a part of a pane.
pub(super) fn small_state(ui: &egui::Ui, rect: Rect, words: &str) {
    let theme = theme_of(ui);
    let width = (rect.width() - 16.0).max(40.0);
    let mut job = egui::text::LayoutJob::simple(words.to_owned(), FontId::proportional(12.0), theme.weak_text, width);
    job.halign = egui::Align::Center;
    let galley = ui.painter().layout_job(job);
    let at = rect.center() - Vec2::new(0.0, galley.size().y / 2.0);
    ui.painter_at(rect).galley(at, galley, theme.weak_text);
}

/// Line of the seam under the pointer.
pub(super) fn seam_stroke(theme: &Theme) -> Stroke {
    Stroke::new(3.5, theme.selection)
}

/// Ring around a vertex.
pub(super) fn halo(painter: &egui::Painter, at: Pos2, colour: Color32, radius: f32) {
    painter.circle_stroke(at, radius + 1.5, Stroke::new(1.5, Color32::from_black_alpha(90)));
    painter.circle_stroke(at, radius, Stroke::new(2.0, colour));
}

/// Small dot on a selected vertex. It hides little of what lies below.
pub(super) fn dot(painter: &egui::Painter, at: Pos2, colour: Color32) {
    painter.circle(at, 3.0, colour, Stroke::new(1.0, Color32::from_black_alpha(150)));
}

/// Draws a dashed line. Only its part inside the painter's clip rectangle gets dashes, because a line of a magnified view
/// can be millions of points long.
pub(super) fn dashed(painter: &egui::Painter, ends: [Pos2; 2], stroke: Stroke, [dash, gap]: [f32; 2]) {
    let seen = painter.clip_rect().expand(stroke.width);
    painter.extend(within(seen, ends).into_iter().flat_map(|part| egui::Shape::dashed_line(&part, stroke, dash, gap)));
}

/// Part of a line inside a rectangle.
fn within(rect: Rect, ends: [Pos2; 2]) -> Option<[Pos2; 2]> {
    if !ends.iter().all(|end| end.is_finite()) {
        return None;
    }
    let point = |at: Pos2| DVec2::new(at.x.into(), at.y.into());
    let part = clip_segment(ends.map(point), Bounds { low: point(rect.min), high: point(rect.max) })?;
    #[expect(clippy::cast_possible_truncation, reason = "points of the screen are f32")]
    Some(part.map(|at| Pos2::new(at.x as f32, at.y as f32)))
}

/// Handles a click with the active tool, and sets the cursor for it.
pub(super) fn click(ui: &egui::Ui, response: &Response, editor: &mut Editor, requests: &mut Vec<Request>) {
    if editor.kind_under_pointer().is_some_and(|kind| kind != ElementKind::Vertices) {
        return elements::click(ui, response, editor, requests);
    }
    if response.clicked() {
        requests.extend(clicked(ui, editor));
    }
    if response.hovered() {
        ui.ctx().set_cursor_icon(match (editor.tools.tool(), editor.pointer.vertex()) {
            (Tool::Constrain | Tool::Seam | Tool::Brush, _) | (Tool::Fix, Some(_)) => CursorIcon::Crosshair,
            (_, None) => CursorIcon::Default,
            (Tool::Select, Some(_)) => CursorIcon::PointingHand,
        });
    }
}

fn clicked(ui: &egui::Ui, editor: &mut Editor) -> Vec<Request> {
    match editor.tools.tool() {
        Tool::Constrain => return editor.constrain(),
        Tool::Seam => return seam::clicked(ui, editor),
        // A click of a brush is a stroke.
        Tool::Brush => return Vec::new(),
        Tool::Select | Tool::Fix => {}
    }
    let Some(vertex) = editor.pointer.vertex() else { return vec![Request::Select(Vec::new())] };
    let adds = ui.input(|input| input.modifiers.shift);
    let select = if adds { Request::AddToSelection(vec![vertex]) } else { Request::Select(vec![vertex]) };
    if editor.tools.tool() == Tool::Fix && !editor.is_new_vertex(vertex) {
        vec![Request::Do(Action::Fix(vec![vertex])), select]
    } else {
        vec![select]
    }
}

/// Drawing surface of a pane, with its name for screen readers.
pub(super) fn surface(ui: &mut egui::Ui, name: &str) -> (Rect, Response) {
    let size = ui.available_size().max(Vec2::splat(16.0));
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    (rect, response.named(Role::Image, name))
}

/// Input of wheel and trackpad over a pane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WheelMove {
    /// Zoom factor; above 1 enlarges.
    pub(super) zoom: f64,
    /// Displacement of the pan, points.
    pub(super) pan: DVec2,
}

/// Zoom factor per notch of the wheel.
const ZOOM_PER_NOTCH: f64 = 1.15;

/// Reads the wheel: notches zoom, two fingers on a trackpad pan, a pinch zooms.
pub(super) fn wheel(ui: &egui::Ui) -> WheelMove {
    ui.input(|input| {
        let mut moved = WheelMove { zoom: f64::from(input.zoom_delta()), pan: DVec2::ZERO };
        for event in &input.events {
            let egui::Event::MouseWheel { unit, delta, modifiers, .. } = event else { continue };
            if modifiers.command {
                continue;
            }
            match unit {
                egui::MouseWheelUnit::Point => moved.pan += DVec2::new(delta.x.into(), delta.y.into()),
                _ => moved.zoom *= ZOOM_PER_NOTCH.powf(delta.y.into()),
            }
        }
        moved
    })
}

/// Ends of the two boundary edges of each marked crossing.
pub(super) fn crossings(editor: &Editor, scene: &MeshScene) -> Vec<[[VertexId; 2]; 2]> {
    let (Some(verdict), Some(disk)) = (editor.plane.verdict(), scene.disk()) else { return Vec::new() };
    let pairs = verdict.boundary_crossings.iter().take(MARKS_SHOWN);
    pairs.map(|edges| edges.map(|edge| disk.ends(edge))).collect()
}

/// Crossing point of two segments; the middle of the first if they are parallel.
pub(super) fn crossing_point([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> DVec2 {
    let (along, across) = (b - a, d - c);
    let share = (c - a).perp_dot(across) / along.perp_dot(across);
    a + along * if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 }
}

/// Marks of all defects of the embedding, and of vertices outside the hull of their neighbours.
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
    let spots = |vertices: Vec<VertexId>| -> Vec<Pos2> { vertices.into_iter().map(|v| view.spot(at(v))).collect() };
    for outline in concave(editor, &plane.mesh) {
        concave_mark(painter, &spots(outline), theme);
    }
    for rim in crossed_holes(editor, &plane.mesh) {
        crossed_hole_mark(painter, &spots(rim), theme);
    }
    for vertex in overwound(editor) {
        overwound_mark(painter, view.spot(at(vertex)), theme);
    }
    for vertex in outside_hull::marked(editor) {
        outside_hull::mark(painter, view.spot(at(vertex)), theme);
    }
}

/// Outlines of the marked concave polygons.
pub(super) fn concave(editor: &Editor, scene: &MeshScene) -> Vec<Vec<VertexId>> {
    let (Some(verdict), Some(disk)) = (editor.plane.verdict(), scene.disk()) else { return Vec::new() };
    let polygons = verdict.concave_polygons.iter().take(MARKS_SHOWN).filter_map(|&face| disk.polygon_of(face));
    polygons.map(|polygon| polygon.corners.to_vec()).collect()
}

/// Rims of the marked crossed holes.
pub(super) fn crossed_holes(editor: &Editor, scene: &MeshScene) -> Vec<Vec<VertexId>> {
    let Some(crossed) = editor.plane.verdict().map(|verdict| &verdict.crossed_holes) else { return Vec::new() };
    crossed.iter().take(MARKS_SHOWN).map(|&lowest| scene.hole_rim(lowest)).collect()
}

/// Mark of a crossed hole: a heavy outline.
pub(super) fn crossed_hole_mark(painter: &egui::Painter, rim: &[Pos2], theme: &Theme) {
    closed_line(painter, rim, Stroke::new(3.0, theme.crossing));
}

/// Mark of a concave polygon: a heavy outline.
pub(super) fn concave_mark(painter: &egui::Painter, outline: &[Pos2], theme: &Theme) {
    closed_line(painter, outline, Stroke::new(3.0, theme.concave));
}

/// Marked overwound vertices.
pub(super) fn overwound(editor: &Editor) -> Vec<VertexId> {
    let all = editor.plane.verdict().into_iter().flat_map(|verdict| &verdict.overwound_vertices);
    all.copied().take(MARKS_SHOWN).collect()
}

/// Mark of an overwound vertex: a ring with a dot.
pub(super) fn overwound_mark(painter: &egui::Painter, at: Pos2, theme: &Theme) {
    painter.circle_stroke(at, 7.0, Stroke::new(2.0, theme.overwound));
    painter.circle_filled(at, 2.5, theme.overwound);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_dashed_in_its_visible_part_alone() {
        let rect = Rect::from_min_max(Pos2::ZERO, Pos2::new(10.0, 20.0));
        let part = |a: [f32; 2], b: [f32; 2]| within(rect, [a.into(), b.into()]);
        let inside = [Pos2::new(2.0, 3.0), Pos2::new(4.0, 5.0)];
        assert_eq!(within(rect, inside), Some(inside));
        assert_eq!(part([-1e6, 5.0], [1e6, 5.0]), Some([Pos2::new(0.0, 5.0), Pos2::new(10.0, 5.0)]));
        assert_eq!(part([3.0, 40.0], [3.0, -20.0]), Some([Pos2::new(3.0, 20.0), Pos2::new(3.0, 0.0)]));
        assert_eq!(part([-5.0, 25.0], [-4.0, 26.0]), None);
        assert_eq!(part([11.0, 0.0], [11.0, 20.0]), None);
        assert_eq!(part([f32::NAN, 0.0], [3.0, 3.0]), None);
        let context = egui::Context::default();
        let painter = egui::Painter::new(context, egui::LayerId::background(), rect);
        let far = [Pos2::new(-1e7, 5.0), Pos2::new(1e7, 5.0)];
        dashed(&painter, far, Stroke::new(1.0, Color32::WHITE), [4.0, 3.0]);
        let mut drawn = 0;
        painter.for_each_shape(|_| drawn += 1);
        assert!((1..=4).contains(&drawn), "{drawn}");
    }
}
