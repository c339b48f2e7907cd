//! Mesh pane: orbit, pan, zoom; hover and pick vertices.

use std::sync::Arc;

use eframe::egui::{self, Pos2, Response};
use glam::{DVec2, DVec3};

use super::elements::{self, Marks, Surface};
use super::pane;
use super::pins::{self, Emphasis, PinMark};
use super::region::draw_region;
use super::{bars, header, legend, magnifier, outside_hull, page_pane, seam, vertex_menu};
use crate::render::{self, LineLayer, MeshFrame, PaneId, PictureLayer, Style};
use crate::session::Action;
use crate::ui::editor::picture_box::picture_box;
use crate::ui::editor::scene::MeshScene;
use crate::ui::state::{Viewport, in_pane, size_of};
use crate::ui::{Control, Editor, Pane, Request, ShadingMode, Theme, Tool, theme_of};
use crate::view::{EdgeList, ElementKind, OrbitCamera, Ray, Visibility};
use freebound_core::mesh::{Seams, VertexId};

/// Opacity of faces over a picture.
const THIN_FILL: f32 = 0.3;

/// Greatest number of marks of new vertices.
const MARKS_SHOWN: usize = 2000;

pub(in crate::ui) fn mesh_pane_ui(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    header::header(ui, editor, Pane::Mesh, requests);
    let (rect, response) = pane::surface(ui, "3D view of the mesh");
    bars::over(ui, rect, editor, Pane::Mesh, requests);
    editor.mesh.pane.set_rect(rect);
    let theme = theme_of(ui);
    ui.painter_at(rect).rect_filled(rect, 0.0, theme.background);
    if editor.shows_page() {
        return page_pane::mesh_ui(ui, &response, editor, requests);
    }
    let (Some(scene), Some(mut camera)) = (editor.mesh_scene().map(Arc::clone), editor.mesh.pane.camera()) else {
        return pane::empty_state(ui, rect, empty_words(editor));
    };
    // A double click ends a seam, and must not move the pivot.
    let sets_pivot = editor.tools.tool() != Tool::Seam;
    if let Some(painted) = paint(ui, &response, editor, &scene, camera) {
        requests.extend(painted);
    } else {
        let hit = |ray| scene.picker.hit(ray).map(|hit| hit.point);
        navigate(ui, &response, &hit, &mut camera, sets_pivot);
    }
    if editor.mesh.pane.camera() != Some(camera) {
        editor.mesh.pane.set_camera(camera);
        ui.ctx().request_repaint();
    }
    if let Some(pointer) = response.hover_pos().map(|at| in_pane(rect, at)) {
        let visibility = if editor.selection.through { Visibility::All } else { Visibility::Visible };
        let pick = scene.picker.nearest_vertex(&camera, editor.mesh.pane.size(), pointer, visibility);
        let pick = pick.filter(|_| editor.is_of_session(&scene));
        let ray = camera.ray(pointer, editor.mesh.pane.size());
        editor.pointer.over_mesh(pick.map(|pick| scene.on_side_at(pick.vertex, ray)));
        find_element(editor, &scene, Viewport { rect, camera }, response.hover_pos());
        if editor.tools.tool() == Tool::Seam {
            editor.pick_seam_vertex(&scene, &camera, pointer);
        }
        editor.aim(ui, Pane::Mesh, None);
    }
    let view = Viewport { rect, camera };
    if let Some(region) = draw_region(ui, &response, editor, Pane::Mesh) {
        let kind = editor.kind_under_pointer().unwrap_or_default();
        let inside = Surface::of_chart(&scene).inside(kind, view, &region, elements::visibility(editor));
        requests.push(Request::AddElements(inside));
    }
    let ray = response.hover_pos().map(|at| camera.ray(in_pane(rect, at), editor.mesh.pane.size()));
    let has_element = editor.pointer.vertex().is_some() || editor.pointer.element().is_some();
    let is_free = !has_element && editor.tools.tool() != Tool::Seam;
    match ray.filter(|_| is_free).and_then(|ray| scene.other_chart_at(ray)) {
        Some(chart) => other_chart(ui, &response, chart, requests),
        None => pane::click(ui, &response, editor, requests),
    }
    vertex_menu::of_pane(&response, editor, requests);
    if editor.gpu.has_gpu() {
        ui.painter().add(render::mesh_pane(PaneId("mesh"), rect, frame(editor, &scene, camera, theme)));
    }
    marks(ui, view, editor, &scene);
    seam::over_mesh(ui, view, editor);
    legend::legend(ui, rect, editor, Pane::Mesh);
    legend::no_move_note(ui, rect, editor, Pane::Mesh);
    magnifier::over_mesh(ui, view, editor, &scene, requests);
}

/// Sets the edge or face under the pointer, if clicks select them.
fn find_element(editor: &mut Editor, scene: &MeshScene, view: Viewport<OrbitCamera>, at: Option<Pos2>) {
    let kind = editor.kind_under_pointer().filter(|kind| *kind != ElementKind::Vertices);
    let kind = kind.filter(|_| editor.is_of_session(scene));
    if let Some((kind, at)) = kind.zip(at) {
        let found = Surface::of_chart(scene).element_at(kind, view, at, elements::visibility(editor));
        editor.pointer.set_element(found);
    }
}

/// Words of a pane without a mesh.
fn empty_words(editor: &Editor) -> &'static [&'static str] {
    if editor.session.busy().is_some() {
        &["Opening…"]
    } else {
        &["No mesh open", "Drop a mesh file or a project here, or open an example from the File menu"]
    }
}

/// Drag that paints where no automatic seam may run, or takes paint away. `None` if there is no such drag.
fn paint(
    ui: &egui::Ui,
    response: &Response,
    editor: &mut Editor,
    scene: &MeshScene,
    camera: OrbitCamera,
) -> Option<Vec<Request>> {
    if editor.tools.tool() != Tool::Seam || !editor.tools.seam.paints() {
        return None;
    }
    let (size, has_shift) = (size_of(response.rect), ui.input(|input| input.modifiers.shift));
    let is_stroke = !editor.tools.seam.stroke().is_empty();
    let pointer = response.interact_pointer_pos().map(|at| in_pane(response.rect, at));
    let begins = response.drag_started_by(egui::PointerButton::Primary)
        && pointer.is_some_and(|at| scene.hits(camera.ray(at, size)));
    if let Some(at) = pointer.filter(|_| begins || is_stroke || response.clicked()) {
        editor.tools.seam.paint(&camera, size, at);
    }
    let mut requests = Vec::new();
    if response.drag_stopped() || response.clicked() {
        let edges = editor.tools.seam.end_stroke();
        let cost = if editor.tools.seam.erases() == has_shift { Seams::AVOIDED } else { 1.0 };
        if !edges.is_empty() {
            requests.push(Action::PaintSeams { edges, cost }.into());
        }
    }
    (begins || is_stroke || !requests.is_empty()).then_some(requests)
}

/// Pointer over a chart that is not on the screen: a click shows that chart.
fn other_chart(ui: &egui::Ui, response: &Response, chart: usize, requests: &mut Vec<Request>) {
    ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
    let tip = format!("Chart {chart}: click to work on it");
    response.clone().on_hover_text_at_pointer(tip).asks(Action::ShowChart(chart), requests);
}

/// Camera moves: turntable, pan, zoom to the pointer, pivot.
pub(super) fn navigate(
    ui: &egui::Ui,
    response: &Response,
    hit: &dyn Fn(Ray) -> Option<DVec3>,
    camera: &mut OrbitCamera,
    sets_pivot: bool,
) {
    let size = size_of(response.rect);
    let drag = DVec2::new(response.drag_delta().x.into(), response.drag_delta().y.into());
    let (shift, boxing) = ui.input(|input| (input.modifiers.shift, input.modifiers.command));
    if response.dragged_by(egui::PointerButton::Primary) && !shift && !boxing {
        camera.orbit(drag);
    } else if response.dragged() && !boxing {
        camera.pan(drag, size);
    }
    let Some(pointer) = response.hover_pos().map(|at| in_pane(response.rect, at)) else { return };
    let hit = |camera: &OrbitCamera| hit(camera.ray(pointer, size));
    let wheel = pane::wheel(ui);
    if (wheel.zoom - 1.0).abs() > f64::EPSILON {
        let anchor = hit(camera).unwrap_or_else(|| camera.point_at_pivot_depth(pointer, size));
        camera.zoom_about(anchor, 1.0 / wheel.zoom);
    }
    if wheel.pan != DVec2::ZERO {
        camera.pan(wheel.pan, size);
    }
    if response.double_clicked()
        && sets_pivot
        && let Some(point) = hit(camera)
    {
        camera.set_pivot(point);
    }
}

pub(super) fn frame(editor: &Editor, scene: &MeshScene, camera: OrbitCamera, theme: &Theme) -> MeshFrame {
    let plane = editor.plane.result().map(|plane| Arc::clone(&plane.arrays));
    let shows_given = editor.mesh.scene().is_some_and(|given| std::ptr::eq(Arc::as_ptr(given), scene));
    let mut lines = vec![boundary_line(scene, theme), seam_line(&scene.seams, theme)];
    lines.extend(editor.selection.lines(scene.arrays.revision).map(|edges| elements::line_of(edges, theme)));
    if shows_given {
        let line = |edges: &Arc<EdgeList>, colour, width_in_points| LineLayer {
            edges: Arc::clone(edges),
            colour,
            width_in_points,
        };
        let is_drawing = editor.tools.tool() == Tool::Seam;
        lines.extend(editor.mesh.kept_whole().filter(|_| is_drawing).map(|edges| line(edges, theme.kept_whole, 2.0)));
        lines.extend(editor.mesh.seams_to_be().map(|edges| line(edges, theme.seam_to_be, 2.5)));
    }
    MeshFrame {
        mesh: Arc::clone(&scene.arrays),
        around: scene.around.as_ref().map(|around| around.surroundings.clone()),
        lines,
        around_lines: scene.around.iter().map(|around| seam_line(&around.seams, theme)).collect(),
        picture: picture_layer(editor),
        pattern: editor.pane_shading.checker.tile(),
        paint: editor
            .plane
            .preview_paint()
            .or(editor.pane_shading.paint(Pane::Mesh).map(|paint| &paint.faces))
            .map(Arc::clone),
        style: style(editor, Pane::Mesh),
        palette: theme.palette,
        camera,
        plane,
    }
}

/// Boundary line, in both panes.
pub(super) fn boundary_line(scene: &MeshScene, theme: &Theme) -> LineLayer {
    LineLayer { edges: Arc::clone(&scene.boundary), colour: theme.boundary, width_in_points: 1.5 }
}

/// Seams, in both panes.
pub(super) fn seam_line(seams: &Arc<EdgeList>, theme: &Theme) -> LineLayer {
    LineLayer { edges: Arc::clone(seams), colour: theme.seam, width_in_points: 3.0 }
}

/// Picture layer of the panes.
pub(super) fn picture_layer(editor: &Editor) -> Option<PictureLayer> {
    editor.pane_shading.picture_layer(picture_box(editor.session.document()), editor.appearance().opacity)
}

/// Style of the faces in a pane.
pub(super) fn style(editor: &Editor, pane: Pane) -> Style {
    let chosen = match editor.shading(pane) {
        // Distortion was measured on another embedding than the drag preview.
        shading if shading.is_by_number() && editor.plane.shows_preview() => ShadingMode::Plain,
        ShadingMode::Move if editor.plane.moved_from(&editor.session).is_none() => ShadingMode::Plain,
        shading => shading,
    };
    style_of(editor, chosen, editor.pane_shading.checker.check_size())
}

/// Style of faces with a shading and a size of checks.
pub(super) fn style_of(editor: &Editor, chosen: ShadingMode, check_size: f64) -> Style {
    let shading = match chosen {
        ShadingMode::Plain | ShadingMode::SeeThrough => render::FaceShading::Plain,
        ShadingMode::Picture if editor.has_picture() => render::FaceShading::Picture,
        ShadingMode::Checker | ShadingMode::Picture if editor.pane_shading.checker.tile().is_some() => {
            render::FaceShading::Pattern
        }
        ShadingMode::Checker | ShadingMode::Picture => render::FaceShading::Checker,
        ShadingMode::Angle | ShadingMode::Area | ShadingMode::Stretch | ShadingMode::Move | ShadingMode::Column => {
            render::FaceShading::Paint
        }
    };
    Style {
        shading,
        wire_in_points: if editor.pane_shading.wireframe { shading.wire_in_points() } else { 0.0 },
        check_size,
        face_opacity: if chosen == ShadingMode::SeeThrough { THIN_FILL } else { 1.0 },
        ..Style::default()
    }
}

/// New vertices that are marked.
pub(super) fn new_vertices(scene: &MeshScene) -> impl Iterator<Item = VertexId> {
    let of_surface = scene.refinement.iter().flat_map(|refinement| refinement.new_vertices_of_surface());
    of_surface.map(|(vertex, _)| vertex).take(MARKS_SHOWN)
}

/// Mark of a new vertex: a small dot.
pub(super) fn new_vertex_mark(painter: &egui::Painter, at: Pos2, theme: &Theme) {
    painter.circle_filled(at, 2.5, theme.background);
    painter.circle_filled(at, 1.75, theme.accent);
}

/// Both sides of the seam under the pointer, where the mesh does not hide them.
fn seam_under_pointer(
    painter: &egui::Painter,
    editor: &Editor,
    theme: &Theme,
    seen: impl Fn(VertexId) -> Option<Pos2>,
) {
    for side in editor.tools.seam_hover.sides() {
        if let [Some(a), Some(b)] = side.map(&seen) {
            painter.line_segment([a, b], pane::seam_stroke(theme));
        }
    }
}

/// Pins of the chart on the screen. `seen` is the place of a vertex that the mesh does not hide.
fn pin_marks(painter: &egui::Painter, editor: &Editor, theme: &Theme, seen: impl Fn(VertexId) -> Option<Pos2>) {
    let unmet = editor.unmet_shown();
    for pin in editor.pins_shown() {
        let Some(at) = seen(pin.vertex) else { continue };
        if unmet.contains(&pin.vertex) {
            pins::unmet_mark(painter, at, theme);
        } else if editor.session.conflict_of(pin.vertex).is_some() {
            pins::conflict_mark(painter, at, theme);
        }
        pin.kind.mark(painter, at, theme, Emphasis::strong_if(editor.selection.vertices().contains(&pin.vertex)));
    }
}

/// Marks over the mesh: pins, selection, hover and defects.
fn marks(ui: &egui::Ui, view: Viewport<OrbitCamera>, editor: &Editor, scene: &MeshScene) {
    let theme = theme_of(ui);
    let painter = ui.painter_at(view.rect);
    let eye = view.camera.eye();
    let positions = &scene.mesh().positions;
    let spot = |vertex: VertexId| view.spot(*positions.get(vertex.index())?);
    let place = |vertex: VertexId| Some((spot(vertex)?, scene.picker.is_visible(vertex, eye)));
    let seen = |vertex: VertexId| place(vertex).filter(|(_, is_seen)| *is_seen).map(|(at, _)| at);
    for edge in pane::crossings(editor, scene).into_iter().flatten() {
        if let [Some((a, a_seen)), Some((b, b_seen))] = edge.map(place)
            && (a_seen || b_seen)
        {
            painter.line_segment([a, b], egui::Stroke::new(4.0, theme.crossing));
        }
    }
    seam_under_pointer(&painter, editor, theme, seen);
    for outline in pane::concave(editor, scene) {
        let corners: Vec<(Pos2, bool)> = outline.iter().filter_map(|&corner| place(corner)).collect();
        if corners.len() == outline.len() && corners.iter().any(|(_, is_seen)| *is_seen) {
            pane::concave_mark(&painter, &corners.into_iter().map(|(at, _)| at).collect::<Vec<_>>(), theme);
        }
    }
    for rim in pane::crossed_holes(editor, scene) {
        if let Some(line) = rim.iter().map(|&vertex| seen(vertex)).collect::<Option<Vec<Pos2>>>() {
            pane::crossed_hole_mark(&painter, &line, theme);
        }
    }
    for at in pane::overwound(editor).into_iter().filter_map(seen) {
        pane::overwound_mark(&painter, at, theme);
    }
    outside_hull::marked(editor).filter_map(seen).for_each(|at| outside_hull::mark(&painter, at, theme));
    for at in new_vertices(scene).filter_map(seen) {
        new_vertex_mark(&painter, at, theme);
    }
    let mesh = scene.elements();
    let is_seen = |element| elements::is_seen(&scene.picker, element, eye);
    let marks = Marks { painter: &painter, theme, mesh: &mesh };
    marks.selection(editor.selection.elements_on(scene), spot, is_seen);
    pin_marks(&painter, editor, theme, seen);
    marks.under_pointer(editor.pointer.element(), seen);
    let vertex = editor.pointer.vertex().filter(|_| editor.pointer.element().is_none());
    if let Some((vertex, at)) = vertex.and_then(|vertex| Some((vertex, seen(vertex)?))) {
        pane::halo(&painter, at, theme.selection, if editor.tools.tool() == Tool::Fix { 7.0 } else { 5.0 });
        match editor.tools.tool() {
            _ if editor.is_new_vertex(vertex) => {}
            Tool::Select | Tool::Seam | Tool::Brush => {}
            Tool::Fix => PinMark::Gauge.mark(&painter, at, theme, Emphasis::Plain),
            Tool::Constrain => pins::ghost(&painter, at, theme),
        }
        pins::name_beside(&painter, at, theme, editor);
    }
}
