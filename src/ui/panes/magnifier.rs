//! Magnifiers: insets over the panes. An inset in the embedding pane magnifies the selected defect, or the first, as
//! in figures 4 and 6 of the paper. Two others show the halves of the current pair: the vertex on the mesh, and its
//! target on the picture. Insets draw from the buffers of the panes around them, and upload nothing.

use std::sync::Arc;

use eframe::egui::{self, Align2, CursorIcon, FontId, Pos2, Rect, Role, Stroke, StrokeKind, Vec2};
use glam::DVec2;

use super::inset::Inset;
use super::pane;
use super::pins::{self, Emphasis};
use super::{mesh_pane, plane_pane};
use crate::render::{self, FaceShading, PaneId, PlaneFrame};
use crate::ui::editor::scene::{MeshScene, PlaneScene};
use crate::ui::state::{InsetKind, InsetSubject, Viewport, size_of};
use crate::ui::{Control, Defect, Editor, Pane, Request, Theme, keys_of, theme_of};
use crate::view::{OrbitCamera, PlaneCamera, Sphere, bounds_of};
use freebound_core::geom::Bounds;
use freebound_core::mesh::VertexId;

/// Distance of insets from the pane's edges, points.
const GAP: f32 = 12.0;
/// Height of the title above the picture of a defect, points.
const TITLE: f32 = 20.0;
/// Half of the shown side, in lengths of the defect.
const REACH: f64 = 0.7;
/// Least side of the frame on the layout, points, so that it can be seen.
const LEAST_FRAME: f32 = 7.0;
/// Share of the mesh or layout that an inset of a pair shows.
const PART: f64 = 1.0 / 14.0;
/// Least magnification of an inset of a pair. A smaller one shows nothing new.
const LEAST_MAGNIFICATION: f64 = 1.5;

/// Size of an inset's picture in its pane.
struct Size {
    /// Share of the pane's shorter side.
    share: f32,
    /// Least and greatest side, points.
    side: [f32; 2],
    /// Least width of the pane, in sides of the inset. The least height is two sides.
    least_width: f32,
}

const DEFECT: Size = Size { share: 0.4, side: [110.0, 240.0], least_width: 2.0 };
const PAIR: Size = Size { share: 0.3, side: [96.0, 180.0], least_width: 2.5 };

impl Size {
    fn side_in(&self, pane: Rect) -> Option<f32> {
        let side = (self.share * pane.width().min(pane.height())).clamp(self.side[0], self.side[1]);
        (pane.width() >= self.least_width * side && pane.height() >= 2.0 * side).then_some(side)
    }
}

/// Rectangle of an inset: the lower right corner of the pane, or the upper right if the lower comes within `margin`
/// of `looks_at`.
fn place_for(pane: Rect, size: Vec2, looks_at: Pos2, margin: f32) -> Rect {
    let lower = Rect::from_min_size(pane.max - size - Vec2::splat(GAP), size);
    let upper = Rect::from_min_size(Pos2::new(lower.left(), pane.top() + GAP), size);
    if lower.expand(margin).contains(looks_at) { upper } else { lower }
}

/// Inset of a frame that magnifies a defect.
pub(super) struct Magnifier {
    place: usize,
    defect: Defect,
    camera: PlaneCamera,
    pane: Rect,
    /// Magnified part of the plane, on the screen.
    looks_at: Rect,
    /// Rectangle of the inset, title included.
    pub(super) rect: Rect,
    magnification: f64,
}

impl Magnifier {
    /// Inset over a pane, if enabled and if there is a defect that it shows larger than the pane does.
    pub(super) fn over(editor: &Editor, view: Viewport<PlaneCamera>, scene: &PlaneScene) -> Option<Self> {
        if !editor.pane_shading.magnifier
            || scene.is_stage()
            || editor.plane.shows_preview()
            || editor.plane.is_easing()
        {
            return None;
        }
        let nth = |place: usize| Some((place, Defect::all(&scene.outcome.step.verdict).nth(place)?));
        let (place, defect) = editor.selection.defect().and_then(nth).or_else(|| nth(0))?;
        let pane = view.rect;
        let side = DEFECT.side_in(pane)?;
        let shown = neighbourhood(scene, defect)?;
        let (insets, about) = (&editor.layout.insets, InsetSubject::Defect(place));
        let shown = nearer(shown, insets.factor(Some(place)));
        let mut camera = PlaneCamera::framing(shown, DVec2::splat(side.into()));
        camera.pan(insets.panned(InsetKind::Defect, about));
        let by = camera.center() - shown.middle();
        let shown = Bounds { low: shown.low + by, high: shown.high + by };
        let looks_at = Rect::from_two_pos(view.spot(shown.low), view.spot(shown.high));
        let magnification = camera.points_per_unit() / view.camera.points_per_unit();
        let rect = place_for(pane, Vec2::new(side, side + TITLE), looks_at.center(), GAP);
        // Keep an inset that the user has zoomed out, so that the wheel can zoom in again.
        let is_wanted = magnification > 1.0 || insets.is_set(InsetKind::Defect, about);
        is_wanted.then_some(Self { place, defect, camera, pane, looks_at, rect, magnification })
    }

    /// Draws the inset, and a frame around its part of the layout. A click shows the defect in the panes.
    pub(super) fn show(&self, ui: &egui::Ui, editor: &Editor, plane: &PlaneScene, requests: &mut Vec<Request>) {
        let theme = theme_of(ui);
        self.mark_on_layout(&ui.painter_at(self.pane), theme);
        let painter = ui.painter_at(self.rect.expand(1.0));
        painter.rect_filled(self.rect, 4.0, theme.panel);
        let title = self.rect.min + Vec2::new(8.0, TITLE / 2.0);
        let font = FontId::proportional(11.0);
        let factor = painter.text(title, Align2::LEFT_CENTER, format!("× {}", self.factor()), font.clone(), theme.text);
        let words = painter.layout_no_wrap(self.defect.words(&plane.mesh), font, theme.weak_text);
        let right = Pos2::new(self.rect.right() - 24.0, title.y);
        let room = Align2::RIGHT_CENTER.anchor_size(right, words.size());
        // A narrow inset shows only the magnification.
        if room.left() > factor.right() + GAP {
            painter.galley(room.min, words, theme.weak_text);
        }
        let picture = Rect::from_min_max(self.rect.min + Vec2::new(0.0, TITLE), self.rect.max);
        if editor.gpu.has_gpu() {
            ui.painter().add(render::plane_pane(PaneId("magnifier"), picture, self.frame(editor, plane, theme)));
        }
        pane::plane_marks(ui, Viewport { rect: picture, camera: self.camera }, editor, plane);
        painter.rect_stroke(self.rect, 4.0, Stroke::new(1.0, theme.weak_text), StrokeKind::Inside);
        self.click(ui, &plane.mesh, requests);
    }

    fn click(&self, ui: &egui::Ui, scene: &MeshScene, requests: &mut Vec<Request>) {
        let name = format!("Magnifier: {}, × {}", self.defect.words(scene), self.factor());
        let keys = keys_of(ui.ctx(), &Request::StepDefect(1));
        let tip = format!("Close-up of a defect. The wheel zooms, drag pans. Click to go there; {keys}: next defect");
        let about = InsetSubject::Defect(self.place);
        let inset = Inset { kind: InsetKind::Defect, rect: self.rect, role: Role::Button, name: &name, about };
        let response = inset.interact(ui, requests);
        let response = response.on_hover_cursor(CursorIcon::PointingHand).on_hover_text(tip);
        response.asks(Request::GoToDefect(self.place), requests);
    }

    /// Thin frame around the magnified part of the layout, and a line from it to the inset.
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

    /// Plain embedding with outlines of faces and with defects.
    fn frame(&self, editor: &Editor, plane: &PlaneScene, theme: &Theme) -> PlaneFrame {
        PlaneFrame {
            paint: editor.pane_shading.paint(Pane::Plane).map(|paint| Arc::clone(&paint.faces)),
            fills: Vec::new(),
            lines: vec![mesh_pane::boundary_line(&plane.mesh, theme)],
            ghost: editor.plane.ghost_layer(theme),
            picture: None,
            pattern: None,
            style: render::Style {
                shading: FaceShading::Plain,
                wire_in_points: 1.0,
                face_opacity: 1.0,
                ..mesh_pane::style(editor, Pane::Plane)
            },
            ..plane_pane::frame(editor, plane, self.camera, theme)
        }
    }

    /// Magnification, in meaningful digits.
    fn factor(&self) -> String {
        match self.magnification {
            factor if factor < 9.95 => format!("{factor:.1}"),
            factor if factor < 1e6 => format!("{factor:.0}"),
            factor => format!("{factor:.0e}"),
        }
    }
}

/// Box with the middle of `shown`, smaller by a factor.
fn nearer(shown: Bounds, factor: f64) -> Bounds {
    let half = shown.size() / (2.0 * factor);
    Bounds { low: shown.middle() - half, high: shown.middle() + half }
}

/// Part of the plane around a defect.
fn neighbourhood(plane: &PlaneScene, defect: Defect) -> Option<Bounds> {
    let disk = plane.mesh.disk()?;
    let around = |vertices: Vec<VertexId>| {
        bounds_of(&vertices.into_iter().filter_map(|v| plane.position_of(v)).collect::<Vec<DVec2>>())
    };
    let (center, reach) = match defect {
        Defect::Crossing(edges) => {
            let [a, b] = edges.map(|edge| disk.ends(edge).map(|v| plane.position_of(v).unwrap_or(DVec2::NAN)));
            let length = |[a, b]: [DVec2; 2]| a.distance(b);
            (pane::crossing_point(a, b), length(a).min(length(b)))
        }
        Defect::Overwound(vertex) => {
            let link = around(disk.outgoing(vertex).map(|h| disk.head(h)).collect());
            (plane.position_of(vertex)?, link.size().max_element())
        }
        Defect::Flipped(_) | Defect::Concave(_) | Defect::CrossedHole(_) => {
            let elements = defect.elements(&plane.mesh).into_iter();
            let bounds = around(elements.flat_map(|element| plane.mesh.vertices_of(element)).collect());
            (bounds.middle(), bounds.size().max_element())
        }
    };
    // A defect without extent is shown at the strongest zoom.
    let half = (REACH * reach).max(plane.arrays.bounds.extent() * 1e-9);
    (center.is_finite() && half.is_finite()).then(|| Bounds { low: center - half, high: center + half })
}

impl Editor {
    /// Magnified vertex: of the pair being placed, or of the only selected pin.
    fn vertex_in_hand(&self) -> Option<VertexId> {
        if self.tools.is_placing_pair() {
            return self.vertex_of_pair();
        }
        self.pins_selected().next().filter(|_| self.selection.vertices().len() == 1)
    }

    /// Magnified target, in the plane.
    fn target_in_hand(&self) -> Option<DVec2> {
        if self.tools.is_placing_pair() {
            return self.target_of_pair();
        }
        let document = self.session.document();
        let target = document.targets.get(&self.vertex_in_hand()?)?;
        Some(document.frame().plane_from_uv(target.uv))
    }

    /// True if the embedding pane magnifies a pair.
    pub(super) fn magnifies_pair(&self) -> bool {
        self.pane_shading.magnifier && (self.tools.is_placing_pair() || self.target_in_hand().is_some())
    }
}

/// Rectangle of the inset for half a pair at a position on the screen.
fn pair_inset(pane: Rect, looks_at: Pos2) -> Option<Rect> {
    Some(place_for(pane, Vec2::splat(PAIR.side_in(pane)?), looks_at, 3.0 * GAP))
}

/// Inset of the pair over the mesh pane.
pub(super) fn over_mesh(
    ui: &egui::Ui,
    view: Viewport<OrbitCamera>,
    editor: &Editor,
    scene: &MeshScene,
    requests: &mut Vec<Request>,
) {
    let Some(vertex) = editor.vertex_in_hand().filter(|_| editor.pane_shading.magnifier) else { return };
    let Some(&position) = scene.mesh().positions.get(vertex.index()) else { return };
    let Some(inset) = view.spot(position).and_then(|at| pair_inset(view.rect, at)) else { return };
    let (insets, kind, about) = (&editor.layout.insets, InsetKind::PairOnMesh, InsetSubject::Pair(Some(vertex)));
    let mut camera = view.camera;
    let radius = PART * scene.sphere.radius / insets.factor(None);
    camera.frame(Sphere { center: position, radius });
    camera.pan(insets.panned(kind, about), size_of(inset));
    let reach = |camera: &OrbitCamera| camera.eye().distance(position);
    let enlarges = reach(&view.camera) / reach(&camera) * f64::from(inset.height() / view.rect.height());
    if enlarges < LEAST_MAGNIFICATION && !insets.is_set(kind, about) {
        return;
    }
    let theme = theme_of(ui);
    ui.painter().rect_filled(inset, 4.0, theme.background);
    if editor.gpu.has_gpu() {
        let frame = mesh_pane::frame(editor, scene, camera, theme);
        ui.painter().add(render::mesh_pane(PaneId("pair on mesh"), inset, frame));
    }
    if let Some(at) = (Viewport { rect: inset, camera }).spot(position) {
        pane::halo(&ui.painter_at(inset), at, theme.selection, 7.0);
    }
    let name = format!("Magnifier: {} on the mesh", editor.session.number_of(vertex));
    let shown = Inset { kind, rect: inset, role: Role::Image, name: &name, about };
    close(ui, &shown, enlarges, requests);
}

/// Inset of the pair over the embedding pane.
pub(super) fn over_plane(
    ui: &egui::Ui,
    view: Viewport<PlaneCamera>,
    editor: &Editor,
    plane: &PlaneScene,
    requests: &mut Vec<Request>,
) {
    let Some(target) = editor.target_in_hand().filter(|z| editor.pane_shading.magnifier && z.is_finite()) else {
        return;
    };
    let Some(inset) = pair_inset(view.rect, view.spot(target)) else { return };
    let (insets, kind, about) =
        (&editor.layout.insets, InsetKind::PairInPlane, InsetSubject::Pair(editor.vertex_in_hand()));
    let half = PART / 2.0 / insets.factor(None) * editor.with_picture(plane.arrays.bounds).extent();
    let mut camera = PlaneCamera::framing(Bounds { low: target - half, high: target + half }, size_of(inset));
    camera.pan(insets.panned(kind, about));
    let enlarges = camera.points_per_unit() / view.camera.points_per_unit();
    if enlarges < LEAST_MAGNIFICATION && !insets.is_set(kind, about) {
        return;
    }
    let theme = theme_of(ui);
    ui.painter().rect_filled(inset, 4.0, theme.background);
    if editor.gpu.has_gpu() {
        let frame = PlaneFrame { ghost: None, ..plane_pane::frame(editor, plane, camera, theme) };
        ui.painter().add(render::plane_pane(PaneId("pair in plane"), inset, frame));
    }
    let painter = ui.painter_at(inset);
    let near = Viewport { rect: inset, camera };
    for pin in editor.pins_shown() {
        let at = near.spot(pin.target);
        if inset.expand(12.0).contains(at) {
            pin.kind.mark(&painter, at, theme, Emphasis::Plain);
        }
    }
    if editor.tools.pair().is_some() {
        pins::ghost(&painter, near.spot(target), theme);
    }
    painter.circle_stroke(near.spot(target), 11.0, Stroke::new(1.0, theme.selection));
    let of = editor.vertex_in_hand().map(|vertex| format!(" of {}", editor.session.number_of(vertex)));
    let name = format!("Magnifier: the target{}", of.unwrap_or_default());
    let shown = Inset { kind, rect: inset, role: Role::Image, name: &name, about };
    close(ui, &shown, enlarges, requests);
}

/// Outline, name and magnification of an inset of a pair.
fn close(ui: &egui::Ui, shown: &Inset<'_>, enlarges: f64, requests: &mut Vec<Request>) {
    let inset = shown.rect;
    let theme = theme_of(ui);
    let painter = ui.painter_at(inset.expand(1.0));
    painter.rect_stroke(inset, 4.0, Stroke::new(1.0, theme.weak_text), StrokeKind::Inside);
    let corner = inset.left_top() + Vec2::new(7.0, 5.0);
    let galley = painter.layout_no_wrap(format!("× {enlarges:.1}"), FontId::proportional(11.0), theme.text);
    let under = Align2::LEFT_TOP.anchor_size(corner, galley.size()).expand(3.0);
    painter.rect_filled(under, 3.0, theme.panel.gamma_multiply(0.85));
    painter.galley(corner, galley, theme.text);
    shown.interact(ui, requests);
}
