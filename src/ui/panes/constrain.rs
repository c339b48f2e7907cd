//! Constrain tool: joins a vertex with a target on the picture, in either order. A single function computes the
//! effect of a click for the preview, the status bar and the click.

use eframe::egui::{self, Stroke};
use glam::DVec2;

use super::{pane, pins};
use crate::session::Action;
use crate::ui::editor::scene::PlaneScene;
use crate::ui::state::{Half, Intent, Viewport};
use crate::ui::{Editor, Pane, Request, Tool, theme_of};
use crate::view::{PlaneCamera, snapped};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;

/// Least size of a pixel on the screen for targets to snap to pixels, points.
const SNAP_FROM: f64 = 8.0;

/// Distance at which a click takes a landmark, points.
const LANDMARK_REACH: f64 = 8.0;

/// Radius of the mark of a landmark, points.
const LANDMARK: f32 = 3.0;

impl Editor {
    /// Sets the effect of a click at the pointer. Call in each pane after the vertex under the pointer is set. `grip`
    /// is the vertex of the pin whose mark would take the click.
    pub(super) fn aim(&mut self, ui: &egui::Ui, pane: Pane, grip: Option<VertexId>) {
        if self.tools.tool() != Tool::Constrain {
            return;
        }
        let modifiers = ui.input(|input| input.modifiers);
        let target = self.pointer.in_embedding().map(|place| self.target_at(place, modifiers));
        self.tools.set_intent(match pane {
            Pane::Mesh => self.intent_on_mesh(),
            Pane::Plane => self.intent_in_plane(target, modifiers, grip),
        });
    }

    fn intent_on_mesh(&self) -> Intent {
        match (self.tools.pair(), self.vertex_to_pin()) {
            (Some(Half::Target(target)), Some(vertex)) => Intent::Join(vertex, target),
            (_, Some(vertex)) => self.first_half(vertex),
            (_, None) => Intent::Nothing,
        }
    }

    fn intent_in_plane(&self, target: Option<DVec2>, modifiers: egui::Modifiers, grip: Option<VertexId>) -> Intent {
        let Some(target) = target else { return Intent::Nothing };
        match (self.tools.pair(), self.vertex_to_pin()) {
            (Some(Half::Vertex(vertex)), _) => Intent::Join(vertex, target),
            (Some(Half::Target(first)), Some(vertex)) => Intent::Join(vertex, first),
            (None, Some(vertex)) if grip == Some(vertex) => Intent::Select(vertex),
            // Over a picture a click chooses a target on the picture.
            (None, Some(vertex)) if modifiers.shift || !(modifiers.alt || self.has_picture()) => {
                self.first_half(vertex)
            }
            _ => Intent::TakeTarget(target),
        }
    }

    /// Vertex under the pointer that can be pinned. New vertices belong to a single embedding and cannot.
    pub(super) fn vertex_to_pin(&self) -> Option<VertexId> {
        self.pointer.vertex().filter(|&vertex| !self.is_new_vertex(vertex))
    }

    /// True if a vertex is in the mesh on the screen, but not in the mesh as given.
    pub(in crate::ui) fn is_new_vertex(&self, vertex: VertexId) -> bool {
        self.mesh_scene().is_some_and(|scene| scene.new_vertex(vertex).is_some())
    }

    fn first_half(&self, vertex: VertexId) -> Intent {
        let is_pinned = self.session.document().targets.contains_key(&vertex);
        if is_pinned && self.tools.pair().is_none() { Intent::Select(vertex) } else { Intent::TakeVertex(vertex) }
    }

    /// Texture coordinates of a point of the plane. If pixels are large on the screen, they snap to a corner or
    /// centre of a pixel, unless Alt is held.
    fn target_at(&self, place: DVec2, modifiers: egui::Modifiers) -> DVec2 {
        let document = self.session.document();
        let target = document.frame().uv_from_plane(place);
        let (Some(picture), Some(camera)) = (&document.picture, self.plane.pane.camera()) else { return target };
        let pixels = DVec2::new(picture.pixels.width.into(), picture.pixels.height.into());
        if let Some(landmark) = self.landmark_near(place, camera.points_per_unit()) {
            return landmark;
        }
        let is_large = camera.points_per_unit() / pixels.y > SNAP_FROM;
        if is_large && !modifiers.alt { snapped(target, pixels) } else { target }
    }

    /// Texture coordinates of the waiting landmark at a point of the plane.
    fn landmark_near(&self, place: DVec2, points_per_unit: f64) -> Option<DVec2> {
        let frame = self.session.document().frame();
        let distance = |uv: DVec2| frame.plane_from_uv(uv).distance(place) * points_per_unit;
        let near = self.session.landmarks_waiting().into_iter().map(|landmark| (distance(landmark.uv), landmark.uv));
        let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.filter(|(distance, _)| *distance < LANDMARK_REACH).map(|(_, uv)| uv)
    }

    /// Carries out the effect of a click.
    pub(in crate::ui) fn constrain(&mut self) -> Vec<Request> {
        match self.tools.take_intent() {
            Intent::Nothing if self.tools.pair().is_some() => Vec::new(),
            Intent::Nothing => vec![Request::Select(Vec::new())],
            Intent::TakeVertex(vertex) => {
                self.tools.set_pair(Some(Half::Vertex(vertex)));
                vec![Request::Select(vec![vertex])]
            }
            Intent::TakeTarget(target) => {
                self.tools.set_pair(Some(Half::Target(target)));
                vec![Request::Select(Vec::new())]
            }
            Intent::Join(vertex, target) => {
                self.tools.set_pair(None);
                let is_landmark = self.session.landmark_at(target).is_some();
                let place = Action::Place { vertex, target: Target { uv: target, kind: self.tools.kind() } };
                let mut requests = vec![Request::Do(place), Request::Select(vec![vertex])];
                if is_landmark && self.session.landmarks_waiting().len() > 1 {
                    requests.push(Request::TakeLandmark { after: Some(target) });
                }
                requests
            }
            Intent::Select(vertex) => vec![Request::Select(vec![vertex])],
        }
    }

    /// Hint for the status bar.
    pub(in crate::ui) fn constrain_words(&self) -> String {
        let numbers = |target: DVec2| format!("u {:.4} v {:.4}", target.x, target.y);
        let number = |vertex: VertexId| self.session.number_of(vertex);
        match (self.tools.intent(), self.tools.pair()) {
            (Intent::Join(vertex, target), _) => format!("Click: {} goes to {}.", number(vertex), numbers(target)),
            (Intent::Select(vertex), _) => format!("Click: select the pin of {}.", number(vertex)),
            (Intent::TakeVertex(vertex), _) => format!("Click: choose {}, then its position.", number(vertex)),
            (Intent::TakeTarget(target), _) => {
                format!("Click: choose the position {}, then the vertex.", numbers(target))
            }
            (Intent::Nothing, Some(Half::Vertex(vertex))) => {
                format!("Click the position of {} in the embedding. Esc cancels.", number(vertex))
            }
            (Intent::Nothing, Some(Half::Target(target))) => {
                if let Some(landmark) = self.session.landmark_at(target) {
                    return format!("Click the vertex of {}, in either pane. Esc cancels.", landmark.name);
                }
                "Click the vertex that goes there, in either pane. Esc cancels.".to_owned()
            }
            (Intent::Nothing, None) => {
                "Click a vertex on the mesh, then its position in the embedding; or the position first. Esc ends."
                    .to_owned()
            }
        }
    }

    /// Target, in the plane, of the pair being placed: already placed, or under the pointer.
    pub(super) fn target_of_pair(&self) -> Option<DVec2> {
        match (self.tools.pair(), self.tools.intent()) {
            (Some(Half::Target(target)), _) | (_, Intent::Join(_, target) | Intent::TakeTarget(target)) => {
                Some(self.session.document().frame().plane_from_uv(target))
            }
            _ => None,
        }
    }

    /// Vertex of the pair being placed.
    pub(super) fn vertex_of_pair(&self) -> Option<VertexId> {
        match (self.tools.pair(), self.tools.intent()) {
            (Some(Half::Vertex(vertex)), _) | (_, Intent::Join(vertex, _)) => Some(vertex),
            _ => None,
        }
    }
}

/// Preview of the target that a click would place, and the line from its vertex, over the embedding.
pub(super) fn preview(ui: &egui::Ui, view: Viewport<PlaneCamera>, editor: &Editor, plane: &PlaneScene) {
    let is_constraining = editor.tools.tool() == Tool::Constrain;
    let Some(target) = editor.target_of_pair().filter(|_| is_constraining).map(|z| view.spot(z)) else { return };
    let (painter, theme) = (ui.painter_at(view.rect), theme_of(ui));
    if let Some(from) = editor.vertex_of_pair().and_then(|vertex| plane.position_of(vertex)) {
        painter.line_segment([view.spot(from), target], Stroke::new(1.5, theme.constraint.gamma_multiply(0.75)));
    }
    pins::ghost(&painter, target, theme);
}

/// Marks of the landmarks that wait for a vertex, over the picture.
pub(super) fn landmarks(ui: &egui::Ui, view: Viewport<PlaneCamera>, editor: &Editor) {
    let waiting = editor.session.landmarks_waiting();
    if waiting.is_empty() {
        return;
    }
    let (painter, theme) = (ui.painter_at(view.rect), theme_of(ui));
    let frame = editor.session.document().frame();
    for at in waiting.iter().map(|landmark| view.spot(frame.plane_from_uv(landmark.uv))) {
        painter.circle_stroke(at, LANDMARK, Stroke::new(3.0, theme.background));
        painter.circle_stroke(at, LANDMARK, Stroke::new(1.5, theme.constraint));
    }
}

/// Line across both panes, from the vertex on the mesh to its target.
pub(in crate::ui) fn line_across(ui: &egui::Ui, editor: &Editor) {
    let (Some(mesh), Some(plane)) = (editor.mesh.pane.viewport(), editor.plane.pane.viewport()) else { return };
    if editor.tools.tool() != Tool::Constrain || editor.tools.pair().is_none() {
        return;
    }
    let theme = theme_of(ui);
    let pointer = ui.input(|input| input.pointer.latest_pos()).filter(|_| editor.pointer.pane().is_some());
    let position = |vertex: VertexId| editor.mesh_scene()?.mesh().positions.get(vertex.index()).copied();
    let vertex = editor.vertex_of_pair().and_then(position).and_then(|position| mesh.spot(position));
    let target = editor.target_of_pair().map(|target| plane.spot(target));
    let ends = match editor.tools.pair() {
        Some(Half::Vertex(_)) => vertex.zip(target.or(pointer)),
        _ => vertex.or(pointer).zip(target),
    };
    let (mesh, plane) = (mesh.rect, plane.rect);
    let Some((from, to)) = ends.filter(|(from, to)| mesh.contains(*from) && plane.contains(*to)) else { return };
    let stroke = Stroke::new(1.0, theme.constraint.gamma_multiply(0.6));
    pane::dashed(&ui.painter().with_clip_rect(mesh.union(plane)), [from, to], stroke, [6.0, 4.0]);
}
