//! A magnifier over the embedding: an inset that shows the first defect, or the one gone to, from near by, as in the
//! paper's figures 4 and 6. It draws from the buffers of the pane around it and so sends nothing of its own.

use std::sync::Arc;

use eframe::egui;
use egui::{Align2, CursorIcon, FontId, Pos2, Rect, Role, Sense, Stroke, StrokeKind, Vec2, WidgetInfo};
use glam::DVec2;

use super::{defect_marks, mesh_pane, pane};
use crate::render::{self, PaneId, PlaneFrame, Shading};
use crate::ui::editor::scene::{PlaneScene, vertices_of};
use crate::ui::theme::{Theme, theme_of};
use crate::ui::{Defect, Editor, Element, Request, keys_of};
use crate::view::{PlaneBox, PlaneCamera};

/// Share of the pane's lesser side that the inset takes.
const SHARE: f32 = 0.4;
/// Least and greatest side of the inset, points.
const SIDE: [f32; 2] = [110.0, 240.0];
/// Distance from the pane's edges, points.
const GAP: f32 = 12.0;
/// Height of the words above the picture, points.
const TITLE: f32 = 20.0;
/// An inset narrower than this only says how much larger it shows, points.
const ROOM_FOR_WORDS: f32 = 180.0;
/// Half of what the inset shows, in lengths of the defect.
const REACH: f64 = 0.7;
/// Least side of the frame on the layout, points: a mark to be found by.
const LEAST_FRAME: f32 = 7.0;

/// The inset of one frame: what it shows, where, and how much larger.
pub(in crate::ui) struct Magnifier {
    place: usize,
    defect: Defect,
    camera: PlaneCamera,
    pane: Rect,
    /// What is shown, on the screen.
    looks_at: Rect,
    /// Where it is shown, words included.
    pub(in crate::ui) rect: Rect,
    magnification: f64,
}

impl Magnifier {
    /// The inset over a pane, where it is wanted and there is a defect that it shows larger than the pane does.
    pub(in crate::ui) fn over(editor: &Editor, pane: Rect, scene: &PlaneScene) -> Option<Self> {
        if !editor.look.magnifier || scene.is_stage() || editor.plane.shows_preview() {
            return None;
        }
        let verdict = &scene.outcome.step.verdict;
        let chosen = editor.selection.defect().and_then(|place| Some((place, Defect::nth(verdict, place)?)));
        let (place, defect) = chosen.or_else(|| Some((0, Defect::nth(verdict, 0)?)))?;
        let side = (SHARE * pane.width().min(pane.height())).clamp(SIDE[0], SIDE[1]);
        if pane.width() < 2.0 * side || pane.height() < 2.0 * side {
            return None;
        }
        let shown = neighbourhood(scene, defect)?;
        let camera = PlaneCamera::framing(shown, DVec2::splat(side.into()));
        let around = editor.plane.camera()?;
        let extent = pane::size_of(pane);
        let corners = [shown.min, shown.max].map(|z| pane::on_screen(pane, around.pane_from_embedding(z, extent)));
        let looks_at = Rect::from_two_pos(corners[0], corners[1]);
        let magnification = camera.points_per_unit() / around.points_per_unit();
        let rect = place_for(pane, Vec2::new(side, side + TITLE), looks_at);
        (magnification > 1.0).then_some(Self { place, defect, camera, pane, looks_at, rect, magnification })
    }

    /// Draws the inset and the frame on the layout; a click goes there.
    pub(in crate::ui) fn show(
        &self,
        ui: &mut egui::Ui,
        editor: &Editor,
        plane: &PlaneScene,
        requests: &mut Vec<Request>,
    ) {
        let theme = theme_of(ui);
        self.mark_on_layout(&ui.painter_at(self.pane), theme);
        let painter = ui.painter_at(self.rect.expand(1.0));
        painter.rect_filled(self.rect, 4.0, theme.panel);
        let words = format!("× {}", self.factor());
        let title = self.rect.min + Vec2::new(8.0, TITLE / 2.0);
        painter.text(title, Align2::LEFT_CENTER, words, FontId::proportional(11.0), theme.text);
        if self.rect.width() >= ROOM_FOR_WORDS {
            let right = Pos2::new(self.rect.right() - 8.0, title.y);
            painter.text(right, Align2::RIGHT_CENTER, self.defect.words(), FontId::proportional(11.0), theme.weak_text);
        }
        let picture = Rect::from_min_max(self.rect.min + Vec2::new(0.0, TITLE), self.rect.max);
        if editor.host.has_gpu() {
            ui.painter().add(render::plane_pane(PaneId("magnifier"), picture, self.frame(editor, plane, theme)));
        }
        let size = pane::size_of(picture);
        let spot = |z: DVec2| pane::on_screen(picture, self.camera.pane_from_embedding(z, size));
        defect_marks::plane_marks(ui, picture, editor, plane, &spot);
        painter.rect_stroke(self.rect, 4.0, Stroke::new(1.0, theme.weak_text), StrokeKind::Inside);
        self.click(ui, requests);
    }

    fn click(&self, ui: &egui::Ui, requests: &mut Vec<Request>) {
        // Drags as well: a pin under the inset must not get them.
        let response = ui.interact(self.rect, ui.scope_id().with("magnifier"), Sense::click_and_drag());
        let name = format!("Magnifier: {}, × {}", self.defect.words(), self.factor());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
        let keys = keys_of(ui.ctx(), &Request::StepDefect(1));
        let tip = format!("A defect from near by. Click to go there; {keys} goes to the next");
        if response.on_hover_cursor(CursorIcon::PointingHand).on_hover_text(tip).clicked() {
            requests.push(Request::GoToDefect(self.place));
        }
    }

    /// A thin frame where the inset looks, and a line from there to the inset.
    fn mark_on_layout(&self, painter: &egui::Painter, theme: &Theme) {
        let least = Vec2::splat(LEAST_FRAME);
        let frame = Rect::from_center_size(self.looks_at.center(), self.looks_at.size().max(least));
        let under = Stroke::new(3.0, theme.background.gamma_multiply(0.7));
        let toward = self.rect.clamp(frame.center());
        let from = frame.expand(1.0).clamp(toward);
        if self.pane.intersects(frame) && !self.rect.intersects(frame) {
            painter.line_segment([from, toward], under);
            painter.line_segment([from, toward], Stroke::new(1.0, theme.text));
        }
        painter.rect_stroke(frame.expand(1.0), 1.0, under, StrokeKind::Middle);
        painter.rect_stroke(frame.expand(1.0), 1.0, Stroke::new(1.25, theme.text), StrokeKind::Middle);
    }

    fn frame(&self, editor: &Editor, plane: &PlaneScene, theme: &Theme) -> PlaneFrame {
        PlaneFrame {
            mesh: Arc::clone(&plane.mesh.arrays),
            plane: Some(Arc::clone(&plane.arrays)),
            paint: editor.look.paint().map(|paint| Arc::clone(&paint.faces)),
            fills: Vec::new(),
            lines: vec![mesh_pane::boundary_line(&plane.mesh, theme)],
            ghost: editor.plane.ghost_layer(theme),
            picture: None,
            outlined: editor.picture_box(),
            style: render::Style { shading: Shading::Plain, wire_in_points: 1.0, ..mesh_pane::style(editor) },
            palette: theme.palette,
            camera: self.camera,
        }
    }

    /// How much larger, in as many digits as mean something.
    fn factor(&self) -> String {
        match self.magnification {
            factor if factor < 9.95 => format!("{factor:.1}"),
            factor if factor < 1e6 => format!("{factor:.0}"),
            factor => format!("{factor:.0e}"),
        }
    }
}

/// The lower right corner of the pane, or the upper one where the inset would hide what it looks at.
fn place_for(pane: Rect, size: Vec2, looks_at: Rect) -> Rect {
    let lower = Rect::from_min_size(pane.max - size - Vec2::splat(GAP), size);
    if lower.expand(GAP).contains(looks_at.center()) {
        Rect::from_min_size(Pos2::new(lower.left(), pane.top() + GAP), size)
    } else {
        lower
    }
}

/// The part of the plane around a defect.
fn neighbourhood(plane: &PlaneScene, defect: Defect) -> Option<PlaneBox> {
    let disk = plane.mesh.disk()?;
    let at = |v: crate::mesh::VertexId| plane.positions().get(v.index()).copied();
    let (center, reach) = match defect {
        Defect::Crossing(edges) => {
            let [a, b] = edges.map(|edge| disk.ends(edge).map(|v| at(v).unwrap_or(DVec2::NAN)));
            let length = |[a, b]: [DVec2; 2]| a.distance(b);
            (defect_marks::crossing_point(a, b), length(a).min(length(b)))
        }
        Defect::Overwound(vertex) => {
            let link: Vec<DVec2> = disk.outgoing(vertex).filter_map(|h| at(disk.head(h))).collect();
            let bounds = PlaneBox::around(&link);
            (at(vertex)?, bounds.size().max_element())
        }
        Defect::Flipped(face) => {
            let corners: Vec<DVec2> =
                vertices_of(&plane.mesh, Element::Face(face)).into_iter().filter_map(at).collect();
            let bounds = PlaneBox::around(&corners);
            (bounds.center(), bounds.size().max_element())
        }
    };
    // A defect without any extent is shown as near as the camera goes.
    let half = (REACH * reach).max(plane.arrays.bounds().extent() * 1e-9);
    (center.is_finite() && half.is_finite()).then(|| PlaneBox { min: center - half, max: center + half })
}
