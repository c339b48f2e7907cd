//! All charts on the page: in the embedding pane as they lie, in the mesh pane on the surface.

use std::collections::BTreeSet;
use std::sync::Arc;

use eframe::egui::{self, Align2, Color32, CursorIcon, FontId, PointerButton, Pos2, Rect, Response, Stroke, Vec2};
use glam::DVec2;

use super::elements::{self, Marks, Plane, Surface};
use super::pins::Emphasis;
use super::region::{Region, draw_region};
use super::{brush, legend, mesh_pane, pins, plane_pane};
use crate::render::{self, LineLayer, MeshFrame, PaneId, PlaneFrame, Style};
use crate::session::ChartPage;
use crate::ui::editor::PageScene;
use crate::ui::state::{GestureKind, PageGesture, PageRequest, Tool, Viewport, in_pane, size_of};
use crate::ui::{Editor, Pane, Request, ShadingMode, Theme, five_digits, theme_of};
use crate::view::{EdgeList, OrbitCamera, PlaneCamera};
use freebound_core::geom::{Bounds, FIRST_UDIM_TILE, corner_of_tile};
use freebound_core::mesh::VertexId;

/// Greatest number of edges of outlines that a kept-back move draws.
const EDGES_SHOWN: usize = 20_000;

/// Greatest number of pins with marks. Each is tested for what hides it.
const PINS_SHOWN: usize = 2000;

/// Distance outside a pane up to which the mark of a pin reaches into it, points.
const OUTSIDE: f32 = 12.0;

/// Embedding pane with all charts.
pub(super) fn plane_ui(ui: &mut egui::Ui, response: &Response, editor: &mut Editor, requests: &mut Vec<Request>) {
    let rect = response.rect;
    editor.plane.page.set_rect(rect);
    let (Some(scene), Some(mut camera)) = (editor.plane.page.scene().map(Arc::clone), editor.plane.page.pane.camera())
    else {
        return;
    };
    let brushes = brush::takes_drags(editor);
    let grip = Grip::at(ui, response, editor, Viewport { rect, camera }, &scene);
    if grip.holds_charts {
        plane_pane::zoom(ui, response, &mut camera);
    } else {
        brush::navigate(ui, response, &mut camera, editor, requests);
    }
    if editor.plane.page.pane.camera() != Some(camera) {
        editor.plane.page.pane.set_camera(camera);
        ui.ctx().request_repaint();
    }
    let view = Viewport { rect, camera };
    let pointer = ui.input(|input| input.pointer.latest_pos()).filter(|at| rect.contains(*at));
    let place = pointer.filter(|_| response.hovered() || response.contains_pointer()).map(|at| view.point_at(at));
    if response.hovered() || response.contains_pointer() {
        editor.pointer.over_plane(place, None);
        if let Some((kind, at)) = editor.kind_under_pointer().zip(pointer) {
            editor.pointer.set_element(Plane::of_page(&scene).element_at(kind, view, at));
        }
        let chart = match editor.session.page_stroke() {
            Some(stroke) => Some(stroke.chart()),
            None if editor.kind_under_pointer().is_some() => None,
            None if brushes => place.and_then(|at| scene.chart_near(at, brush::radius_in_plane(editor, view))),
            None => place.and_then(|at| scene.chart_at(at)),
        };
        editor.plane.page.set_hovered(chart);
    }
    // A gesture goes on where the pointer leaves the pane.
    let anywhere = ui.input(|input| input.pointer.latest_pos()).map(|at| view.point_at(at));
    follow(ui, response, editor, anywhere);
    if editor.gpu.has_gpu() {
        let frame = plane_frame(editor, &scene, camera, theme_of(ui));
        ui.painter().add(render::plane_pane(PaneId("page"), rect, frame));
    }
    if brushes {
        brush::over_page(ui, response, view, editor, requests);
    } else if let Some(region) = draw_region(ui, response, editor, Pane::Plane) {
        requests.push(within(view, &region, editor, &scene));
    }
    if !brushes {
        click(ui, response, editor, requests);
    }
    element_marks(ui, view, editor, &scene);
    tiles(ui, view, editor, &scene);
    kept_back(ui, view, editor, &scene);
    gesture_note(ui, rect, editor);
    brush::bar(ui, rect, editor, requests);
    if legend::plane_has_own(editor) {
        legend::legend(ui, rect, editor, Pane::Plane);
    }
}

/// Request that selects what lies in a region of the page: charts, or elements.
fn within(view: Viewport<PlaneCamera>, region: &Region, editor: &Editor, scene: &PageScene) -> Request {
    if let Some(kind) = editor.kind_under_pointer() {
        return Request::AddElements(Plane::of_page(scene).inside(kind, view, region));
    }
    let mut charts = scene.charts_within(|at| region.contains(view.spot(at)));
    charts.extend(region.line().into_iter().filter_map(|at| scene.chart_at(view.point_at(at))));
    PageRequest::Add(charts).into()
}

/// Pins of all charts. `spot` returns the position of a vertex on the screen, and `is_seen` tells if the mesh hides it.
fn pin_marks(
    painter: &egui::Painter,
    editor: &Editor,
    theme: &Theme,
    spot: impl Fn(VertexId) -> Option<Pos2>,
    is_seen: impl Fn(VertexId) -> bool,
) {
    let inside = painter.clip_rect().expand(OUTSIDE);
    let pins = editor.pins_on_page().into_iter().take(PINS_SHOWN);
    for (pin, at) in pins.filter_map(|pin| Some((pin, spot(pin.vertex).filter(|at| inside.contains(*at))?))) {
        if !is_seen(pin.vertex) {
            continue;
        }
        if pin.is_unmet {
            pins::unmet_mark(painter, at, theme);
        }
        let is_selected = editor.plane.page.elements().vertices().contains(&pin.vertex);
        pin.kind.mark(painter, at, theme, Emphasis::strong_if(is_selected));
    }
}

/// Pins, selected vertices, and the element under the pointer.
fn element_marks(ui: &egui::Ui, view: Viewport<PlaneCamera>, editor: &Editor, scene: &PageScene) {
    let (painter, theme) = (ui.painter_at(view.rect), theme_of(ui));
    let spot = |vertex: VertexId| Some(view.spot(scene.place_of(vertex)?));
    let (mesh, selected) = (scene.elements(), editor.plane.page.elements());
    let marks = Marks { painter: &painter, theme, mesh: &mesh };
    marks.selection(Some(selected), spot, |_| true);
    pin_marks(&painter, editor, theme, spot, |_| true);
    marks.under_pointer(editor.pointer.element(), spot);
}

/// Press of the left button on a chart, which moves the selected charts and not the camera.
struct Grip {
    holds_charts: bool,
}

impl Grip {
    /// Starts a drag of charts if the press is on one of them. A chart that is not selected is selected first.
    fn at(
        ui: &egui::Ui,
        response: &Response,
        editor: &mut Editor,
        view: Viewport<PlaneCamera>,
        scene: &PageScene,
    ) -> Self {
        let is_boxing = ui.input(|input| input.modifiers.command || input.modifiers.shift);
        if editor.plane.page.gesture().is_none()
            && !brush::takes_drags(editor)
            && editor.kind_under_pointer().is_none()
            && response.drag_started_by(PointerButton::Primary)
            && !is_boxing
        {
            let origin = ui.input(|input| input.pointer.press_origin()).or(response.interact_pointer_pos());
            let from = origin.map(|at| view.point_at(at));
            if let Some((from, chart)) = from.and_then(|from| Some((from, scene.chart_at(from)?))) {
                if !editor.plane.page.selected().contains(&chart) {
                    editor.handle(PageRequest::Pick { chart: Some(chart), adds: false }.into());
                }
                editor.begin_gesture(GestureKind::Move, Some(from), true);
            }
        }
        Self { holds_charts: editor.plane.page.gesture().is_some() }
    }
}

/// Lets a gesture follow the pointer, and ends a drag with its button.
fn follow(ui: &egui::Ui, response: &Response, editor: &mut Editor, place: Option<DVec2>) {
    let Some(&PageGesture { is_drag, has_start, .. }) = editor.plane.page.gesture() else { return };
    let place = place.filter(|_| has_start || response.contains_pointer());
    let modifiers = ui.input(|input| input.modifiers);
    editor.follow_gesture(place, modifiers.command, modifiers.alt);
    ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
    if is_drag && (response.drag_stopped() || !ui.input(|input| input.pointer.primary_down())) {
        editor.end_gesture();
    }
}

/// Clicks: a click ends a gesture of the keyboard, or selects; a double click shows the chart alone.
fn click(ui: &egui::Ui, response: &Response, editor: &mut Editor, requests: &mut Vec<Request>) {
    if editor.plane.page.gesture().is_some() {
        if response.clicked() {
            requests.push(PageRequest::End.into());
        } else if response.secondary_clicked() {
            editor.drop_gesture();
        }
        return;
    }
    if editor.kind_under_pointer().is_some() {
        return element_click(ui, response, editor, requests);
    }
    let chart = editor.plane.page.hovered();
    if response.double_clicked() && chart.is_some() {
        requests.push(PageRequest::Open(chart).into());
    } else if response.clicked() {
        let adds = ui.input(|input| input.modifiers.shift);
        requests.push(PageRequest::Pick { chart, adds }.into());
    }
    if response.hovered() && chart.is_some() {
        ui.ctx().set_cursor_icon(CursorIcon::PointingHand);
    }
}

/// Clicks on elements: a click selects one; a double click shows its chart alone.
fn element_click(ui: &egui::Ui, response: &Response, editor: &Editor, requests: &mut Vec<Request>) {
    let chart = editor.chart_of_element();
    if response.double_clicked() && chart.is_some() {
        requests.push(PageRequest::Open(chart).into());
    } else {
        elements::click(ui, response, editor, requests);
    }
}

/// Mesh pane with the maps of all charts.
pub(super) fn mesh_ui(ui: &mut egui::Ui, response: &Response, editor: &mut Editor, requests: &mut Vec<Request>) {
    let (Some(scene), Some(mut camera)) = (editor.plane.page.scene().map(Arc::clone), editor.mesh.pane.camera()) else {
        return;
    };
    let rect = response.rect;
    let hit = |ray| scene.picker_hit(ray);
    mesh_pane::navigate(ui, response, &hit, &mut camera, true);
    if editor.mesh.pane.camera() != Some(camera) {
        editor.mesh.pane.set_camera(camera);
        ui.ctx().request_repaint();
    }
    if let Some(pointer) = response.hover_pos().map(|at| in_pane(rect, at)) {
        editor.pointer.over_mesh(None);
        let kind = editor.kind_under_pointer();
        let chart = || scene.chart_hit(camera.ray(pointer, size_of(rect)));
        editor.plane.page.set_hovered(if kind.is_none() { chart() } else { None });
        if let Some((kind, at)) = kind.zip(response.hover_pos()) {
            let (surface, visibility) = (Surface::of_page(&scene), elements::visibility(editor));
            editor.pointer.set_element(surface.element_at(kind, Viewport { rect, camera }, at, visibility));
        }
        if editor.plane.page.hovered().is_some() {
            ui.ctx().set_cursor_icon(CursorIcon::PointingHand);
        }
    }
    let view = Viewport { rect, camera };
    if let Some(region) = draw_region(ui, response, editor, Pane::Mesh) {
        requests.push(within_mesh(view, &region, editor, &scene));
    }
    if editor.kind_under_pointer().is_some() {
        elements::click(ui, response, editor, requests);
    } else if response.clicked() && editor.plane.page.gesture().is_none() && editor.tools.tool() == Tool::Select {
        let adds = ui.input(|input| input.modifiers.shift);
        requests.push(PageRequest::Pick { chart: editor.plane.page.hovered(), adds }.into());
    }
    if editor.gpu.has_gpu() {
        ui.painter().add(render::mesh_pane(PaneId("mesh"), rect, mesh_frame(editor, &scene, camera, theme_of(ui))));
    }
    element_marks_on_mesh(ui, view, editor, &scene);
    legend::legend(ui, rect, editor, Pane::Mesh);
}

/// Request that selects what is seen in a region of the mesh pane: charts, or elements.
fn within_mesh(view: Viewport<OrbitCamera>, region: &Region, editor: &Editor, scene: &PageScene) -> Request {
    let (rect, camera) = (view.rect, view.camera);
    if let Some(kind) = editor.kind_under_pointer() {
        let (surface, visibility) = (Surface::of_page(scene), elements::visibility(editor));
        return Request::AddElements(surface.inside(kind, view, region, visibility));
    }
    let is_in_region = |at| view.spot(at).is_some_and(|at| region.contains(at));
    let eye = (!editor.selection.through).then(|| camera.eye());
    let is_inside = |chart: &usize| scene.has_vertex_within(*chart, eye, is_in_region);
    let mut charts: Vec<usize> = (0..scene.spans.len()).filter(is_inside).collect();
    let under = |at| scene.chart_hit(camera.ray(in_pane(rect, at), size_of(rect)));
    charts.extend(region.line().into_iter().filter_map(under));
    PageRequest::Add(charts).into()
}

/// Pins, selected vertices, and the element under the pointer, in the mesh pane.
fn element_marks_on_mesh(ui: &egui::Ui, view: Viewport<OrbitCamera>, editor: &Editor, scene: &PageScene) {
    let (painter, theme) = (ui.painter_at(view.rect), theme_of(ui));
    let (picker, eye) = (scene.surface_picker(), view.camera.eye());
    let spot = |vertex: VertexId| view.spot(*picker.positions().get(vertex.index())?);
    let mesh = scene.elements();
    let seen = |vertex| spot(vertex).filter(|_| picker.is_visible(vertex, eye));
    let is_seen = |element| elements::is_seen(picker, element, eye);
    let marks = Marks { painter: &painter, theme, mesh: &mesh };
    marks.selection(Some(editor.plane.page.elements()), spot, is_seen);
    pin_marks(&painter, editor, theme, spot, |vertex| picker.is_visible(vertex, eye));
    marks.under_pointer(editor.pointer.element(), seen);
}

/// Lines of the outlines: all, those under the pointer, and those that are selected.
fn lines(editor: &Editor, scene: &PageScene, theme: &Theme, colour: crate::view::Srgb) -> Vec<LineLayer> {
    let line = |edges: &Arc<EdgeList>, colour, width_in_points| LineLayer {
        edges: Arc::clone(edges),
        colour,
        width_in_points,
    };
    let mut lines = vec![line(&scene.outlines, colour, 1.5)];
    lines.extend(editor.plane.page.hovered_outlines().map(|edges| line(edges, theme.selection_line, 2.0)));
    lines.extend(editor.plane.page.element_lines().map(|edges| elements::line_of(edges, theme)));
    lines.extend(editor.plane.page.selected_outlines().map(|edges| line(edges, theme.selection_line, 3.0)));
    lines
}

/// Style of the faces in a pane.
fn style(editor: &Editor, pane: Pane) -> Style {
    // A movement of faces is a movement of one chart between its steps.
    let chosen =
        Some(editor.shading(pane)).filter(|shading| *shading != ShadingMode::Move).unwrap_or(ShadingMode::Plain);
    mesh_pane::style_of(editor, chosen, editor.plane.page.check_size(editor.pane_shading.checker.wanted_squares()))
}

/// Frame of the embedding pane.
pub(super) fn plane_frame(editor: &Editor, scene: &PageScene, camera: PlaneCamera, theme: &Theme) -> PlaneFrame {
    PlaneFrame {
        mesh: Arc::clone(&scene.mesh),
        plane: editor.plane.page.plane().map(Arc::clone),
        paint: editor.plane.page.paint(Pane::Plane).map(Arc::clone),
        fills: Vec::new(),
        lines: lines(editor, scene, theme, theme.boundary),
        ghost: None,
        picture: editor.pane_shading.picture_layer(scene.page_box(), editor.appearance().opacity),
        pattern: editor.pane_shading.checker.tile(),
        outlined: scene.page_box(),
        style: style(editor, Pane::Plane),
        palette: theme.palette,
        camera,
    }
}

/// Frame of the mesh pane.
pub(super) fn mesh_frame(editor: &Editor, scene: &PageScene, camera: OrbitCamera, theme: &Theme) -> MeshFrame {
    MeshFrame {
        around: None,
        mesh: Arc::clone(&scene.mesh),
        plane: editor.plane.page.plane().map(Arc::clone),
        paint: editor.plane.page.paint(Pane::Mesh).map(Arc::clone),
        lines: lines(editor, scene, theme, theme.seam),
        around_lines: Vec::new(),
        picture: editor.pane_shading.picture_layer(scene.page_box(), editor.appearance().opacity),
        pattern: editor.pane_shading.checker.tile(),
        camera,
        style: style(editor, Pane::Mesh),
        palette: theme.palette,
    }
}

/// Frames of tiles with charts beyond the first, and the numbers of all tiles.
fn tiles(ui: &egui::Ui, view: Viewport<PlaneCamera>, editor: &Editor, scene: &PageScene) {
    let Some(atlas) = editor.session.newest_atlas() else { return };
    let theme = theme_of(ui);
    let painter = ui.painter_at(view.rect);
    let numbers: BTreeSet<u32> = atlas.tiles.iter().flatten().copied().chain([FIRST_UDIM_TILE]).collect();
    let size = scene.page_box().high;
    for &tile in numbers.iter().filter(|_| numbers.len() > 1) {
        let low = corner_of_tile((tile - FIRST_UDIM_TILE) as usize) * size;
        let box_of_tile = Bounds::at(low, size);
        let rect = Rect::from_two_pos(view.spot(box_of_tile.low), view.spot(box_of_tile.high));
        painter.rect_stroke(rect, 0.0, Stroke::new(1.0, theme.weak_text), egui::StrokeKind::Inside);
        let at = rect.left_bottom() + Vec2::new(4.0, -3.0);
        painter.text(at, Align2::LEFT_BOTTOM, tile.to_string(), FontId::proportional(11.0), theme.weak_text);
    }
}

/// Outlines where charts are kept back from, because they would overlap others there.
fn kept_back(ui: &egui::Ui, view: Viewport<PlaneCamera>, editor: &Editor, scene: &PageScene) {
    let kept_back = editor.session.move_state().and_then(|state| state.kept_back.as_ref());
    let Some(judged) = kept_back else { return };
    let (painter, theme) = (ui.painter_at(view.rect), theme_of(ui));
    let mut left = EDGES_SHOWN;
    for &(chart, by) in &judged.moves {
        for outline in scene.outlines_of(chart) {
            let spots: Vec<Pos2> = outline.iter().map(|&at| view.spot(by.transform_point2(at))).collect();
            for (&from, &to) in spots.iter().zip(spots.iter().cycle().skip(1)).take(left) {
                painter.line_segment([from, to], Stroke::new(1.5, theme.flipped));
            }
            left = left.saturating_sub(spots.len());
        }
    }
}

/// Note over the pane on the gesture in progress.
fn gesture_note(ui: &egui::Ui, rect: Rect, editor: &Editor) {
    let Some(gesture) = editor.plane.page.gesture() else { return };
    let theme = theme_of(ui);
    let words = gesture.words(&editor.snap_places(ui.input(|input| input.modifiers.command)));
    let font = FontId::proportional(13.0);
    let galley = ui.painter().layout_no_wrap(words, font, theme.text);
    let frame = Rect::from_center_size(rect.center_top() + Vec2::new(0.0, 20.0), galley.size() + Vec2::new(20.0, 8.0));
    let painter = ui.painter_at(rect);
    painter.rect_filled(frame, 4.0, theme.panel.gamma_multiply(0.95));
    painter.galley(frame.min + Vec2::new(10.0, 4.0), galley, Color32::PLACEHOLDER);
}

/// State of the charts that are being solved, in the middle of the pane.
pub(super) fn waiting_words(editor: &Editor) -> Vec<String> {
    let [solved, all] = editor.session.solved_count();
    if solved < all {
        vec!["Solving…".to_owned(), format!("{solved} of {all} charts are solved")]
    } else {
        vec!["Packing…".to_owned(), "All charts appear here as they lie on the page".to_owned()]
    }
}

/// Data of the chart under the pointer, or of the selection, for the status bar.
pub(in crate::ui) fn numbers(editor: &Editor) -> Vec<String> {
    let mut parts = Vec::new();
    let element = editor.pointer.element().zip(editor.plane.page.scene());
    parts.extend(element.and_then(|(element, scene)| scene.element_words(element)));
    let atlas = editor.session.newest_atlas();
    if let Some(chart) = editor.plane.page.hovered() {
        let name = editor.session.chart_name(chart).map(|name| format!(" {name}")).unwrap_or_default();
        parts.push(format!("Chart {chart}{name}"));
        if let Some(density) = atlas.and_then(|atlas| atlas.densities.get(chart)) {
            parts.push(format!("{} px per unit", five_digits(*density)));
        }
        let tile = atlas.and_then(|atlas| atlas.tiles.get(chart).copied().flatten());
        parts.extend(tile.map(|tile| format!("tile {tile}")));
    }
    parts
}

/// Point of the page's plane as texture coordinates.
pub(in crate::ui) fn texture_coordinates(page: &ChartPage, at: DVec2) -> DVec2 {
    at / DVec2::new(page.aspect, 1.0)
}
