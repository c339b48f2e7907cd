//! Vertices, edges and faces in both panes: the element under the pointer, those in a region, and clicks on them.

use std::sync::Arc;

use eframe::egui::{self, CursorIcon, Painter, Pos2, Response, Stroke};
use glam::{DVec2, DVec3};

use super::pane;
use super::region::{Region, in_plane};
use crate::render::LineLayer;
use crate::ui::editor::PageScene;
use crate::ui::editor::scene::{MeshScene, PlaneScene};
use crate::ui::state::{Viewport, in_pane, size_of};
use crate::ui::{Editor, Request, Theme};
use crate::view::{
    EdgeList, ElementKind, ElementMesh, ElementSet, MeshElement, OrbitCamera, PICK_RADIUS, PlaneCamera, SurfacePicker,
    Visibility, distance_to_segment,
};
use freebound_core::mesh::VertexId;

/// Width of the edges of a selection, points.
const WIDTH: f32 = 2.5;

/// Greatest number of selected vertices with dots. The edges between them are always drawn.
const MARKS_SHOWN: usize = 2000;

/// Greatest number of selected triangles with a tint. More have none, because a part of them would look like another
/// selection; their edges are always drawn.
const TINTED: usize = 4000;

/// Opacity of the tint of selected faces.
const TINT: f32 = 0.25;

/// Opacity of the mark of a selected vertex that the mesh hides.
const HIDDEN: f32 = 0.4;

/// Most tests of points of a stroke against vertices of the map. On large meshes, points of the stroke are left out,
/// because the width of the stroke covers their elements.
const MOST_TESTS: usize = 30_000_000;

/// Least number of points of a stroke that are tested.
const LEAST_POINTS: usize = 30;

/// Surface whose elements are picked in the mesh pane.
pub(super) struct Surface<'a> {
    pub(super) mesh: ElementMesh<'a>,
    pub(super) picker: &'a SurfacePicker,
}

impl<'a> Surface<'a> {
    pub(super) fn of_chart(scene: &'a MeshScene) -> Self {
        Self { mesh: scene.elements(), picker: &scene.picker }
    }

    pub(super) fn of_page(scene: &'a PageScene) -> Self {
        Self { mesh: scene.elements(), picker: scene.surface_picker() }
    }

    /// Element under a point of the pane.
    pub(super) fn element_at(
        &self,
        kind: ElementKind,
        view: Viewport<OrbitCamera>,
        at: Pos2,
        visibility: Visibility,
    ) -> Option<MeshElement> {
        let (camera, size) = (view.camera, size_of(view.rect));
        let pointer = in_pane(view.rect, at);
        if kind == ElementKind::Vertices {
            let pick = self.picker.nearest_vertex(&camera, size, pointer, visibility)?;
            return Some(MeshElement::Vertex(pick.vertex));
        }
        let hit = self.picker.hit(camera.ray(pointer, size))?;
        let spot = |vertex: VertexId| view.spot(self.picker.positions()[vertex.index()]).map(in_plane);
        let away = |[a, b]: [VertexId; 2]| match (spot(a), spot(b)) {
            (Some(a), Some(b)) => distance_to_segment(in_plane(at), [a, b]),
            _ => f64::INFINITY,
        };
        self.mesh.element_at(kind, hit.face.index(), PICK_RADIUS, away)
    }

    /// Elements inside a region of the pane, and those under the line of a stroke. Without X-ray, a vertex that the mesh
    /// hides is outside.
    pub(super) fn inside(
        &self,
        kind: ElementKind,
        view: Viewport<OrbitCamera>,
        region: &Region,
        visibility: Visibility,
    ) -> ElementSet {
        let is_seen = |vertex| visibility == Visibility::All || self.picker.is_visible(vertex, view.camera.eye());
        let place = |vertex: VertexId| view.spot(self.picker.positions()[vertex.index()]);
        let holds = |vertex| place(vertex).is_some_and(|at| region.contains(at)) && is_seen(vertex);
        let inside = self.mesh.inside(kind, holds);
        let crossed = region.line().into_iter().filter_map(|at| self.element_at(kind, view, at, visibility));
        self.mesh.union(&inside, &self.mesh.set_of(kind, crossed))
    }
}

/// Map whose elements are picked in the embedding pane.
pub(super) struct Plane<'a> {
    pub(super) mesh: ElementMesh<'a>,
    pub(super) places: &'a [DVec2],
}

impl<'a> Plane<'a> {
    pub(super) fn of_chart(plane: &'a PlaneScene) -> Self {
        Self { mesh: plane.mesh.elements(), places: plane.positions() }
    }

    pub(super) fn of_page(scene: &'a PageScene) -> Self {
        Self { mesh: scene.elements(), places: scene.places() }
    }

    /// Element under a point of the pane.
    pub(super) fn element_at(&self, kind: ElementKind, view: Viewport<PlaneCamera>, at: Pos2) -> Option<MeshElement> {
        let radius = PICK_RADIUS / view.camera.points_per_unit();
        self.mesh.element_in_plane(kind, self.places, view.point_at(at), radius)
    }

    /// Elements inside a region of the pane, and those under the line of a stroke.
    pub(super) fn inside(&self, kind: ElementKind, view: Viewport<PlaneCamera>, region: &Region) -> ElementSet {
        let inside = self.mesh.inside(kind, |vertex| region.contains(view.spot(self.places[vertex.index()])));
        let line = region.line();
        let step = line.len().div_ceil((MOST_TESTS / self.places.len().max(1)).max(LEAST_POINTS)).max(1);
        let crossed = line.into_iter().step_by(step).filter_map(|at| self.element_at(kind, view, at));
        self.mesh.union(&inside, &self.mesh.set_of(kind, crossed))
    }
}

/// Vertices that count for picking and for regions.
pub(super) fn visibility(editor: &Editor) -> Visibility {
    if editor.selection.through { Visibility::All } else { Visibility::Visible }
}

/// Click that selects the element under the pointer, or nothing.
pub(super) fn click(ui: &egui::Ui, response: &Response, editor: &Editor, requests: &mut Vec<Request>) {
    let element = editor.pointer.element();
    if response.clicked() {
        let adds = ui.input(|input| input.modifiers.shift);
        match element {
            Some(element) => requests.push(Request::SelectElement { element, adds }),
            None if adds => {}
            None => requests.push(Request::SelectNothing),
        }
    }
    if response.hovered() && element.is_some() {
        ui.ctx().set_cursor_icon(CursorIcon::PointingHand);
    }
}

/// Lines of a selection, for both panes.
pub(super) fn line_of(edges: &Arc<EdgeList>, theme: &Theme) -> LineLayer {
    LineLayer { edges: Arc::clone(edges), colour: theme.selection_line, width_in_points: WIDTH }
}

/// True if a surface does not hide an element from the eye: a vertex, both ends of an edge, or the middle of a face.
pub(super) fn is_seen(picker: &SurfacePicker, element: MeshElement, eye: DVec3) -> bool {
    match element {
        MeshElement::Vertex(vertex) => picker.is_visible(vertex, eye),
        MeshElement::Edge(ends) => ends.into_iter().all(|end| picker.is_visible(end, eye)),
        MeshElement::Face(face) => picker.is_face_visible(face, eye),
    }
}

/// Marks over a mesh on the screen.
pub(super) struct Marks<'a> {
    pub(super) painter: &'a Painter,
    pub(super) theme: &'a Theme,
    pub(super) mesh: &'a ElementMesh<'a>,
}

impl Marks<'_> {
    /// Marks the element under the pointer. `spot` is the place of a vertex on the screen, if it is seen.
    pub(super) fn under_pointer(&self, element: Option<MeshElement>, spot: impl Fn(VertexId) -> Option<Pos2>) {
        let Self { painter, theme, mesh } = self;
        if let Some(MeshElement::Vertex(vertex)) = element
            && let Some(at) = spot(vertex)
        {
            pane::halo(painter, at, theme.selection, 5.0);
        }
        for ends in element.map(|element| mesh.outline(element)).unwrap_or_default() {
            if let [Some(a), Some(b)] = ends.map(&spot) {
                painter.line_segment([a, b], Stroke::new(3.5, theme.selection));
            }
        }
    }

    /// Marks what is selected: dots on vertices, a tint on faces. `spot` is the place of a vertex on the screen, and
    /// `is_seen` tells what the mesh does not hide. The edges are drawn with the mesh.
    pub(super) fn selection(
        &self,
        elements: Option<&ElementSet>,
        spot: impl Fn(VertexId) -> Option<Pos2>,
        is_seen: impl Fn(MeshElement) -> bool,
    ) {
        let Some(elements) = elements else { return };
        let Self { painter, theme, mesh } = self;
        if elements.kind() == ElementKind::Vertices {
            for &vertex in elements.vertices().iter().take(MARKS_SHOWN) {
                let Some(at) = spot(vertex) else { continue };
                // Show hidden vertices dimmed through the mesh, because "Go to" may select them.
                let shown = is_seen(MeshElement::Vertex(vertex));
                pane::dot(painter, at, if shown { theme.selection } else { theme.selection.gamma_multiply(HIDDEN) });
            }
        }
        if elements.faces().len() > TINTED {
            return;
        }
        let mut tint = egui::Mesh::default();
        for &face in elements.faces() {
            let corners = mesh.triangle(face).map(|corners| corners.map(&spot));
            if let Some([Some(a), Some(b), Some(c)]) = corners.filter(|_| is_seen(MeshElement::Face(face))) {
                let first = u32::try_from(tint.vertices.len()).unwrap_or_default();
                for at in [a, b, c] {
                    tint.colored_vertex(at, theme.selection.gamma_multiply(TINT));
                }
                tint.add_triangle(first, first + 1, first + 2);
            }
        }
        painter.add(tint);
    }
}
