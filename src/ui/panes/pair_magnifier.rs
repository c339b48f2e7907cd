//! The pair in hand from near by, in both panes: the vertex on the mesh, its target on the picture.

use eframe::egui;
use egui::{Align2, FontId, Rect, Role, Sense, Stroke, StrokeKind, Vec2, WidgetInfo};
use glam::DVec2;

use super::pins::{self, Emphasis};
use super::plane_pane;
use super::{mesh_pane, pane};
use crate::mesh::VertexId;
use crate::render::{self, PaneId};
use crate::ui::Editor;
use crate::ui::editor::scene::{MeshScene, PlaneScene};
use crate::ui::theme::{Theme, theme_of};
use crate::view::{PlaneBox, PlaneCamera, Sphere};

/// Share of the pane's lesser side that the inset takes.
const SHARE: f32 = 0.3;
/// Least and greatest side of the inset, points.
const SIDE: [f32; 2] = [96.0, 180.0];
/// Distance from the pane's edges, points.
const GAP: f32 = 12.0;
/// The inset shows this part of the whole.
const PART: f64 = 1.0 / 14.0;
/// An inset that enlarges less than this shows nothing new.
const LEAST_MAGNIFICATION: f64 = 1.5;

impl Editor {
    /// The vertex that is magnified: that of the pair being placed, or the one selected pin.
    fn vertex_in_hand(&self) -> Option<VertexId> {
        if self.tools.is_placing_pair() {
            return self.vertex_of_pair();
        }
        let mut pins = self.pins_selected();
        pins.next().filter(|_| self.selection.vertices().len() == 1)
    }

    /// The target that is magnified, in the plane.
    fn target_in_hand(&self) -> Option<DVec2> {
        if self.tools.is_placing_pair() {
            return self.target_of_pair();
        }
        let document = self.session.document();
        let target = document.targets.get(&self.vertex_in_hand()?)?;
        Some(document.frame().plane_from_uv(target.uv))
    }

    /// Whether a pair is magnified in the embedding's pane.
    pub(super) fn magnifies_pair(&self) -> bool {
        self.look.magnifier && (self.tools.is_placing_pair() || self.target_in_hand().is_some())
    }
}

/// The place of an inset in a pane: a lower corner, away from what it looks at.
fn place_in(pane: Rect, looks_at: egui::Pos2) -> Option<Rect> {
    let side = (SHARE * pane.width().min(pane.height())).clamp(SIDE[0], SIDE[1]);
    if pane.width() < 2.5 * side || pane.height() < 2.0 * side {
        return None;
    }
    let square = Vec2::splat(side);
    let lower = Rect::from_min_size(pane.max - square - Vec2::splat(GAP), square);
    let upper = Rect::from_min_size(egui::pos2(lower.left(), pane.top() + GAP), square);
    Some(if lower.expand(3.0 * GAP).contains(looks_at) { upper } else { lower })
}

/// The inset over the mesh's pane.
pub(super) fn over_mesh(ui: &mut egui::Ui, rect: Rect, editor: &Editor, scene: &MeshScene) {
    let Some(vertex) = editor.vertex_in_hand().filter(|_| editor.look.magnifier) else { return };
    let (Some(around), Some(&position)) = (editor.mesh.camera(), scene.mesh().positions.get(vertex.index())) else {
        return;
    };
    let Some(at) = around.pane_from_world(position, pane::size_of(rect)).map(|at| pane::on_screen(rect, at)) else {
        return;
    };
    let Some(inset) = place_in(rect, at) else { return };
    let mut camera = around;
    let size = pane::size_of(inset);
    camera.frame(Sphere { center: position, radius: PART * scene.sphere.radius }, size);
    let reach = |camera: &crate::view::OrbitCamera| camera.eye().distance(position);
    let enlarges = reach(&around) / reach(&camera) * f64::from(inset.height() / rect.height());
    if enlarges < LEAST_MAGNIFICATION {
        return;
    }
    let theme = theme_of(ui);
    frame_of(ui, inset, theme);
    if editor.host.has_gpu() {
        let frame = mesh_pane::frame(editor, scene, camera, theme);
        ui.painter().add(render::mesh_pane(PaneId("pair on mesh"), inset, frame));
    }
    let painter = ui.painter_at(inset);
    pane::halo(&painter, inset.center(), theme.selection, 7.0);
    close(ui, inset, &format!("Magnifier: {vertex} on the mesh"), enlarges);
}

/// The inset over the embedding's pane.
pub(super) fn over_plane(ui: &mut egui::Ui, rect: Rect, editor: &Editor, plane: &PlaneScene) {
    let Some(target) = editor.target_in_hand().filter(|z| editor.look.magnifier && z.is_finite()) else { return };
    let Some(around) = editor.plane.camera() else { return };
    let at = pane::on_screen(rect, around.pane_from_embedding(target, pane::size_of(rect)));
    let Some(inset) = place_in(rect, at) else { return };
    let half = DVec2::splat(PART / 2.0 * editor.with_picture(plane.arrays.bounds()).extent());
    let size = pane::size_of(inset);
    let camera = PlaneCamera::framing(PlaneBox { min: target - half, max: target + half }, size);
    let enlarges = camera.points_per_unit() / around.points_per_unit();
    if enlarges < LEAST_MAGNIFICATION {
        return;
    }
    let theme = theme_of(ui);
    frame_of(ui, inset, theme);
    if editor.host.has_gpu() {
        let mut frame = plane_pane::frame(editor, plane, camera, theme);
        frame.ghost = None;
        ui.painter().add(render::plane_pane(PaneId("pair in plane"), inset, frame));
    }
    let painter = ui.painter_at(inset);
    let spot = |z: DVec2| pane::on_screen(inset, camera.pane_from_embedding(z, size));
    for pin in editor.pins_shown() {
        let is_seen = inset.expand(12.0).contains(spot(pin.target));
        if is_seen {
            pin.kind.mark(&painter, spot(pin.target), theme, Emphasis::Plain);
        }
    }
    if editor.tools.pair().is_some() {
        pins::ghost(&painter, spot(target), theme);
    }
    let cross = Stroke::new(1.0, theme.selection);
    painter.circle_stroke(inset.center(), 11.0, cross);
    let words = match editor.vertex_in_hand() {
        Some(vertex) => format!("Magnifier: the target of {vertex}"),
        None => "Magnifier: the target".to_owned(),
    };
    close(ui, inset, &words, enlarges);
}

fn frame_of(ui: &egui::Ui, inset: Rect, theme: &Theme) {
    ui.painter().rect_filled(inset, 4.0, theme.background);
}

/// Edge, name and how much larger: what both insets end with.
fn close(ui: &egui::Ui, inset: Rect, name: &str, enlarges: f64) {
    let theme = theme_of(ui);
    let painter = ui.painter_at(inset.expand(1.0));
    painter.rect_stroke(inset, 4.0, Stroke::new(1.0, theme.weak_text), StrokeKind::Inside);
    let corner = inset.left_top() + Vec2::new(7.0, 5.0);
    let words = format!("× {enlarges:.1}");
    let galley = painter.layout_no_wrap(words, FontId::proportional(11.0), theme.text);
    let under = Align2::LEFT_TOP.anchor_size(corner, galley.size()).expand(3.0);
    painter.rect_filled(under, 3.0, theme.panel.gamma_multiply(0.85));
    painter.galley(corner, galley, theme.text);
    // Clicks and drags as well: what lies under the inset must not get them.
    let response = ui.interact(inset, ui.scope_id().with(("pair magnifier", name)), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, name));
}
